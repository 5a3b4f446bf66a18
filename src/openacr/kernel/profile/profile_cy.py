"""One motion profile: segments of constant jerk along a path.

                 velocity
                    |      cruise = target_velocity
                    |     ________________
                    |    /                \
          velocity  |___/                  \\___ end velocity (FVEL)
                    |   ACC                STP
                    +------------------------------- distance
                  distance                  end_distance

A plan is a list of at most 16 segments. Segment k starts at seg_distance, seg_velocity,
seg_accel and runs for seg_time_s with constant jerk j, so that at time t within it

    s = s_k + v_k t + a_k t^2/2 + j t^3/6,   v = v_k + a_k t + j t^2/2,   a = a_k + j t.

The planner decides (profile_plan, profile_stop), the tick only evaluates
(profile_advance): positions come from the closed form of the segment, never from summing
increments, so the end is exact however many ticks a move takes.

Instances 0-15 are the masters, 16-31 the jog profilers. `_u`, `_ups`, `_ups2`, `_ups3` are here the
units of the path and those per second, squared and cubed: programming units for masters, pulses
for jogs.
"""

from openacr.kernel.profile.ramps_cy import (
    CRUISING,
    plain,
    plan_build,
    plan_finish,
    plan_ramp,
    plan_start,
    plan_truncate,
    rest_speed,
)
from openacr.kernel.profile.short_cy import plan_short, plan_short_jerk
from openacr.map.rows import profiles
from openacr.views import F64, I32

__all__ = ["profile_advance", "profile_plan", "profile_reset", "profile_stop"]
__inlined__ = ["profile_advance"]

FOREVER_S = 1e30  # a plan that waits at speed 0 for a new cruising speed
TIME_EPS_S = 1e-10  # far below a servo period, far above the rounding of a sum of them


def profile_reset(F: F64, I: I32, n: int, velocity_ups: float, accel_ups2: float) -> None:
    """Start profile n at distance 0 with the given speed and acceleration and no plan."""
    F[profiles.distance[n]] = 0.0
    F[profiles.velocity[n]] = velocity_ups
    F[profiles.accel[n]] = accel_ups2
    F[profiles.jerk[n]] = 0.0
    F[profiles.time_s[n]] = 0.0
    F[profiles.end_distance[n]] = 0.0
    F[profiles.end_velocity[n]] = velocity_ups
    I[profiles.seg_count[n]] = 0
    I[profiles.seg_index[n]] = 0
    I[profiles.kind[n]] = CRUISING


def profile_plan(
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
    """Plan from the present state to distance `end_u`, cruising at `cruise_ups`.

    ACC serves rises of speed, DEC falls to a lower cruising speed, STP the end ramp to
    `end_ups`. STP 0 means no end ramp: the profile arrives with the speed (and
    acceleration) it has. A rate of 0 is a velocity step. `cruise_ups` 0 slows to a stop and
    waits there.
    """
    F[profiles.target_velocity[n]] = cruise_ups
    cruise_ups = plain(cruise_ups)
    acc_ups2 = plain(acc_ups2)
    dec_ups2 = plain(dec_ups2)
    stp_ups2 = plain(stp_ups2)
    jerk_ups3 = plain(jerk_ups3)
    distance_u: float = end_u - F[profiles.distance[n]]
    plan_start(F, I, n, jerk_ups3)
    rest_ups: float = rest_speed(F[profiles.plan_velocity[n]], F[profiles.plan_accel[n]], jerk_ups3)
    # FVEL never speeds up: at or below it there is nothing to slow down for.
    if end_ups >= cruise_ups and end_ups >= rest_ups:
        stp_ups2 = 0.0
    if stp_ups2 <= 0.0:
        end_ups = cruise_ups
    used_u: float = plan_build(
        F, I, n, cruise_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, 0.0
    )
    if used_u <= distance_u:
        wait_s: float = (distance_u - used_u) / cruise_ups if cruise_ups > 0.0 else FOREVER_S
        plan_build(F, I, n, cruise_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3, wait_s)
        plan_finish(F, I, n, end_u)
    elif stp_ups2 <= 0.0:
        plan_truncate(F, I, n, end_u)
    elif jerk_ups3 > 0.0:
        plan_short_jerk(
            F, I, n, end_u, cruise_ups, end_ups, acc_ups2, dec_ups2, stp_ups2, jerk_ups3
        )
    else:
        plan_short(F, I, n, end_u, cruise_ups, end_ups, acc_ups2, dec_ups2, stp_ups2)


def profile_stop(
    F: F64, I: I32, n: int, end_u: float, rate_ups2: float, jerk_ups3: float, kind: int
) -> bool:
    """Plan a ramp to rest at `rate_ups2`, wherever that is; False if it would pass `end_u`.

    When False is returned the plan is cut at `end_u` and still moving there.
    """
    jerk_ups3 = plain(jerk_ups3)
    plan_start(F, I, n, jerk_ups3)
    plan_ramp(F, I, n, 0.0, plain(rate_ups2), jerk_ups3, kind)
    if F[profiles.plan_distance[n]] > end_u:
        plan_truncate(F, I, n, end_u)
        return False
    plan_finish(F, I, n, F[profiles.plan_distance[n]])
    return True


def profile_advance(F: F64, I: I32, n: int, dt_s: float) -> float:
    """Advance profile n by `dt_s` seconds; return the time left over at its end, else -1."""
    count: int = I[profiles.seg_count[n]]
    k: int = I[profiles.seg_index[n]]
    t_s: float = F[profiles.time_s[n]] + dt_s
    while k < count and t_s >= F[profiles.seg_time_s[n] + k] - TIME_EPS_S:
        t_s -= F[profiles.seg_time_s[n] + k]
        k += 1
    I[profiles.seg_index[n]] = k
    F[profiles.time_s[n]] = t_s
    if k >= count:
        F[profiles.distance[n]] = F[profiles.end_distance[n]]
        F[profiles.velocity[n]] = F[profiles.end_velocity[n]]
        F[profiles.accel[n]] = F[profiles.plan_accel[n]]
        F[profiles.jerk[n]] = 0.0
        I[profiles.kind[n]] = CRUISING
        return max(t_s, 0.0)
    jerk_ups3: float = F[profiles.seg_jerk[n] + k]
    accel_ups2: float = F[profiles.seg_accel[n] + k]
    velocity_ups: float = F[profiles.seg_velocity[n] + k]
    F[profiles.jerk[n]] = jerk_ups3
    F[profiles.accel[n]] = accel_ups2 + t_s * jerk_ups3
    F[profiles.velocity[n]] = velocity_ups + t_s * (accel_ups2 + t_s * jerk_ups3 / 2.0)
    distance_u: float = F[profiles.seg_distance[n] + k] + t_s * (
        velocity_ups + t_s * (accel_ups2 / 2.0 + t_s * jerk_ups3 / 6.0)
    )
    # Just before the end the sum may be beyond it in its last bit.
    F[profiles.distance[n]] = min(distance_u, F[profiles.end_distance[n]])
    I[profiles.kind[n]] = I[profiles.seg_kind[n] + k]
    return -1.0
