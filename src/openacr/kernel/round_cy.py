"""Plan a path with rounded corners: piece by piece, fast as the acceleration allows.

Rounded corners (corner_cy) divide every move into up to three pieces:

    |-- corner behind --|------ line ------|-- corner ahead --|
    0                  Tin              L - Tout              L

On the line the ramps of the move apply. In a corner the path already accelerates sideways,
by q = v^2 |p''|; what is left of the limit A may change the speed. With h = |u2 - u1| / 2,
the sine of half the turn, the two may lie as unfavourably as this:

    a^2 + 2 a q h + q^2 <= A^2

A constant a over half a corner from w = v^2 to w' = w + 2 a T is a quadratic equation in the
larger of the two: that is the step of the backward pass (round_exit2) through the corners
and lines of all moves that wait, and of the forward plan.

With a jerk limit the speed in corners is constant, whatever happens: a change of override or
a feedhold that cannot be done with in front of a corner goes on behind it. Only a path that
starts from rest just before one speeds up in it, softly, to half of what it allows.

A binary move with a tolerance of its own is planned through the corner at its end though LOOK
is off; the chain of such moves ends with the first other one, as that one ends without LOOK.

The pass begins with rest a few moves ahead; if no corner and no feed has capped it on its
way here, those few were not enough, and it begins farther ahead.
"""

from openacr.cmath import exp, fabs, log, sqrt
from openacr.kernel.axis_cy import axis_scale
from openacr.kernel.bezier_cy import is_bezier
from openacr.kernel.corner_cy import corner_open
from openacr.kernel.lookahead_cy import (
    look_active,
    look_beyond,
    look_corner,
    look_final,
    look_plain,
    look_rate,
    look_record,
    look_speed,
    ramp_start,
)
from openacr.kernel.path_cy import MARK_ROUNDS, SLAVE_COUNT, master_limit, move_record
from openacr.kernel.profile_cy import DECELERATING, STOPPING, profile_plan, ramp_way, rest_speed
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
    MQF_STP_UPS2,
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
    MSF_CORNER_IN_TURN,
    MSF_CORNER_IN_U,
    MSF_CORNER_IN_UPS,
    MSF_CORNER_OUT_TURN,
    MSF_CORNER_OUT_U,
    MSF_CORNER_OUT_UPS,
    MSF_LOOK_CAP_UPS,
    MSF_LOOK_EXIT_UPS,
    MSF_ORIGIN_U,
    MSF_STRETCH_U,
    MSF_STRIDE,
    MSI_BASE,
    MSI_MOVING,
    MSI_PIECE,
    MSI_QUEUED,
    MSI_ROUNDING,
    MSI_SLAVE_AXIS,
    MSI_STRETCH,
    MSI_STRIDE,
    PRF_ACCEL,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_END_DISTANCE,
    PRF_STRIDE,
    PRF_TARGET_VELOCITY,
    PRF_VELOCITY,
    PRI_BASE,
    PRI_SEG_COUNT,
    PRI_SEG_KIND,
    PRI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["round_between", "round_brake", "round_cap", "round_exit2", "round_ramp2"]

BEHIND = 0  # pieces of a move
LINE = 1
AHEAD = 2

SHARE = 0.98  # of the acceleration limit may be sideways: some is left to brake with
STRAIGHT = 1e-7  # changes of direction below are none
SLACK = 1e-9  # of a length
ENDLESS = 1e30
FEW = 16  # moves the backward pass looks at first
SOFT = 0.2  # share of the limits for starts within a corner under a jerk limit
LINGER = 0.3  # of the speed a corner allows: slower ones do not stay constant in it
BISECTIONS = 50


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


def round_join2(F: F64, I: I32, S: F32, m: int, a: int, b: int) -> float:
    """Speed squared at a corner that is not rounded."""
    p: int = MQF_BASE + a * MQF_STRIDE
    if I[MQI_BASE + a * MQI_STRIDE + MQI_AHEAD]:  # straight on
        speed: float = min(look_speed(F, I, S, m, a), look_speed(F, I, S, m, b))
        return speed * speed
    if F[p + MQF_TOLERANCE_U] > 0.0 and F[p + MQF_CORNER_TURN] > STRAIGHT:
        return 0.0  # the next move has come too late
    law: float = look_corner(F, I, S, m, a, b)
    return law * law


