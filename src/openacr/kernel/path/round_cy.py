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
from openacr.kernel.path.bezier_cy import is_bezier
from openacr.kernel.path.corner_cy import corner_open
from openacr.kernel.path.lookahead_cy import (
    look_active,
    look_beyond,
    look_plain,
    look_rate,
    look_record,
)
from openacr.kernel.path.path_cy import master_limit, move_record
from openacr.kernel.path.round_law_cy import round_accel, round_brake, round_ramp2
from openacr.kernel.path.round_pass_cy import AHEAD, BEHIND, LINE, round_exit2, round_last
from openacr.kernel.profile_cy import DECELERATING, STOPPING, profile_plan, ramp_way, rest_speed
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

SLACK = 1e-9  # of a length
SOFT = 0.2  # share of the limits for starts within a corner under a jerk limit
LINGER = 0.3  # of the speed a corner allows: slower ones do not stay constant in it
BISECTIONS = 50


def round_through(F: F64, I: I32, m: int, record: int) -> bool:
    """Whether the present move is planned in pieces."""
    if not I[masters.rounding[m]]:
        return False
    if not look_plain(F, I, record) or is_bezier(I, record):
        return False
    if not look_active(I, m):
        leaves: bool = F[masters.corner_in_u[m]] > 0.0
        return leaves or I[moves.ahead[record]] != 0
    if F[moves.jrk_ups3[record]] <= 0.0:
        return True
    # With jerk moves between corners that are not rounded merge, as LOOK has it.
    behind: float = F[masters.corner_in_u[m]]
    return behind > 0.0 or round_reach(F, I, m, record) > 0.0


def round_part(F: F64, I: I32, m: int) -> int:
    """The piece of the present move in which the path is; open the corner ahead."""
    record: int = move_record(I, m)
    length: float = F[moves.length_u[record]]
    gone: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    if gone < F[masters.corner_in_u[m]] - SLACK * length:
        return BEHIND
    reach: float = round_reach(F, I, m, record)
    if reach <= 0.0 or gone < length - reach - SLACK * length:
        return LINE
    if F[masters.corner_out_u[m]] <= 0.0 and I[masters.queued[m]] > 1:
        smooth: int = 1 if F[moves.jrk_ups3[record]] > 0.0 else 0
        corner_open(F, I, m, record, look_record(I, m, 1), reach, smooth)
        F[masters.corner_out_turn[m]] = F[moves.corner_turn[record]]
        F[masters.corner_out_ups[m]] = F[moves.corner_ups[record]]
    return AHEAD


def round_reach(F: F64, I: I32, m: int, record: int) -> float:
    """From how far before its end the present move is rounded."""
    if F[masters.corner_out_u[m]] > 0.0:
        return F[masters.corner_out_u[m]]
    if I[masters.queued[m]] > 1 and look_beyond(I, m, record):
        return F[moves.corner_u[record]]
    return 0.0


