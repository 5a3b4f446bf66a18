"""The servo loop of an axis and its output stage.

    e   = secondary setpoint - actual position                       [pulses]
    sum = P + I + D + FFVEL term + FFACC term - FBVEL term           [volts]
    out = torque limit( filters( sum ) )

P = PGAIN e;  I integrates IGAIN e, held for IDELAY after commanded motion and clamped to
ILIMIT;  D = DGAIN (e - e')/W with e' sampled every W = DWIDTH (at least one tick);
feed-forward from the differences of the secondary setpoint; velocity feedback from the
encoder of the third ATTACH AXIS argument. With KVP > 0 a velocity loop takes the place of
the PID sum:  vr = PGAIN e + KVF v_cmd,  ve = vr - FBVEL v_fb,  sum = KVP ve + KVI int(ve).

The output goes to a converter, to a commutator or, as the setpoint, to a stepper output.
"""

from openacr.cmath import fabs, rint
from openacr.kernel.axis.commutator_cy import commutator_step, dac_put
from openacr.kernel.axis.drive_cy import drive_driven
from openacr.kernel.axis.feedback_cy import ENCODER_COUNT, FROM_ENCODER
from openacr.kernel.axis.maintain_cy import maintain_step
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.rows import (
    axes,
    commutators,
    encoders,
    followers,
    kernel,
    stepper_outputs,
    steppers,
)
from openacr.map.words import af1, af3
from openacr.views import F32, F64, I32

__all__ = ["servo_step"]
__inlined__ = ["biquad", "servo_step"]

TO_DAC = 0
TO_STEPPER = 1
OWN_STEPS = 2  # as position feedback
TO_COMMUTATOR = 2
# Coefficients of a biquad filter, from the first on.
B2 = 0
A2 = 1
B1 = 2
A1 = 3
A0 = 4
CUTOFF_SLACK_CPS = 0.001  # differences of large positions are that far from a constant speed
LARGEST = 1.7976931348623157e308  # number of 64 bits
TINY = 1e-30  # filter states below this are 0: denormal numbers are very slow


def feedback_velocity(F: F64, I: I32, S: F32, n: int) -> float:
    """Velocity feedback of axis n [pulses/s], averaged over Smooth Encoder Velocity samples."""
    k: int = I[axes.velocity_index[n]]
    if I[axes.velocity_source[n]] != FROM_ENCODER or not 0 <= k < ENCODER_COUNT:
        return 0.0
    samples: float = S[axes.smooth_encoder_velocity[n]]
    size: int = 1
    if samples >= 2.0:
        size = int(min(samples, 64.0))
    if size == 1:
        return I[encoders.encoder_velocity[k]]
    now_cps: float = I[encoders.encoder_velocity[k]]
    index: int = I[axes.window_index[n]]
    if size != I[axes.window_count[n]]:
        I[axes.window_count[n]] = size
        index = 0
        for j in range(size):
            F[axes.velocity_window_cnt[n] + j] = now_cps
        F[axes.velocity_sum_cnt[n]] = now_cps * size
    F[axes.velocity_sum_cnt[n]] += now_cps - F[axes.velocity_window_cnt[n] + index]
    F[axes.velocity_window_cnt[n] + index] = now_cps
    index += 1
    I[axes.window_index[n]] = 0 if index >= size else index
    return F[axes.velocity_sum_cnt[n]] / size


def dead_band(F: F64, I: I32, S: F32, n: int, error_cnt: float) -> bool:
    """Dead zone of axis n: enter below DZL at rest, leave above DZU."""
    word: int = af3.word[n]
    if I[axes.dzu[n]] <= 0:
        I[word] &= ~af3.IN_DEAD_BAND
        return False
    if I[word] & af3.IN_DEAD_BAND:
        if fabs(error_cnt) > I[axes.dzu[n]]:
            I[word] &= ~af3.IN_DEAD_BAND
            F[axes.integral_v[n]] = S[axes.dip[n]] if error_cnt > 0.0 else S[axes.din[n]]
    elif fabs(error_cnt) < I[axes.dzl[n]] and F[axes.ssp_velocity_cps[n]] == 0.0:
        I[word] |= af3.IN_DEAD_BAND
    return I[word] & af3.IN_DEAD_BAND != 0


