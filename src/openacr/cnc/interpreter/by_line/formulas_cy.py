"""Formulas of part programs as byte code: numbers of the line, cells, operators, functions.

Code is part of a plan, operands are on `values.stack`. The numbers are those of the trees
(`reading/formulas.py`, `reading/functions.py`), bit for bit. Where a tree would raise an error, or
a result is not finite, or a cell is not at hand, there is no value: the tree then says why.

`cells` are those of the store, with their state in `states`.
"""

from openacr.cmath import (
    acos,
    asin,
    atan,
    atan2,
    ceil,
    cos,
    exp,
    fabs,
    floor,
    fmod,
    log,
    pow,
    sin,
    sqrt,
    tan,
    trunc,
)
from openacr.cnc.rows import scans, values
from openacr.views import F64, I32

__all__ = ["formula_run"]

DO_RESULT = 0
DO_NUMBER = 1  # (n)
DO_NEGATED = 2  # (n)
DO_CELL = 3  # (n)
DO_LOCAL = 4  # (n)
DO_HASH = 5  # (n): the local, or outside calls the cell
DO_OWN = 6  # (n)
DO_WHOLE = 7  # (n): n itself
DO_ANY_CELL = 8  # [n]
DO_ANY_HASH = 9  # [n]
DO_ANY_OWN = 10  # [n]
DO_NEGATE = 11  # [x], the first of these
DO_NOT = 12
DO_SIN = 13
DO_COS = 14
DO_TAN = 15
DO_ATAN = 16
DO_ASIN = 17
DO_ACOS = 18
DO_SQRT = 19
DO_ABS = 20
DO_INT = 21
DO_ROUND = 22
DO_FIX = 23
DO_FUP = 24
DO_LN = 25
DO_EXP = 26
DO_ADD = 27  # [x, y], the first of these
DO_SUBTRACT = 28
DO_MULTIPLY = 29
DO_DIVIDE = 30
DO_LESS = 31
DO_MORE = 32
DO_EQUAL = 33
DO_AT_MOST = 34
DO_AT_LEAST = 35
DO_UNEQUAL = 36
DO_AND = 37
DO_OR = 38
DO_XOR = 39
DO_MOD = 40
DO_MOD_UP = 41
DO_POWER = 42
DO_ATAN2 = 43

RADIANS = 0.017453292519943295
DEGREES = 57.29577951308232
NO_VALUE = 1.0e308 * 10.0


def formula_sine(x: float) -> float:
    """Sine of degrees, exact where it is a half or a whole."""
    turned: float = fabs(x)
    side: float = 1.0 if x > 0.0 else -1.0
    if turned == 0.0 or turned == 180.0 or turned == 360.0:
        return side * 0.0
    if turned == 30.0 or turned == 150.0:
        return side * 0.5
    if turned == 90.0:
        return side
    if turned == 210.0 or turned == 330.0:
        return side * -0.5
    if turned == 270.0:
        return side * -1.0
    return sin(x * RADIANS)


def formula_cosine(x: float) -> float:
    """Cosine of degrees, exact where it is a half or a whole."""
    turned: float = fabs(x)
    if turned == 0.0 or turned == 360.0:
        return 1.0
    if turned == 60.0 or turned == 300.0:
        return 0.5
    if turned == 90.0 or turned == 270.0:
        return 0.0
    if turned == 120.0 or turned == 240.0:
        return -0.5
    if turned == 180.0:
        return -1.0
    return cos(x * RADIANS)


def formula_tangent(x: float) -> float:
    """Tangent of degrees; none at right angles."""
    turned: float = fmod(x, 180.0)
    if fabs(turned) == 90.0:
        return NO_VALUE
    if fabs(turned) == 45.0:
        return 1.0 if turned > 0.0 else -1.0
    return tan(x * RADIANS)


def formula_rounded(op: int, x: float) -> float:
    """INT, ROUND, FIX and FUP; no negative zero but that of ROUND."""
    if op == DO_ROUND:
        whole: float = floor(fabs(x) + 0.5)
        return -whole if formula_is_negative(x) else whole
    if op == DO_INT:
        return trunc(x) + 0.0
    return (floor(x) if op == DO_FIX else ceil(x)) + 0.0


def formula_is_negative(x: float) -> bool:
    """Whether x has a minus sign, of zeros too."""
    return x < 0.0 or (x == 0.0 and atan2(x, -1.0) < 0.0)


def formula_inverse(op: int, x: float) -> float:
    """ATAN, ASIN and ACOS in degrees."""
    if op == DO_ATAN:
        return atan(x) * DEGREES
    if x < -1.0 or x > 1.0:
        return NO_VALUE
    return (asin(x) if op == DO_ASIN else acos(x)) * DEGREES


