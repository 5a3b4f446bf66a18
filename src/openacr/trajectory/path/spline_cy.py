"""A path as a uniform cubic B-spline of its length, evaluated at any distance.

Control points are rows of `axes` numbers in `C`. Between s = i*step and (i+1)*step, with
x = s/step - i, the four rows i .. i+3 count:

    6 q = (1-x)^3 c0 + (3x^3 - 6x^2 + 4) c1 + (-3x^3 + 3x^2 + 3x + 1) c2 + x^3 c3

The first and second derivative are continuous, the third is a step function; where it is asked for,
its values, taken at the middles of the intervals, are joined linearly.
"""

from openacr.cmath import floor
from openacr.views import F64

__all__ = ["spline_point", "spline_slopes"]


def spline_row(s: float, step: float, count: int) -> int:
    """The first of the four rows that count at s; inside the table for any s."""
    row: int = int(floor(s / step))
    if row > count - 4:
        row = count - 4
    if row < 0:
        row = 0
    return row


def spline_point(C: F64, count: int, axes: int, step: float, s: float, Q: F64, at: int) -> None:
    """Write the position at distance s to Q[at], Q[at + 1] ..., one number per axis."""
    row: int = spline_row(s, step, count)
    x: float = s / step - float(row)
    y: float = 1.0 - x
    w0: float = y * y * y / 6.0
    w3: float = x * x * x / 6.0
    w1: float = (4.0 + x * x * (3.0 * x - 6.0)) / 6.0
    w2: float = 1.0 - w0 - w1 - w3
    i: int = row * axes
    for k in range(axes):
        Q[at + k] = (
            w0 * C[i + k]
            + w1 * C[i + axes + k]
            + w2 * C[i + 2 * axes + k]
            + w3 * C[i + 3 * axes + k]
        )


def spline_third(C: F64, axes: int, i: int, step: float) -> float:
    """The third derivative between the rows of which C[i] is the first, for one axis."""
    bend: float = C[i + 3 * axes] - 3.0 * C[i + 2 * axes] + 3.0 * C[i + axes] - C[i]
    return bend / (step * step * step)


def spline_slopes(C: F64, count: int, axes: int, step: float, s: float, Q: F64, at: int) -> None:
    """Write q', q'' and q''' at distance s to Q[at ...], three groups of one number per axis."""
    row: int = spline_row(s, step, count)
    x: float = s / step - float(row)
    y: float = 1.0 - x
    other: int = row + 1 if x > 0.5 else row - 1
    share: float = x - 0.5 if x > 0.5 else 0.5 - x
    if other > count - 4 or other < 0:
        other = row
    i: int = row * axes
    for k in range(axes):
        d0: float = C[i + axes + k] - C[i + k]
        d1: float = C[i + 2 * axes + k] - C[i + axes + k]
        d2: float = C[i + 3 * axes + k] - C[i + 2 * axes + k]
        Q[at + k] = (0.5 * y * y * d0 + (0.5 + x * y) * d1 + 0.5 * x * x * d2) / step
        Q[at + axes + k] = (y * (d1 - d0) + x * (d2 - d1)) / (step * step)
        Q[at + 2 * axes + k] = (1.0 - share) * spline_third(C, axes, i + k, step) + (
            share * spline_third(C, axes, other * axes + k, step)
        )
