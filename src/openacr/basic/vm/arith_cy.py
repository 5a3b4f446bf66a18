"""The arithmetic of AcroBASIC: the one definition of every operator.

Arithmetic is float64; logical and shift operators work on 32-bit words. A result that is
no finite number is an error, so that a program stops instead of moving an axis to NaN.
Operands and results stand on the expression stack of a thread.
"""

from openacr import messages
from openacr.cmath import floor, fmod, pow
from openacr.kernel.words_cy import wrap32
from openacr.views import F64

__all__ = ["apply_operator", "long_word", "operand_word"]


OP_ADD = 1
OP_SUBTRACT = 2
OP_MULTIPLY = 3
OP_DIVIDE = 4
OP_MOD = 5
OP_POWER = 6
OP_EQUAL = 7
OP_UNEQUAL = 8
OP_LESS = 9
OP_GREATER = 10
OP_LESS_EQUAL = 11
OP_GREATER_EQUAL = 12
OP_AND = 13
OP_NAND = 14
OP_OR = 15
OP_NOR = 16
OP_XOR = 17
OP_XNOR = 18
OP_SHIFT_LEFT = 19
OP_SHIFT_RIGHT = 20

NO_WORD = 1099511627776  # what operand_word gives for a number that is no 32-bit word
LOW32 = 4294967295


def long_word(value: float) -> int:
    """`value` as it is stored in a LONG: without fraction, wrapped to 32 bits."""
    if not (-4.611686018427388e18 < value < 4.611686018427388e18):
        return 0
    return wrap32(int(value))


def operand_word(value: float) -> int:
    """`value` as an operand of a logical operator, or NO_WORD if it is out of range."""
    if not (-2147483649.0 < value < 4294967296.0):
        return NO_WORD
    return wrap32(int(value))


def finite(value: float) -> bool:
    """Whether `value` is neither infinite nor NaN."""
    return value - value == 0.0


def apply_operator(F: F64, op: int, at: int) -> int:
    """F[at] := F[at] op F[at + 1]; an error number or 0."""
    a: float = F[at]
    b: float = F[at + 1]
    r: float = 0.0
    if op >= OP_AND:
        return apply_word_operator(F, op, at)
    if op == OP_ADD:
        r = a + b
    elif op == OP_SUBTRACT:
        r = a - b
    elif op == OP_MULTIPLY:
        r = a * b
    elif op == OP_DIVIDE:
        if b == 0.0:
            return messages.DIVIDE_BY_ZERO.number
        r = a / b
    elif op == OP_MOD:
        if b == 0.0:
            return messages.DIVIDE_BY_ZERO.number
        r = fmod(a, b) + 0.0  # no negative zero
    elif op == OP_POWER:
        if a == 0.0 and b < 0.0:
            return messages.DIVIDE_BY_ZERO.number
        if a < 0.0 and floor(b) != b:
            return messages.MATH_ERROR.number
        r = pow(a, b)
    else:
        F[at] = -1.0 if related(op, a, b) else 0.0
        return 0
    if not finite(r):
        return messages.MATH_ERROR.number
    F[at] = r
    return 0


def related(op: int, a: float, b: float) -> bool:
    """The relational operators."""
    if op == OP_EQUAL:
        return a == b
    if op == OP_UNEQUAL:
        return a != b
    if op == OP_LESS:
        return a < b
    if op == OP_GREATER:
        return a > b
    if op == OP_LESS_EQUAL:
        return a <= b
    return a >= b


def apply_word_operator(F: F64, op: int, at: int) -> int:
    """The operators on 32-bit words: logical ones and shifts."""
    a: int = operand_word(F[at])
    b: int = operand_word(F[at + 1])
    r: int = 0
    if a == NO_WORD or b == NO_WORD:
        return messages.MATH_ERROR.number
    if op == OP_AND:
        r = a & b
    elif op == OP_NAND:
        r = ~(a & b)
    elif op == OP_OR:
        r = a | b
    elif op == OP_NOR:
        r = ~(a | b)
    elif op == OP_XOR:
        r = a ^ b
    elif op == OP_XNOR:
        r = ~(a ^ b)
    elif b < 0 or b > 31:
        return messages.MATH_ERROR.number
    elif op == OP_SHIFT_LEFT:
        r = wrap32((a & LOW32) << b)
    else:
        r = a >> b
    F[at] = float(r)
    return 0
