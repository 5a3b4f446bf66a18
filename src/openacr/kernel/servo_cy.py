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
from openacr.kernel.axis_cy import axis_word
from openacr.kernel.commutator_cy import commutator_step, dac_put
from openacr.kernel.drive_cy import drive_driven
from openacr.kernel.feedback_cy import ENCODER_COUNT, FROM_ENCODER, encoder_row
from openacr.kernel.maintain_cy import maintain_step
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.numbers import (
    AF1_BIQUAD_FILTER_ACTIVATE,
    AF1_CLAMP_OUTPUT_SIGNAL,
    AF1_OPEN_SERVO_LOOP,
    AF3_IN_DEAD_BAND,
    AF3_WORD,
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_DERIVATIVE_GAIN,
    AX_DERIVATIVE_TERM,
    AX_DERIVATIVE_WIDTH,
    AX_DIN,
    AX_DIP,
    AX_DZL,
    AX_DZU,
    AX_FBVEL_GAIN_SETTING,
    AX_FBVEL_TERM,
    AX_FEEDFORWARD_ACCEL,
    AX_FEEDFORWARD_VELOCITY,
    AX_FFACC_TERM,
    AX_FFVC,
    AX_FFVEL_TERM,
    AX_FILTER0_A0,
    AX_FILTER0_A1,
    AX_FILTER0_A2,
    AX_FILTER0_B1,
    AX_FILTER0_B2,
    AX_FILTER1_B2,
    AX_FILTER_OUTPUT_SIGNAL,
    AX_FOLLOWING_ERROR,
    AX_INTEGRAL_DELAY,
    AX_INTEGRAL_GAIN,
    AX_INTEGRAL_LIMIT,
    AX_INTEGRAL_TERM,
    AX_KVF,
    AX_KVI,
    AX_KVP,
    AX_MINUS_TORQUE_LIMIT,
    AX_OUTPUT_SIGNAL,
    AX_PLUS_TORQUE_LIMIT,
    AX_PROPORTIONAL_GAIN,
    AX_PROPORTIONAL_TERM,
    AX_SMOOTH_ENCODER_VELOCITY,
    AX_STRIDE,
    AX_SUMMATION_POINT,
    AXF_BASE,
    AXF_DERIVATIVE_HISTORY,
    AXF_DERIVATIVE_SUM,
    AXF_DERIVATIVE_V,
    AXF_ERROR_OLD_CNT,
    AXF_FILTER_STATE,
    AXF_IDLE_S,
    AXF_INTEGRAL_V,
    AXF_PEAK_ERROR_CNT,
    AXF_PM_CNT,
    AXF_SSP_ACCEL_CPS2,
    AXF_SSP_CNT,
    AXF_SSP_OLD_CNT,
    AXF_SSP_VELOCITY_CPS,
    AXF_STRIDE,
    AXF_VELOCITY_SUM_CNT,
    AXF_VELOCITY_WINDOW_CNT,
    AXI_BASE,
    AXI_CLIPPED,
    AXI_DERIVATIVE_INDEX,
    AXI_DERIVATIVE_SMOOTH,
    AXI_DERIVATIVE_TICKS,
    AXI_ON,
    AXI_PM_ON,
    AXI_POSITION_INDEX,
    AXI_POSITION_SOURCE,
    AXI_SIGNAL_INDEX,
    AXI_SIGNAL_SOURCE,
    AXI_STRIDE,
    AXI_VELOCITY_INDEX,
    AXI_VELOCITY_SOURCE,
    AXI_WINDOW_COUNT,
    AXI_WINDOW_INDEX,
    CMT_COUNT,
    ENC_ENCODER_VELOCITY,
    FOF_BASE,
    FOF_LOCK_V,
    FOF_STRIDE,
    KRI_BASE,
    KRI_MISSING_STEPPERS,
    STOF_BASE,
    STOF_PM_OLD_CNT,
    STOF_PULSES,
    STOF_SENT_CNT,
    STOF_STRIDE,
    STPR_BASE,
    STPR_STEPPER_COUNT,
    STPR_STEPPER_SIGNAL,
    STPR_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["servo_step"]

TO_DAC = 0
TO_STEPPER = 1
OWN_STEPS = 2  # as position feedback
TO_COMMUTATOR = 2
TINY = 1e-30  # filter states below this are 0: denormal numbers are very slow


def feedback_velocity(F: F64, I: I32, S: F32, n: int) -> float:
    """Velocity feedback of axis n [pulses/s], averaged over Smooth Encoder Velocity samples."""
    i: int = AXI_BASE + n * AXI_STRIDE
    k: int = I[i + AXI_VELOCITY_INDEX]
    if I[i + AXI_VELOCITY_SOURCE] != FROM_ENCODER or not 0 <= k < ENCODER_COUNT:
        return 0.0
    samples: float = S[AX_BASE + n * AX_STRIDE + AX_SMOOTH_ENCODER_VELOCITY]
    size: int = 1
    if samples >= 2.0:
        size = int(min(samples, 64.0))
    if size == 1:
        return I[encoder_row(k) + ENC_ENCODER_VELOCITY]
    a: int = AXF_BASE + n * AXF_STRIDE
    now: float = I[encoder_row(k) + ENC_ENCODER_VELOCITY]
    index: int = I[i + AXI_WINDOW_INDEX]
    if size != I[i + AXI_WINDOW_COUNT]:
        I[i + AXI_WINDOW_COUNT] = size
        index = 0
        for j in range(size):
            F[a + AXF_VELOCITY_WINDOW_CNT + j] = now
        F[a + AXF_VELOCITY_SUM_CNT] = now * size
    F[a + AXF_VELOCITY_SUM_CNT] += now - F[a + AXF_VELOCITY_WINDOW_CNT + index]
    F[a + AXF_VELOCITY_WINDOW_CNT + index] = now
    index += 1
    I[i + AXI_WINDOW_INDEX] = 0 if index >= size else index
    return F[a + AXF_VELOCITY_SUM_CNT] / size


def dead_band(F: F64, I: I32, S: F32, n: int, error: float) -> bool:
    """Dead zone of axis n: enter below DZL at rest, leave above DZU."""
    p: int = AX_BASE + n * AX_STRIDE
    a: int = AXF_BASE + n * AXF_STRIDE
    word: int = AF3_WORD + n
    if I[p + AX_DZU] <= 0:
        I[word] &= ~AF3_IN_DEAD_BAND
        return False
    if I[word] & AF3_IN_DEAD_BAND:
        if fabs(error) > I[p + AX_DZU]:
            I[word] &= ~AF3_IN_DEAD_BAND
            F[a + AXF_INTEGRAL_V] = S[p + AX_DIP] if error > 0.0 else S[p + AX_DIN]
    elif fabs(error) < I[p + AX_DZL] and F[a + AXF_SSP_VELOCITY_CPS] == 0.0:
        I[word] |= AF3_IN_DEAD_BAND
    return I[word] & AF3_IN_DEAD_BAND != 0


def integrate(F: F64, S: F32, n: int, value: float, rate: float, period_s: float) -> float:
    """Integral of `rate * value`, held for IDELAY after motion, clamped to ILIMIT [V]."""
    a: int = AXF_BASE + n * AXF_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    delay: float = S[p + AX_INTEGRAL_DELAY]
    limit: float = S[p + AX_INTEGRAL_LIMIT]
    total: float = F[a + AXF_INTEGRAL_V]
    if delay <= 0.0 or F[a + AXF_IDLE_S] >= delay:
        total += rate * value * period_s
    return integral_keep(F, n, max(-limit, min(limit, total)))


def integral_keep(F: F64, n: int, total: float) -> float:
    """Store the integral; what is no number must not stay in it."""
    if total - total != 0.0:
        total = 0.0
    F[AXF_BASE + n * AXF_STRIDE + AXF_INTEGRAL_V] = total
    return total


def derivative(F: F64, I: I32, S: F32, n: int, error: float, rate_hz: float) -> float:
    """Derivative term [V], sampled every DWIDTH."""
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    ticks: int = 1
    if S[p + AX_DERIVATIVE_WIDTH] > 0.0:
        ticks = int(rint(max(1.0, min(S[p + AX_DERIVATIVE_WIDTH] * rate_hz, 1e6))))
    I[i + AXI_DERIVATIVE_TICKS] += 1
    if I[i + AXI_DERIVATIVE_TICKS] >= ticks:
        I[i + AXI_DERIVATIVE_TICKS] = 0
        slope: float = (error - F[a + AXF_ERROR_OLD_CNT]) * rate_hz
        if ticks > 1:
            slope = slope / ticks
        F[a + AXF_ERROR_OLD_CNT] = error
        F[a + AXF_DERIVATIVE_V] = derivative_smoothed(F, I, n, slope)
    return S[p + AX_DERIVATIVE_GAIN] * F[a + AXF_DERIVATIVE_V]


def derivative_smoothed(F: F64, I: I32, n: int, slope: float) -> float:
    """Average over the last 2^n slopes (DGain Smooth, as activated by DGAIN)."""
    i: int = AXI_BASE + n * AXI_STRIDE
    size: int = I[i + AXI_DERIVATIVE_SMOOTH]
    if size <= 1:
        return slope
    a: int = AXF_BASE + n * AXF_STRIDE
    index: int = I[i + AXI_DERIVATIVE_INDEX]
    F[a + AXF_DERIVATIVE_SUM] += slope - F[a + AXF_DERIVATIVE_HISTORY + index]
    F[a + AXF_DERIVATIVE_HISTORY + index] = slope
    index += 1
    I[i + AXI_DERIVATIVE_INDEX] = 0 if index >= size else index
    return F[a + AXF_DERIVATIVE_SUM] / size


def biquad(F: F64, S: F32, state: int, row: int, x: float) -> float:
    """Y = a0 x + a1 x1 + a2 x2 - b1 y1 - b2 y2, in transposed form (two states)."""
    y: float = S[row + AX_FILTER0_A0 - AX_FILTER0_B2] * x + F[state]
    s1: float = (
        S[row + AX_FILTER0_A1 - AX_FILTER0_B2] * x
        - S[row + AX_FILTER0_B1 - AX_FILTER0_B2] * y
        + F[state + 1]
    )
    s2: float = S[row + AX_FILTER0_A2 - AX_FILTER0_B2] * x - S[row] * y
    F[state] = s1 if fabs(s1) > TINY else 0.0
    F[state + 1] = s2 if fabs(s2) > TINY else 0.0
    return y


def servo_sum(
    F: F64, I: I32, S: F32, n: int, error: float, period_s: float, rate_hz: float
) -> float:
    """The summation point of axis n [V]; the terms are shown in their parameters."""
    a: int = AXF_BASE + n * AXF_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    command: float = F[a + AXF_SSP_VELOCITY_CPS]
    banded: bool = dead_band(F, I, S, n, error)
    used: float = 0.0 if banded else error
    feed: float = S[p + AX_FEEDFORWARD_VELOCITY] * command
    if fabs(command) < I[p + AX_FFVC]:
        feed = 0.0
    surge: float = S[p + AX_FEEDFORWARD_ACCEL] * F[a + AXF_SSP_ACCEL_CPS2]
    tacho: float = 0.0
    if S[p + AX_FBVEL_GAIN_SETTING] != 0.0:
        tacho = S[p + AX_FBVEL_GAIN_SETTING] * feedback_velocity(F, I, S, n)
    proportional: float = S[p + AX_PROPORTIONAL_GAIN] * used
    slope: float = derivative(F, I, S, n, used, rate_hz)
    integral: float = F[a + AXF_INTEGRAL_V]
    total: float = 0.0
    if S[p + AX_KVP] > 0.0:
        wanted: float = proportional + S[p + AX_KVF] * command - tacho
        if not banded:
            integral = velocity_integral(F, S, n, wanted, period_s)
        total = S[p + AX_KVP] * wanted + integral + surge
    else:
        if not banded:
            integral = integrate(F, S, n, error, S[p + AX_INTEGRAL_GAIN], period_s)
        total = proportional + integral + slope + feed + surge - tacho
    total += F[FOF_BASE + n * FOF_STRIDE + FOF_LOCK_V]
    S[p + AX_PROPORTIONAL_TERM] = proportional
    S[p + AX_INTEGRAL_TERM] = integral
    S[p + AX_DERIVATIVE_TERM] = slope
    S[p + AX_FFVEL_TERM] = feed
    S[p + AX_FFACC_TERM] = surge
    S[p + AX_FBVEL_TERM] = tacho
    return total


def velocity_integral(F: F64, S: F32, n: int, value: float, period_s: float) -> float:
    """Integral of the velocity loop; ILIMIT clamps it only where it is set."""
    p: int = AX_BASE + n * AX_STRIDE
    if S[p + AX_INTEGRAL_LIMIT] > 0.0:
        return integrate(F, S, n, value, S[p + AX_KVI], period_s)
    total: float = F[AXF_BASE + n * AXF_STRIDE + AXF_INTEGRAL_V]
    return integral_keep(F, n, total + S[p + AX_KVI] * value * period_s)


def servo_closed(I: I32, n: int) -> bool:
    """Whether the loop of axis n produces an output: axis on, loop closed, drive enabled."""
    if not I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
        return False
    if I[axis_word(n)] & (AF1_OPEN_SERVO_LOOP | AF1_CLAMP_OUTPUT_SIGNAL):
        return False
    return drive_driven(I, n)


def servo_step(F: F64, I: I32, S: F32, n: int, period_s: float, rate_hz: float) -> None:
    """One pass of the servo loop of axis n."""
    a: int = AXF_BASE + n * AXF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    if I[i + AXI_SIGNAL_SOURCE] == TO_STEPPER:
        stepper_step(F, I, S, n, period_s)
        return
    error: float = F[a + AXF_SSP_CNT] - I[p + AX_ACTUAL_POSITION]
    I[p + AX_FOLLOWING_ERROR] = round32(error)
    F[a + AXF_PEAK_ERROR_CNT] = max(F[a + AXF_PEAK_ERROR_CNT], fabs(error))
    if F[a + AXF_SSP_VELOCITY_CPS] != 0.0:
        F[a + AXF_IDLE_S] = 0.0
    else:
        F[a + AXF_IDLE_S] += period_s
    output: float = 0.0
    I[i + AXI_CLIPPED] = 0
    if servo_closed(I, n):
        total: float = servo_sum(F, I, S, n, error, period_s, rate_hz)
        S[p + AX_SUMMATION_POINT] = total
        if I[axis_word(n)] & AF1_BIQUAD_FILTER_ACTIVATE:
            total = biquad(F, S, a + AXF_FILTER_STATE, p + AX_FILTER0_B2, total)
            total = biquad(F, S, a + AXF_FILTER_STATE + 2, p + AX_FILTER1_B2, total)
        S[p + AX_FILTER_OUTPUT_SIGNAL] = total
        output = min(total, S[p + AX_PLUS_TORQUE_LIMIT])
        output = max(output, S[p + AX_MINUS_TORQUE_LIMIT])
        I[i + AXI_CLIPPED] = 1 if output != total else 0
    else:
        F[a + AXF_ERROR_OLD_CNT] = error
    if output - output != 0.0:  # a gain or limit that is no number
        output = 0.0
    S[p + AX_OUTPUT_SIGNAL] = output
    k: int = I[i + AXI_SIGNAL_INDEX]
    if I[i + AXI_SIGNAL_SOURCE] == TO_DAC:
        dac_put(S, k, output)
    elif I[i + AXI_SIGNAL_SOURCE] == TO_COMMUTATOR and 0 <= k < CMT_COUNT:
        commutator_step(I, S, n, k, output)


def pulses_put(F: F64, I: I32, n: int, k: int, count: int) -> None:
    """Add what axis n sends to stepper output k: the travel of its setpoint, without jumps.

    Registers that are set (RES, homing) change the count of an axis that has its own pulses as
    feedback, so the difference to its new count is motion. With an encoder as feedback the count
    jumps with the setpoint: there the motion itself is summed up.
    """
    a: int = AXF_BASE + n * AXF_STRIDE
    f: int = STOF_BASE + k * STOF_STRIDE
    i: int = AXI_BASE + n * AXI_STRIDE
    if I[i + AXI_POSITION_SOURCE] == OWN_STEPS and I[i + AXI_POSITION_INDEX] == k:
        F[f + STOF_SENT_CNT] = F[f + STOF_PULSES]
        F[f + STOF_SENT_CNT] += wrap32(count - I[STPR_BASE + k * STPR_STRIDE + STPR_STEPPER_COUNT])
    else:
        F[f + STOF_SENT_CNT] += F[a + AXF_SSP_CNT] - F[a + AXF_SSP_OLD_CNT]
        F[f + STOF_SENT_CNT] += F[a + AXF_PM_CNT] - F[f + STOF_PM_OLD_CNT]
    F[f + STOF_PM_OLD_CNT] = F[a + AXF_PM_CNT]
    F[f + STOF_PULSES] = rint(F[f + STOF_SENT_CNT])


def stepper_idle(F: F64, S: F32, n: int, k: int) -> None:
    """Send nothing to stepper output k while the drive of axis n is disabled."""
    if 0 <= k < 16:
        F[STOF_BASE + k * STOF_STRIDE + STOF_PM_OLD_CNT] = F[AXF_BASE + n * AXF_STRIDE + AXF_PM_CNT]
        S[STPR_BASE + k * STPR_STRIDE + STPR_STEPPER_SIGNAL] = 0.0


def stepper_step(F: F64, I: I32, S: F32, n: int, period_s: float) -> None:
    """A stepper axis puts out its setpoint as steps; its own count is its feedback."""
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    k: int = I[i + AXI_SIGNAL_INDEX]
    if not drive_driven(I, n):
        stepper_idle(F, S, n, k)
    elif 0 <= k < 16 and not I[KRI_BASE + KRI_MISSING_STEPPERS] >> k & 1:
        row: int = STPR_BASE + k * STPR_STRIDE
        if I[i + AXI_PM_ON]:
            maintain_step(F, I, S, n, period_s)
        setpoint: float = F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT]
        setpoint += F[AXF_BASE + n * AXF_STRIDE + AXF_PM_CNT]
        pulses_put(F, I, n, k, round32(setpoint))
        I[row + STPR_STEPPER_COUNT] = round32(setpoint)
        S[row + STPR_STEPPER_SIGNAL] = F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_VELOCITY_CPS]
        if I[i + AXI_POSITION_SOURCE] == OWN_STEPS and I[i + AXI_POSITION_INDEX] == k:
            I[p + AX_ACTUAL_POSITION] = I[row + STPR_STEPPER_COUNT]
    I[p + AX_FOLLOWING_ERROR] = round32(
        F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT] - I[p + AX_ACTUAL_POSITION]
    )