def idle_step(F: F64, n: int, period_s: float) -> None:
    """How long axis n has had no commanded motion."""
    if F[axes.ssp_velocity_cps[n]] != 0.0:
        F[axes.idle_s[n]] = 0.0
    else:
        F[axes.idle_s[n]] += period_s


def idle_enough(F: F64, S: F32, n: int) -> bool:
    """Whether IDELAY has passed since the latest commanded motion."""
    delay_s: float = S[axes.integral_delay[n]]
    return delay_s <= 0.0 or F[axes.idle_s[n]] >= delay_s


def integrate(F: F64, S: F32, n: int, value: float, rate: float, period_s: float) -> float:
    """Integral of `rate * value`, held for IDELAY after motion, clamped to ILIMIT [V]."""
    limit_v: float = S[axes.integral_limit[n]]
    total_v: float = F[axes.integral_v[n]]
    if idle_enough(F, S, n):
        total_v += rate * value * period_s
    return integral_keep(F, n, max(-limit_v, min(limit_v, total_v)))


def integral_keep(F: F64, n: int, total_v: float) -> float:
    """Store the integral; what is no number must not stay in it."""
    if total_v - total_v != 0.0:
        total_v = 0.0
    F[axes.integral_v[n]] = total_v
    return total_v


def derivative(F: F64, I: I32, S: F32, n: int, error_cnt: float, rate_hz: float) -> float:
    """Derivative term [V], sampled every DWIDTH."""
    ticks: int = 1
    if S[axes.derivative_width[n]] > 0.0:
        ticks = int(rint(max(1.0, min(S[axes.derivative_width[n]] * rate_hz, 1e6))))
    counted: int = I[axes.derivative_ticks[n]] + 1
    I[axes.derivative_ticks[n]] = 0 if counted >= ticks else counted
    if counted >= ticks:
        slope_cps: float = (error_cnt - F[axes.error_old_cnt[n]]) * rate_hz
        if ticks > 1:
            slope_cps = slope_cps / ticks
        F[axes.error_old_cnt[n]] = error_cnt
        F[axes.derivative_v[n]] = derivative_smoothed(F, I, n, slope_cps)
    return S[axes.derivative_gain[n]] * F[axes.derivative_v[n]]


def derivative_smoothed(F: F64, I: I32, n: int, slope_cps: float) -> float:
    """Average over the last 2^n slopes (DGain Smooth, as activated by DGAIN)."""
    size: int = I[axes.derivative_smooth[n]]
    if size <= 1:
        return slope_cps
    index: int = I[axes.derivative_index[n]]
    F[axes.derivative_sum[n]] += slope_cps - F[axes.derivative_history[n] + index]
    F[axes.derivative_history[n] + index] = slope_cps
    index += 1
    I[axes.derivative_index[n]] = 0 if index >= size else index
    return F[axes.derivative_sum[n]] / size


def biquad(F: F64, S: F32, state: int, first: int, x: float) -> float:
    """Y = a0 x + a1 x1 + a2 x2 - b1 y1 - b2 y2, in transposed form (two states).

    `first` is the place of the first of its five coefficients.
    """
    y: float = S[first + A0] * x + F[state]
    s1: float = S[first + A1] * x - S[first + B1] * y + F[state + 1]
    s2: float = S[first + A2] * x - S[first + B2] * y
    F[state] = s1 if fabs(s1) > TINY else 0.0
    F[state + 1] = s2 if fabs(s2) > TINY else 0.0
    return y


