"""The numeric functions of AcroBASIC: the one definition of each.

A result that is no finite number is an error, as with operators. Angles are in degrees.
"""

from openacr import messages
from openacr.basic.vm.arith_cy import LOW32, NO_WORD, finite, operand_word
from openacr.cmath import (
    acos,
    acosh,
    asin,
    asinh,
    atan,
    atanh,
    ceil,
    cos,
    cosh,
    exp,
    fabs,
    floor,
    fmod,
    log,
    log10,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
    trunc,
)
from openacr.kernel.words_cy import wrap32
from openacr.map.rows import system
from openacr.views import F64, I32

__all__ = ["apply_function"]

FN_NEGATE = 1
FN_NOT = 2
FN_ABS = 3
FN_SQRT = 4
FN_LN = 5
FN_LOG = 6
FN_EXP = 7
FN_SIN = 8
FN_COS = 9
FN_TAN = 10
FN_ASIN = 11
FN_ACOS = 12
FN_ATAN = 13
FN_SINH = 14
FN_COSH = 15
FN_TANH = 16
FN_ASINH = 17
FN_ACOSH = 18
FN_ATANH = 19
FN_RND = 20
FN_CEIL = 21
FN_FLOOR = 22
FN_ROUND = 23
FN_TRUNC = 24
FN_SGN = 25
FN_FRAC = 26

TRIG_DEGREES = 1  # 0: radians
DEGREE = 0.017453292519943295


def apply_function(F: F64, I: I32, function: int, at: int) -> int:
    """F[at] := function(F[at]); an error number or 0."""
    x: float = F[at]
    r: float = 0.0
    word: int = 0
    if function == FN_NEGATE:
        r = 0.0 - x  # no negative zero
    elif function == FN_NOT:
        word = operand_word(x)
        if word == NO_WORD:
            return messages.MATH_ERROR.number
        r = float(~word)
    elif function == FN_ABS:
        r = fabs(x)
    elif function >= FN_CEIL:
        r = rounded(function, x)
    elif function == FN_RND:
        r = random_below(I, x)
    elif function >= FN_SINH:
        if (function == FN_ACOSH and x < 1.0) or (function == FN_ATANH and not -1.0 < x < 1.0):
            return messages.MATH_ERROR.number
        r = hyperbolic(function, x)
    elif function >= FN_SIN:
        if (function == FN_ASIN or function == FN_ACOS) and not -1.0 <= x <= 1.0:
            return messages.MATH_ERROR.number
        r = trigonometric(function, x)
    elif function == FN_EXP:
        if x > 709.782712893384:
            return messages.MATH_ERROR.number
        r = exp(x)
    elif function == FN_SQRT:
        if x < 0.0:
            return messages.MATH_ERROR.number
        r = sqrt(x)
    elif x <= 0.0:
        return messages.MATH_ERROR.number
    elif function == FN_LN:
        r = log(x)
    else:
        r = log10(x)
    if not finite(r):
        return messages.MATH_ERROR.number
    F[at] = r
    return 0


def rounded(function: int, x: float) -> float:
    """The functions that find a nearby integer, and the sign."""
    whole: float = trunc(x)
    if function == FN_CEIL:
        whole = ceil(x)
    elif function == FN_FLOOR:
        whole = floor(x)
    elif function == FN_FRAC:
        whole = x - whole
    elif function == FN_SGN:
        whole = 1.0 if x > 0.0 else (-1.0 if x < 0.0 else 0.0)
    elif function == FN_ROUND and fabs(x - whole) >= 0.5:  # halves away from zero
        whole = whole + (1.0 if x > 0.0 else -1.0)
    return whole + 0.0


def trigonometric(function: int, x: float) -> float:
    """Sine, cosine, tangent and their inverses, in the unit of TRIG_DEGREES."""
    unit: float = DEGREE if TRIG_DEGREES == 1 else 1.0
    if function == FN_ASIN:
        return asin(x) / unit
    if function == FN_ACOS:
        return acos(x) / unit
    if function == FN_ATAN:
        return atan(x) / unit
    if TRIG_DEGREES == 0:
        return sin(x) if function == FN_SIN else (cos(x) if function == FN_COS else tan(x))
    if function == FN_SIN:
        return sine_of_degrees(x)
    if function == FN_COS:
        return sine_of_degrees(90.0 - fabs(fmod(x, 360.0)))
    return tangent_of_degrees(x)


def sine_of_degrees(x: float) -> float:
    """Sine by reduction in degrees, so that whole quarter turns and 30 degrees are exact."""
    turn: float = fmod(x, 360.0)
    if turn > 180.0:
        turn = turn - 360.0
    elif turn < -180.0:
        turn = turn + 360.0
    if turn > 90.0:
        turn = 180.0 - turn
    elif turn < -90.0:
        turn = -180.0 - turn
    if turn == 30.0:
        return 0.5
    if turn == -30.0:
        return -0.5
    if turn > 45.0:
        return cos((90.0 - turn) * DEGREE)
    if turn < -45.0:
        return 0.0 - cos((90.0 + turn) * DEGREE)
    return sin(turn * DEGREE)


def tangent_of_degrees(x: float) -> float:
    """Tangent; not finite at odd quarter turns."""
    low: float = sine_of_degrees(90.0 - fabs(fmod(x, 360.0)))
    if low == 0.0:
        return 1.0e308 * 10.0
    if fabs(fmod(x, 180.0)) == 45.0 or fabs(fmod(x, 180.0)) == 135.0:
        return 1.0 if sine_of_degrees(x) * low > 0.0 else -1.0
    return sine_of_degrees(x) / low


def hyperbolic(function: int, x: float) -> float:
    """The hyperbolic functions and their inverses."""
    if function == FN_SINH:
        return sinh(x)
    if function == FN_COSH:
        return cosh(x)
    if function == FN_TANH:
        return tanh(x)
    if function == FN_ASINH:
        return asinh(x)
    if function == FN_ACOSH:
        return acosh(x)
    return atanh(x)


def random_below(I: I32, limit: float) -> float:
    """A uniform integer 0 .. limit - 1 for limits up to 2**32 - 1.

    Marsaglia's xorshift (13, 7, 17) on 64 bits, kept as two words because the state lies
    in the memory of the card. The high word times the limit, shifted down, is uniform
    enough and needs no division.
    """
    low: int = I[system.random_seed_low] & LOW32
    high: int = I[system.random_seed_high] & LOW32
    shifted: int = 0
    if low == 0 and high == 0:
        low = 2463534242
        high = 88675123
    shifted = (low << 13) & LOW32
    high = high ^ (((high << 13) | (low >> 19)) & LOW32)
    low = low ^ shifted
    shifted = high >> 7
    low = low ^ (((low >> 7) | (high << 25)) & LOW32)
    high = high ^ shifted
    shifted = (low << 17) & LOW32
    high = high ^ (((high << 17) | (low >> 15)) & LOW32)
    low = low ^ shifted
    I[system.random_seed_low] = wrap32(low)
    I[system.random_seed_high] = wrap32(high)
    if not (1.0 <= limit):
        return 0.0
    below: int = LOW32 if limit >= 4294967295.0 else int(limit)
    return float(((high >> 16) * below + (((high & 65535) * below) >> 16)) >> 16)
