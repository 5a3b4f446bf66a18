"""What the time law needs of a path at its knots, and the time law that a speed curve gives."""

from openacr.cmath import fabs, sqrt
from openacr.trajectory.law_cy import A_ROW, ROW, S_ROW, T_ROW, V_ROW
from openacr.trajectory.speed_curve_cy import AXIS_ROWS, WEIGHTS
from openacr.trajectory.spline_cy import spline_row, spline_slopes, spline_third
from openacr.views import F64

NODE1 = 0.06943184420297371  # of a Gauss formula with four nodes
NODE2 = 0.33000947820757187
SHARE1 = 0.17392742256872693
SHARE2 = 0.32607257743127307
PARTS = 3  # rows of a law for every cell

__all__ = ["law_from_speed", "speed_rows"]


def speed_rows(
    C: F64,
    points: int,
    axes: int,
    step: float,
    origin: float,
    at: F64,
    first: int,
    stop: int,
    feed: F64,
    tool: F64,
    push: F64,
    soft: F64,
    normal: F64,
    limits: F64,
    Q: F64,
    D: F64,
    cap: F64,
) -> None:
    """Write the rows of the knots first ... stop-1 (`at` has two knots before them) and their caps.

    `limits` are velocities, accelerations and jerks, and 1 for axes that carry the tool, whose
    common speed is `tool` at most; `feed` is that of all axes. `push` and `soft` are the shares of
    the limits of acceleration and jerk that count at a knot, `normal` is the largest acceleration
    across the path.
    """
    for i in range(first, stop):
        s: float = at[i + 2] - origin
        low: int = spline_row(s - 0.5 * (at[i + 2] - at[i + 1]), step, points)
        high: int = spline_row(s + 0.5 * (at[i + 3] - at[i + 2]), step, points)
        spline_slopes(C, points, axes, step, s, Q, 0)
        along2: float = 0.0
        tool2: float = 0.0
        bend2: float = 0.0
        best: float = 1e300
        for k in range(axes):
            q1: float = Q[k]
            q2: float = Q[axes + k]
            least: float = spline_third(C, axes, low * axes + k, step)
            greatest: float = least
            for row in range(low + 1, high + 1):
                q3: float = spline_third(C, axes, row * axes + k, step)
                if q3 < least:
                    least = q3
                if q3 > greatest:
                    greatest = q3
            along2 += q1 * q1
            tool2 += limits[3 * axes + k] * q1 * q1
            bend2 += q2 * q2
            d: int = AXIS_ROWS * (i * axes + k)
            most: float = limits[axes + k] * push[i]
            D[d] = q2 / most
            D[d + 1] = 0.5 * q1 / most
            jerk: float = limits[2 * axes + k] * soft[i]
            D[d + 2] = 0.5 * (greatest + least) / jerk
            D[d + 5] = 0.5 * (greatest - least) / jerk
            D[d + 3] = 1.5 * q2 / jerk
            D[d + 4] = 0.5 * q1 / jerk
            if fabs(q1) * sqrt(best) > limits[k]:
                best = limits[k] * limits[k] / (q1 * q1)
        cap[i] = feed[i] * feed[i] / along2
        if best < cap[i]:
            cap[i] = best
        if tool2 * cap[i] > tool[i] * tool[i]:
            cap[i] = tool[i] * tool[i] / tool2
        if sqrt(bend2) * cap[i] > normal[i]:
            cap[i] = normal[i] / sqrt(bend2)


def speed_hermite(h: float, h1: float, g: float, g1: float, d: float, x: float) -> float:
    """The cubic from h with slope h1 to g with slope g1, d apart, at the share x."""
    y: float = 1.0 - x
    return y * y * (h * (1.0 + 2.0 * x) + h1 * d * x) + x * x * (g * (3.0 - 2.0 * x) - g1 * d * y)


def cell_time(h: float, h1: float, g: float, g1: float, d: float, x0: float, x1: float) -> float:
    """The time from the share x0 to the share x1 of a cell, by a formula with four nodes."""
    w: float = x1 - x0
    mean: float = SHARE1 / sqrt(speed_hermite(h, h1, g, g1, d, x0 + w * NODE1))
    mean += SHARE2 / sqrt(speed_hermite(h, h1, g, g1, d, x0 + w * NODE2))
    mean += SHARE2 / sqrt(speed_hermite(h, h1, g, g1, d, x1 - w * NODE2))
    mean += SHARE1 / sqrt(speed_hermite(h, h1, g, g1, d, x1 - w * NODE1))
    return mean * d * w


def law_from_speed(at: F64, X: F64, W: F64, first: int, stop: int, Z: F64, row: int) -> None:
    """Continue a law by PARTS rows for every cell from knot `first` to stop-1.

    Row `row` is that of the knot `first`: its time and distance are given.
    """
    h: float = 0.0
    h1: float = 0.0
    h2: float = 0.0
    for i in range(first, stop):
        w: int = WEIGHTS * i
        g: float = W[w] * X[i] + W[w + 1] * X[i + 1] + W[w + 2] * X[i + 2]
        g1: float = W[w + 3] * X[i] + W[w + 4] * X[i + 1] + W[w + 5] * X[i + 2]
        g2: float = W[w + 6] * X[i] + W[w + 7] * X[i + 1] + W[w + 8] * X[i + 2]
        if i > first:
            d: float = at[i + 2] - at[i + 1]
            for part in range(PARTS):
                x0: float = float(part) / float(PARTS)
                x1: float = float(part + 1) / float(PARTS)
                o: int = ROW * (row + PARTS * (i - first - 1) + part + 1)
                Z[o + T_ROW] = Z[o - ROW + T_ROW] + cell_time(h, h1, g, g1, d, x0, x1)
                Z[o + S_ROW] = at[i + 1] + d * x1
                Z[o + V_ROW] = sqrt(speed_hermite(h, h1, g, g1, d, x1))
                Z[o + A_ROW] = 0.5 * (h1 + d * x1 * (h2 + 0.5 * x1 * (g2 - h2)))
            Z[o + S_ROW] = at[i + 2]
        h = g
        h1 = g1
        h2 = g2
