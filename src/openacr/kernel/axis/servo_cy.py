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
    now: float = I[encoders.encoder_velocity[k]]
    index: int = I[axes.window_index[n]]
    if size != I[axes.window_count[n]]:
        I[axes.window_count[n]] = size
        index = 0
        for j in range(size):
            F[axes.velocity_window_cnt[n] + j] = now
        F[axes.velocity_sum_cnt[n]] = now * size
    F[axes.velocity_sum_cnt[n]] += now - F[axes.velocity_window_cnt[n] + index]
    F[axes.velocity_window_cnt[n] + index] = now
    index += 1
    I[axes.window_index[n]] = 0 if index >= size else index
    return F[axes.velocity_sum_cnt[n]] / size


def dead_band(F: F64, I: I32, S: F32, n: int, error: float) -> bool:
    """Dead zone of axis n: enter below DZL at rest, leave above DZU."""
    word: int = af3.word[n]
    if I[axes.dzu[n]] <= 0:
        I[word] &= ~af3.IN_DEAD_BAND
        return False
    if I[word] & af3.IN_DEAD_BAND:
        if fabs(error) > I[axes.dzu[n]]:
            I[word] &= ~af3.IN_DEAD_BAND
            F[axes.integral_v[n]] = S[axes.dip[n]] if error > 0.0 else S[axes.din[n]]
    elif fabs(error) < I[axes.dzl[n]] and F[axes.ssp_velocity_cps[n]] == 0.0:
        I[word] |= af3.IN_DEAD_BAND
    return I[word] & af3.IN_DEAD_BAND != 0


def integrate(F: F64, S: F32, n: int, value: float, rate: float, period_s: float) -> float:
    """Integral of `rate * value`, held for IDELAY after motion, clamped to ILIMIT [V]."""
    delay: float = S[axes.integral_delay[n]]
    limit: float = S[axes.integral_limit[n]]
    total: float = F[axes.integral_v[n]]
    if delay <= 0.0 or F[axes.idle_s[n]] >= delay:
        total += rate * value * period_s
    return integral_keep(F, n, max(-limit, min(limit, total)))


def integral_keep(F: F64, n: int, total: float) -> float:
    """Store the integral; what is no number must not stay in it."""
    if total - total != 0.0:
        total = 0.0
    F[axes.integral_v[n]] = total
    return total


def derivative(F: F64, I: I32, S: F32, n: int, error: float, rate_hz: float) -> float:
    """Derivative term [V], sampled every DWIDTH."""
    ticks: int = 1
    if S[axes.derivative_width[n]] > 0.0:
        ticks = int(rint(max(1.0, min(S[axes.derivative_width[n]] * rate_hz, 1e6))))
    I[axes.derivative_ticks[n]] += 1
    if I[axes.derivative_ticks[n]] >= ticks:
        I[axes.derivative_ticks[n]] = 0
        slope: float = (error - F[axes.error_old_cnt[n]]) * rate_hz
        if ticks > 1:
            slope = slope / ticks
        F[axes.error_old_cnt[n]] = error
        F[axes.derivative_v[n]] = derivative_smoothed(F, I, n, slope)
    return S[axes.derivative_gain[n]] * F[axes.derivative_v[n]]


def derivative_smoothed(F: F64, I: I32, n: int, slope: float) -> float:
    """Average over the last 2^n slopes (DGain Smooth, as activated by DGAIN)."""
    size: int = I[axes.derivative_smooth[n]]
    if size <= 1:
        return slope
    index: int = I[axes.derivative_index[n]]
    F[axes.derivative_sum[n]] += slope - F[axes.derivative_history[n] + index]
    F[axes.derivative_history[n] + index] = slope
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
    F: F64, I: I32, S: F32, n: int, error: float, period_s: float, rate_hz: float
) -> float:
    """The summation point of axis n [V]; the terms are shown in their parameters."""
    command: float = F[axes.ssp_velocity_cps[n]]
    banded: bool = dead_band(F, I, S, n, error)
    used: float = 0.0 if banded else error
    feed: float = S[axes.feedforward_velocity[n]] * command
    if fabs(command) < I[axes.ffvc[n]]:
        feed = 0.0
    surge: float = S[axes.feedforward_accel[n]] * F[axes.ssp_accel_cps2[n]]
    tacho: float = 0.0
    if S[axes.fbvel_gain_setting[n]] != 0.0:
        tacho = S[axes.fbvel_gain_setting[n]] * feedback_velocity(F, I, S, n)
    proportional: float = S[axes.proportional_gain[n]] * used
    slope: float = derivative(F, I, S, n, used, rate_hz)
    integral: float = F[axes.integral_v[n]]
    total: float = 0.0
    if S[axes.kvp[n]] > 0.0:
        wanted: float = proportional + S[axes.kvf[n]] * command - tacho
        if not banded:
            integral = velocity_integral(F, S, n, wanted, period_s)
        total = S[axes.kvp[n]] * wanted + integral + surge
    else:
        if not banded:
            integral = integrate(F, S, n, error, S[axes.integral_gain[n]], period_s)
        total = proportional + integral + slope + feed + surge - tacho
    total += F[followers.lock_v[n]]
    S[axes.proportional_term[n]] = proportional
    S[axes.integral_term[n]] = integral
    S[axes.derivative_term[n]] = slope
    S[axes.ffvel_term[n]] = feed
    S[axes.ffacc_term[n]] = surge
    S[axes.fbvel_term[n]] = tacho
    return total


