"""Encoders and other position feedback, once per tick, before anything else.

The plant delivers raw quadrature counts (4 per line). An encoder counts |MULT| of each
four, in the direction of its sign:

    position += MULT/4 * (raw - raw_old), whole counts; fractions are carried.

ROTARY wraps the position that is shown into 0 .. length - 1. Whoever follows an encoder - the
axis it belongs to, gears, encoders locked to it - sees its count instead, position + what the
wraps have taken off, and so never a wrap; what looks at the place itself (limit switches, output
objects, ballscrew tables, copies, programs) sees the position. A commutator sees neither wraps
nor presets: it needs the angle of the shaft.

LIMIT is a filter in front of the counter: a level of the two signals passes once no edge has
come for 1/LIMIT seconds. The counter sees the signals that pass, and those have four states:
after too quick a motion it goes on by -1, 0 or 1 to the state it finds, and has lost a multiple
of four edges (or the direction, where two signals have changed at once: it counts none then).

An axis without a modelled motor has ideal feedback: with its loop closed and its drive
enabled the actual position is the secondary setpoint of the previous tick.
"""

from openacr.cmath import fabs, floor, rint
from openacr.kernel.axis_cy import axis_word
from openacr.kernel.drive_cy import drive_driven
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.kinds_cy import store_long
from openacr.map.numbers import (
    ADC_ADC_INPUT,
    ADC_BASE,
    ADC_STRIDE,
    AF1_CLAMP_OUTPUT_SIGNAL,
    AF1_OPEN_SERVO_LOOP,
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_KVP,
    AX_MINUS_TORQUE_LIMIT,
    AX_PLUS_TORQUE_LIMIT,
    AX_PROPORTIONAL_GAIN,
    AX_STRIDE,
    AXF_BASE,
    AXF_SSP_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_POSITION_INDEX,
    AXI_POSITION_OFFSET,
    AXI_POSITION_SOURCE,
    AXI_SHOWN_ACTUAL,
    AXI_STRIDE,
    EF_ENCODER_SIGNAL_FAULT,
    EF_ENCODER_SIGNAL_LOST,
    EF_WORD,
    ENC_BASE,
    ENC_ENCODER_POSITION,
    ENC_ENCODER_VELOCITY,
    ENC_HIGH_BASE,
    ENC_STRIDE,
    ENF_BASE,
    ENF_PARTIAL_CNT,
    ENF_RAW_OLD_CNT,
    ENF_STEP_CNT,
    ENF_STRIDE,
    ENI_BASE,
    ENI_DESTINATION,
    ENI_LOCKED_TO,
    ENI_MULT,
    ENI_SEEN,
    ENI_STRIDE,
    ENXF_BASE,
    ENXF_FILTER_LEVEL_CNT,
    ENXF_FILTER_OLD_CNT,
    ENXF_FILTER_SINCE_S,
    ENXF_PASSED_CNT,
    ENXF_STRIDE,
    ENXI_BASE,
    ENXI_LIMIT_HZ,
    ENXI_ROTARY,
    ENXI_SHAFT,
    ENXI_STRIDE,
    ENXI_TURNED,
    KRI_BASE,
    KRI_LINKED_ENCODERS,
    KRI_MISSING_ENCODERS,
    PLF_BASE,
    PLF_RAW_COUNT,
    PLF_STRIDE,
    PLI_BASE,
    PLI_ENCODER_FAULT,
    PLI_KIND,
    PLI_STRIDE,
    STPR_BASE,
    STPR_STEPPER_COUNT,
    STPR_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = [
    "encoder_count",
    "encoder_filters_step",
    "encoder_limit",
    "encoder_roll",
    "encoder_set",
    "feedback_set",
]

FROM_ENCODER = 0
FROM_ADC = 1
FROM_STEPPER = 2
ENCODER_COUNT = 24
MODELLED = 16  # encoders that can have a motor in the plant
FITTED = 8  # encoders CONFIG can leave out
FIRST_LONG = 4096  # of the parameters that are no user variables
LAST_PARAMETER = 40959
ADC_COUNTS_PER_VOLT = 1000.0


def encoder_row(e: int) -> int:
    """Parameter number of the first row of encoder e."""
    return ENC_BASE + e * ENC_STRIDE if e < 16 else ENC_HIGH_BASE + (e - 16) * ENC_STRIDE


def encoder_count(I: I32, e: int) -> int:
    """Position of encoder e without the wraps of ROTARY."""
    turned: int = I[ENXI_BASE + e * ENXI_STRIDE + ENXI_TURNED]
    return wrap32(I[encoder_row(e) + ENC_ENCODER_POSITION] + turned)


def encoder_shaft(I: I32, e: int) -> int:
    """Counts of encoder e since power-up, whatever its position was made."""
    taken: int = I[ENXI_BASE + e * ENXI_STRIDE + ENXI_SHAFT]
    return wrap32(I[encoder_row(e) + ENC_ENCODER_POSITION] + taken)


def encoder_turn(I: I32, e: int, position: int) -> int:
    """A position of encoder e within its turn, the same where it is linear."""
    length: int = I[ENXI_BASE + e * ENXI_STRIDE + ENXI_ROTARY]
    if length <= 0 or 0 <= position < length:
        return position
    # both are words of 32 bits, so the quotient never rounds up to the next whole number
    return position - int(floor(1.0 * position / length)) * length


def encoder_wrap(I: I32, e: int) -> None:
    """Bring the position of encoder e back into its turn."""
    i: int = ENXI_BASE + e * ENXI_STRIDE
    row: int = encoder_row(e) + ENC_ENCODER_POSITION
    away: int = I[row] - encoder_turn(I, e, I[row])
    I[row] = wrap32(I[row] - away)
    I[i + ENXI_TURNED] = wrap32(I[i + ENXI_TURNED] + away)
    I[i + ENXI_SHAFT] = wrap32(I[i + ENXI_SHAFT] + away)


def encoder_roll(I: I32, e: int, length: int) -> None:
    """Let the position of encoder e wrap at `length`, or not at all (0)."""
    i: int = ENXI_BASE + e * ENXI_STRIDE
    I[encoder_row(e) + ENC_ENCODER_POSITION] = encoder_count(I, e)
    I[i + ENXI_SHAFT] = wrap32(I[i + ENXI_SHAFT] - I[i + ENXI_TURNED])
    I[i + ENXI_TURNED] = 0
    I[i + ENXI_ROTARY] = length
    encoder_wrap(I, e)


def followers_shift(I: I32, leader: int, jump: int) -> None:
    """Let encoders that are locked to one not count a jump that is no motion."""
    for e in range(ENCODER_COUNT):
        i: int = ENI_BASE + e * ENI_STRIDE
        if I[i + ENI_LOCKED_TO] == leader + 1:
            I[i + ENI_SEEN] = wrap32(I[i + ENI_SEEN] + jump)


def encoder_set(F: F64, I: I32, e: int, position: int) -> None:
    """Preload the position of encoder e, its count where it wraps."""
    i: int = ENXI_BASE + e * ENXI_STRIDE
    row: int = encoder_row(e)
    if I[KRI_BASE + KRI_LINKED_ENCODERS]:
        followers_shift(I, e, position - encoder_count(I, e))
    shown: int = encoder_turn(I, e, wrap32(position))
    jump: int = shown - I[row + ENC_ENCODER_POSITION]
    I[i + ENXI_SHAFT] = wrap32(I[i + ENXI_SHAFT] - jump)
    I[i + ENXI_TURNED] = wrap32(position - shown)
    I[row + ENC_ENCODER_POSITION] = shown
    F[ENF_BASE + e * ENF_STRIDE + ENF_PARTIAL_CNT] = 0.0


def encoder_limit(F: F64, I: I32, e: int, hz: int) -> None:
    """Count no edges quicker than `hz`, or all (0), from where encoder e is."""
    f: int = ENXF_BASE + e * ENXF_STRIDE
    raw: float = F[PLF_BASE + e * PLF_STRIDE + PLF_RAW_COUNT] if e < MODELLED else 0.0
    I[ENXI_BASE + e * ENXI_STRIDE + ENXI_LIMIT_HZ] = hz
    F[f + ENXF_FILTER_OLD_CNT] = raw
    F[f + ENXF_FILTER_LEVEL_CNT] = raw
    F[f + ENXF_FILTER_SINCE_S] = 0.0


def encoder_pass(F: F64, f: int, level_cnt: float) -> None:
    """The signals of a raw count have passed the filter: count on to their state."""
    step: float = level_cnt - F[f + ENXF_FILTER_LEVEL_CNT]
    step -= floor(step * 0.25) * 4.0
    F[f + ENXF_FILTER_LEVEL_CNT] = level_cnt
    if step == 1.0:
        F[f + ENXF_PASSED_CNT] += 1.0
    elif step == 3.0:
        F[f + ENXF_PASSED_CNT] -= 1.0


def encoder_filter(F: F64, I: I32, e: int, raw: float, period_s: float) -> None:
    """Edges of encoder e that pass its filter in this tick, in which they are spread evenly."""
    f: int = ENXF_BASE + e * ENXF_STRIDE
    hold_s: float = 1.0 / I[ENXI_BASE + e * ENXI_STRIDE + ENXI_LIMIT_HZ]
    old: float = F[f + ENXF_FILTER_OLD_CNT]
    edges: float = fabs(raw - old)
    F[f + ENXF_PASSED_CNT] = 0.0
    if edges == 0.0:
        F[f + ENXF_FILTER_SINCE_S] += period_s
    else:
        way: float = 1.0 if raw > old else -1.0
        gap_s: float = period_s / edges
        if F[f + ENXF_FILTER_SINCE_S] + 0.5 * gap_s >= hold_s:
            encoder_pass(F, f, old)
        if edges > 1.0 and gap_s >= hold_s:
            encoder_pass(F, f, old + way)
            F[f + ENXF_PASSED_CNT] += way * (edges - 2.0)
            F[f + ENXF_FILTER_LEVEL_CNT] = raw - way
        F[f + ENXF_FILTER_SINCE_S] = 0.5 * gap_s
        F[f + ENXF_FILTER_OLD_CNT] = raw
    if F[f + ENXF_FILTER_SINCE_S] >= hold_s:
        encoder_pass(F, f, raw)


def encoder_filters_step(F: F64, I: I32, period_s: float) -> None:
    """Let encoders with a LIMIT see only the edges that pass: those lost were seen before."""
    for e in range(MODELLED):
        if I[ENXI_BASE + e * ENXI_STRIDE + ENXI_LIMIT_HZ] > 0:
            raw: float = F[PLF_BASE + e * PLF_STRIDE + PLF_RAW_COUNT]
            encoder_filter(F, I, e, raw, period_s)
            passed: float = F[ENXF_BASE + e * ENXF_STRIDE + ENXF_PASSED_CNT]
            F[ENF_BASE + e * ENF_STRIDE + ENF_RAW_OLD_CNT] = raw - passed


def encoder_broken(F: F64, I: I32, e: int, fault: int) -> None:
    """Show what is wrong with the signals of encoder e, and leave out the edges it does not see.

    Without signals it sees none. With disturbed ones two change at once in every period in which
    it turns: one edge, that towards which it turns, is lost.
    """
    f: int = ENF_BASE + e * ENF_STRIDE
    raw: float = F[PLF_BASE + e * PLF_STRIDE + PLF_RAW_COUNT]
    I[EF_WORD + e] |= fault & (EF_ENCODER_SIGNAL_FAULT | EF_ENCODER_SIGNAL_LOST)
    if fault != EF_ENCODER_SIGNAL_FAULT:
        F[f + ENF_RAW_OLD_CNT] = raw
    elif raw > F[f + ENF_RAW_OLD_CNT]:
        F[f + ENF_RAW_OLD_CNT] += 1.0
    elif raw < F[f + ENF_RAW_OLD_CNT]:
        F[f + ENF_RAW_OLD_CNT] -= 1.0


def encoder_step(F: F64, I: I32, e: int, rate_hz: float) -> None:
    """Count what the motor of encoder e has moved since the last tick."""
    f: int = ENF_BASE + e * ENF_STRIDE
    fault: int = I[PLI_BASE + e * PLI_STRIDE + PLI_ENCODER_FAULT]
    if fault:
        encoder_broken(F, I, e, fault)
    raw: float = F[PLF_BASE + e * PLF_STRIDE + PLF_RAW_COUNT]
    scaled: float = (raw - F[f + ENF_RAW_OLD_CNT]) * I[ENI_BASE + e * ENI_STRIDE + ENI_MULT] * 0.25
    F[f + ENF_RAW_OLD_CNT] = raw
    scaled += F[f + ENF_PARTIAL_CNT]
    whole: float = floor(scaled)
    F[f + ENF_PARTIAL_CNT] = scaled - whole
    F[f + ENF_STEP_CNT] = whole
    row: int = encoder_row(e)
    I[row + ENC_ENCODER_POSITION] = wrap32(I[row + ENC_ENCODER_POSITION] + int(whole))
    I[row + ENC_ENCODER_VELOCITY] = round32(whole * rate_hz)


def encoder_links_step(I: I32, rate_hz: float) -> None:
    """Add the counts of encoders to those locked to them, wrap and copy (LOCK, ROTARY, DST)."""
    for e in range(ENCODER_COUNT):
        i: int = ENI_BASE + e * ENI_STRIDE
        row: int = encoder_row(e)
        leader: int = I[i + ENI_LOCKED_TO] - 1
        if 0 <= leader < ENCODER_COUNT:
            now: int = encoder_count(I, leader)
            step: int = wrap32(now - I[i + ENI_SEEN])
            I[i + ENI_SEEN] = now
            I[row + ENC_ENCODER_POSITION] = wrap32(I[row + ENC_ENCODER_POSITION] + step)
            I[row + ENC_ENCODER_VELOCITY] = round32(step * rate_hz)
        encoder_wrap(I, e)
        destination: int = I[i + ENI_DESTINATION]
        if FIRST_LONG <= destination <= LAST_PARAMETER:
            store_long(I, destination, I[row + ENC_ENCODER_POSITION])


def ideal_follows(I: I32, S: F32, n: int) -> bool:
    """Whether an axis without a modelled motor follows its setpoint."""
    p: int = AX_BASE + n * AX_STRIDE
    if I[axis_word(n)] & (AF1_OPEN_SERVO_LOOP | AF1_CLAMP_OUTPUT_SIGNAL):
        return False
    if not drive_driven(I, n):
        return False
    if S[p + AX_PLUS_TORQUE_LIMIT] == 0.0 and S[p + AX_MINUS_TORQUE_LIMIT] == 0.0:
        return False
    return S[p + AX_PROPORTIONAL_GAIN] != 0.0 or S[p + AX_KVP] != 0.0


def adc_counts(S: F32, k: int) -> int:
    """ADC input k in counts of 1/1000 volt."""
    volts: float = S[ADC_BASE + k * ADC_STRIDE + ADC_ADC_INPUT]
    return int(rint(max(-1e6, min(1e6, volts)) * ADC_COUNTS_PER_VOLT))


def feedback_set(F: F64, I: I32, S: F32, n: int, actual: int) -> None:
    """Make the position feedback of axis n read `actual` where it is now."""
    i: int = AXI_BASE + n * AXI_STRIDE
    source: int = I[i + AXI_POSITION_SOURCE]
    k: int = I[i + AXI_POSITION_INDEX]
    if source == FROM_ENCODER and 0 <= k < ENCODER_COUNT:
        encoder_set(F, I, k, actual)
    elif source == FROM_ADC and 0 <= k < 16:
        I[i + AXI_POSITION_OFFSET] = wrap32(actual - adc_counts(S, k))
    elif source == FROM_STEPPER and 0 <= k < 16:
        I[STPR_BASE + k * STPR_STRIDE + STPR_STEPPER_COUNT] = actual
    I[AX_BASE + n * AX_STRIDE + AX_ACTUAL_POSITION] = actual
    I[i + AXI_SHOWN_ACTUAL] = actual


def feedback_read(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> int:
    """Actual position of axis n from whatever is attached as its position feedback."""
    i: int = AXI_BASE + n * AXI_STRIDE
    source: int = I[i + AXI_POSITION_SOURCE]
    k: int = I[i + AXI_POSITION_INDEX]
    if source == FROM_ENCODER and 0 <= k < ENCODER_COUNT:
        if k < FITTED and I[KRI_BASE + KRI_MISSING_ENCODERS] >> k & 1:
            return 0
        modelled: bool = k < MODELLED and I[PLI_BASE + k * PLI_STRIDE + PLI_KIND] != 0
        if not modelled:
            F[ENF_BASE + k * ENF_STRIDE + ENF_STEP_CNT] = 0.0
            locked: bool = I[ENI_BASE + k * ENI_STRIDE + ENI_LOCKED_TO] != 0
            if not locked and ideal_follows(I, S, n):
                ideal_step(F, I, n, k, rate_hz)
        if I[KRI_BASE + KRI_LINKED_ENCODERS]:
            return encoder_count(I, k)
        return I[encoder_row(k) + ENC_ENCODER_POSITION]
    if source == FROM_ADC and 0 <= k < 16:
        return wrap32(adc_counts(S, k) + I[i + AXI_POSITION_OFFSET])
    if source == FROM_STEPPER and 0 <= k < 16:
        return I[STPR_BASE + k * STPR_STRIDE + STPR_STEPPER_COUNT]
    return 0


def ideal_step(F: F64, I: I32, n: int, e: int, rate_hz: float) -> None:
    """Ideal feedback: encoder e stands where axis n was told to be."""
    row: int = encoder_row(e)
    now: int = round32(F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT])
    step: int = wrap32(now - encoder_count(I, e))
    I[row + ENC_ENCODER_POSITION] = wrap32(I[row + ENC_ENCODER_POSITION] + step)
    I[row + ENC_ENCODER_VELOCITY] = round32(step * rate_hz)
    F[ENF_BASE + e * ENF_STRIDE + ENF_STEP_CNT] = step
    if I[KRI_BASE + KRI_LINKED_ENCODERS]:
        encoder_wrap(I, e)


def feedback_step(F: F64, I: I32, S: F32, n: int, written: bool, rate_hz: float) -> None:
    """Bring the actual position of axis n up to date.

    `written` says that it was written since the last tick: the feedback is then set to
    that value first.
    """
    i: int = AXI_BASE + n * AXI_STRIDE
    p: int = AX_BASE + n * AX_STRIDE
    if written:
        feedback_set(F, I, S, n, I[p + AX_ACTUAL_POSITION])
    else:
        I[p + AX_ACTUAL_POSITION] = feedback_read(F, I, S, n, rate_hz)
    I[i + AXI_SHOWN_ACTUAL] = I[p + AX_ACTUAL_POSITION]
