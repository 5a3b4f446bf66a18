"""What a rounded corner allows, and where rounding takes less time than a stop.

In a corner the path already accelerates sideways, by q = v^2 |p''|; what is left of the
limit A may change the speed. With h = |u2 - u1| / 2, the sine of half the turn, the two may
lie as unfavourably as this:

    a^2 + 2 a q h + q^2 <= A^2

A constant a over half a corner from w = v^2 to w' = w + 2 a T is a quadratic equation in the
larger of the two: the step of the backward pass (round_pass_cy) and of the forward plan
(round_cy) through a corner. With a jerk limit the speed in corners is constant; corners where
that takes longer than a stop are stops.
"""

from openacr.cmath import exp, fabs, log, sqrt
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.bezier_cy import is_bezier
from openacr.kernel.path.lookahead_cy import look_plain, ramp_start
from openacr.kernel.path.path_cy import SLAVE_COUNT
from openacr.map.rows import masters, moves
from openacr.views import F32, F64, I32

__all__ = ["round_brake", "round_cap", "round_limit", "round_ramp2"]

SHARE = 0.98  # of the acceleration limit may be sideways: some is left to brake with
STRAIGHT = 1e-7  # smaller changes of direction are ignored
ENDLESS = 1e30


def round_accel(F: F64, record: int) -> float:
    """The acceleration limit of a move: the lower of ACC and DEC, 0 none."""
    acc_ups2: float = F[moves.acc_ups2[record]]
    dec_ups2: float = F[moves.dec_ups2[record]]
    if acc_ups2 <= 0.0:
        return max(dec_ups2, 0.0)
    return min(acc_ups2, dec_ups2) if dec_ups2 > 0.0 else acc_ups2


def round_straight(F: F64, I: I32, record: int) -> bool:
    """Whether a move is a straight line that merges with others."""
    return F[moves.length_u[record]] > 0.0 and round_plain(F, I, record)


def round_point(F: F64, I: I32, record: int) -> bool:
    """Whether a move goes nowhere and merges with others."""
    return F[moves.length_u[record]] <= 0.0 and round_plain(F, I, record)


def round_plain(F: F64, I: I32, record: int) -> bool:
    """Whether a move has no curve, time, flag, capture or trigger of its own."""
    if I[moves.curved[record]] or I[moves.tang_slave[record]] or is_bezier(I, record):
        return False
    return look_plain(F, I, record)


