"""Rounded corners: how far the path leaves its corner, and where that puts the slaves.

With a path tolerance the corner between two straight moves is rounded from T before it to
T after it. The path keeps its own distance s; only the position is lifted off the corner:

    p(s) = line(s) + (u2 - u1) g(|x|),      x = s - corner,  u1, u2 directions per unit of s
    p''(s) = (u2 - u1) w(x)                 w a window of area 1 over [-T, T], g'' = w

Without jerk the window is a box, which makes the corner a parabola: at constant speed its
acceleration is constant, the fastest rounding of a corner there is. With jerk it is a triangle.

    box        w = 1/(2T)           g = (T - x)^2 / (4T)      g(0) = T/4
    triangle   w = (1 - x/T)/T      g = (T - x)^3 / (6T^2)    g(0) = T/6

g(0) |u2 - u1| is how far the path stays off its corner: the tolerance gives T.
"""

from openacr.cmath import fabs
from openacr.map.rows import axes, masters, moves
from openacr.views import F64, I32

SLAVE_COUNT = 16


def corner_lift(x_u: float, reach_u: float, smooth: int) -> float:
    """How far the path is lifted off at distance x from a corner rounded from `reach_u`."""
    left_u: float = reach_u - x_u
    if left_u <= 0.0 or reach_u <= 0.0:
        return 0.0
    if smooth:
        return left_u * left_u * left_u / (6.0 * reach_u * reach_u)
    return left_u * left_u / (4.0 * reach_u)


def corner_open(F: F64, I: I32, m: int, a: int, b: int, reach_u: float, smooth: int) -> None:
    """The path comes to the rounded corner between records a and b: note its two directions."""
    first: int = I[moves.slaves[a]]
    second: int = I[moves.slaves[b]]
    for s in range(SLAVE_COUNT):
        turn: float = 0.0
        if second & (1 << s) and F[moves.length_u[b]] > 0.0:
            turn += F[moves.delta_cnt[b] + s] / F[moves.length_u[b]]
        if first & (1 << s) and F[moves.length_u[a]] > 0.0:
            turn -= F[moves.delta_cnt[a] + s] / F[moves.length_u[a]]
        F[masters.corner_out_cnt[m] + s] = turn
    F[masters.corner_out_u[m]] = reach_u
    I[masters.corner_smooth_out[m]] = smooth


def corner_pass(F: F64, I: I32, m: int, record: int) -> None:
    """The move in front of a corner has ended; `record` is to leave it."""
    I[masters.corner_next[m]] = 0
    if F[masters.corner_out_u[m]] <= 0.0:
        return
    for s in range(SLAVE_COUNT):
        F[masters.corner_in_cnt[m] + s] = F[masters.corner_out_cnt[m] + s]
    F[masters.corner_in_u[m]] = F[masters.corner_out_u[m]]
    F[masters.corner_in_turn[m]] = F[masters.corner_out_turn[m]]
    F[masters.corner_in_ups[m]] = F[masters.corner_out_ups[m]]
    F[masters.corner_out_u[m]] = 0.0
    I[masters.corner_smooth_in[m]] = I[masters.corner_smooth_out[m]]
    I[masters.corner_next[m]] = record + 1


def corner_enter(F: F64, I: I32, m: int, record: int) -> None:
    """A move begins: after its corner from the corner itself, else from where the axes are."""
    F[masters.corner_out_u[m]] = 0.0
    if I[masters.corner_next[m]] != record + 1:
        F[masters.corner_in_u[m]] = 0.0
    elif F[masters.corner_in_u[m]] > 0.0:
        for s in range(SLAVE_COUNT):
            axis: int = I[masters.slave_axis[m] + s]
            if axis >= 0 and F[masters.corner_in_cnt[m] + s] != 0.0:
                F[axes.position_cnt[axis]] = F[axes.target_cnt[axis]]
    I[masters.corner_next[m]] = 0


def corner_drop(F: F64, I: I32, m: int) -> None:
    """End the rounding of both corners."""
    F[masters.corner_in_u[m]] = 0.0
    F[masters.corner_out_u[m]] = 0.0
    I[masters.corner_next[m]] = 0


def corner_place(F: F64, I: I32, m: int, slaves: int, gone_u: float, left_u: float) -> None:
    """Lift the slaves off the corner passed and the corner ahead.

    Those of `slaves` stand where the present move puts them, the others at their targets.
    """
    if F[masters.corner_in_u[m]] <= 0.0 and F[masters.corner_out_u[m]] <= 0.0:
        return
    passed: float = corner_lift(gone_u, F[masters.corner_in_u[m]], I[masters.corner_smooth_in[m]])
    ahead: float = corner_lift(left_u, F[masters.corner_out_u[m]], I[masters.corner_smooth_out[m]])
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        turn: float = 0.0
        lift: float = 0.0
        if F[masters.corner_in_u[m]] > 0.0:
            turn = fabs(F[masters.corner_in_cnt[m] + s])
            lift = passed * F[masters.corner_in_cnt[m] + s]
        if F[masters.corner_out_u[m]] > 0.0:
            turn += fabs(F[masters.corner_out_cnt[m] + s])
            lift += ahead * F[masters.corner_out_cnt[m] + s]
        if axis >= 0 and turn > 0.0:
            if not slaves & (1 << s):
                F[axes.position_cnt[axis]] = F[axes.target_cnt[axis]]
            F[axes.position_cnt[axis]] += lift