def round_pass(F: F64, I: I32, S: F32, m: int, part: int, far: int, last: int) -> float:
    """Backward pass from move `far` of up to `last` to the end of a piece of the present one.

    Not capped on the way, the result is negative if moves beyond `far` might change it.
    """
    k: int = far
    r: int = look_record(I, m, k)
    w: float = 0.0
    rate: float = look_rate(F, r)
    capped: bool = far >= last
    if far >= last:
        w = look_final(F, I, S, m, r)
        w = w * w
        rate = F[MQF_BASE + r * MQF_STRIDE + MQF_STP_UPS2]
    while True:
        q: int = MQF_BASE + r * MQF_STRIDE
        speed: float = look_speed(F, I, S, m, r)
        top: float = speed * speed
        jerk: float = F[q + MQF_JRK_UPS3]
        reach: float = F[q + MQF_CORNER_U] if k < last else 0.0
        before: float = F[MSF_BASE + m * MSF_STRIDE + MSF_CORNER_IN_U]
        a: int = r
        if k > 0:
            a = look_record(I, m, k - 1)
            before = F[MQF_BASE + a * MQF_STRIDE + MQF_CORNER_U]
        if w >= top:
            w = top
            capped = True
        if k == 0 and part == AHEAD:
            break
        if reach > 0.0:
            w = round_ramp2(F[q + MQF_CORNER_TURN], reach, round_accel(F, r), jerk, w)
            cap: float = min(F[q + MQF_CORNER_UPS] * F[q + MQF_CORNER_UPS], top)
            if w >= cap:
                w = cap
                capped = True
        if k == 0 and part == LINE:
            break
        w = line_start2(F[q + MQF_LENGTH_U] - reach - before, w, rate, jerk)
        if w >= top:
            w = top
            capped = True
        if k == 0:
            break
        corner: float = F[MQF_BASE + a * MQF_STRIDE + MQF_CORNER_UPS]
        if before > 0.0:
            w = min(w, corner * corner)
            turn: float = F[MQF_BASE + a * MQF_STRIDE + MQF_CORNER_TURN]
            w = round_ramp2(turn, before, round_accel(F, r), jerk, w)
            corner = corner * corner
        else:
            corner = round_join2(F, I, S, m, a, r)
        if w >= corner:
            w = corner
            capped = True
        rate = look_rate(F, a)
        r = a
        k -= 1
    return w if capped else -1.0


def round_last(I: I32, m: int) -> int:
    """How far behind the present move the last one is that plans may run through."""
    last: int = I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED] - 1
    k: int = 0
    while k < last and look_beyond(I, m, look_record(I, m, k)):
        k += 1
    return k


def round_exit2(F: F64, I: I32, S: F32, m: int, part: int) -> float:
    """Highest speed squared at the end of a piece of the present move."""
    last: int = round_last(I, m)
    far: int = min(FEW, last)
    w: float = round_pass(F, I, S, m, part, far, last)
    while w < 0.0 and far < last:
        far = min(2 * far, last)
        w = round_pass(F, I, S, m, part, far, last)
    return max(w, 0.0)


def round_through(F: F64, I: I32, m: int, record: int) -> bool:
    """Whether the present move is planned in pieces."""
    if not I[MSI_BASE + m * MSI_STRIDE + MSI_ROUNDING]:
        return False
    if not look_plain(F, I, record) or is_bezier(I, record):
        return False
    if not look_active(I, m):
        leaves: bool = F[MSF_BASE + m * MSF_STRIDE + MSF_CORNER_IN_U] > 0.0
        return leaves or I[MQI_BASE + record * MQI_STRIDE + MQI_AHEAD] != 0
    if F[MQF_BASE + record * MQF_STRIDE + MQF_JRK_UPS3] <= 0.0:
        return True
    # With jerk moves between corners that are not rounded merge, as LOOK has it.
    behind: float = F[MSF_BASE + m * MSF_STRIDE + MSF_CORNER_IN_U]
    return behind > 0.0 or round_reach(F, I, m, record) > 0.0