def round_turn(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Size of the change of direction between two lines; of the largest weightless one."""
    first: int = I[moves.slaves[a]]
    second: int = I[moves.slaves[b]]
    square: float = 0.0
    largest: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0 and (first | second) & (1 << s):
            turn: float = 0.0
            weight: float = 0.0
            if first & (1 << s):
                turn -= F[moves.delta_cnt[a] + s] / F[moves.length_u[a]]
                weight = F[moves.weight[a] + s]
            if second & (1 << s):
                turn += F[moves.delta_cnt[b] + s] / F[moves.length_u[b]]
                weight = max(weight, F[moves.weight[b] + s])
            turn = turn / fabs(axis_scale(S, axis))
            square += weight * weight * turn * turn
            largest = max(largest, fabs(turn))
    return max(sqrt(square), largest if square <= 0.0 else 0.0)


def round_cap(turn: float, reach_u: float, limit_ups2: float, jerk_ups3: float) -> float:
    """The highest constant speed in a corner, by acceleration and jerk."""
    cap_ups: float = ENDLESS
    if jerk_ups3 > 0.0:
        if limit_ups2 > 0.0:
            cap_ups = sqrt(limit_ups2 * reach_u / turn)
        return min(cap_ups, exp(log(jerk_ups3 * reach_u * reach_u / turn) / 3.0)) * SHARE
    if limit_ups2 > 0.0:
        cap_ups = sqrt(SHARE * limit_ups2 * 2.0 * reach_u / turn)
    return cap_ups


def round_limit(
    turn: float, reach_u: float, cap_ups: float, accel_ups2: float, jerk_ups3: float
) -> float:
    """The acceleration limit within a corner of a move that may use `accel_ups2` on its line.

    Without jerk that of the weaker of the two moves, from which `round_cap` has found the highest
    speed: in a corner, what changes the speed of one goes along the other, too.
    """
    if jerk_ups3 > 0.0 or cap_ups >= ENDLESS:
        return accel_ups2
    return cap_ups * cap_ups * turn / (2.0 * SHARE * reach_u)


def round_pays(F: F64, a: int, b: int, reach_u: float, limit_ups2: float, jerk_ups3: float) -> bool:
    """Whether going round a corner at constant speed is quicker than what jerk does without.

    Compared is the time lost on each side against the feed: by the ramp to the speed in the
    corner and the distance at that speed, or by the ramp to rest. On lines too short to come
    above the speed in the corner nothing is lost.
    """
    feed_ups: float = min(F[moves.vel_ups[a]], F[moves.vel_ups[b]])
    cap_ups: float = F[moves.corner_ups[a]]
    room_u: float = 0.5 * min(F[moves.length_u[a]], F[moves.length_u[b]]) - reach_u
    if limit_ups2 <= 0.0 or cap_ups <= 0.0 or room_u <= 0.0:
        return False
    feed_ups = min(feed_ups, ramp_start(room_u, 0.0, limit_ups2, jerk_ups3))
    if cap_ups >= feed_ups:
        return True
    slow_s: float = reach_u / cap_ups - reach_u / feed_ups
    return ramp_loss(cap_ups, feed_ups, limit_ups2, jerk_ups3) + slow_s < ramp_loss(
        0.0, feed_ups, limit_ups2, jerk_ups3
    )


def ramp_loss(low_ups: float, high_ups: float, rate_ups2: float, jerk_ups3: float) -> float:
    """Time a ramp between two speeds loses against its distance at the higher one."""
    rise_ups: float = high_ups - low_ups
    time_s: float = rise_ups / rate_ups2 + rate_ups2 / jerk_ups3
    if rise_ups * jerk_ups3 < rate_ups2 * rate_ups2:
        time_s = 2.0 * sqrt(rise_ups / jerk_ups3)
    return time_s - 0.5 * (low_ups + high_ups) * time_s / high_ups


def round_ramp2(
    turn: float, reach_u: float, limit_ups2: float, jerk_ups3: float, w_v2: float
) -> float:
    """Highest speed squared at the other end of a corner that has `w_v2` at this one."""
    if jerk_ups3 > 0.0:
        return w_v2
    if limit_ups2 <= 0.0:
        return ENDLESS
    half: float = 0.5 * turn
    bend_per_u: float = turn / (2.0 * reach_u)
    inverse_per_u: float = 0.5 / reach_u  # a = (w' - w) / 2T, over half a corner
    along_per_u: float = inverse_per_u + bend_per_u * half
    square: float = along_per_u * along_per_u + bend_per_u * bend_per_u * max(
        1.0 - half * half, 0.0
    )
    b: float = along_per_u * w_v2 * inverse_per_u
    c: float = w_v2 * w_v2 * inverse_per_u * inverse_per_u - limit_ups2 * limit_ups2
    root: float = b * b - square * c
    if root <= 0.0:
        return w_v2
    return max(w_v2, (b + sqrt(root)) / square)


def round_brake(turn: float, reach_u: float, limit_ups2: float, w_v2: float) -> float:
    """How strongly speed may change in a corner at speed squared `w_v2`."""
    half: float = 0.5 * turn
    side_ups2: float = w_v2 * turn / (2.0 * reach_u)
    rest: float = limit_ups2 * limit_ups2 - side_ups2 * side_ups2 * (1.0 - half * half)
    return max(sqrt(max(rest, 0.0)) - side_ups2 * half, 0.01 * limit_ups2)


def line_start2(length_u: float, w_v2: float, rate_ups2: float, jerk_ups3: float) -> float:
    """Highest speed squared from which a ramp on a line of this length ends with `w_v2`."""
    if rate_ups2 <= 0.0:
        return ENDLESS
    if jerk_ups3 <= 0.0:
        return w_v2 + 2.0 * rate_ups2 * max(length_u, 0.0)
    start_ups: float = ramp_start(max(length_u, 0.0), sqrt(w_v2), rate_ups2, jerk_ups3)
    return start_ups * start_ups
