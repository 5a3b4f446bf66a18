"""Profiles of moves too short for their cruising speed (profile_cy.py).

A move too short for its cruising speed gets a lower peak, found in closed form without
jerk and by bisection with it; one that is braking already may need a softer end ramp
instead. Only if even the end ramp itself, begun at once, does not fit, its rate is raised
just enough: the target is never overshot. Distances run forwards only; the owner mirrors a
backward motion.
"""

from openacr.cmath import fabs, sqrt
from openacr.kernel.profile.ramps_cy import (
    BISECTIONS,
    STOPPING,
    plan_append,
    plan_build,
    plan_finish,
    plan_ramp,
    plan_start,
    plan_truncate,
    rest_speed,
)
from openacr.map.rows import profiles
from openacr.views import F64, I32

SLACK = 1e-12  # of a length: what sums of its parts may miss by rounding


def plan_short(
    F: F64,
    I: I32,
    n: int,
    end_u: float,
    cruise_ups: float,
    end_ups: float,
    acc_ups2: float,
    dec_ups2: float,
    stp_ups2: float,
) -> None:
    """Plan a move too short for its cruising speed, without jerk limit.

    Two ramps that meet at the peak p cover the distance d:
    (p^2 - v^2)/(2r) + (p^2 - e^2)/(2 stp) = d with r = ACC on a rise (v <= p) and
    r = -DEC on a fall, which is linear in p^2.
    """
    velocity_ups: float = F[profiles.velocity[n]]
    distance_u: float = end_u - F[profiles.distance[n]]
    peak_ups: float = 0.0
    if velocity_ups <= cruise_ups:
        peak_ups = short_peak(velocity_ups, end_ups, distance_u, acc_ups2, stp_ups2)
        if peak_ups <= end_ups:
            # Not even FVEL is reached: speed up to the end, no end ramp.
            plan_build(F, I, n, cruise_ups, cruise_ups, acc_ups2, dec_ups2, stp_ups2, 0.0, 0.0)
            plan_truncate(F, I, n, end_u)
            return
        peak_ups = peak_ups if peak_ups >= velocity_ups else -1.0
    else:
        peak_ups = short_peak(velocity_ups, end_ups, distance_u, -dec_ups2, stp_ups2)
        peak_ups = peak_ups if end_ups <= peak_ups <= velocity_ups else -1.0
    if peak_ups >= 0.0:
        plan_build(F, I, n, peak_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, 0.0, 0.0)
        plan_finish(F, I, n, end_u)
    else:
        plan_forced(F, I, n, end_u, end_ups)


def short_peak(
    velocity_ups: float, end_ups: float, distance_u: float, rate_ups2: float, stp_ups2: float
) -> float:
    """Speed at which a ramp of `rate_ups2` and the end ramp meet; -1 if they do not."""
    inverse: float = 1.0 / stp_ups2
    twice_u: float = 2.0 * distance_u + end_ups * end_ups / stp_ups2
    if rate_ups2 != 0.0:
        inverse += 1.0 / rate_ups2
        twice_u += velocity_ups * velocity_ups / rate_ups2
    if inverse != 0.0 and twice_u / inverse > 0.0:
        return sqrt(twice_u / inverse)
    return -1.0


