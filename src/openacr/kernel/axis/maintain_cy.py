"""Position maintenance (PM) of stepper axes with an encoder.

When the axis is not commanded to move and its encoder has been off the setpoint by more
than the dead band for a time, the missing steps are put out on top of the setpoint, with
ramps of their own. The setpoint and its parts know nothing of it.
"""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import axis_scale
from openacr.kernel.profile.profile_cy import profile_advance, profile_plan, profile_reset
from openacr.map.rows import axes, profiles
from openacr.map.words import af1, af4, mf1
from openacr.views import F32, F64, I32

PROFILE = 32  # of axis 0
FROM_ENCODER = 0
JUST = 1e-9  # of the time: rounding of the sum of periods


def maintain_rests(F: F64, I: I32, n: int) -> bool:
    """Whether axis n is free of every commanded motion."""
    m: int = I[axes.master[n]]
    if m >= 0 and I[mf1.word[m]] & mf1.IN_MOTION:
        return False
    if I[af1.word[n]] & af1.JOG_ACTIVE or F[axes.ssp_velocity_cps[n]]:
        return False
    return I[axes.position_source[n]] == FROM_ENCODER


def maintain_step(F: F64, I: I32, S: F32, n: int, period_s: float) -> None:
    """Correct the steps of axis n, or look whether that is needed."""
    sign: int = I[axes.pm_sign[n]]
    if I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST:
        I[axes.pm_sign[n]] = 0
        F[axes.pm_off_s[n]] = 0.0
    elif sign:
        ended: bool = profile_advance(F, I, PROFILE + n, period_s) >= 0.0
        gone_cnt: float = F[profiles.distance[PROFILE + n]]
        F[axes.pm_cnt[n]] = F[axes.pm_from_cnt[n]] + sign * gone_cnt
        if ended:
            I[axes.pm_sign[n]] = 0
            F[axes.pm_off_s[n]] = 0.0
    else:
        maintain_watch(F, I, S, n, period_s)


def maintain_watch(F: F64, I: I32, S: F32, n: int, period_s: float) -> None:
    """Begin a correction once the axis has been off for long enough."""
    error_cnt: float = F[axes.ssp_cnt[n]] - I[axes.actual_position[n]]
    band_cnt: float = F[axes.pm_band_u[n]] * fabs(axis_scale(S, n))
    if fabs(error_cnt) <= band_cnt or not maintain_rests(F, I, n):
        F[axes.pm_off_s[n]] = 0.0
        return
    F[axes.pm_off_s[n]] += period_s
    if F[axes.pm_off_s[n]] >= F[axes.pm_time_s[n]] * (1.0 - JUST):
        maintain_begin(F, I, S, n, error_cnt)


def maintain_begin(F: F64, I: I32, S: F32, n: int, error_cnt: float) -> None:
    """Plan the correction of an error in pulses; without a speed there is none."""
    scale: float = fabs(axis_scale(S, n))
    speed_ups: float = F[axes.pm_vel_ups[n]]
    if speed_ups <= 0.0:
        speed_ups = S[axes.jog_veloc_setting[n]]
    rate_ups2: float = F[axes.pm_acc_ups2[n]]
    if rate_ups2 <= 0.0:
        rate_ups2 = S[axes.jog_accel_setting[n]]
    if not speed_ups > 0.0:
        return
    speed_ups = speed_ups * scale
    rate_ups2 = rate_ups2 * scale
    I[axes.pm_sign[n]] = 1 if error_cnt > 0.0 else -1
    F[axes.pm_from_cnt[n]] = F[axes.pm_cnt[n]]
    profile_reset(F, I, PROFILE + n, 0.0, 0.0)
    profile_plan(
        F, I, PROFILE + n, fabs(error_cnt), speed_ups, 0.0, rate_ups2, rate_ups2, rate_ups2, 0.0
    )