def round_part(F: F64, I: I32, m: int) -> int:
    """The piece of the present move in which the path is; open the corner ahead."""
    i: int = MSI_BASE + m * MSI_STRIDE
    f: int = MSF_BASE + m * MSF_STRIDE
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    length: float = F[q + MQF_LENGTH_U]
    gone: float = F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE] - F[f + MSF_ORIGIN_U]
    if gone < F[f + MSF_CORNER_IN_U] - SLACK * length:
        return BEHIND
    reach: float = round_reach(F, I, m, record)
    if reach <= 0.0 or gone < length - reach - SLACK * length:
        return LINE
    if F[f + MSF_CORNER_OUT_U] <= 0.0 and I[i + MSI_QUEUED] > 1:
        smooth: int = 1 if F[q + MQF_JRK_UPS3] > 0.0 else 0
        corner_open(F, I, m, record, look_record(I, m, 1), reach, smooth)
        F[f + MSF_CORNER_OUT_TURN] = F[q + MQF_CORNER_TURN]
        F[f + MSF_CORNER_OUT_UPS] = F[q + MQF_CORNER_UPS]
    return AHEAD


def round_reach(F: F64, I: I32, m: int, record: int) -> float:
    """From how far before its end the present move is rounded."""
    f: int = MSF_BASE + m * MSF_STRIDE
    if F[f + MSF_CORNER_OUT_U] > 0.0:
        return F[f + MSF_CORNER_OUT_U]
    if I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED] > 1 and look_beyond(I, m, record):
        return F[MQF_BASE + record * MQF_STRIDE + MQF_CORNER_U]
    return 0.0