def servo_sum(
    F: F64, I: I32, S: F32, n: int, error_cnt: float, period_s: float, rate_hz: float
) -> float:
    """The summation point of axis n [V]; the terms are shown in their parameters."""
    command_cps: float = F[axes.ssp_velocity_cps[n]]
    banded: bool = dead_band(F, I, S, n, error_cnt)
    used_cnt: float = 0.0 if banded else error_cnt
    feed_v: float = S[axes.feedforward_velocity[n]] * command_cps
    if fabs(command_cps) < I[axes.ffvc[n]] - CUTOFF_SLACK_CPS:
        feed_v = 0.0
    surge_v: float = S[axes.feedforward_accel[n]] * F[axes.ssp_accel_cps2[n]]
    tacho: float = 0.0
    if S[axes.fbvel_gain_setting[n]] != 0.0:
        tacho = S[axes.fbvel_gain_setting[n]] * feedback_velocity(F, I, S, n)
    proportional_v: float = S[axes.proportional_gain[n]] * used_cnt
    slope_cps: float = derivative(F, I, S, n, used_cnt, rate_hz)
    integral_v: float = F[axes.integral_v[n]]
    total_v: float = 0.0
    if S[axes.kvp[n]] > 0.0:
        wanted: float = proportional_v + S[axes.kvf[n]] * command_cps - tacho
        if not banded:
            integral_v = velocity_integral(F, S, n, wanted, period_s)
        total_v = S[axes.kvp[n]] * wanted + integral_v + surge_v
    else:
        if not banded:
            integral_v = integrate(F, S, n, error_cnt, S[axes.integral_gain[n]], period_s)
        total_v = proportional_v + integral_v + slope_cps + feed_v + surge_v - tacho
    total_v += F[followers.lock_v[n]]
    S[axes.proportional_term[n]] = proportional_v
    S[axes.integral_term[n]] = integral_v
    S[axes.derivative_term[n]] = slope_cps
    S[axes.ffvel_term[n]] = feed_v
    S[axes.ffacc_term[n]] = surge_v
    S[axes.fbvel_term[n]] = tacho
    return total_v


def velocity_integral(F: F64, S: F32, n: int, value: float, period_s: float) -> float:
    """Integral of the velocity loop; ILIMIT clamps it only where it is set."""
    if S[axes.integral_limit[n]] > 0.0:
        return integrate(F, S, n, value, S[axes.kvi[n]], period_s)
    total_v: float = F[axes.integral_v[n]]
    return integral_keep(F, n, total_v + S[axes.kvi[n]] * value * period_s)


def servo_closed(I: I32, n: int) -> bool:
    """Whether the loop of axis n produces an output: axis on, loop closed, drive enabled."""
    if not I[axes.on[n]]:
        return False
    if I[af1.word[n]] & (af1.OPEN_SERVO_LOOP | af1.CLAMP_OUTPUT_SIGNAL):
        return False
    return drive_driven(I, n)


def servo_counts(I: I32, n: int) -> bool:
    """Whether axis n has a servo loop, whose times run on at rest, too."""
    return I[axes.on[n]] != 0 and I[axes.signal_source[n]] != TO_STEPPER


