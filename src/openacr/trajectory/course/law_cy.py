"""A time law: the distance s along a path as a function of time.

It is a table of rows (t, s, v, a) in `Z`. Between two rows s is the polynomial of fifth degree
that has their distances, speeds and accelerations; for a section of constant jerk that is the exact
cubic.
"""

from openacr.views import F64

T_ROW = 0
S_ROW = 1
V_ROW = 2
A_ROW = 3
ROW = 4

__all__ = ["law_distance", "law_row"]


def law_row(Z: F64, count: int, t: float) -> int:
    """The row at or before time t; the last but one at most, the first at least."""
    low: int = 0
    high: int = count - 1
    while high - low > 1:
        middle: int = (low + high) >> 1
        if Z[ROW * middle + T_ROW] <= t:
            low = middle
        else:
            high = middle
    return low


def law_between(Z: F64, row: int, t: float) -> float:
    """The distance at time t by the polynomial that begins at a row."""
    i: int = ROW * row
    d: float = Z[i + ROW + T_ROW] - Z[i + T_ROW]
    if d <= 0.0:
        return Z[i + S_ROW]
    x: float = t - Z[i + T_ROW]
    v: float = Z[i + V_ROW]
    a: float = Z[i + A_ROW]
    rs: float = Z[i + ROW + S_ROW] - Z[i + S_ROW] - d * (v + 0.5 * a * d)
    rv: float = d * (Z[i + ROW + V_ROW] - v - a * d)
    ra: float = d * d * (Z[i + ROW + A_ROW] - a)
    c3: float = 10.0 * rs - 4.0 * rv + 0.5 * ra
    c4: float = -15.0 * rs + 7.0 * rv - ra
    c5: float = 6.0 * rs - 3.0 * rv + 0.5 * ra
    r: float = x / d
    return Z[i + S_ROW] + x * (v + 0.5 * a * x) + r * r * r * (c3 + r * (c4 + r * c5))


def law_distance(Z: F64, count: int, t: float) -> float:
    """The distance at time t: that of the first row before it, that of the last after it."""
    last: int = ROW * (count - 1)
    if t >= Z[last + T_ROW]:
        return Z[last + S_ROW]
    if t <= Z[T_ROW]:
        return Z[S_ROW]
    return law_between(Z, law_row(Z, count, t), t)
