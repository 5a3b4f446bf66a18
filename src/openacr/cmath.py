"""C library mathematics under the names the compiled sources use.

Compiled, these are the functions of libm; as plain Python they are thin wrappers that
return the same double for the same arguments (`floor` and `rint` return floats, unlike
their Python relatives; `rint` rounds halves to even, as the C library does).
"""

import math
from math import acos, asin, atan, atan2, cos, exp, fabs, fmod, log, sin, sqrt, tan

__all__ = [
    "acos", "asin", "atan", "atan2", "ceil", "cos", "exp", "fabs", "floor", "fmod",
    "log", "rint", "sin", "sqrt", "tan", "trunc",
]  # fmt: skip


def floor(x: float) -> float:
    """Largest integer not above x, as a float; infinities and NaN pass through."""
    return float(math.floor(x)) if math.isfinite(x) else x


def ceil(x: float) -> float:
    """Smallest integer not below x, as a float; infinities and NaN pass through."""
    return float(math.ceil(x)) if math.isfinite(x) else x


def trunc(x: float) -> float:
    """x without its fraction, as a float; infinities and NaN pass through."""
    return float(math.trunc(x)) if math.isfinite(x) else x


def rint(x: float) -> float:
    """Nearest integer, halves to even, as a float; infinities and NaN pass through."""
    return float(round(x)) if math.isfinite(x) else x
