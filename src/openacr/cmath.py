"""C library mathematics under the names the compiled sources use.

Compiled, these are the functions of libm; as plain Python they are thin wrappers that
return the same double for the same arguments, where Python would raise, too: a pole is an
infinity, and an invalid operation the NaN of this processor, sign bit included. `floor` and
`rint` return floats, unlike their Python relatives; `rint` rounds halves to even, as the C
library does. `sqrt` is the function of Python itself: the core calls it with 0 and above only.
"""

import math
from collections.abc import Callable
from functools import wraps
from math import asinh, atan, atan2, fabs, sqrt, tanh

__all__ = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "ceil", "cos", "cosh", "exp",
    "fabs", "floor", "fmod", "log", "log10", "pow", "rint", "sin", "sinh", "sqrt", "tan", "tanh",
    "trunc",
]  # fmt: skip


# The result of an invalid operation: its sign bit is that of the processor, as in C.
_INFINITY = math.inf
INVALID = _INFINITY - _INFINITY


def _domain(function: Callable[[float], float], nan: float = INVALID) -> Callable[[float], float]:
    """A function that gives NaN outside its domain."""

    @wraps(function)
    def total(x: float) -> float:
        try:
            return function(x)
        except ValueError:
            return nan

    return total


# glibc wraps acos, asin and log10: their NaN is the positive one.
acos, asin = _domain(math.acos, math.nan), _domain(math.asin, math.nan)
acosh = _domain(math.acosh)
cos, sin, tan = _domain(math.cos), _domain(math.sin), _domain(math.tan)


def atanh(x: float) -> float:
    """Inverse hyperbolic tangent; infinite at -1 and 1."""
    try:
        return math.atanh(x)
    except ValueError:
        return math.copysign(math.inf, x) if abs(x) == 1.0 else INVALID


def exp(x: float) -> float:
    """Power of e; infinite where it overflows."""
    try:
        return math.exp(x)
    except OverflowError:
        return math.inf


def log(x: float) -> float:
    """Natural logarithm; minus infinity at 0."""
    try:
        return math.log(x)
    except ValueError:
        return -math.inf if x == 0.0 else INVALID


def log10(x: float) -> float:
    """Logarithm to base 10; minus infinity at 0."""
    try:
        return math.log10(x)
    except ValueError:
        return -math.inf if x == 0.0 else math.nan


def fmod(x: float, y: float) -> float:
    """The rest of x divided by y, with the sign of x."""
    try:
        return math.fmod(x, y)
    except ValueError:
        return INVALID


def _signed(whole: int, x: float) -> float:
    """A whole number as a float; 0 has the sign of what was rounded to it."""
    return float(whole) if whole else math.copysign(0.0, x)


def floor(x: float) -> float:
    """Largest integer not above x, as a float; infinities and NaN pass through."""
    return _signed(math.floor(x), x) if math.isfinite(x) else x


def ceil(x: float) -> float:
    """Smallest integer not below x, as a float; infinities and NaN pass through."""
    return _signed(math.ceil(x), x) if math.isfinite(x) else x


def trunc(x: float) -> float:
    """The value without its fraction, as a float; infinities and NaN pass through."""
    return _signed(math.trunc(x), x) if math.isfinite(x) else x


def rint(x: float) -> float:
    """Nearest integer, halves to even, as a float; infinities and NaN pass through."""
    return _signed(round(x), x) if math.isfinite(x) else x


def sinh(x: float) -> float:
    """Hyperbolic sine; infinite where it overflows."""
    try:
        return math.sinh(x)
    except OverflowError:
        return math.copysign(math.inf, x)


def cosh(x: float) -> float:
    """Hyperbolic cosine; infinite where it overflows."""
    try:
        return math.cosh(x)
    except OverflowError:
        return math.inf


def pow(x: float, y: float) -> float:
    """Power of x to y; infinite where it overflows and at 0 with y below 0, NaN where not real."""
    try:
        return math.pow(x, y)
    except OverflowError:
        return math.inf if x > 0 or math.fmod(y, 2) == 0 else -math.inf
    except ValueError:
        if x != 0.0:
            return INVALID
        is_odd = math.fmod(y, 2) in (-1.0, 1.0)
        return math.copysign(math.inf, x) if is_odd else math.inf