def formula_unary(op: int, x: float) -> float:
    """A function of one operand; not finite where there is no value."""
    if op == DO_NEGATE:
        return -x
    if op == DO_NOT:
        return 1.0 if x == 0.0 else 0.0
    if op == DO_SIN:
        return formula_sine(x)
    if op == DO_COS:
        return formula_cosine(x)
    if op == DO_TAN:
        return formula_tangent(x)
    if op <= DO_ACOS:
        return formula_inverse(op, x)
    if op == DO_SQRT:
        return sqrt(x) if x >= 0.0 else NO_VALUE
    if op == DO_ABS:
        return fabs(x)
    if op <= DO_FUP:
        return formula_rounded(op, x)
    if op == DO_EXP:
        return exp(x)
    return log(x) if x > 0.0 else NO_VALUE


def formula_compared(op: int, x: float, y: float) -> bool:
    """Comparisons and logic."""
    if op == DO_LESS:
        return x < y
    if op == DO_MORE:
        return x > y
    if op == DO_EQUAL:
        return x == y
    if op == DO_AT_MOST:
        return x <= y
    if op == DO_AT_LEAST:
        return x >= y
    if op == DO_UNEQUAL:
        return x != y
    if op == DO_AND:
        return x != 0.0 and y != 0.0
    if op == DO_OR:
        return x != 0.0 or y != 0.0
    return (x != 0.0) != (y != 0.0)


def formula_binary(op: int, x: float, y: float) -> float:
    """An operator or function of two operands; not finite where there is no value."""
    if op == DO_ADD:
        return x + y
    if op == DO_SUBTRACT:
        return x - y
    if op == DO_MULTIPLY:
        return x * y
    if op == DO_DIVIDE:
        return x / y if y != 0.0 else NO_VALUE
    if op <= DO_XOR:
        return 1.0 if formula_compared(op, x, y) else 0.0
    if op == DO_POWER:
        return pow(x, y)
    if op == DO_ATAN2:
        return atan2(x, y) * DEGREES
    if y == 0.0:
        return NO_VALUE
    rest: float = fmod(x, y)
    return rest + fabs(y) if op == DO_MOD_UP and rest < 0.0 else rest


def formula_whole(x: float) -> int:
    """The number of a parameter; -1 if it is not whole or out of range."""
    if not 0.0 <= x <= 1.0e6 or floor(x) != x:
        return -1
    return int(x)


def formula_cell(I: I32, cells: F64, states: I32, n: int) -> float:
    """A cell of the store."""
    if n < 0 or n >= values.CELLS or not I[values.access[n]] & values.MAY_READ:
        return NO_VALUE
    return cells[n] if states[n] & values.IS_KNOWN else NO_VALUE


def formula_hash(F: F64, I: I32, cells: F64, states: I32, n: int) -> float:
    """Parameter #n of the acromill dialect."""
    if F[values.local[0]] != 0.0 and 1 <= n <= values.LOCALS:
        return F[values.local[n]]
    return formula_cell(I, cells, states, n)


def formula_own(F: F64, n: int) -> float:
    """Parameter #n of the rs274ngc dialect."""
    if n < 1 or n > values.LAST_OWN:
        return NO_VALUE
    return F[values.local[n]] if n <= values.OWN_LOCALS else F[values.own[n]]


def formula_read(F: F64, I: I32, cells: F64, states: I32, op: int, n: int) -> float:
    """A parameter; not finite where only the tree can read it."""
    if op == DO_LOCAL:
        return F[values.local[n]]
    if op == DO_HASH or op == DO_ANY_HASH:
        return formula_hash(F, I, cells, states, n)
    if op == DO_OWN or op == DO_ANY_OWN:
        return formula_own(F, n)
    return formula_cell(I, cells, states, n)


def formula_run(F: F64, I: I32, cells: F64, states: I32, at: int) -> bool:
    """Compute a formula to the stack; False where it has no value, or only the tree has it."""
    top: int = values.stack[0]  # after the last operand
    is_open: bool = True
    op: int = I[at]
    while is_open and op != DO_RESULT:
        if op <= DO_WHOLE:
            n: int = I[at + 1]
            at += 2
            if op == DO_NUMBER:
                F[top] = F[scans.number[n]]
            elif op == DO_NEGATED:
                F[top] = -F[scans.number[n]]
            elif op == DO_WHOLE:
                F[top] = float(n)
            else:
                F[top] = formula_read(F, I, cells, states, op, n)
            top += 1
        else:
            at += 1
            if op < DO_NEGATE:
                F[top - 1] = formula_read(F, I, cells, states, op, formula_whole(F[top - 1]))
            elif op < DO_ADD:
                F[top - 1] = formula_unary(op, F[top - 1])
            else:
                top -= 1
                F[top - 1] = formula_binary(op, F[top - 1], F[top])
        is_open = F[top - 1] - F[top - 1] == 0.0
        op = I[at]
    return is_open