def velocity_integral(F: F64, S: F32, n: int, value: float, period_s: float) -> float:
    """Integral of the velocity loop; ILIMIT clamps it only where it is set."""
    if S[axes.integral_limit[n]] > 0.0:
        return integrate(F, S, n, value, S[axes.kvi[n]], period_s)
    total: float = F[axes.integral_v[n]]
    return integral_keep(F, n, total + S[axes.kvi[n]] * value * period_s)


def servo_closed(I: I32, n: int) -> bool:
    """Whether the loop of axis n produces an output: axis on, loop closed, drive enabled."""
    if not I[axes.on[n]]:
        return False
    if I[af1.word[n]] & (af1.OPEN_SERVO_LOOP | af1.CLAMP_OUTPUT_SIGNAL):
        return False
    return drive_driven(I, n)


def servo_step(F: F64, I: I32, S: F32, n: int, period_s: float, rate_hz: float) -> None:
    """One pass of the servo loop of axis n."""
    if I[axes.signal_source[n]] == TO_STEPPER:
        stepper_step(F, I, S, n, period_s)
        return
    error: float = F[axes.ssp_cnt[n]] - I[axes.actual_position[n]]
    I[axes.following_error[n]] = round32(error)
    F[axes.peak_error_cnt[n]] = max(F[axes.peak_error_cnt[n]], fabs(error))
    if F[axes.ssp_velocity_cps[n]] != 0.0:
        F[axes.idle_s[n]] = 0.0
    else:
        F[axes.idle_s[n]] += period_s
    output: float = 0.0
    I[axes.clipped[n]] = 0
    if servo_closed(I, n):
        total: float = servo_sum(F, I, S, n, error, period_s, rate_hz)
        S[axes.summation_point[n]] = total
        if I[af1.word[n]] & af1.BIQUAD_FILTER_ACTIVATE:
            total = biquad(F, S, axes.filter_state[n], axes.filter0_b2[n], total)
            total = biquad(F, S, axes.filter_state[n] + 2, axes.filter1_b2[n], total)
        S[axes.filter_output_signal[n]] = total
        output = min(total, S[axes.plus_torque_limit[n]])
        output = max(output, S[axes.minus_torque_limit[n]])
        I[axes.clipped[n]] = 1 if output != total else 0
    else:
        F[axes.error_old_cnt[n]] = error
    if output - output != 0.0:  # a gain or limit that is no number
        output = 0.0
    S[axes.output_signal[n]] = output
    k: int = I[axes.signal_index[n]]
    if I[axes.signal_source[n]] == TO_DAC:
        dac_put(S, k, output)
    elif I[axes.signal_source[n]] == TO_COMMUTATOR and 0 <= k < commutators.COUNT:
        commutator_step(I, S, n, k, output)


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
        setpoint: float = F[axes.ssp_cnt[n]]
        setpoint += F[axes.pm_cnt[n]]
        pulses_put(F, I, n, k, round32(setpoint))
        I[steppers.stepper_count[k]] = round32(setpoint)
        S[steppers.stepper_signal[k]] = F[axes.ssp_velocity_cps[n]]
        if I[axes.position_source[n]] == OWN_STEPS and I[axes.position_index[n]] == k:
            I[axes.actual_position[n]] = I[steppers.stepper_count[k]]
    I[axes.following_error[n]] = round32(F[axes.ssp_cnt[n]] - I[axes.actual_position[n]])
