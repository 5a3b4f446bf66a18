"""What happens between knots: the highest speed, mean acceleration and jerk of every cell.

Rows keep the limits at knots only. Setpoints are some milliseconds apart, and their differences
are means over several of them; so the mean over a cell is what has to be within the limits. In a
cell that takes longer it is every value. Of the speeds the highest counts in every cell: where the
path turns, q' of an axis is larger between knots than the squared speed at knots allows.
"""

from openacr.cmath import fabs, sqrt
from openacr.trajectory.speed_curve_cy import VALUES
from openacr.trajectory.speed_rows_cy import speed_hermite
from openacr.trajectory.spline_cy import spline_slopes
from openacr.views import F64

PARTS = 4
TOO_MUCH = 2.0  # where h falls to 0

__all__ = ["cells_excess"]


def boole_weight(n: int) -> float:
    """Weights of the formula of Boole over five points."""
    if n == 0 or n == PARTS:
        return 7.0 / 90.0
    if n == 2:
        return 12.0 / 90.0
    return 32.0 / 90.0


def cells_excess(
    C: F64, points: int, axes: int, step: float, origin: float, at: F64, first: int, stop: int,
    long_s: float, soft: F64, limits: F64, H: F64, Q: F64, N: F64, speeds: F64,
    pushes: F64, jerks: F64,
) -> None:  # fmt: skip
    """Write squared speed, acceleration and jerk of the cells first ... stop-1 by the limits.

    The largest of all axes count. H are h, h' and h'' at the knots (speed_curve_cy.py), `soft` the
    shares of the jerk limits at knots, of which the larger one counts. Q is room for 4
    numbers of every axis, N for 5.
    """
    for i in range(first, stop):
        v: int = VALUES * i
        d: float = at[i + 3] - at[i + 2]
        for k in range(5 * axes):
            N[k] = 0.0
        is_low: bool = False
        for n in range(PARTS + 1):
            x: float = float(n) / float(PARTS)
            h: float = speed_hermite(H[v], H[v + 1], H[v + VALUES], H[v + VALUES + 1], d, x)
            if h <= 0.0:
                is_low = True
                h = 0.0
            bend: float = H[v + VALUES + 2] - H[v + 2]
            h1: float = H[v + 1] + d * x * (H[v + 2] + 0.5 * x * bend)
            h2: float = H[v + 2] + x * bend
            weight: float = boole_weight(n)
            root: float = sqrt(h)
            spline_slopes(C, points, axes, step, at[i + 2] + x * d - origin, Q, 0)
            for k in range(axes):
                push: float = 0.5 * Q[k] * h1 + Q[axes + k] * h
                jerk: float = root * (
                    0.5 * Q[k] * h2 + 1.5 * Q[axes + k] * h1 + Q[2 * axes + k] * h
                )
                N[k] = N[k] + weight * push
                N[axes + k] = N[axes + k] + weight * jerk
                if Q[k] * Q[k] * h > N[4 * axes + k]:
                    N[4 * axes + k] = Q[k] * Q[k] * h
                if fabs(push) > N[2 * axes + k]:
                    N[2 * axes + k] = fabs(push)
                if fabs(jerk) > N[3 * axes + k]:
                    N[3 * axes + k] = fabs(jerk)
        slow: float = H[v] if H[v] < H[v + VALUES] else H[v + VALUES]
        shift: int = 2 * axes if d * d > long_s * long_s * slow else 0
        fastest: float = 0.0
        most: float = 0.0
        worst: float = 0.0
        for k in range(axes):
            ratio: float = N[4 * axes + k] / (limits[k] * limits[k])
            if ratio > fastest:
                fastest = ratio
            ratio = fabs(N[shift + k]) / limits[axes + k]
            if ratio > most:
                most = ratio
            ratio = fabs(N[shift + axes + k]) / limits[2 * axes + k]
            if ratio > worst:
                worst = ratio
        speeds[i] = fastest
        pushes[i] = most
        jerks[i] = worst / (soft[i] if soft[i] > soft[i + 1] else soft[i + 1])
        if is_low:
            jerks[i] = TOO_MUCH
