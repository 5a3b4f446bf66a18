"""Feedholds near rounded corners: where they wait, and how fast they slow the path."""

from openacr.kernel.path.interrupt_cy import stop_distance
from openacr.kernel.path.path_cy import move_record
from openacr.kernel.path.round_corner_cy import LINGER
from openacr.kernel.path.round_cy import round_part, round_planned, round_through
from openacr.kernel.path.round_law_cy import round_accel, round_brake, round_limit
from openacr.kernel.path.round_pass_cy import CORNER_AFTER, LINE
from openacr.kernel.path.round_settle_cy import round_even, round_settle
from openacr.kernel.profile.ramps_cy import rest_speed
from openacr.map.rows import masters, moves, profiles
from openacr.views import F32, F64, I32

__all__ = ["round_hold_rate", "round_holds"]


def round_holds(F: F64, I: I32, S: F32, m: int, rate_ups2: float) -> bool:
    """Whether a feedhold has to wait: until the stop ahead or, with jerk, beyond a corner.

    Under jerk it slows the path in front of a corner as far as that can be done without
    acceleration in the corner, where the path neither stops nor lingers.
    """
    record: int = move_record(I, m)
    if not round_through(F, I, m, record):
        return False
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    if round_part(F, I, m) != LINE:
        return jerk_ups3 > 0.0
    end_u: float = F[masters.section_u[m]]
    distance_u: float = end_u - F[profiles.distance[m]]
    if not I[masters.piece[m]]:  # at a corner that is a stop the path has planned to rest
        stop_u: float = stop_distance(F, m, rate_ups2, jerk_ups3)
        return stop_u >= distance_u and round_planned(F, I, m, end_u, 0.0)
    if jerk_ups3 <= 0.0:
        return False
    reached_ups: float = round_settle(F, m, distance_u, 0.0, 0.0, rate_ups2, jerk_ups3)
    if reached_ups == 0.0:
        return False
    leaving_ups: float = F[masters.look_exit_ups[m]]
    wanted_ups: float = LINGER * leaving_ups
    if wanted_ups > reached_ups:
        reached_ups = round_settle(F, m, distance_u, wanted_ups, leaving_ups, rate_ups2, jerk_ups3)
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
