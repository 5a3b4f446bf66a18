"""Segments and ramps of a motion profile (profile_cy.py).

Without jerk a ramp is one segment. With jerk J a ramp from (v0, a0) to v1 at rest
of acceleration raises |a| to a peak p, holds it, and takes it back. With sign d = +-1 of
the change,

    p^2 = J d (v1 - v0) + a0^2/2     (no hold; cut to the limit, then the hold makes up)

which contains the textbook cases t = dv/a + a/J and t = 2 sqrt(dv/J) for a0 = 0.
"""

from openacr.cmath import fabs, sqrt
from openacr.map.rows import profiles
from openacr.views import F64, I32

CRUISING = 0
ACCELERATING = 1
DECELERATING = 2
STOPPING = 3

BISECTIONS = 64
BACKWARD = 1e-6  # of a speed: more than rounding, see plan_start
LARGEST = 1e15  # speeds and rates beyond are no numbers of any machine


def rest_speed(velocity_ups: float, accel_ups2: float, jerk_ups3: float) -> float:
    """Speed that is reached when the acceleration is taken to 0 at once."""
    if jerk_ups3 <= 0.0:
        return velocity_ups
    return velocity_ups + accel_ups2 * fabs(accel_ups2) / (2.0 * jerk_ups3)


def plain(value: float) -> float:
    """A speed or rate as the planner can use it: 0 for less and for NaN, never infinite."""
    if not value > 0.0:
        return 0.0
    return min(value, LARGEST)


def ramp_distance(
    velocity_ups: float, accel_ups2: float, goal_ups: float, limit_ups2: float, jerk_ups3: float
) -> float:
    """Distance of a ramp under a jerk limit from a speed and acceleration to another speed."""
    sign: float = 1.0 if goal_ups >= rest_speed(velocity_ups, accel_ups2, jerk_ups3) else -1.0
    square: float = jerk_ups3 * sign * (goal_ups - velocity_ups) + accel_ups2 * accel_ups2 / 2.0
    peak_ups2: float = sign * min(sqrt(max(square, 0.0)), limit_ups2)
    rise_ups3: float = jerk_ups3 if peak_ups2 > accel_ups2 else -jerk_ups3
    t_s: float = (peak_ups2 - accel_ups2) / rise_ups3
    distance_u: float = t_s * (velocity_ups + t_s * (accel_ups2 / 2.0 + t_s * rise_ups3 / 6.0))
    speed_ups: float = velocity_ups + t_s * (accel_ups2 + t_s * rise_ups3 / 2.0)
    last_s: float = fabs(peak_ups2) / jerk_ups3
    if peak_ups2 != 0.0:
        t_s = max((goal_ups - speed_ups - peak_ups2 * last_s / 2.0) / peak_ups2, 0.0)
        distance_u += t_s * (speed_ups + t_s * peak_ups2 / 2.0)
        speed_ups += t_s * peak_ups2
    return distance_u + last_s * (
        speed_ups + last_s * (peak_ups2 / 2.0 - sign * last_s * jerk_ups3 / 6.0)
    )


def plan_start(F: F64, I: I32, n: int, jerk_ups3: float) -> None:
    """Empty the plan; planning continues from where the profile is now.

    A jerk too low to end the present braking before the path would run backwards (it has
    been lowered meanwhile) lets the acceleration start from 0 instead.
    """
    velocity_ups: float = F[profiles.velocity[n]]
    accel_ups2: float = F[profiles.accel[n]]
    if jerk_ups3 <= 0.0 or rest_speed(velocity_ups, accel_ups2, jerk_ups3) < -BACKWARD * fabs(
        velocity_ups
    ):
        accel_ups2 = 0.0
    F[profiles.plan_distance[n]] = F[profiles.distance[n]]
    F[profiles.plan_velocity[n]] = velocity_ups
    F[profiles.plan_accel[n]] = accel_ups2
    F[profiles.time_s[n]] = 0.0
    I[profiles.seg_count[n]] = 0
    I[profiles.seg_index[n]] = 0


def plan_append(
    F: F64, I: I32, n: int, time_s: float, accel_ups2: float, jerk_ups3: float, kind: int
) -> None:
    """Append a segment of constant jerk that starts with `accel_ups2`."""
    k: int = I[profiles.seg_count[n]]
    if time_s <= 0.0 or k >= profiles.SEG_TIME_S_SIZE:
        return
    distance_u: float = F[profiles.plan_distance[n]]
    velocity_ups: float = F[profiles.plan_velocity[n]]
    F[profiles.seg_time_s[n] + k] = time_s
    F[profiles.seg_jerk[n] + k] = jerk_ups3
    F[profiles.seg_accel[n] + k] = accel_ups2
    F[profiles.seg_velocity[n] + k] = velocity_ups
    F[profiles.seg_distance[n] + k] = distance_u
    I[profiles.seg_kind[n] + k] = kind
    I[profiles.seg_count[n]] = k + 1
    F[profiles.plan_distance[n]] = distance_u + time_s * (
        velocity_ups + time_s * (accel_ups2 / 2.0 + time_s * jerk_ups3 / 6.0)
    )
    F[profiles.plan_velocity[n]] = velocity_ups + time_s * (accel_ups2 + time_s * jerk_ups3 / 2.0)
    F[profiles.plan_accel[n]] = accel_ups2 + time_s * jerk_ups3


