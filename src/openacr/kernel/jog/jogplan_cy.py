"""Planning primitives of the jog profiler, shared by jogs and homing."""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import axis_scale, axis_sense
from openacr.kernel.profile.profile_cy import profile_plan, profile_reset, profile_stop
from openacr.kernel.profile.ramps_cy import DECELERATING, plain
from openacr.map.rows import axes, hand_wheels, profiles
from openacr.views import F32, F64, I32

JOG_PROFILE = 16  # profile of axis n is number 16 + n
FAR_CNT = 1e18  # end of a jog without target


def jog_setting(S: F32, n: int, place: int) -> float:
    """A jog setting of axis n in pulses and seconds; negative values and NaN count as 0."""
    return plain(S[place] * fabs(axis_scale(S, n)))


def jog_speed(F: F64, I: I32, S: F32, n: int) -> float:
    """Speed of jogs of axis n [pulses/s]: HDW VEL while the hand wheel has one, else JOG VEL."""
    own_ups: float = F[hand_wheels.vel_ups[n]]
    if I[hand_wheels.on[n]] and own_ups > 0.0:
        return own_ups * fabs(axis_scale(S, n))
    return jog_setting(S, n, axes.jog_veloc_setting[n])


def jog_rate(F: F64, I: I32, S: F32, n: int, place: int) -> float:
    """Ramp of jogs of axis n [pulses/s2]: HDW ACC while the hand wheel has one, else at `place`."""
    own_ups2: float = F[hand_wheels.acc_ups2[n]]
    if I[hand_wheels.on[n]] and own_ups2 > 0.0:
        return own_ups2 * fabs(axis_scale(S, n))
    return jog_setting(S, n, place)


def jog_mirror(F: F64, I: I32, n: int, sign: int) -> None:
    """Let the profile of axis n count in direction `sign` from the present jog offset."""
    flip: float = 1.0 if sign == I[axes.jog_sign[n]] else -1.0
    velocity_cps: float = F[profiles.velocity[JOG_PROFILE + n]] * flip
    accel_cps2: float = F[profiles.accel[JOG_PROFILE + n]] * flip
    I[axes.jog_sign[n]] = sign
    F[axes.jog_origin_cnt[n]] = F[axes.jog_cnt[n]]
    profile_reset(F, I, JOG_PROFILE + n, velocity_cps, accel_cps2)


def jog_run(
    F: F64, I: I32, S: F32, n: int, sign: int, distance_cnt: float, speed_cps: float
) -> bool:
    """Plan a jog `distance_cnt` pulses on in direction `sign`; False if it must turn round first.

    In that case the plan is the ramp to rest.
    """
    dec_cps2: float = jog_rate(F, I, S, n, axes.jog_decel_setting[n])
    jerk_cps3: float = jog_setting(S, n, axes.jog_jerk_setting[n])
    moving: int = sign
    if F[profiles.velocity[JOG_PROFILE + n]] != 0.0:
        moving = I[axes.jog_sign[n]]
    jog_mirror(F, I, n, moving)
    if F[profiles.velocity[JOG_PROFILE + n]] != 0.0:
        profile_stop(F, I, JOG_PROFILE + n, FAR_CNT, dec_cps2, jerk_cps3, DECELERATING)
        if (
            moving != sign
            or F[profiles.plan_distance[JOG_PROFILE + n]] > distance_cnt * (1.0 + 1e-12) + 1e-9
        ):
            F[profiles.target_velocity[JOG_PROFILE + n]] = speed_cps
            return False
    acc_cps2: float = jog_rate(F, I, S, n, axes.jog_accel_setting[n])
    profile_plan(
        F, I, JOG_PROFILE + n, distance_cnt, speed_cps, 0.0, acc_cps2, dec_cps2, dec_cps2, jerk_cps3
    )
    return True


def jog_ramp_down(F: F64, I: I32, n: int, rate_cps2: float, jerk_cps3: float, kind: int) -> None:
    """Plan a ramp to rest at `rate_cps2` [pulses/s^2] from the present jog motion."""
    jog_mirror(F, I, n, I[axes.jog_sign[n]])
    profile_stop(F, I, JOG_PROFILE + n, FAR_CNT, rate_cps2, jerk_cps3, kind)


def jog_room(F: F64, S: F32, n: int, want: int) -> float:
    """Pulses from the present jog offset to the jog limit (JLM) in direction `want`."""
    limit_u: float = S[axes.plus_jog_limit[n]] if want > 0 else S[axes.minus_jog_limit[n]]
    distance_cnt: float = limit_u * axis_scale(S, n) - F[axes.jog_cnt[n]]
    return want * axis_sense(S, n) * distance_cnt