def plan_short_jerk(
    F: F64,
    I: I32,
    n: int,
    end_u: float,
    cruise_ups: float,
    end_ups: float,
    acc_ups2: float,
    dec_ups2: float,
    stp_ups2: float,
    jerk_ups3: float,
) -> None:
    """Plan a move too short for its cruising speed under a jerk limit.

    The distance of "ramp to p, end ramp" is monotonic in the peak p between the bounds
    tried, so bisection finds the p that covers exactly the distance. The last bracket end
    that still fits is used and the tiny remainder becomes cruising time.
    """
    distance_u: float = end_u - F[profiles.distance[n]]
    plan_start(F, I, n, jerk_ups3)
    rest_ups: float = rest_speed(F[profiles.plan_velocity[n]], F[profiles.plan_accel[n]], jerk_ups3)
    fits_ups: float = max(rest_ups, 0.0)
    if rest_ups <= end_ups:
        # Not even FVEL is reached: speed up to the end, no end ramp.
        fits_ups = end_ups
        if (
            plan_build(F, I, n, fits_ups, fits_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, 0.0)
            > distance_u
        ):
            plan_truncate(F, I, n, end_u)
            return
    elif rest_ups > cruise_ups and dec_ups2 > stp_ups2:
        fits_ups = end_ups
    fails_ups: float = cruise_ups
    if (
        plan_build(F, I, n, fits_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, 0.0)
        > distance_u
    ):
        plan_brake(F, I, n, end_u, end_ups, max(dec_ups2, stp_ups2), jerk_ups3)
        return
    for _ in range(BISECTIONS):
        peak_ups: float = (fits_ups + fails_ups) / 2.0
        if (
            plan_build(F, I, n, peak_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, 0.0)
            > distance_u
        ):
            fails_ups = peak_ups
        else:
            fits_ups = peak_ups
    used_u: float = plan_build(
        F, I, n, fits_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, 0.0
    )
    wait_s: float = (distance_u - used_u) / fits_ups if fits_ups > 0.0 else 0.0
    plan_build(F, I, n, fits_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, wait_s)
    plan_finish(F, I, n, end_u)


def plan_ramp_at_once(
    F: F64, I: I32, n: int, goal_ups: float, rate_ups2: float, jerk_ups3: float
) -> float:
    """Plan an end ramp that begins now; return the distance it takes."""
    plan_start(F, I, n, jerk_ups3)
    plan_ramp(F, I, n, goal_ups, rate_ups2, jerk_ups3, STOPPING)
    return F[profiles.plan_distance[n]] - F[profiles.distance[n]]


def plan_brake(
    F: F64, I: I32, n: int, end_u: float, end_ups: float, limit_ups2: float, jerk_ups3: float
) -> None:
    """Plan the end ramp from here, at the softest rate that still fits; else force it.

    A path that brakes already and has too little distance left to let go of the brake first
    keeps braking. The distance grows as the rate falls, so bisection finds the rate; it may be
    above STP, which is then too weak, but not above `limit_ups2`.
    """
    distance_u: float = end_u - F[profiles.distance[n]]
    if plan_ramp_at_once(F, I, n, end_ups, limit_ups2, jerk_ups3) > distance_u + SLACK * fabs(
        end_u
    ):
        plan_forced(F, I, n, end_u, end_ups)
        return
    fails_ups2: float = 0.0
    fits_ups2: float = limit_ups2
    for _ in range(BISECTIONS):
        rate_ups2: float = (fits_ups2 + fails_ups2) / 2.0
        if plan_ramp_at_once(F, I, n, end_ups, rate_ups2, jerk_ups3) > distance_u:
            fails_ups2 = rate_ups2
        else:
            fits_ups2 = rate_ups2
    plan_ramp_at_once(F, I, n, end_ups, fits_ups2, jerk_ups3)
    plan_finish(F, I, n, end_u)


def plan_forced(F: F64, I: I32, n: int, end_u: float, end_ups: float) -> None:
    """Brake at the one constant rate that still arrives with `end_ups` (or less)."""
    velocity_ups: float = F[profiles.velocity[n]]
    distance_u: float = end_u - F[profiles.distance[n]]
    plan_start(F, I, n, 0.0)
    if distance_u > 0.0 and velocity_ups > end_ups:
        # By time: exact even where the two speeds differ in their last bits only.
        time_s: float = 2.0 * distance_u / (velocity_ups + end_ups)
        plan_append(F, I, n, time_s, (end_ups - velocity_ups) / time_s, 0.0, STOPPING)
    elif distance_u > 0.0 and velocity_ups > 0.0:
        plan_append(F, I, n, distance_u / velocity_ups, 0.0, 0.0, STOPPING)
        end_ups = velocity_ups
    F[profiles.plan_velocity[n]] = end_ups
    F[profiles.plan_accel[n]] = 0.0
    plan_finish(F, I, n, end_u)
