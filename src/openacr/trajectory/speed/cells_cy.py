"""What happens between knots: the highest speed, mean acceleration and jerk of every cell.

Rows keep the limits at knots only. Setpoints are some milliseconds apart, and their differences
are means over several of them; so the mean over a cell is what has to be within the limits. In a
cell that takes longer it is every value. Of the speeds the highest counts in every cell: where the
path turns, q' of an axis is larger between knots than the squared speed at knots allows.
"""

from openacr.cmath import fabs, sqrt
from openacr.trajectory.path.spline_cy import spline_slopes
from openacr.trajectory.speed.speed_curve_cy import (
    CELL,
    J_AXES,
    J_KNOTS,
    J_POINTS,
    J_ROW,
    K_AT_U,
    K_CELL,
    K_H,
    K_ZONE,
    N_LIMITS,
    N_LONG_S,
    N_ORIGIN_U,
    N_STEP_U,
    SLOPES,
    knot_row,
)
from openacr.trajectory.speed.speed_rows_cy import speed_hermite
from openacr.views import F64, I32

PARTS = 4
TOO_MUCH = 2.0  # where h falls to 0
# Groups of the axes that are summed up over a cell.
HIGHEST = 2  # acceleration and jerk, after their means
FASTEST2 = 4
SUMS = 5

__all__ = ["cells_excess"]


def boole_weight(n: int) -> float:
    """Weights of the formula of Boole over five points."""
    if n == 0 or n == PARTS:
        return 7.0 / 90.0
    if n == 2:
        return 12.0 / 90.0
    return 32.0 / 90.0


def cell_axes(J: I32, N: F64, h: float, h1: float, h2: float, weight: float) -> None:
    """Add a place in a cell, whose slopes are in N, to what is summed up over it."""
    axes: int = J[J_AXES]
    root: float = sqrt(h)
    for k in range(axes):
        q: int = N_LIMITS + SLOPES * axes + k
        n: int = N_LIMITS + CELL * axes + k
        q1: float = N[q]
        q2: float = N[q + axes]
        push: float = 0.5 * q1 * h1 + q2 * h
        jerk: float = root * (0.5 * q1 * h2 + 1.5 * q2 * h1 + N[q + 2 * axes] * h)
        N[n] = N[n] + weight * push
        N[n + axes] = N[n + axes] + weight * jerk
        if q1 * q1 * h > N[n + FASTEST2 * axes]:
            N[n + FASTEST2 * axes] = q1 * q1 * h
        if fabs(push) > N[n + HIGHEST * axes]:
            N[n + HIGHEST * axes] = fabs(push)
        if fabs(jerk) > N[n + (HIGHEST + 1) * axes]:
            N[n + (HIGHEST + 1) * axes] = fabs(jerk)


def cell_sums(J: I32, N: F64, K: F64, C: F64, row: int) -> bool:
    """Sum up the cell after the knot at K[row]; whether h falls to 0 in it."""
    axes: int = J[J_AXES]
    v: int = row + K_H
    w: int = v + J[J_ROW]
    at: float = K[row + K_AT_U]
    d: float = K[row + J[J_ROW] + K_AT_U] - at
    bend: float = K[w + 2] - K[v + 2]
    is_low: bool = False
    for k in range(SUMS * axes):
        N[N_LIMITS + CELL * axes + k] = 0.0
    for n in range(PARTS + 1):
        x: float = float(n) / float(PARTS)
        h: float = speed_hermite(K[v], K[v + 1], K[w], K[w + 1], d, x)
        if h <= 0.0:
            is_low = True
            h = 0.0
        h1: float = K[v + 1] + d * x * (K[v + 2] + 0.5 * x * bend)
        h2: float = K[v + 2] + x * bend
        s: float = at + x * d - N[N_ORIGIN_U]
        spline_slopes(C, J[J_POINTS], axes, N[N_STEP_U], s, N, N_LIMITS + SLOPES * axes)
        cell_axes(J, N, h, h1, h2, boole_weight(n))
    return is_low


def cells_excess(J: I32, N: F64, K: F64, C: F64) -> None:
    """Write squared speed, acceleration and jerk of all cells by the limits.

    The largest of all axes count; of the shares of the jerk at both knots the larger one. The
    values at the knots are those of the weights without ties.
    """
    axes: int = J[J_AXES]
    for i in range(J[J_KNOTS] - 1):
        row: int = knot_row(J, i)
        after: int = row + J[J_ROW]
        is_low: bool = cell_sums(J, N, K, C, row)
        d: float = K[after + K_AT_U] - K[row + K_AT_U]
        slow: float = K[row + K_H] if K[row + K_H] < K[after + K_H] else K[after + K_H]
        is_long: bool = d * d > N[N_LONG_S] * N[N_LONG_S] * slow
        fastest: float = 0.0
        most: float = 0.0
        worst: float = 0.0
        for k in range(axes):
            n: int = N_LIMITS + CELL * axes + k
            limit: int = N_LIMITS + k
            ratio: float = N[n + FASTEST2 * axes] / (N[limit] * N[limit])
            if ratio > fastest:
                fastest = ratio
            n = n + HIGHEST * axes if is_long else n
            ratio = fabs(N[n]) / N[limit + axes]
            if ratio > most:
                most = ratio
            ratio = fabs(N[n + axes]) / N[limit + 2 * axes]
            if ratio > worst:
                worst = ratio
        K[row + K_CELL] = fastest
        K[row + K_CELL + 1] = most
        zone: float = K[row + K_ZONE] if K[row + K_ZONE] > K[after + K_ZONE] else K[after + K_ZONE]
        K[row + K_CELL + 2] = TOO_MUCH if is_low else worst / zone
