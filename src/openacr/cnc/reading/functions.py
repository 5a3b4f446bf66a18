"""Functions and operators of formulas: their values, and their form in compiled formulas."""

import math
from collections.abc import Callable
from typing import Any

from msgspec import Struct

RADIANS = math.pi / 180.0

_SINES = {
    0.0: 0.0, 30.0: 0.5, 90.0: 1.0, 150.0: 0.5, 180.0: 0.0, 210.0: -0.5, 270.0: -1.0,
    330.0: -0.5, 360.0: 0.0,
}  # fmt: skip
_SINES |= {-x: -y for x, y in _SINES.items()}
_COSINES = {
    0.0: 1.0, 60.0: 0.5, 90.0: 0.0, 120.0: -0.5, 180.0: -1.0, 240.0: -0.5, 270.0: 0.0,
    300.0: 0.5, 360.0: 1.0,
}  # fmt: skip
_COSINES |= {-x: y for x, y in _COSINES.items()}


class Function(Struct, frozen=True):
    """A function or operator: how it is computed, and its form as Python source."""

    work: Callable[..., float]
    template: str


def sine(x: float) -> float:
    """Sine of degrees; exact where it is a half or a whole."""
    y = _SINES.get(x)
    return math.sin(x * RADIANS) if y is None else y


def cosine(x: float) -> float:
    """Cosine of degrees; exact where it is a half or a whole."""
    y = _COSINES.get(x)
    return math.cos(x * RADIANS) if y is None else y


def tangent(x: float) -> float:
    """Tangent of degrees; ArithmeticError at 90 and 270."""
    turned = math.fmod(x, 180.0)
    if abs(turned) == 90.0:
        raise ArithmeticError("TAN of a right angle")
    return math.copysign(1.0, turned) if abs(turned) == 45.0 else math.tan(x * RADIANS)


def arc_tangent(x: float) -> float:
    """Arc tangent in degrees."""
    return math.degrees(math.atan(x))


def arc_tangent2(y: float, x: float) -> float:
    """Angle in degrees of the point (x, y)."""
    return math.degrees(math.atan2(y, x))


def arc_sine(x: float) -> float:
    """Arc sine in degrees."""
    return math.degrees(math.asin(x))


def arc_cosine(x: float) -> float:
    """Arc cosine in degrees."""
    return math.degrees(math.acos(x))


def whole(x: float) -> float:
    """The number without its fraction."""
    return float(math.trunc(x))


def rounded(x: float) -> float:
    """Nearest whole number, halves away from zero."""
    return math.copysign(math.floor(abs(x) + 0.5), x)


def down(x: float) -> float:
    """Largest whole number not above."""
    return float(math.floor(x))


def up(x: float) -> float:
    """Smallest whole number not below."""
    return float(math.ceil(x))


def remainder(x: float, y: float) -> float:
    """Remainder with the sign of the dividend."""
    return math.fmod(x, y)


def remainder_up(x: float, y: float) -> float:
    """Remainder that is never negative."""
    rest = math.fmod(x, y)
    return rest + abs(y) if rest < 0.0 else rest


def power(x: float, y: float) -> float:
    """Power of x to y."""
    return math.pow(x, y)


def _logic(operator: str) -> Function:
    template = f"float(({{0}} != 0.0) {operator} ({{1}} != 0.0))"
    return Function(eval(f"lambda x, y: {template.format('x', 'y')}"), template)


def _comparison(operator: str) -> Function:
    template = f"(1.0 if {{0}} {operator} {{1}} else 0.0)"
    return Function(eval(f"lambda x, y: {template.format('x', 'y')}"), template)


def _arithmetic(operator: str) -> Function:
    template = f"({{0}} {operator} {{1}})"
    return Function(eval(f"lambda x, y: {template.format('x', 'y')}"), template)


NAMES: dict[str, Any] = {}  # what compiled formulas call by name


def _called(work: Callable[..., float], count: int = 1) -> Function:
    NAMES[work.__name__] = work
    holes = ", ".join(f"{{{k}}}" for k in range(count))
    return Function(work, f"{work.__name__}({holes})")


ADD, SUBTRACT, MULTIPLY, DIVIDE = (_arithmetic(operator) for operator in "+-*/")
LESS, MORE, EQUAL, AT_MOST, AT_LEAST, UNEQUAL = (
    _comparison(operator) for operator in ("<", ">", "==", "<=", ">=", "!=")
)
AND, OR, XOR = (_logic(operator) for operator in ("&", "|", "!="))
NOT = Function(lambda x: float(x == 0.0), "float({0} == 0.0)")
NEGATE = Function(lambda x: -x, "(-{0})")
MOD = _called(remainder, 2)
MOD_UP = _called(remainder_up, 2)
POWER = _called(power, 2)
SIN, COS, TAN, ATAN = _called(sine), _called(cosine), _called(tangent), _called(arc_tangent)
ASIN, ACOS, ATAN2 = _called(arc_sine), _called(arc_cosine), _called(arc_tangent2, 2)
SQRT, ABS, INT, ROUND = _called(math.sqrt), _called(math.fabs), _called(whole), _called(rounded)
FIX, FUP, LN, EXP = _called(down), _called(up), _called(math.log), _called(math.exp)