def round_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the piece of the present move in which the path is."""
    i: int = MSI_BASE + m * MSI_STRIDE
    f: int = MSF_BASE + m * MSF_STRIDE
    record: int = move_record(I, m)
    part: int = round_part(F, I, m)
    reach: float = round_reach(F, I, m, record)
    end: float = F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]
    I[i + MSI_PIECE] = 0
    if part == BEHIND:
        end = F[f + MSF_CORNER_IN_U]
        I[i + MSI_PIECE] = 1
    elif part == LINE and reach > 0.0:
        end = end - reach
        I[i + MSI_PIECE] = 1
    F[f + MSF_STRETCH_U] = F[f + MSF_ORIGIN_U] + end
    F[f + MSF_LOOK_CAP_UPS] = 0.0
    I[i + MSI_STRETCH] = 1
    w: float = round_exit2(F, I, S, m, part)
    F[f + MSF_LOOK_EXIT_UPS] = sqrt(w)
    limit: float = master_limit(F, I, S, m)
    if part == LINE:
        round_line(F, I, m, record, limit, sqrt(w))
    elif part == BEHIND:
        cap: float = F[f + MSF_CORNER_IN_UPS]
        round_corner(
            F, I, m, record, limit, w, F[f + MSF_CORNER_IN_TURN], F[f + MSF_CORNER_IN_U], cap
        )
    else:
        cap = F[f + MSF_CORNER_OUT_UPS]
        round_corner(F, I, m, record, limit, w, F[f + MSF_CORNER_OUT_TURN], reach, cap)
    F[PRF_BASE + m * PRF_STRIDE + PRF_TARGET_VELOCITY] = limit


def round_line(F: F64, I: I32, m: int, record: int, limit: float, leaving: float) -> None:
    """Plan the line of the present move, to the corner ahead or the end of the path."""
    q: int = MQF_BASE + record * MQF_STRIDE
    f: int = PRF_BASE + m * PRF_STRIDE
    acc: float = F[q + MQF_ACC_UPS2]
    dec: float = F[q + MQF_DEC_UPS2]
    jerk: float = F[q + MQF_JRK_UPS3]
    end: float = F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U]
    ends: bool = round_last(I, m) == 0
    rate: float = F[q + MQF_STP_UPS2]
    if not ends:
        rate = look_rate(F, record)
        if jerk > 0.0 and acc > 0.0:  # corners are entered without acceleration
            reached: float = round_reached(F, m, end - F[f + PRF_DISTANCE], limit, acc, jerk)
            leaving = min(leaving, reached * (1.0 - SLACK))
        if jerk > 0.0 and rate > 0.0:
            wanted: float = min(leaving, limit)
            reached = round_settle(F, m, end - F[f + PRF_DISTANCE], wanted, rate, jerk)
            if reached < 0.0 and round_planned(F, I, m, end):
                return
            if reached > wanted:
                if limit <= 0.0 and I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE]:
                    reached = max(reached, LINGER * leaving)
                round_even(F, I, m, end, reached, acc, rate, jerk)
                return
        if leaving >= limit:
            rate = 0.0
    profile_plan(F, I, m, end, limit, leaving, acc, dec, rate, jerk)
    if not ends:
        round_decelerate(I, m)


def round_reached(F: F64, m: int, way: float, limit: float, rate: float, jerk: float) -> float:
    """The highest speed up to `limit` that is reached, without acceleration, within a way."""
    velocity: float = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
    accel: float = F[PRF_BASE + m * PRF_STRIDE + PRF_ACCEL]
    low: float = max(rest_speed(velocity, accel, jerk), 0.0)
    high: float = limit
    if high <= low or ramp_way(velocity, accel, high, rate, jerk) <= way:
        return max(high, low)
    for _ in range(BISECTIONS):
        middle: float = (low + high) / 2.0
        if ramp_way(velocity, accel, middle, rate, jerk) > way:
            high = middle
        else:
            low = middle
    return low


def round_settle(F: F64, m: int, way: float, wanted: float, rate: float, jerk: float) -> float:
    """The lowest speed from `wanted` up that is reached, without acceleration, within a way.

    -1 if there is not even room to let go of the present acceleration.
    """
    velocity: float = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
    accel: float = F[PRF_BASE + m * PRF_STRIDE + PRF_ACCEL]
    high: float = max(rest_speed(velocity, accel, jerk), 0.0)
    if wanted >= high:
        return wanted
    if ramp_way(velocity, accel, wanted, rate, jerk) <= way:
        return wanted
    if ramp_way(velocity, accel, high, rate, jerk) > way:
        return -1.0
    low: float = wanted
    for _ in range(BISECTIONS):
        middle: float = (low + high) / 2.0
        if ramp_way(velocity, accel, middle, rate, jerk) > way:
            low = middle
        else:
            high = middle
    return high


def round_planned(F: F64, I: I32, m: int, end: float) -> bool:
    """Whether the plan under way leads to `end`."""
    f: int = PRF_BASE + m * PRF_STRIDE
    return I[PRI_BASE + m * PRI_STRIDE + PRI_SEG_COUNT] > 0 and F[f + PRF_END_DISTANCE] == end


def round_even(
    F: F64, I: I32, m: int, end: float, goal: float, acc: float, rate: float, jerk: float
) -> None:
    """Plan to a corner that is passed at speed `goal`."""
    profile_plan(F, I, m, end, goal, goal, acc, rate, 0.0, jerk)


def round_decelerate(I: I32, m: int) -> None:
    """Slowing down for a corner is no end of the path."""
    p: int = PRI_BASE + m * PRI_STRIDE
    for k in range(I[p + PRI_SEG_COUNT]):
        if I[p + PRI_SEG_KIND + k] == STOPPING:
            I[p + PRI_SEG_KIND + k] = DECELERATING


def round_corner(
    F: F64,
    I: I32,
    m: int,
    record: int,
    limit: float,
    w: float,
    turn: float,
    reach: float,
    cap: float,
) -> None:
    """Plan the rest of a corner: one constant acceleration, or constant speed under jerk."""
    q: int = MQF_BASE + record * MQF_STRIDE
    f: int = PRF_BASE + m * PRF_STRIDE
    end: float = F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U]
    left: float = end - F[f + PRF_DISTANCE]
    velocity: float = F[f + PRF_VELOCITY]
    now: float = velocity * velocity
    jerk: float = F[q + MQF_JRK_UPS3]
    accel: float = round_accel(F, record)
    leaving: float = min(sqrt(w), min(limit, cap))
    if jerk > 0.0:
        if velocity <= LINGER * leaving or F[f + PRF_ACCEL] != 0.0:
            soft: float = SOFT * accel
            profile_plan(F, I, m, end, min(limit, 0.5 * cap), 0.0, soft, soft, 0.0, SOFT * jerk)
        else:
            profile_plan(F, I, m, end, velocity, velocity, accel, accel, 0.0, jerk)
    elif accel <= 0.0 or left <= 0.0 or fabs(leaving - velocity) <= SLACK * leaving:
        profile_plan(F, I, m, end, leaving, leaving, accel, accel, 0.0, 0.0)
    elif leaving >= velocity:
        # From within a corner the way left is shorter than the whole: still a safe choice.
        top: float = min(leaving * leaving, round_ramp2(turn, reach, accel, 0.0, now))
        rate: float = max((top - now) / (2.0 * left), 0.0)
        rate = min(rate, round_brake(turn, reach, accel, top))
        profile_plan(F, I, m, end, leaving, leaving, rate, rate, 0.0, 0.0)
    else:
        brake: float = round_brake(turn, reach, accel, now)
        needed: float = (now - w) / (2.0 * left)
        if limit <= 0.0:
            profile_plan(F, I, m, end, 0.0, 0.0, accel, max(brake, needed), 0.0, 0.0)
            return
        lowest: float = max(now - 2.0 * brake * left, 0.0)
        goal: float = min(max(leaving * leaving, lowest), max(w, 0.0))
        rate = (now - goal) / (2.0 * left)
        profile_plan(F, I, m, end, velocity, sqrt(goal), rate, rate, rate, 0.0)
        round_decelerate(I, m)


def round_holds(F: F64, I: I32, S: F32, m: int, rate: float) -> bool:
    """A feedhold under a jerk limit: True if it has to wait until a corner is behind.

    In front of a corner it slows the path as far as that can be done without acceleration in
    the corner, where the path neither stops nor lingers.
    """
    record: int = move_record(I, m)
    jerk: float = F[MQF_BASE + record * MQF_STRIDE + MQF_JRK_UPS3]
    if jerk <= 0.0 or not round_through(F, I, m, record):
        return False
    if round_part(F, I, m) != LINE:
        return True
    if not I[MSI_BASE + m * MSI_STRIDE + MSI_PIECE]:
        return False
    f: int = PRF_BASE + m * PRF_STRIDE
    end: float = F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U]
    way: float = end - F[f + PRF_DISTANCE]
    reached: float = round_settle(F, m, way, 0.0, rate, jerk)
    if reached == 0.0:
        return False
    cap: float = F[MQF_BASE + record * MQF_STRIDE + MQF_CORNER_UPS]
    wanted: float = LINGER * min(cap, F[MSF_BASE + m * MSF_STRIDE + MSF_LOOK_EXIT_UPS])
    if wanted > reached:
        reached = round_settle(F, m, way, wanted, rate, jerk)
    speed: float = rest_speed(F[f + PRF_VELOCITY], F[f + PRF_ACCEL], jerk)
    if 0.0 < reached < speed:
        round_even(F, I, m, end, reached, rate, rate, jerk)
    return True


def round_hold_rate(F: F64, I: I32, m: int, rate: float) -> float:
    """The rate of a feedhold: less in a corner."""
    if not round_through(F, I, m, move_record(I, m)):
        return rate
    f: int = MSF_BASE + m * MSF_STRIDE
    part: int = round_part(F, I, m)
    accel: float = round_accel(F, move_record(I, m))
    velocity: float = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
    turn: float = F[f + MSF_CORNER_IN_TURN]
    reach: float = F[f + MSF_CORNER_IN_U]
    if part == AHEAD:
        turn = F[f + MSF_CORNER_OUT_TURN]
        reach = F[f + MSF_CORNER_OUT_U]
    if part == LINE or reach <= 0.0 or accel <= 0.0:
        return rate
    return min(rate, round_brake(turn, reach, accel, velocity * velocity))
