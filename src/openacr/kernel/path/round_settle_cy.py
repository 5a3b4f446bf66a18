"""Speeds that a path under a jerk limit reaches, without acceleration, before a corner."""

from openacr.kernel.profile.profile_cy import profile_plan
from openacr.kernel.profile.ramps_cy import ramp_distance, rest_speed
from openacr.map.rows import profiles
from openacr.views import F64, I32

__all__ = ["round_arrives", "round_even", "round_reached", "round_settle"]

LOWER = 0.6  # of a wanted speed: more than LINGER
BISECTIONS = 50


def round_reached(
    F: F64, m: int, distance_u: float, limit_ups: float, rate_ups2: float, jerk_ups3: float
) -> float:
    """The highest speed up to `limit_ups` reached, without acceleration, within a distance.

    -1 if even the acceleration it has cannot be taken back on it.
    """
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    low_ups: float = max(rest_speed(velocity_ups, accel_ups2, jerk_ups3), 0.0)
    if ramp_distance(velocity_ups, accel_ups2, low_ups, rate_ups2, jerk_ups3) > distance_u:
        return -1.0
    if limit_ups <= low_ups:
        return low_ups
    if ramp_distance(velocity_ups, accel_ups2, limit_ups, rate_ups2, jerk_ups3) <= distance_u:
        return limit_ups
    return round_nearest(F, m, distance_u, limit_ups, low_ups, rate_ups2, jerk_ups3)


def round_settle(
    F: F64,
    m: int,
    distance_u: float,
    wanted_ups: float,
    top_ups: float,
    rate_ups2: float,
    jerk_ups3: float,
) -> float:
    """The speed nearest to `wanted_ups` reached, without acceleration, within a distance.

    Of all ramps the one to a third of the speed is the longest: what is too short for a low speed
    may do for a still lower one, which is preferred where corners are passed with it, and taken
    at any rate before a speed above `top_ups`. -1 if there is not even room for a stop.
    """
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    rest_ups: float = max(rest_speed(velocity_ups, accel_ups2, jerk_ups3), 0.0)
    goal_ups: float = min(wanted_ups, rest_ups)
    if ramp_distance(velocity_ups, accel_ups2, goal_ups, rate_ups2, jerk_ups3) <= distance_u:
        return wanted_ups
    wanted_ups = goal_ups
    lower_ups: float = LOWER * wanted_ups
    if ramp_distance(velocity_ups, accel_ups2, lower_ups, rate_ups2, jerk_ups3) <= distance_u:
        return round_nearest(F, m, distance_u, wanted_ups, lower_ups, rate_ups2, jerk_ups3)
    higher_ups: float = -1.0
    if ramp_distance(velocity_ups, accel_ups2, rest_ups, rate_ups2, jerk_ups3) <= distance_u:
        higher_ups = round_nearest(F, m, distance_u, wanted_ups, rest_ups, rate_ups2, jerk_ups3)
    if 0.0 <= higher_ups <= top_ups:
        return higher_ups
    if ramp_distance(velocity_ups, accel_ups2, 0.0, rate_ups2, jerk_ups3) <= distance_u:
        return round_nearest(F, m, distance_u, wanted_ups, 0.0, rate_ups2, jerk_ups3)
    return higher_ups


def round_nearest(
    F: F64,
    m: int,
    distance_u: float,
    fails_ups: float,
    fits_ups: float,
    rate_ups2: float,
    jerk_ups3: float,
) -> float:
    """Of the speeds between one that cannot be reached and one that can, that nearest to it."""
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    for _ in range(BISECTIONS):
        middle_ups: float = (fails_ups + fits_ups) / 2.0
        if ramp_distance(velocity_ups, accel_ups2, middle_ups, rate_ups2, jerk_ups3) > distance_u:
            fails_ups = middle_ups
        else:
            fits_ups = middle_ups
    return fits_ups


def round_arrives(
    F: F64, m: int, distance_u: float, leaving_ups: float, rate_ups2: float, jerk_ups3: float
) -> bool:
    """Whether a corner passed at up to `leaving_ups` can be reached at a fair speed."""
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    rest_ups: float = max(rest_speed(velocity_ups, accel_ups2, jerk_ups3), 0.0)
    goal_ups: float = min(leaving_ups, rest_ups)
    if ramp_distance(velocity_ups, accel_ups2, goal_ups, rate_ups2, jerk_ups3) <= distance_u:
        return True
    lower_ups: float = LOWER * leaving_ups
    if lower_ups >= rest_ups:
        return False
    return ramp_distance(velocity_ups, accel_ups2, lower_ups, rate_ups2, jerk_ups3) <= distance_u


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
