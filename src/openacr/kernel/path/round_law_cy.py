"""Which corners of a path are rounded, and what a rounded corner allows.

In a corner the path already accelerates sideways, by q = v^2 |p''|; what is left of the
limit A may change the speed. With h = |u2 - u1| / 2, the sine of half the turn, the two may
lie as unfavourably as this:

    a^2 + 2 a q h + q^2 <= A^2

A constant a over half a corner from w = v^2 to w' = w + 2 a T is a quadratic equation in the
larger of the two: the step of the backward pass (round_pass_cy) and of the forward plan
(round_cy) through a corner. With a jerk limit the speed in corners is constant.
"""

from openacr.cmath import exp, fabs, log, sqrt
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.path.bezier_cy import is_bezier
from openacr.kernel.path.lookahead_cy import look_plain, look_rate, ramp_start
from openacr.kernel.path.path_cy import MARK_ROUNDS, SLAVE_COUNT
from openacr.kernel.profile_cy import ramp_way, rest_speed
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

__all__ = ["round_between", "round_brake", "round_cap", "round_ramp2"]

SHARE = 0.98  # of the acceleration limit may be sideways: some is left to brake with
STRAIGHT = 1e-7  # changes of direction below are none
ENDLESS = 1e30


def round_accel(F: F64, record: int) -> float:
    """The acceleration limit of a move: the lower of ACC and DEC, 0 none."""
    acc: float = F[moves.acc_ups2[record]]
    dec: float = F[moves.dec_ups2[record]]
    if acc <= 0.0:
        return max(dec, 0.0)
    return min(acc, dec) if dec > 0.0 else acc


def round_straight(F: F64, I: I32, record: int) -> bool:
    """Whether a move is a straight line that merges with others."""
    if I[moves.curved[record]] or I[moves.tang_slave[record]] or is_bezier(I, record):
        return False
    return look_plain(F, I, record) and F[moves.length_u[record]] > 0.0


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


def round_between(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> None:
    """Find how the corner between a move and the one just put behind it is rounded."""
    F[moves.corner_u[a]] = 0.0
    F[moves.corner_turn[a]] = 0.0
    ahead: int = moves.ahead[a]
    I[ahead] = 0
    tolerance: float = F[moves.tolerance_u[a]]
    if not tolerance > 0.0 or not round_straight(F, I, a) or not round_straight(F, I, b):
        return
    own: int = 1 if I[moves.marks[a]] & MARK_ROUNDS else 0
    turn: float = round_turn(F, I, S, m, a, b)
    if turn <= STRAIGHT:
        I[ahead] = own
        return
    F[moves.corner_turn[a]] = turn
    jerk: float = F[moves.jrk_ups3[a]]
    reach: float = (6.0 if jerk > 0.0 else 4.0) * tolerance / turn
    reach = min(reach, 0.5 * min(F[moves.length_u[a]], F[moves.length_u[b]]))
    limit: float = round_accel(F, a)
    other: float = round_accel(F, b)
    if limit <= 0.0 or 0.0 < other < limit:
        limit = other
    F[moves.corner_ups[a]] = round_cap(turn, reach, limit, jerk)
    if jerk > 0.0 and not round_pays(F, a, b, reach, limit, jerk):
        F[moves.corner_turn[a]] = 0.0
        return
    if I[masters.queued[m]] == 1 and I[masters.moving[m]]:
        if not round_in_time(F, m, a, reach, F[moves.corner_ups[a]]):
            return
    F[moves.corner_u[a]] = reach
    I[ahead] = own


def round_cap(turn: float, reach: float, limit: float, jerk: float) -> float:
    """The highest constant speed in a corner, by acceleration and jerk."""
    cap: float = ENDLESS
    if jerk > 0.0:
        if limit > 0.0:
            cap = sqrt(limit * reach / turn)
        return min(cap, exp(log(jerk * reach * reach / turn) / 3.0)) * SHARE
    if limit > 0.0:
        cap = sqrt(SHARE * limit * 2.0 * reach / turn)
    return cap


def round_pays(F: F64, a: int, b: int, reach: float, limit: float, jerk: float) -> bool:
    """Whether going round a corner at constant speed is quicker than what jerk does without.

    Compared is the time lost on each side against the feed: by the ramp to the speed in the
    corner and the way at that speed, or by the ramp to rest. Lines too short to speed up on
    are left to the merging of LOOK.
    """
    feed: float = min(F[moves.vel_ups[a]], F[moves.vel_ups[b]])
    cap: float = F[moves.corner_ups[a]]
    room: float = 0.5 * min(F[moves.length_u[a]], F[moves.length_u[b]]) - reach
    if limit <= 0.0 or cap <= 0.0 or room <= 0.0:
        return False
    feed = min(feed, ramp_start(room, 0.0, limit, jerk))
    if cap >= feed:
        return False
    slow: float = reach / cap - reach / feed
    return ramp_loss(cap, feed, limit, jerk) + slow < ramp_loss(0.0, feed, limit, jerk)


def ramp_loss(low: float, high: float, rate: float, jerk: float) -> float:
    """Time a ramp between two speeds loses against its way at the higher one."""
    rise: float = high - low
    time: float = rise / rate + rate / jerk
    if rise * jerk < rate * rate:
        time = 2.0 * sqrt(rise / jerk)
    return time - 0.5 * (low + high) * time / high


def round_in_time(F: F64, m: int, record: int, reach: float, cap: float) -> bool:
    """Whether the move under way can still slow down in front of its corner."""
    gone: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    left: float = F[moves.length_u[record]] - reach - gone
    if left <= 0.0:
        return False
    velocity: float = F[profiles.velocity[m]]
    jerk: float = F[moves.jrk_ups3[record]]
    if jerk > 0.0:
        accel: float = F[profiles.accel[m]]
        slow: bool = rest_speed(velocity, accel, jerk) <= cap
        rate: float = look_rate(F, record)
        return slow or ramp_way(velocity, accel, cap, rate, jerk) <= left * SHARE
    return velocity * velocity <= cap * cap + 2.0 * look_rate(F, record) * left * SHARE


def round_ramp2(turn: float, reach: float, limit: float, jerk: float, w: float) -> float:
    """Highest speed squared at the other end of a corner that has `w` at this one."""
    if jerk > 0.0:
        return w
    if limit <= 0.0:
        return ENDLESS
    half: float = 0.5 * turn
    bend: float = turn / (2.0 * reach)
    inverse: float = 0.5 / reach  # a = (w' - w) / 2T, over half a corner
    along: float = inverse + bend * half
    square: float = along * along + bend * bend * max(1.0 - half * half, 0.0)
    b: float = along * w * inverse
    c: float = w * w * inverse * inverse - limit * limit
    root: float = b * b - square * c
    if root <= 0.0:
        return w
    return max(w, (b + sqrt(root)) / square)


def round_brake(turn: float, reach: float, limit: float, w: float) -> float:
    """How strongly speed may change in a corner at speed squared `w`."""
    half: float = 0.5 * turn
    side: float = w * turn / (2.0 * reach)
    rest: float = limit * limit - side * side * (1.0 - half * half)
    return max(sqrt(max(rest, 0.0)) - side * half, 0.01 * limit)


def line_start2(length: float, w: float, rate: float, jerk: float) -> float:
    """Highest speed squared from which a ramp on a line of this length ends with `w`."""
    if rate <= 0.0:
        return ENDLESS
    if jerk <= 0.0:
        return w + 2.0 * rate * max(length, 0.0)
    start: float = ramp_start(max(length, 0.0), sqrt(w), rate, jerk)
    return start * start
