"""Chains of short moves under jerk: corners whose roundings overlap, with speed that changes.

Where moves are shorter than what their tolerance lets a corner take of them, a corner with room of
its own is slow: to be passed at constant speed v, with half of every move left to change the speed
on, it takes a quarter T of a move, and v^3 turn / T^2 <= J. So such moves are *blended*: the
windows of their corners reach over whole moves (corner_cy), and those of neighbours overlap.

    window of corner 1   /\\                p'' = d1 w1 + d2 w2 + ...     d change of direction
    window of corner 2     /\\              of each window, w up to 1/T
    moves              |--|--|--|

On a move no more than two of them meet, one that falls and one that rises:

    size of p''          at most the largest d/T at its ends            bend
    size of p'''         |d2/T2^2 - d1/T1^2| or that of one alone       change of bend
    off the path         at most the largest d T/6                      as of one corner

At speed v, with a and j along the path, it accelerates by a p' + v^2 p'' and jerks by
j p' + 3 v a p'' + v^3 p'''. Within a blended chain p' and the others stand nearly across each
other: their cosine c is at most the turn of a corner, up to SHARPEST. So the limits are shared:

    a <= ALONG A         v^2 bend <= ACROSS A
    j <= JERK_ALONG J    v^3 change <= JERK_ACROSS J,  3 v ALONG A bend <= JERK_BOTH J

    ALONG^2 + ACROSS^2 + 2 ALONG ACROSS c <= 1
    JERK_ALONG^2 + s^2 + 2 JERK_ALONG s c <= 1    with s = JERK_ACROSS + JERK_BOTH

Every blended move has ramps and jerk of that share and a speed of its own that keeps the rest; for
the plan it is a line with straight joints (round_run_cy). Its speed is lowered to one of few
levels, so that neighbours have the same one and are gone through in one plan.
"""

from openacr.cmath import ceil, exp, log, sqrt
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.corner_cy import corner_blend, corner_turn
from openacr.kernel.path.lookahead_cy import JOINED, look_record, ramp_start
from openacr.kernel.path.path_cy import SLAVE_COUNT, move_record
from openacr.kernel.path.round_law_cy import round_accel
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

__all__ = ["blend_begin"]

SHARPEST = 0.3  # change of direction at most
ALONG = 0.4
ACROSS = 0.8
JERK_ALONG = 0.45
JERK_ACROSS = 0.46
JERK_BOTH = 0.3
LEVEL = -0.2231435513142097  # log 0.8: a level is 0.8 of the next higher one
PREFERRED = 0.7  # of its speed: a move that would come above that alone is not blended


def blend_ready(I: I32, m: int, a: int) -> bool:
    """Whether the path has not come to move a, the last one that waits."""
    if I[masters.queued[m]] > 1:
        return True
    return not I[masters.moving[m]] and I[masters.corner_next[m]] != a + 1


def blend_alike(F: F64, a: int, b: int) -> bool:
    """Whether two moves have the same limits; those of a may be the shares already."""
    accel_ups2: float = round_accel(F, b)
    jerk_ups3: float = F[moves.jrk_ups3[b]]
    if not accel_ups2 > 0.0 or not jerk_ups3 > 0.0 or not F[moves.stp_ups2[a]] > 0.0:
        return False
    if F[moves.blend_ups[a]] > 0.0:
        accel_ups2 = ALONG * accel_ups2
        jerk_ups3 = JERK_ALONG * jerk_ups3
    return round_accel(F, a) == accel_ups2 and F[moves.jrk_ups3[a]] == jerk_ups3


def blend_change(
    F: F64, I: I32, S: F32, m: int, p: int, a: int, b: int, before_u: float, reach_u: float
) -> float:
    """The size of p''' on move a where the windows of its corners to p and to b overlap."""
    square: float = 0.0
    largest: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            change: float = corner_turn(F, I, a, b, s) / (reach_u * reach_u)
            change -= corner_turn(F, I, p, a, s) / (before_u * before_u)
            change = change / axis_scale(S, axis)
            weight: float = F[moves.weight[a] + s] if I[moves.slaves[a]] & (1 << s) else 0.0
            if I[moves.slaves[b]] & (1 << s):
                weight = max(weight, F[moves.weight[b] + s])
            if I[moves.slaves[p]] & (1 << s):
                weight = max(weight, F[moves.weight[p] + s])
            square += weight * weight * change * change
            largest = max(largest, change if change > 0.0 else -change)
    return sqrt(square) if square > 0.0 else largest


def blend_cap(bend: float, change: float, accel_ups2: float, jerk_ups3: float) -> float:
    """The highest speed on a move by the bend of its path and how fast that changes."""
    cap_ups: float = exp(log(JERK_ACROSS * jerk_ups3 / change) / 3.0)
    cap_ups = min(cap_ups, sqrt(ACROSS * accel_ups2 / bend))
    return min(cap_ups, JERK_BOTH * jerk_ups3 / (3.0 * ALONG * accel_ups2 * bend))


def blend_level(cap_ups: float) -> float:
    """The highest level not above a speed."""
    return exp(LEVEL * ceil(log(cap_ups) / LEVEL))


