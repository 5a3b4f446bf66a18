"""Planning primitives of the jog profiler, shared by jogs and homing."""

from openacr.cmath import fabs
from openacr.kernel.axis_cy import axis_scale
from openacr.kernel.profile_cy import (
    DECELERATING,
    plain,
    profile_plan,
    profile_reset,
    profile_stop,
)
from openacr.map.numbers import (
    AX_BASE,
    AX_JOG_ACCEL_SETTING,
    AX_JOG_DECEL_SETTING,
    AX_JOG_JERK_SETTING,
    AX_JOG_VELOC_SETTING,
    AX_STRIDE,
    AXF_BASE,
    AXF_JOG_CNT,
    AXF_JOG_ORIGIN_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_JOG_SIGN,
    AXI_STRIDE,
    HWF_ACC_UPS2,
    HWF_BASE,
    HWF_STRIDE,
    HWF_VEL_UPS,
    HWI_BASE,
    HWI_ON,
    HWI_STRIDE,
    PRF_ACCEL,
    PRF_BASE,
    PRF_PLAN_DISTANCE,
    PRF_STRIDE,
    PRF_TARGET_VELOCITY,
    PRF_VELOCITY,
)
from openacr.views import F32, F64, I32

JOG_PROFILE = 16  # profile of axis n is number 16 + n
FAR_CNT = 1e18  # end of a jog without target


def jog_setting(S: F32, n: int, row: int) -> float:
    """A jog setting of axis n in pulses and seconds; negative values and NaN count as 0."""
    return plain(S[AX_BASE + n * AX_STRIDE + row] * fabs(axis_scale(S, n)))


def jog_speed(F: F64, I: I32, S: F32, n: int) -> float:
    """Speed of jogs of axis n [pulses/s]: HDW VEL while the hand wheel has one, else JOG VEL."""
    own: float = F[HWF_BASE + n * HWF_STRIDE + HWF_VEL_UPS]
    if I[HWI_BASE + n * HWI_STRIDE + HWI_ON] and own > 0.0:
        return own * fabs(axis_scale(S, n))
    return jog_setting(S, n, AX_JOG_VELOC_SETTING)


def jog_rate(F: F64, I: I32, S: F32, n: int, row: int) -> float:
    """Ramp of jogs of axis n [pulses/s2]: HDW ACC while the hand wheel has one, else `row`."""
    own: float = F[HWF_BASE + n * HWF_STRIDE + HWF_ACC_UPS2]
    if I[HWI_BASE + n * HWI_STRIDE + HWI_ON] and own > 0.0:
        return own * fabs(axis_scale(S, n))
    return jog_setting(S, n, row)


def jog_mirror(F: F64, I: I32, n: int, sign: int) -> None:
    """Let the profile of axis n count in direction `sign` from the present jog offset."""
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    f: int = PRF_BASE + (JOG_PROFILE + n) * PRF_STRIDE
    flip: float = 1.0 if sign == I[i + AXI_JOG_SIGN] else -1.0
    velocity: float = F[f + PRF_VELOCITY] * flip
    accel: float = F[f + PRF_ACCEL] * flip
    I[i + AXI_JOG_SIGN] = sign
    F[a + AXF_JOG_ORIGIN_CNT] = F[a + AXF_JOG_CNT]
    profile_reset(F, I, JOG_PROFILE + n, velocity, accel)


def jog_run(F: F64, I: I32, S: F32, n: int, sign: int, distance: float, speed: float) -> bool:
    """Plan a jog `distance` pulses on in direction `sign`; False if it must turn round first.

    In that case the plan is the ramp to rest.
    """
    i: int = AXI_BASE + n * AXI_STRIDE
    f: int = PRF_BASE + (JOG_PROFILE + n) * PRF_STRIDE
    dec: float = jog_rate(F, I, S, n, AX_JOG_DECEL_SETTING)
    jerk: float = jog_setting(S, n, AX_JOG_JERK_SETTING)
    moving: int = sign
    if F[f + PRF_VELOCITY] != 0.0:
        moving = I[i + AXI_JOG_SIGN]
    jog_mirror(F, I, n, moving)
    if F[f + PRF_VELOCITY] != 0.0:
        profile_stop(F, I, JOG_PROFILE + n, FAR_CNT, dec, jerk, DECELERATING)
        if moving != sign or F[f + PRF_PLAN_DISTANCE] > distance * (1.0 + 1e-12) + 1e-9:
            F[f + PRF_TARGET_VELOCITY] = speed
            return False
    acc: float = jog_rate(F, I, S, n, AX_JOG_ACCEL_SETTING)
    profile_plan(F, I, JOG_PROFILE + n, distance, speed, 0.0, acc, dec, dec, jerk)
    return True


def jog_ramp_down(F: F64, I: I32, n: int, rate: float, jerk: float, kind: int) -> None:
    """Plan a ramp to rest at `rate` [pulses/s^2] from the present jog motion."""
    jog_mirror(F, I, n, I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_SIGN])
    profile_stop(F, I, JOG_PROFILE + n, FAR_CNT, rate, jerk, kind)
