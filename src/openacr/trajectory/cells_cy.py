"""What happens between knots: mean acceleration and jerk of every cell.

Rows keep the limits at knots only. Setpoints are some milliseconds apart, and their differences
are means over several of them; so the mean over a cell is what has to be within the limits.
"""

from openacr.cmath import fabs, sqrt
from openacr.trajectory.speed_curve_cy import VALUES
from openacr.trajectory.speed_rows_cy import speed_hermite
from openacr.trajectory.spline_cy import spline_slopes
from openacr.views import F64

PARTS = 4

__all__ = ["cells_excess"]


def boole_weight(n: int) -> float:
    """Weights of the formula of Boole over five points."""
    if n == 0 or n == PARTS:
        return 7.0 / 90.0
    if n == 2:
        return 12.0 / 90.0
    return 32.0 / 90.0


def cells_excess(
    C: F64,
    points: int,
    axes: int,
    step: float,
    origin: float,
    at: F64,
    first: int,
    stop: int,
    push: F64,
    soft: F64,
    limits: F64,
    H: F64,
    Q: F64,
    N: F64,
    pushes: F64,
    jerks: F64,
) -> None:
    """Write the mean acceleration and jerk of the cells first ... stop-1, relative to the limits.

    The largest of all axes count. H are h, h' and h'' at the knots (speed_curve_cy.py), `push`
    and `soft` the
    shares of the limits at knots, of which the larger one counts; Q and N are room for axes*3
    numbers.
    """
    for i in range(first, stop):
        v: int = VALUES * i
        d: float = at[i + 3] - at[i + 2]
        for k in range(2 * axes):
            N[k] = 0.0
        for n in range(PARTS + 1):
            x: float = float(n) / float(PARTS)
            h: float = speed_hermite(H[v], H[v + 1], H[v + VALUES], H[v + VALUES + 1], d, x)
            bend: float = H[v + VALUES + 2] - H[v + 2]
            h1: float = H[v + 1] + d * x * (H[v + 2] + 0.5 * x * bend)
            h2: float = H[v + 2] + x * bend
            weight: float = boole_weight(n)
            root: float = weight * sqrt(h)
            spline_slopes(C, points, axes, step, at[i + 2] + x * d - origin, Q, 0)
            for k in range(axes):
                N[k] = N[k] + weight * (0.5 * Q[k] * h1 + Q[axes + k] * h)
                N[axes + k] = N[axes + k] + root * (
                    0.5 * Q[k] * h2 + 1.5 * Q[axes + k] * h1 + Q[2 * axes + k] * h
                )
        most: float = 0.0
        worst: float = 0.0
        for k in range(axes):
            ratio: float = fabs(N[k]) / limits[axes + k]
            if ratio > most:
                most = ratio
            ratio = fabs(N[axes + k]) / limits[2 * axes + k]
            if ratio > worst:
                worst = ratio
        share: float = push[i] if push[i] > push[i + 1] else push[i + 1]
        pushes[i] = most / share
        share = soft[i] if soft[i] > soft[i + 1] else soft[i + 1]
        jerks[i] = worst / share
