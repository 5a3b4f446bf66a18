"""What the time law needs of a path at its knots, and the time law that a speed curve gives."""

from openacr.cmath import fabs, sqrt
from openacr.trajectory.course.law_cy import A_ROW, ROW, S_ROW, T_ROW, V_ROW
from openacr.trajectory.path.spline_cy import spline_row, spline_slopes, spline_third
from openacr.trajectory.speed.speed_curve_cy import (
    A_JERK,
    A_PUSH,
    A_SPREAD,
    AXIS,
    J_AXES,
    J_KNOTS,
    J_POINTS,
    K_AT_U,
    K_AXES,
    K_CAP,
    K_FEED_UPS,
    K_NORMAL_UPS2,
    K_PLAIN,
    K_PUSH,
    K_SOFT,
    K_TOOL_UPS,
    N_LIMITS,
    N_ORIGIN_U,
    N_STEP_U,
    SLOPES,
    knot_row,
)
from openacr.views import F64, I32

NODE1 = 0.06943184420297371  # of a Gauss formula with four nodes
NODE2 = 0.33000947820757187
SHARE1 = 0.17392742256872693
SHARE2 = 0.32607257743127307
PARTS = 3  # rows of a law for every cell

__all__ = ["law_from_speed", "speed_rows"]


def speed_axis(J: I32, N: F64, K: F64, C: F64, row: int, k: int, low: int, high: int) -> None:
    """Write the rows of an axis at a knot; q''' counts on the rows low ... high of C."""
    axes: int = J[J_AXES]
    slopes: int = N_LIMITS + SLOPES * axes
    q1: float = N[slopes + k]
    q2: float = N[slopes + axes + k]
    least: float = spline_third(C, axes, low * axes + k, N[N_STEP_U])
    greatest: float = least
    for n in range(low + 1, high + 1):
        q3: float = spline_third(C, axes, n * axes + k, N[N_STEP_U])
        if q3 < least:
            least = q3
        if q3 > greatest:
            greatest = q3
    a: int = row + K_AXES + AXIS * k
    push: float = N[N_LIMITS + axes + k] * K[row + K_PUSH]
    K[a + A_PUSH] = q2 / push
    K[a + A_PUSH + 1] = 0.5 * q1 / push
    jerk: float = N[N_LIMITS + 2 * axes + k] * K[row + K_SOFT]
    K[a + A_JERK] = 0.5 * (greatest + least) / jerk
    K[a + A_JERK + 1] = 1.5 * q2 / jerk
    K[a + A_JERK + 2] = 0.5 * q1 / jerk
    K[a + A_SPREAD] = 0.5 * (greatest - least) / jerk


def speed_cap(J: I32, N: F64, K: F64, row: int) -> None:
    """Write the highest h at a knot: by the feeds, by the axes, and by the turn of the path."""
    axes: int = J[J_AXES]
    slopes: int = N_LIMITS + SLOPES * axes
    along2: float = 0.0
    tool2: float = 0.0
    bend2: float = 0.0
    best: float = 1e300
    for k in range(axes):
        q1: float = N[slopes + k]
        q2: float = N[slopes + axes + k]
        most: float = N[N_LIMITS + k]
        along2 += q1 * q1
        tool2 += N[N_LIMITS + 3 * axes + k] * q1 * q1
        bend2 += q2 * q2
        if fabs(q1) * sqrt(best) > most:
            best = most * most / (q1 * q1)
    cap: float = K[row + K_FEED_UPS] * K[row + K_FEED_UPS] / along2
    if best < cap:
        cap = best
    tool: float = K[row + K_TOOL_UPS]
    if tool2 * cap > tool * tool:
        cap = tool * tool / tool2
    if sqrt(bend2) * cap > K[row + K_NORMAL_UPS2]:
        cap = K[row + K_NORMAL_UPS2] / sqrt(bend2)
    K[row + K_CAP] = cap


def speed_rows(J: I32, N: F64, K: F64, C: F64) -> None:
    """Write the rows and the caps of all knots, by their feeds and shares of the limits."""
    axes: int = J[J_AXES]
    for i in range(J[J_KNOTS]):
        row: int = knot_row(J, i)
        at: float = K[row + K_AT_U]
        s: float = at - N[N_ORIGIN_U]
        before: float = at - K[knot_row(J, i - 1) + K_AT_U]
        after: float = K[knot_row(J, i + 1) + K_AT_U] - at
        low: int = spline_row(s - 0.5 * before, N[N_STEP_U], J[J_POINTS])
        high: int = spline_row(s + 0.5 * after, N[N_STEP_U], J[J_POINTS])
        spline_slopes(C, J[J_POINTS], axes, N[N_STEP_U], s, N, N_LIMITS + SLOPES * axes)
        for k in range(axes):
            speed_axis(J, N, K, C, row, k, low, high)
        speed_cap(J, N, K, row)


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


def law_from_speed(J: I32, K: F64, X: F64, Z: F64, row: int) -> None:
    """Continue a law by PARTS rows for every cell between two knots.

    Row `row` is that of the first knot: its time and distance are given.
    """
    h: float = 0.0
    h1: float = 0.0
    h2: float = 0.0
    for i in range(J[J_KNOTS]):
        w: int = knot_row(J, i) + K_PLAIN
        g: float = K[w] * X[i] + K[w + 1] * X[i + 1] + K[w + 2] * X[i + 2]
        g1: float = K[w + 3] * X[i] + K[w + 4] * X[i + 1] + K[w + 5] * X[i + 2]
        g2: float = K[w + 6] * X[i] + K[w + 7] * X[i + 1] + K[w + 8] * X[i + 2]
        if i > 0:
            at: float = K[knot_row(J, i) + K_AT_U]
            before: float = K[knot_row(J, i - 1) + K_AT_U]
            d: float = at - before
            for part in range(PARTS):
                x0: float = float(part) / float(PARTS)
                x1: float = float(part + 1) / float(PARTS)
                o: int = ROW * (row + PARTS * (i - 1) + part + 1)
                Z[o + T_ROW] = Z[o - ROW + T_ROW] + cell_time(h, h1, g, g1, d, x0, x1)
                Z[o + S_ROW] = before + d * x1
                Z[o + V_ROW] = sqrt(speed_hermite(h, h1, g, g1, d, x1))
                Z[o + A_ROW] = 0.5 * (h1 + d * x1 * (h2 + 0.5 * x1 * (g2 - h2)))
            Z[o + S_ROW] = at
        h = g
        h1 = g1
        h2 = g2
