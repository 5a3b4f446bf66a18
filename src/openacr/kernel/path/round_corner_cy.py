"""Plan through one rounded corner: one constant acceleration, or constant speed under jerk."""

from openacr.cmath import fabs, sqrt
from openacr.kernel.path.round_law_cy import round_accel, round_brake, round_limit, round_ramp2
from openacr.kernel.path.round_settle_cy import round_reached
from openacr.kernel.profile.profile_cy import profile_plan
from openacr.kernel.profile.ramps_cy import DECELERATING, STOPPING
from openacr.map.rows import masters, moves, profiles
from openacr.views import F64, I32

__all__ = ["round_corner", "round_decelerate"]

SLACK = 1e-9  # of a length
SOFT = 0.2  # share of the limits for starts within a corner under a jerk limit
LINGER = 0.3  # of the speed a corner allows: slower ones do not stay constant in it
STEADY = 1e-6  # of the limit: less acceleration than that is what rounding leaves of none


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
        if velocity_ups <= LINGER * leaving_ups or fabs(F[profiles.accel[m]]) > STEADY * accel_ups2:
            soft_ups2: float = SOFT * accel_ups2
            soft_ups3: float = SOFT * jerk_ups3
            goal_ups: float = min(leaving_ups, 0.5 * cap_ups)
            if goal_ups > velocity_ups:
                room_u: float = left_u * (1.0 - SLACK)
                goal_ups = max(
                    velocity_ups,
                    round_reached(F, m, room_u, goal_ups, soft_ups2, soft_ups3),
                )
            profile_plan(F, I, m, end_u, goal_ups, 0.0, soft_ups2, soft_ups2, 0.0, soft_ups3)
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