def servo_step(F: F64, I: I32, S: F32, n: int, period_s: float, rate_hz: float) -> None:
    """One pass of the servo loop of axis n."""
    if I[axes.signal_source[n]] == TO_STEPPER:
        stepper_step(F, I, S, n, period_s)
        return
    error_cnt: float = F[axes.ssp_cnt[n]] - I[axes.actual_position[n]]
    I[axes.following_error[n]] = round32(error_cnt)
    F[axes.peak_error_cnt[n]] = max(F[axes.peak_error_cnt[n]], fabs(error_cnt))
    idle_step(F, n, period_s)
    output_v: float = 0.0
    clipped: int = 0
    if servo_closed(I, n):
        total_v: float = servo_sum(F, I, S, n, error_cnt, period_s, rate_hz)
        S[axes.summation_point[n]] = total_v
        if I[af1.word[n]] & af1.BIQUAD_FILTER_ACTIVATE:
            total_v = biquad(F, S, axes.filter_state[n], axes.filter0_b2[n], total_v)
            total_v = biquad(F, S, axes.filter_state[n] + 2, axes.filter1_b2[n], total_v)
        S[axes.filter_output_signal[n]] = total_v
        output_v = min(total_v, S[axes.plus_torque_limit[n]])
        output_v = max(output_v, S[axes.minus_torque_limit[n]])
        clipped = 1 if output_v != total_v else 0
        if not fabs(output_v) <= LARGEST:  # a gain or limit that is no number
            output_v = 0.0
    else:
        F[axes.error_old_cnt[n]] = error_cnt
    I[axes.clipped[n]] = clipped
    S[axes.output_signal[n]] = output_v
    k: int = I[axes.signal_index[n]]
    if I[axes.signal_source[n]] == TO_DAC:
        dac_put(S, k, output_v)
    elif I[axes.signal_source[n]] == TO_COMMUTATOR and 0 <= k < commutators.COUNT:
        commutator_step(I, S, n, k, output_v)


def pulses_put(F: F64, I: I32, n: int, k: int, count: int) -> None:
    """Add what axis n sends to stepper output k: the travel of its setpoint, without jumps.

    Registers that are set (RES, homing) change the count of an axis that has its own pulses as
    feedback, so the difference to its new count is motion. With an encoder as feedback the count
    jumps with the setpoint: there the motion itself is summed up.
    """
    if I[axes.position_source[n]] == OWN_STEPS and I[axes.position_index[n]] == k:
        F[stepper_outputs.sent_cnt[k]] = F[stepper_outputs.pulses[k]]
        F[stepper_outputs.sent_cnt[k]] += wrap32(count - I[steppers.stepper_count[k]])
    else:
        F[stepper_outputs.sent_cnt[k]] += F[axes.ssp_cnt[n]] - F[axes.ssp_old_cnt[n]]
        F[stepper_outputs.sent_cnt[k]] += F[axes.pm_cnt[n]] - F[stepper_outputs.pm_old_cnt[k]]
    F[stepper_outputs.pm_old_cnt[k]] = F[axes.pm_cnt[n]]
    F[stepper_outputs.pulses[k]] = rint(F[stepper_outputs.sent_cnt[k]])


def stepper_idle(F: F64, S: F32, n: int, k: int) -> None:
    """Send nothing to stepper output k while the drive of axis n is disabled."""
    if 0 <= k < 16:
        F[stepper_outputs.pm_old_cnt[k]] = F[axes.pm_cnt[n]]
        S[steppers.stepper_signal[k]] = 0.0


def stepper_step(F: F64, I: I32, S: F32, n: int, period_s: float) -> None:
    """A stepper axis puts out its setpoint as steps; its own count is its feedback."""
    k: int = I[axes.signal_index[n]]
    if not drive_driven(I, n):
        stepper_idle(F, S, n, k)
    elif 0 <= k < 16 and not I[kernel.missing_steppers] >> k & 1:
        if I[axes.pm_on[n]]:
            maintain_step(F, I, S, n, period_s)
        setpoint_cnt: float = F[axes.ssp_cnt[n]]
        setpoint_cnt += F[axes.pm_cnt[n]]
        pulses_put(F, I, n, k, round32(setpoint_cnt))
        I[steppers.stepper_count[k]] = round32(setpoint_cnt)
        S[steppers.stepper_signal[k]] = F[axes.ssp_velocity_cps[n]]
        if I[axes.position_source[n]] == OWN_STEPS and I[axes.position_index[n]] == k:
            I[axes.actual_position[n]] = I[steppers.stepper_count[k]]
    I[axes.following_error[n]] = round32(F[axes.ssp_cnt[n]] - I[axes.actual_position[n]])
