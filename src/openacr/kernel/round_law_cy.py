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
from openacr.kernel.axis_cy import axis_scale
from openacr.kernel.bezier_cy import is_bezier
from openacr.kernel.lookahead_cy import look_plain, look_rate, ramp_start
from openacr.kernel.path_cy import MARK_ROUNDS, SLAVE_COUNT
from openacr.kernel.profile_cy import ramp_way, rest_speed
from openacr.map.numbers import (
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_CORNER_TURN,
    MQF_CORNER_U,
    MQF_CORNER_UPS,
    MQF_DEC_UPS2,
    MQF_DELTA_CNT,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MQF_TOLERANCE_U,
    MQF_VEL_UPS,
    MQF_WEIGHT,
    MQI_AHEAD,
    MQI_BASE,
    MQI_CURVED,
    MQI_MARKS,
    MQI_SLAVES,
    MQI_STRIDE,
    MQI_TANG,
    MSF_BASE,
    MSF_ORIGIN_U,
    MSF_STRIDE,
    MSI_BASE,
    MSI_MOVING,
    MSI_QUEUED,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
    PRF_ACCEL,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
    PRF_VELOCITY,
)
from openacr.views import F32, F64, I32

__all__ = ["round_between", "round_brake", "round_cap", "round_ramp2"]

SHARE = 0.98  # of the acceleration limit may be sideways: some is left to brake with
STRAIGHT = 1e-7  # changes of direction below are none
ENDLESS = 1e30


def round_accel(F: F64, record: int) -> float:
    """The acceleration limit of a move: the lower of ACC and DEC, 0 none."""
    acc: float = F[MQF_BASE + record * MQF_STRIDE + MQF_ACC_UPS2]
    dec: float = F[MQF_BASE + record * MQF_STRIDE + MQF_DEC_UPS2]
    if acc <= 0.0:
        return max(dec, 0.0)
    return min(acc, dec) if dec > 0.0 else acc


def round_straight(F: F64, I: I32, record: int) -> bool:
    """Whether a move is a straight line that merges with others."""
    q: int = MQI_BASE + record * MQI_STRIDE
    if I[q + MQI_CURVED] or I[q + MQI_TANG] or is_bezier(I, record):
        return False
    return look_plain(F, I, record) and F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U] > 0.0


def round_turn(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Size of the change of direction between two lines; of the largest weightless one."""
    p: int = MQF_BASE + a * MQF_STRIDE
    q: int = MQF_BASE + b * MQF_STRIDE
    first: int = I[MQI_BASE + a * MQI_STRIDE + MQI_SLAVES]
    second: int = I[MQI_BASE + b * MQI_STRIDE + MQI_SLAVES]
    square: float = 0.0
    largest: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        if axis >= 0 and (first | second) & (1 << s):
            turn: float = 0.0
            weight: float = 0.0
            if first & (1 << s):
                turn -= F[p + MQF_DELTA_CNT + s] / F[p + MQF_LENGTH_U]
                weight = F[p + MQF_WEIGHT + s]
            if second & (1 << s):
                turn += F[q + MQF_DELTA_CNT + s] / F[q + MQF_LENGTH_U]
                weight = max(weight, F[q + MQF_WEIGHT + s])
            turn = turn / fabs(axis_scale(S, axis))
            square += weight * weight * turn * turn
            largest = max(largest, fabs(turn))
    return max(sqrt(square), largest if square <= 0.0 else 0.0)


def round_between(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> None:
    """Find how the corner between a move and the one just put behind it is rounded."""
    p: int = MQF_BASE + a * MQF_STRIDE
    q: int = MQF_BASE + b * MQF_STRIDE
    F[p + MQF_CORNER_U] = 0.0
    F[p + MQF_CORNER_TURN] = 0.0
    ahead: int = MQI_BASE + a * MQI_STRIDE + MQI_AHEAD
    I[ahead] = 0
    tolerance: float = F[p + MQF_TOLERANCE_U]
    if not tolerance > 0.0 or not round_straight(F, I, a) or not round_straight(F, I, b):
        return
    own: int = 1 if I[MQI_BASE + a * MQI_STRIDE + MQI_MARKS] & MARK_ROUNDS else 0
    turn: float = round_turn(F, I, S, m, a, b)
    if turn <= STRAIGHT:
        I[ahead] = own
        return
    F[p + MQF_CORNER_TURN] = turn
    jerk: float = F[p + MQF_JRK_UPS3]
    reach: float = (6.0 if jerk > 0.0 else 4.0) * tolerance / turn
    reach = min(reach, 0.5 * min(F[p + MQF_LENGTH_U], F[q + MQF_LENGTH_U]))
    limit: float = round_accel(F, a)
    other: float = round_accel(F, b)
    if limit <= 0.0 or 0.0 < other < limit:
        limit = other
    F[p + MQF_CORNER_UPS] = round_cap(turn, reach, limit, jerk)
    if jerk > 0.0 and not round_pays(F, a, b, reach, limit, jerk):
        F[p + MQF_CORNER_TURN] = 0.0
        return
    if I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED] == 1 and I[MSI_BASE + m * MSI_STRIDE + MSI_MOVING]:
        if not round_in_time(F, m, a, reach, F[p + MQF_CORNER_UPS]):
            return
    F[p + MQF_CORNER_U] = reach
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
    p: int = MQF_BASE + a * MQF_STRIDE
    q: int = MQF_BASE + b * MQF_STRIDE
    feed: float = min(F[p + MQF_VEL_UPS], F[q + MQF_VEL_UPS])
    cap: float = F[p + MQF_CORNER_UPS]
    room: float = 0.5 * min(F[p + MQF_LENGTH_U], F[q + MQF_LENGTH_U]) - reach
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
    q: int = MQF_BASE + record * MQF_STRIDE
    f: int = PRF_BASE + m * PRF_STRIDE
    gone: float = F[f + PRF_DISTANCE] - F[MSF_BASE + m * MSF_STRIDE + MSF_ORIGIN_U]
    left: float = F[q + MQF_LENGTH_U] - reach - gone
    if left <= 0.0:
        return False
    velocity: float = F[f + PRF_VELOCITY]
    jerk: float = F[q + MQF_JRK_UPS3]
    if jerk > 0.0:
        accel: float = F[f + PRF_ACCEL]
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
