"""C library mathematics under the names the compiled sources use.

Compiled, these are the functions of libm; as plain Python they are thin wrappers that
return the same double for the same arguments (`floor` and `rint` return floats, unlike
their Python relatives; `rint` rounds halves to even, as the C library does).
"""

import math
from math import (
    acos,
    acosh,
    asin,
    asinh,
    atan,
    atan2,
    atanh,
    cos,
    exp,
    fabs,
    fmod,
    log,
    log10,
    sin,
    sqrt,
    tan,
    tanh,
)

__all__ = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "ceil", "cos", "cosh", "exp",
    "fabs", "floor", "fmod", "log", "log10", "pow", "rint", "sin", "sinh", "sqrt", "tan", "tanh",
    "trunc",
]  # fmt: skip


def floor(x: float) -> float:
    """Largest integer not above x, as a float; infinities and NaN pass through."""
    return float(math.floor(x)) if math.isfinite(x) else x


def ceil(x: float) -> float:
    """Smallest integer not below x, as a float; infinities and NaN pass through."""
    return float(math.ceil(x)) if math.isfinite(x) else x


def trunc(x: float) -> float:
    """The value without its fraction, as a float; infinities and NaN pass through."""
    return float(math.trunc(x)) if math.isfinite(x) else x


def rint(x: float) -> float:
    """Nearest integer, halves to even, as a float; infinities and NaN pass through."""
    return float(round(x)) if math.isfinite(x) else x


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
    """Power of x to y; infinite where it overflows, NaN where it is not real."""
    try:
        return math.pow(x, y)
    except OverflowError:
        return math.inf if x > 0 or math.fmod(y, 2) == 0 else -math.inf
    except ValueError:
        return math.nan