def blend_reach(F: F64, I: I32, m: int, a: int, b: int) -> float:
    """How far before and after the corner between a and the new move b its window may reach."""
    turn: float = F[moves.corner_turn[a]]
    if turn > SHARPEST or not blend_alike(F, a, b) or not blend_ready(I, m, a):
        return 0.0
    room_u: float = F[moves.length_u[a]]
    if I[masters.queued[m]] > 1:
        room_u -= F[moves.corner_u[look_record(I, m, I[masters.queued[m]] - 2)]]
    return min(6.0 * F[moves.tolerance_u[a]] / turn, min(room_u, F[moves.length_u[b]]))


def blend_before(F: F64, I: I32, S: F32, m: int, a: int, b: int, reach_u: float) -> float:
    """The speed of move a when it is blended into b, by both its corners."""
    turn: float = F[moves.corner_turn[a]]
    accel_ups2: float = round_accel(F, b)
    jerk_ups3: float = F[moves.jrk_ups3[b]]
    change: float = turn / (reach_u * reach_u)
    if F[moves.blend_ups[a]] > 0.0 and I[masters.queued[m]] > 1:
        p: int = look_record(I, m, I[masters.queued[m]] - 2)
        before_u: float = F[moves.blend_u[p]]
        if before_u > 0.0 and before_u + reach_u > F[moves.length_u[a]]:
            change = max(change, blend_change(F, I, S, m, p, a, b, before_u, reach_u))
    cap_ups: float = blend_level(blend_cap(turn / reach_u, change, accel_ups2, jerk_ups3))
    if F[moves.blend_ups[a]] > 0.0:
        cap_ups = min(cap_ups, F[moves.blend_ups[a]])
    return cap_ups


def blend_after(F: F64, a: int, b: int, reach_u: float) -> float:
    """The speed of the new move b by its corner to move a."""
    turn: float = F[moves.corner_turn[a]]
    change: float = turn / (reach_u * reach_u)
    return blend_level(blend_cap(turn / reach_u, change, round_accel(F, b), F[moves.jrk_ups3[b]]))


def blend_pays(
    F: F64,
    r: int,
    blend_ups: float,
    reach_u: float,
    cap_ups: float,
    accel_ups2: float,
    jerk_ups3: float,
) -> bool:
    """Whether move r is as quick blended as between corners of `reach_u` passed at `cap_ups`."""
    room_u: float = max(0.5 * F[moves.length_u[r]] - reach_u, 0.0)
    top_ups: float = min(ramp_start(room_u, cap_ups, accel_ups2, jerk_ups3), F[moves.vel_ups[r]])
    if F[moves.blend_ups[r]] > 0.0:
        top_ups = min(top_ups, F[moves.blend_ups[r]])
    return top_ups <= PREFERRED * blend_ups


def blend_share(F: F64, r: int, blend_ups: float) -> None:
    """Give a move the ramps, the jerk and the speed of a blended one."""
    if not F[moves.blend_ups[r]] > 0.0:
        accel_ups2: float = ALONG * round_accel(F, r)
        F[moves.acc_ups2[r]] = accel_ups2
        F[moves.dec_ups2[r]] = accel_ups2
        F[moves.stp_ups2[r]] = min(F[moves.stp_ups2[r]], accel_ups2)
        F[moves.jrk_ups3[r]] = JERK_ALONG * F[moves.jrk_ups3[r]]
    F[moves.blend_ups[r]] = blend_ups


def blend_restore(
    F: F64,
    r: int,
    acc_ups2: float,
    dec_ups2: float,
    stp_ups2: float,
    jrk_ups3: float,
    blend_ups: float,
) -> None:
    """Give a move back what it had before `blend_share`."""
    F[moves.acc_ups2[r]] = acc_ups2
    F[moves.dec_ups2[r]] = dec_ups2
    F[moves.stp_ups2[r]] = stp_ups2
    F[moves.jrk_ups3[r]] = jrk_ups3
    F[moves.blend_ups[r]] = blend_ups


def blend_joined(F: F64, I: I32, a: int, r: int) -> bool:
    """Whether two moves that follow each other, blended both, have one line and the same ramps."""
    if not F[moves.blend_ups[a]] > 0.0 or not F[moves.blend_ups[r]] > 0.0:
        return False
    if I[moves.ahead[a]] != JOINED or F[moves.corner_u[a]] > 0.0:
        return False
    if F[moves.acc_ups2[a]] != F[moves.acc_ups2[r]] or I[moves.rapid[a]] != I[moves.rapid[r]]:
        return False
    return F[moves.jrk_ups3[a]] == F[moves.jrk_ups3[r]]


def blend_begin(F: F64, I: I32, m: int, a: int) -> None:
    """Move a has begun: it may be blended into the next."""
    if F[moves.blend_u[a]] > 0.0 and I[masters.queued[m]] > 1:
        corner_blend(F, I, m, a, look_record(I, m, 1))


def blend_entered(F: F64, I: I32, m: int) -> bool:
    """Whether the path is within the window of the corner ahead of the present move."""
    left_u: float = F[moves.length_u[move_record(I, m)]]
    left_u -= F[profiles.distance[m]] - F[masters.origin_u[m]]
    return F[masters.blend_out_u[m]] >= left_u