def plan_ramp(
    F: F64, I: I32, n: int, goal_ups: float, limit_ups2: float, jerk_ups3: float, kind: int
) -> None:
    """Append the ramp from the end of the plan to `goal_ups`; limit 0 is a velocity step."""
    start_ups: float = F[profiles.plan_velocity[n]]
    start_ups2: float = F[profiles.plan_accel[n]]
    if limit_ups2 > 0.0 and jerk_ups3 > 0.0:
        sign: float = 1.0 if goal_ups >= rest_speed(start_ups, start_ups2, jerk_ups3) else -1.0
        square: float = jerk_ups3 * sign * (goal_ups - start_ups) + start_ups2 * start_ups2 / 2.0
        peak_ups2: float = sign * min(sqrt(max(square, 0.0)), limit_ups2)
        rise_ups3: float = jerk_ups3 if peak_ups2 > start_ups2 else -jerk_ups3
        gained_ups: float = (peak_ups2 * peak_ups2 - start_ups2 * start_ups2) / (
            2.0 * rise_ups3
        ) + peak_ups2 * fabs(peak_ups2) / (2.0 * jerk_ups3)
        hold_s: float = 0.0
        if peak_ups2 != 0.0:
            hold_s = (goal_ups - start_ups - gained_ups) / peak_ups2
        plan_append(F, I, n, (peak_ups2 - start_ups2) / rise_ups3, start_ups2, rise_ups3, kind)
        plan_append(F, I, n, hold_s, peak_ups2, 0.0, kind)
        plan_append(F, I, n, fabs(peak_ups2) / jerk_ups3, peak_ups2, -sign * jerk_ups3, kind)
    elif limit_ups2 > 0.0 and goal_ups != start_ups:
        rate_ups2: float = limit_ups2 if goal_ups > start_ups else -limit_ups2
        plan_append(F, I, n, (goal_ups - start_ups) / rate_ups2, rate_ups2, 0.0, kind)
    F[profiles.plan_velocity[n]] = goal_ups
    F[profiles.plan_accel[n]] = 0.0


def plan_build(
    F: F64,
    I: I32,
    n: int,
    peak_ups: float,
    end_ups: float,
    acc_ups2: float,
    dec_ups2: float,
    stp_ups2: float,
    jerk_ups3: float,
    cruise_s: float,
) -> float:
    """Plan ramp to `peak_ups`, `cruise_s` seconds there, end ramp; return the distance used."""
    plan_start(F, I, n, jerk_ups3)
    if peak_ups >= rest_speed(F[profiles.plan_velocity[n]], F[profiles.plan_accel[n]], jerk_ups3):
        plan_ramp(F, I, n, peak_ups, acc_ups2, jerk_ups3, ACCELERATING)
    else:
        plan_ramp(F, I, n, peak_ups, dec_ups2, jerk_ups3, DECELERATING)
    plan_append(F, I, n, cruise_s, 0.0, 0.0, CRUISING)
    if end_ups < peak_ups:
        plan_ramp(F, I, n, end_ups, stp_ups2, jerk_ups3, STOPPING)
    return F[profiles.plan_distance[n]] - F[profiles.distance[n]]


def plan_finish(F: F64, I: I32, n: int, end_u: float) -> None:
    """Make the end of the plan exact: `end_u` is reached however the sums were rounded."""
    F[profiles.end_distance[n]] = end_u
    F[profiles.end_velocity[n]] = F[profiles.plan_velocity[n]]


def plan_truncate(F: F64, I: I32, n: int, end_u: float) -> None:
    """Cut the plan where it passes `end_u`; speed and acceleration there become its end."""
    count: int = I[profiles.seg_count[n]]
    k: int = 0
    while k + 1 < count and F[profiles.seg_distance[n] + k + 1] < end_u:
        k += 1
    if count > 0:
        accel_ups2: float = F[profiles.seg_accel[n] + k]
        velocity_ups: float = F[profiles.seg_velocity[n] + k]
        jerk_ups3: float = F[profiles.seg_jerk[n] + k]
        wanted_u: float = end_u - F[profiles.seg_distance[n] + k]
        low_s: float = 0.0
        high_s: float = F[profiles.seg_time_s[n] + k]
        for _ in range(BISECTIONS):
            time_s: float = (low_s + high_s) / 2.0
            if (
                time_s * (velocity_ups + time_s * (accel_ups2 / 2.0 + time_s * jerk_ups3 / 6.0))
                < wanted_u
            ):
                low_s = time_s
            else:
                high_s = time_s
        F[profiles.seg_time_s[n] + k] = high_s
        F[profiles.plan_velocity[n]] = velocity_ups + high_s * (
            accel_ups2 + high_s * jerk_ups3 / 2.0
        )
        F[profiles.plan_accel[n]] = accel_ups2 + high_s * jerk_ups3
        I[profiles.seg_count[n]] = k + 1
    plan_finish(F, I, n, end_u)
