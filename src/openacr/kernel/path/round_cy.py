"""Plan a path with rounded corners: piece by piece, fast as the acceleration allows.

Rounded corners (corner_cy) divide every move into up to three parts:

    |-- corner before --|------ line ------|-- corner ahead --|
    0                  Tin              L - Tout              L

On the line the ramps of the move apply, in a corner what round_law_cy says; round_pass_cy
looks ahead.

With a jerk limit the speed in corners is constant, whatever happens: a change of override or
a feedhold that cannot be done with in front of a corner continues after it. Only a path that
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
from openacr.kernel.path.round_law_cy import round_accel, round_brake, round_limit, round_ramp2
from openacr.kernel.path.round_pass_cy import (
    CORNER_AFTER,
    CORNER_BEFORE,
    LINE,
    round_exit2,
    round_last,
)
from openacr.kernel.profile.profile_cy import profile_plan
from openacr.kernel.profile.ramps_cy import DECELERATING, STOPPING, ramp_distance, rest_speed
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

SLACK = 1e-9  # of a length
SOFT = 0.2  # share of the limits for starts within a corner under a jerk limit
LINGER = 0.3  # of the speed a corner allows: slower ones do not stay constant in it
BISECTIONS = 50


def round_through(F: F64, I: I32, m: int, record: int) -> bool:
    """Whether the present move is planned in parts."""
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
    before_u: float = F[masters.corner_in_u[m]]
    return before_u > 0.0 or round_reach(F, I, m, record) > 0.0


def round_part(F: F64, I: I32, m: int) -> int:
    """The part of the present move in which the path is; open the corner ahead."""
    record: int = move_record(I, m)
    length_u: float = F[moves.length_u[record]]
    gone_u: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    if gone_u < F[masters.corner_in_u[m]] - SLACK * length_u:
        return CORNER_BEFORE
    reach_u: float = round_reach(F, I, m, record)
    if reach_u <= 0.0 or gone_u < length_u - reach_u - SLACK * length_u:
        return LINE
    if F[masters.corner_out_u[m]] <= 0.0 and I[masters.queued[m]] > 1:
        smooth: int = 1 if F[moves.jrk_ups3[record]] > 0.0 else 0
        corner_open(F, I, m, record, look_record(I, m, 1), reach_u, smooth)
        F[masters.corner_out_turn[m]] = F[moves.corner_turn[record]]
        F[masters.corner_out_ups[m]] = F[moves.corner_ups[record]]
    return CORNER_AFTER


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
    reach_u: float = round_reach(F, I, m, record)
    end_u: float = F[moves.length_u[record]]
    I[masters.piece[m]] = 0
    if part == CORNER_BEFORE:
        end_u = F[masters.corner_in_u[m]]
        I[masters.piece[m]] = 1
    elif part == LINE and reach_u > 0.0:
        end_u = end_u - reach_u
        I[masters.piece[m]] = 1
    F[masters.section_u[m]] = F[masters.origin_u[m]] + end_u
    F[masters.look_cap_ups[m]] = 0.0
    I[masters.section_cnt[m]] = 1
    w_v2: float = round_exit2(F, I, S, m, part)
    F[masters.look_exit_ups[m]] = sqrt(w_v2)
    limit_ups: float = master_limit(F, I, S, m)
    if part == LINE:
        round_line(F, I, m, record, limit_ups, sqrt(w_v2))
    elif part == CORNER_BEFORE:
        cap_ups: float = F[masters.corner_in_ups[m]]
        round_corner(
            F,
            I,
            m,
            record,
            limit_ups,
            w_v2,
            F[masters.corner_in_turn[m]],
            F[masters.corner_in_u[m]],
            cap_ups,
        )
    else:
        cap_ups = F[masters.corner_out_ups[m]]
        round_corner(
            F, I, m, record, limit_ups, w_v2, F[masters.corner_out_turn[m]], reach_u, cap_ups
        )
    F[profiles.target_velocity[m]] = limit_ups


def round_line(F: F64, I: I32, m: int, record: int, limit_ups: float, leaving_ups: float) -> None:
    """Plan the line of the present move, to the corner ahead or the end of the path."""
    acc_ups2: float = F[moves.acc_ups2[record]]
    dec_ups2: float = F[moves.dec_ups2[record]]
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    end_u: float = F[masters.section_u[m]]
    ends: bool = round_last(I, m) == 0
    rate_ups2: float = F[moves.stp_ups2[record]]
    if not ends:
        rate_ups2 = look_rate(F, record)
        if jerk_ups3 > 0.0 and acc_ups2 > 0.0:  # corners are entered without acceleration
            reached_ups: float = round_reached(
                F, m, end_u - F[profiles.distance[m]], limit_ups, acc_ups2, jerk_ups3
            )
            leaving_ups = min(leaving_ups, reached_ups * (1.0 - SLACK))
        if jerk_ups3 > 0.0 and rate_ups2 > 0.0:
            wanted_ups: float = min(leaving_ups, limit_ups)
            reached_ups = round_settle(
                F, m, end_u - F[profiles.distance[m]], wanted_ups, rate_ups2, jerk_ups3
            )
            if reached_ups < 0.0 and round_planned(F, I, m, end_u):
                return
            if reached_ups > wanted_ups:
                if limit_ups <= 0.0 and I[masters.piece[m]]:
                    reached_ups = max(reached_ups, LINGER * leaving_ups)
                round_even(F, I, m, end_u, reached_ups, acc_ups2, rate_ups2, jerk_ups3)
                return
        if leaving_ups >= limit_ups:
            rate_ups2 = 0.0
    profile_plan(F, I, m, end_u, limit_ups, leaving_ups, acc_ups2, dec_ups2, rate_ups2, jerk_ups3)
    if not ends:
        round_decelerate(I, m)


def round_reached(
    F: F64, m: int, distance_u: float, limit_ups: float, rate_ups2: float, jerk_ups3: float
) -> float:
    """The highest speed up to `limit_ups` reached, without acceleration, within a distance."""
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    low_ups: float = max(rest_speed(velocity_ups, accel_ups2, jerk_ups3), 0.0)
    high_ups: float = limit_ups
    if (
        high_ups <= low_ups
        or ramp_distance(velocity_ups, accel_ups2, high_ups, rate_ups2, jerk_ups3) <= distance_u
    ):
        return max(high_ups, low_ups)
    for _ in range(BISECTIONS):
        middle_ups: float = (low_ups + high_ups) / 2.0
        if ramp_distance(velocity_ups, accel_ups2, middle_ups, rate_ups2, jerk_ups3) > distance_u:
            high_ups = middle_ups
        else:
            low_ups = middle_ups
    return low_ups


def round_settle(
    F: F64, m: int, distance_u: float, wanted_ups: float, rate_ups2: float, jerk_ups3: float
) -> float:
    """The lowest speed from `wanted_ups` up reached, without acceleration, within a distance.

    -1 if there is not even room to let go of the present acceleration.
    """
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    high_ups: float = max(rest_speed(velocity_ups, accel_ups2, jerk_ups3), 0.0)
    if wanted_ups >= high_ups:
        return wanted_ups
    if ramp_distance(velocity_ups, accel_ups2, wanted_ups, rate_ups2, jerk_ups3) <= distance_u:
        return wanted_ups
    if ramp_distance(velocity_ups, accel_ups2, high_ups, rate_ups2, jerk_ups3) > distance_u:
        return -1.0
    low_ups: float = wanted_ups
    for _ in range(BISECTIONS):
        middle_ups: float = (low_ups + high_ups) / 2.0
        if ramp_distance(velocity_ups, accel_ups2, middle_ups, rate_ups2, jerk_ups3) > distance_u:
            low_ups = middle_ups
        else:
            high_ups = middle_ups
    return high_ups


def round_planned(F: F64, I: I32, m: int, end_u: float) -> bool:
    """Whether the present plan leads to `end_u`."""
    return I[profiles.seg_count[m]] > 0 and F[profiles.end_distance[m]] == end_u


def round_even(
    F: F64,
    I: I32,
    m: int,
    end_u: float,
    goal_ups: float,
    acc_ups2: float,
    rate_ups2: float,
    jerk_ups3: float,
) -> None:
    """Plan to a corner that is passed at speed `goal_ups`."""
    profile_plan(F, I, m, end_u, goal_ups, goal_ups, acc_ups2, rate_ups2, 0.0, jerk_ups3)


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
    limit_ups: float,
    w_v2: float,
    turn: float,
    reach_u: float,
    cap_ups: float,
) -> None:
    """Plan the rest of a corner: one constant acceleration, or constant speed under jerk."""
    end_u: float = F[masters.section_u[m]]
    left_u: float = end_u - F[profiles.distance[m]]
    velocity_ups: float = F[profiles.velocity[m]]
    now_v2: float = velocity_ups * velocity_ups
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    accel_ups2: float = round_limit(turn, reach_u, cap_ups, round_accel(F, record), jerk_ups3)
    leaving_ups: float = min(sqrt(w_v2), min(limit_ups, cap_ups))
    if jerk_ups3 > 0.0:
        if velocity_ups <= LINGER * leaving_ups or F[profiles.accel[m]] != 0.0:
            soft_ups2: float = SOFT * accel_ups2
            profile_plan(
                F,
                I,
                m,
                end_u,
                min(limit_ups, 0.5 * cap_ups),
                0.0,
                soft_ups2,
                soft_ups2,
                0.0,
                SOFT * jerk_ups3,
            )
        else:
            profile_plan(
                F, I, m, end_u, velocity_ups, velocity_ups, accel_ups2, accel_ups2, 0.0, jerk_ups3
            )
    elif (
        accel_ups2 <= 0.0
        or left_u <= 0.0
        or fabs(leaving_ups - velocity_ups) <= SLACK * leaving_ups
    ):
        profile_plan(F, I, m, end_u, leaving_ups, leaving_ups, accel_ups2, accel_ups2, 0.0, 0.0)
    elif leaving_ups >= velocity_ups:
        # From within a corner the distance left is shorter than the whole: still a safe choice.
        top_v2: float = min(
            leaving_ups * leaving_ups, round_ramp2(turn, reach_u, accel_ups2, 0.0, now_v2)
        )
        rate_ups2: float = max((top_v2 - now_v2) / (2.0 * left_u), 0.0)
        rate_ups2 = min(rate_ups2, round_brake(turn, reach_u, accel_ups2, top_v2))
        profile_plan(F, I, m, end_u, leaving_ups, leaving_ups, rate_ups2, rate_ups2, 0.0, 0.0)
    else:
        brake_ups2: float = round_brake(turn, reach_u, accel_ups2, now_v2)
        needed_ups2: float = (now_v2 - w_v2) / (2.0 * left_u)
        if limit_ups <= 0.0:
            profile_plan(
                F, I, m, end_u, 0.0, 0.0, accel_ups2, max(brake_ups2, needed_ups2), 0.0, 0.0
            )
            return
        lowest_v2: float = max(now_v2 - 2.0 * brake_ups2 * left_u, 0.0)
        goal_v2: float = min(max(leaving_ups * leaving_ups, lowest_v2), max(w_v2, 0.0))
        rate_ups2 = (now_v2 - goal_v2) / (2.0 * left_u)
        profile_plan(
            F, I, m, end_u, velocity_ups, sqrt(goal_v2), rate_ups2, rate_ups2, rate_ups2, 0.0
        )
        round_decelerate(I, m)


def round_holds(F: F64, I: I32, S: F32, m: int, rate_ups2: float) -> bool:
    """A feedhold under a jerk limit: True if it has to wait until a corner is passed.

    In front of a corner it slows the path as far as that can be done without acceleration in
    the corner, where the path neither stops nor lingers.
    """
    record: int = move_record(I, m)
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    if jerk_ups3 <= 0.0 or not round_through(F, I, m, record):
        return False
    if round_part(F, I, m) != LINE:
        return True
    if not I[masters.piece[m]]:
        return False
    end_u: float = F[masters.section_u[m]]
    distance_u: float = end_u - F[profiles.distance[m]]
    reached_ups: float = round_settle(F, m, distance_u, 0.0, rate_ups2, jerk_ups3)
    if reached_ups == 0.0:
        return False
    cap_ups: float = F[moves.corner_ups[record]]
    wanted_ups: float = LINGER * min(cap_ups, F[masters.look_exit_ups[m]])
    if wanted_ups > reached_ups:
        reached_ups = round_settle(F, m, distance_u, wanted_ups, rate_ups2, jerk_ups3)
    speed_ups: float = rest_speed(F[profiles.velocity[m]], F[profiles.accel[m]], jerk_ups3)
    if 0.0 < reached_ups < speed_ups:
        round_even(F, I, m, end_u, reached_ups, rate_ups2, rate_ups2, jerk_ups3)
    return True


def round_hold_rate(F: F64, I: I32, m: int, rate_ups2: float) -> float:
    """The rate of a feedhold: less in a corner."""
    if not round_through(F, I, m, move_record(I, m)):
        return rate_ups2
    part: int = round_part(F, I, m)
    record: int = move_record(I, m)
    velocity_ups: float = F[profiles.velocity[m]]
    turn: float = F[masters.corner_in_turn[m]]
    reach_u: float = F[masters.corner_in_u[m]]
    cap_ups: float = F[masters.corner_in_ups[m]]
    if part == CORNER_AFTER:
        turn = F[masters.corner_out_turn[m]]
        reach_u = F[masters.corner_out_u[m]]
        cap_ups = F[masters.corner_out_ups[m]]
    if part == LINE or reach_u <= 0.0:
        return rate_ups2
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    accel_ups2: float = round_limit(turn, reach_u, cap_ups, round_accel(F, record), jerk_ups3)
    if accel_ups2 <= 0.0:
        return rate_ups2
    return min(rate_ups2, round_brake(turn, reach_u, accel_ups2, velocity_ups * velocity_ups))
