"""Plan a path with rounded corners: piece by piece, fast as the acceleration allows.

Rounded corners (corner_cy) divide every move into up to three pieces:

    |-- corner behind --|------ line ------|-- corner ahead --|
    0                  Tin              L - Tout              L

On the line the ramps of the move apply, in a corner what round_law_cy says; round_pass_cy
looks ahead.

With a jerk limit the speed in corners is constant, whatever happens: a change of override or
a feedhold that cannot be done with in front of a corner goes on behind it. Only a path that
starts from rest just before one speeds up in it, softly, to half of what it allows.
"""

from openacr.cmath import fabs, sqrt
from openacr.kernel.bezier_cy import is_bezier
from openacr.kernel.corner_cy import corner_open
from openacr.kernel.lookahead_cy import look_active, look_beyond, look_plain, look_rate, look_record
from openacr.kernel.path_cy import master_limit, move_record
from openacr.kernel.profile_cy import DECELERATING, STOPPING, profile_plan, ramp_way, rest_speed
from openacr.kernel.round_law_cy import round_accel, round_brake, round_ramp2
from openacr.kernel.round_pass_cy import AHEAD, BEHIND, LINE, round_exit2, round_last
from openacr.map.numbers import (
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_CORNER_TURN,
    MQF_CORNER_U,
    MQF_CORNER_UPS,
    MQF_DEC_UPS2,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQI_AHEAD,
    MQI_BASE,
    MQI_STRIDE,
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
    MSI_PIECE,
    MSI_QUEUED,
    MSI_ROUNDING,
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

SLACK = 1e-9  # of a length
SOFT = 0.2  # share of the limits for starts within a corner under a jerk limit
LINGER = 0.3  # of the speed a corner allows: slower ones do not stay constant in it
BISECTIONS = 50


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
