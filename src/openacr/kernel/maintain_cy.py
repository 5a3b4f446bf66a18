"""Position maintenance (PM) of stepper axes with an encoder.

When the axis is not commanded to move and its encoder has been off the setpoint by more
than the dead band for a time, the missing steps are put out on top of the setpoint, with
ramps of their own. The setpoint and its parts know nothing of it.
"""

from openacr.cmath import fabs
from openacr.kernel.axis_cy import axis_scale, axis_word
from openacr.kernel.profile_cy import profile_advance, profile_plan, profile_reset
from openacr.map.numbers import (
    AF1_JOG_ACTIVE,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_JOG_ACCEL_SETTING,
    AX_JOG_VELOC_SETTING,
    AX_STRIDE,
    AXF_BASE,
    AXF_PM_ACC_UPS2,
    AXF_PM_BAND_U,
    AXF_PM_CNT,
    AXF_PM_FROM_CNT,
    AXF_PM_OFF_S,
    AXF_PM_TIME_S,
    AXF_PM_VEL_UPS,
    AXF_SSP_CNT,
    AXF_SSP_VELOCITY_CPS,
    AXF_STRIDE,
    AXI_BASE,
    AXI_MASTER,
    AXI_PM_SIGN,
    AXI_POSITION_SOURCE,
    AXI_STRIDE,
    MF1_IN_MOTION,
    MF1_WORD,
    MF1_WORD_HIGH,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
)
from openacr.views import F32, F64, I32

PROFILE = 32  # of axis 0
FROM_ENCODER = 0
JUST = 1e-9  # of the time: rounding of the sum of periods


def maintain_rests(F: F64, I: I32, n: int) -> bool:
    """Whether axis n is free of every commanded motion."""
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if m >= 0 and I[MF1_WORD + m if m < 8 else MF1_WORD_HIGH + m] & MF1_IN_MOTION:
        return False
    if I[axis_word(n)] & AF1_JOG_ACTIVE or F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_VELOCITY_CPS]:
        return False
    return I[AXI_BASE + n * AXI_STRIDE + AXI_POSITION_SOURCE] == FROM_ENCODER


def maintain_step(F: F64, I: I32, S: F32, n: int, period_s: float) -> None:
    """Correct the steps of axis n, or look whether that is needed."""
    a: int = AXF_BASE + n * AXF_STRIDE
    sign: int = I[AXI_BASE + n * AXI_STRIDE + AXI_PM_SIGN]
    if I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST:
        I[AXI_BASE + n * AXI_STRIDE + AXI_PM_SIGN] = 0
        F[a + AXF_PM_OFF_S] = 0.0
    elif sign:
        ended: bool = profile_advance(F, I, PROFILE + n, period_s) >= 0.0
        gone: float = F[PRF_BASE + (PROFILE + n) * PRF_STRIDE + PRF_DISTANCE]
        F[a + AXF_PM_CNT] = F[a + AXF_PM_FROM_CNT] + sign * gone
        if ended:
            I[AXI_BASE + n * AXI_STRIDE + AXI_PM_SIGN] = 0
            F[a + AXF_PM_OFF_S] = 0.0
    else:
        maintain_watch(F, I, S, n, period_s)


def maintain_watch(F: F64, I: I32, S: F32, n: int, period_s: float) -> None:
    """Begin a correction once the axis has been off for long enough."""
    a: int = AXF_BASE + n * AXF_STRIDE
    error: float = F[a + AXF_SSP_CNT] - I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION]
    band: float = F[a + AXF_PM_BAND_U] * fabs(axis_scale(S, n))
    if fabs(error) <= band or not maintain_rests(F, I, n):
        F[a + AXF_PM_OFF_S] = 0.0
        return
    F[a + AXF_PM_OFF_S] += period_s
    if F[a + AXF_PM_OFF_S] >= F[a + AXF_PM_TIME_S] * (1.0 - JUST):
        maintain_begin(F, I, S, n, error)


def maintain_begin(F: F64, I: I32, S: F32, n: int, error: float) -> None:
    """Plan the correction of an error in pulses; without a speed there is none."""
    a: int = AXF_BASE + n * AXF_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    scale: float = fabs(axis_scale(S, n))
    speed: float = F[a + AXF_PM_VEL_UPS]
    if speed <= 0.0:
        speed = S[p + AX_JOG_VELOC_SETTING]
    rate: float = F[a + AXF_PM_ACC_UPS2]
    if rate <= 0.0:
        rate = S[p + AX_JOG_ACCEL_SETTING]
    if not speed > 0.0:
        return
    speed = speed * scale
    rate = rate * scale
    I[AXI_BASE + n * AXI_STRIDE + AXI_PM_SIGN] = 1 if error > 0.0 else -1
    F[a + AXF_PM_FROM_CNT] = F[a + AXF_PM_CNT]
    profile_reset(F, I, PROFILE + n, 0.0, 0.0)
    profile_plan(F, I, PROFILE + n, fabs(error), speed, 0.0, rate, rate, rate, 0.0)