def round_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the piece of the present move in which the path is."""
    record: int = move_record(I, m)
    part: int = round_part(F, I, m)
    reach: float = round_reach(F, I, m, record)
    end: float = F[moves.length_u[record]]
    I[masters.piece[m]] = 0
    if part == BEHIND:
        end = F[masters.corner_in_u[m]]
        I[masters.piece[m]] = 1
    elif part == LINE and reach > 0.0:
        end = end - reach
        I[masters.piece[m]] = 1
    F[masters.stretch_u[m]] = F[masters.origin_u[m]] + end
    F[masters.look_cap_ups[m]] = 0.0
    I[masters.stretch[m]] = 1
    w: float = round_exit2(F, I, S, m, part)
    F[masters.look_exit_ups[m]] = sqrt(w)
    limit: float = master_limit(F, I, S, m)
    if part == LINE:
        round_line(F, I, m, record, limit, sqrt(w))
    elif part == BEHIND:
        cap: float = F[masters.corner_in_ups[m]]
        round_corner(
            F, I, m, record, limit, w, F[masters.corner_in_turn[m]], F[masters.corner_in_u[m]], cap
        )
    else:
        cap = F[masters.corner_out_ups[m]]
        round_corner(F, I, m, record, limit, w, F[masters.corner_out_turn[m]], reach, cap)
    F[profiles.target_velocity[m]] = limit


def round_line(F: F64, I: I32, m: int, record: int, limit: float, leaving: float) -> None:
    """Plan the line of the present move, to the corner ahead or the end of the path."""
    acc: float = F[moves.acc_ups2[record]]
    dec: float = F[moves.dec_ups2[record]]
    jerk: float = F[moves.jrk_ups3[record]]
    end: float = F[masters.stretch_u[m]]
    ends: bool = round_last(I, m) == 0
    rate: float = F[moves.stp_ups2[record]]
    if not ends:
        rate = look_rate(F, record)
        if jerk > 0.0 and acc > 0.0:  # corners are entered without acceleration
            reached: float = round_reached(F, m, end - F[profiles.distance[m]], limit, acc, jerk)
            leaving = min(leaving, reached * (1.0 - SLACK))
        if jerk > 0.0 and rate > 0.0:
            wanted: float = min(leaving, limit)
            reached = round_settle(F, m, end - F[profiles.distance[m]], wanted, rate, jerk)
            if reached < 0.0 and round_planned(F, I, m, end):
                return
            if reached > wanted:
                if limit <= 0.0 and I[masters.piece[m]]:
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
    velocity: float = F[profiles.velocity[m]]
    accel: float = F[profiles.accel[m]]
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
    velocity: float = F[profiles.velocity[m]]
    accel: float = F[profiles.accel[m]]
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
    return I[profiles.seg_count[m]] > 0 and F[profiles.end_distance[m]] == end


def round_even(
    F: F64, I: I32, m: int, end: float, goal: float, acc: float, rate: float, jerk: float
) -> None:
    """Plan to a corner that is passed at speed `goal`."""
    profile_plan(F, I, m, end, goal, goal, acc, rate, 0.0, jerk)


def round_decelerate(I: I32, m: int) -> None:
    """Slowing down for a corner is no end of the path."""
    for k in range(I[profiles.seg_count[m]]):
        if I[profiles.seg_kind[m] + k] == STOPPING:
            I[profiles.seg_kind[m] + k] = DECELERATING


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
    end: float = F[masters.stretch_u[m]]
    left: float = end - F[profiles.distance[m]]
    velocity: float = F[profiles.velocity[m]]
    now: float = velocity * velocity
    jerk: float = F[moves.jrk_ups3[record]]
    accel: float = round_accel(F, record)
    leaving: float = min(sqrt(w), min(limit, cap))
    if jerk > 0.0:
        if velocity <= LINGER * leaving or F[profiles.accel[m]] != 0.0:
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
    jerk: float = F[moves.jrk_ups3[record]]
    if jerk <= 0.0 or not round_through(F, I, m, record):
        return False
    if round_part(F, I, m) != LINE:
        return True
    if not I[masters.piece[m]]:
        return False
    end: float = F[masters.stretch_u[m]]
    way: float = end - F[profiles.distance[m]]
    reached: float = round_settle(F, m, way, 0.0, rate, jerk)
    if reached == 0.0:
        return False
    cap: float = F[moves.corner_ups[record]]
    wanted: float = LINGER * min(cap, F[masters.look_exit_ups[m]])
    if wanted > reached:
        reached = round_settle(F, m, way, wanted, rate, jerk)
    speed: float = rest_speed(F[profiles.velocity[m]], F[profiles.accel[m]], jerk)
    if 0.0 < reached < speed:
        round_even(F, I, m, end, reached, rate, rate, jerk)
    return True


def round_hold_rate(F: F64, I: I32, m: int, rate: float) -> float:
    """The rate of a feedhold: less in a corner."""
    if not round_through(F, I, m, move_record(I, m)):
        return rate
    part: int = round_part(F, I, m)
    accel: float = round_accel(F, move_record(I, m))
    velocity: float = F[profiles.velocity[m]]
    turn: float = F[masters.corner_in_turn[m]]
    reach: float = F[masters.corner_in_u[m]]
    if part == AHEAD:
        turn = F[masters.corner_out_turn[m]]
        reach = F[masters.corner_out_u[m]]
    if part == LINE or reach <= 0.0 or accel <= 0.0:
        return rate
    return min(rate, round_brake(turn, reach, accel, velocity * velocity))
