"""Encoders and other position feedback, once per tick, before anything else.

The plant delivers raw quadrature counts (4 per line). An encoder counts |MULT| of each
four, in the direction of its sign:

    position += MULT/4 * (raw - raw_old), whole counts; fractions are carried.

ROTARY wraps the position that is shown into 0 .. length - 1. What follows an encoder - the
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
from openacr.kernel.axis.drive_cy import drive_driven
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.kinds_cy import store_long
from openacr.map.numbers import FLAG_WORD_BASE
from openacr.map.rows import adcs, axes, encoders, kernel, motors, steppers
from openacr.map.words import af1, ef
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
LAST_PARAMETER = 40959
ADC_COUNTS_PER_VOLT = 1000.0


def encoder_count(I: I32, e: int) -> int:
    """Position of encoder e without the wraps of ROTARY."""
    turned: int = I[encoders.turned[e]]
    return wrap32(I[encoders.encoder_position[e]] + turned)


def encoder_shaft(I: I32, e: int) -> int:
    """Counts of encoder e since power-up, whatever its position was made."""
    taken: int = I[encoders.shaft[e]]
    return wrap32(I[encoders.encoder_position[e]] + taken)


def encoder_turn(I: I32, e: int, position: int) -> int:
    """A position of encoder e within its turn, the same where it is linear."""
    length: int = I[encoders.rotary[e]]
    if length <= 0 or 0 <= position < length:
        return position
    # both are words of 32 bits, so the quotient never rounds up to the next whole number
    return position - int(floor(1.0 * position / length)) * length


def encoder_wrap(I: I32, e: int) -> None:
    """Bring the position of encoder e back into its turn."""
    row: int = encoders.encoder_position[e]
    away: int = I[row] - encoder_turn(I, e, I[row])
    I[row] = wrap32(I[row] - away)
    I[encoders.turned[e]] = wrap32(I[encoders.turned[e]] + away)
    I[encoders.shaft[e]] = wrap32(I[encoders.shaft[e]] + away)


def encoder_roll(I: I32, e: int, length: int) -> None:
    """Let the position of encoder e wrap at `length`, or not at all (0)."""
    I[encoders.encoder_position[e]] = encoder_count(I, e)
    I[encoders.shaft[e]] = wrap32(I[encoders.shaft[e]] - I[encoders.turned[e]])
    I[encoders.turned[e]] = 0
    I[encoders.rotary[e]] = length
    encoder_wrap(I, e)


def followers_shift(I: I32, leader: int, jump: int) -> None:
    """Let encoders that are locked to one not count a jump that is no motion."""
    for e in range(ENCODER_COUNT):
        if I[encoders.locked_to[e]] == leader + 1:
            I[encoders.seen[e]] = wrap32(I[encoders.seen[e]] + jump)


def encoder_set(F: F64, I: I32, e: int, position: int) -> None:
    """Preload the position of encoder e, its count where it wraps."""
    if I[kernel.linked_encoders]:
        followers_shift(I, e, position - encoder_count(I, e))
    shown: int = encoder_turn(I, e, wrap32(position))
    jump: int = shown - I[encoders.encoder_position[e]]
    I[encoders.shaft[e]] = wrap32(I[encoders.shaft[e]] - jump)
    I[encoders.turned[e]] = wrap32(position - shown)
    I[encoders.encoder_position[e]] = shown
    F[encoders.partial_cnt[e]] = 0.0


def encoder_limit(F: F64, I: I32, e: int, hz: int) -> None:
    """Count no edges quicker than `hz`, or all (0), from where encoder e is."""
    raw_cnt: float = F[motors.raw_count[e]] if e < MODELLED else 0.0
    I[encoders.limit_hz[e]] = hz
    F[encoders.filter_old_cnt[e]] = raw_cnt
    F[encoders.filter_level_cnt[e]] = raw_cnt
    F[encoders.filter_since_s[e]] = 0.0


def encoder_pass(F: F64, e: int, level_cnt: float) -> None:
    """The signals of a raw count have passed the filter: count on to their state."""
    step_cnt: float = level_cnt - F[encoders.filter_level_cnt[e]]
    step_cnt -= floor(step_cnt * 0.25) * 4.0
    F[encoders.filter_level_cnt[e]] = level_cnt
    if step_cnt == 1.0:
        F[encoders.passed_cnt[e]] += 1.0
    elif step_cnt == 3.0:
        F[encoders.passed_cnt[e]] -= 1.0


def encoder_filter(F: F64, I: I32, e: int, raw_cnt: float, period_s: float) -> None:
    """Edges of encoder e that pass its filter in this tick, in which they are spread evenly."""
    hold_s: float = 1.0 / I[encoders.limit_hz[e]]
    old_cnt: float = F[encoders.filter_old_cnt[e]]
    edges: float = fabs(raw_cnt - old_cnt)
    F[encoders.passed_cnt[e]] = 0.0
    if edges == 0.0:
        F[encoders.filter_since_s[e]] += period_s
    else:
        direction: float = 1.0 if raw_cnt > old_cnt else -1.0
        gap_s: float = period_s / edges
        if F[encoders.filter_since_s[e]] + 0.5 * gap_s >= hold_s:
            encoder_pass(F, e, old_cnt)
        if edges > 1.0 and gap_s >= hold_s:
            encoder_pass(F, e, old_cnt + direction)
            F[encoders.passed_cnt[e]] += direction * (edges - 2.0)
            F[encoders.filter_level_cnt[e]] = raw_cnt - direction
        F[encoders.filter_since_s[e]] = 0.5 * gap_s
        F[encoders.filter_old_cnt[e]] = raw_cnt
    if F[encoders.filter_since_s[e]] >= hold_s:
        encoder_pass(F, e, raw_cnt)


def encoder_filters_step(F: F64, I: I32, period_s: float) -> None:
    """Let encoders with a LIMIT see only the edges that pass: those lost were seen before."""
    for e in range(MODELLED):
        if I[encoders.limit_hz[e]] > 0:
            raw_cnt: float = F[motors.raw_count[e]]
            encoder_filter(F, I, e, raw_cnt, period_s)
            passed_cnt: float = F[encoders.passed_cnt[e]]
            F[encoders.raw_old_cnt[e]] = raw_cnt - passed_cnt


def encoder_broken(F: F64, I: I32, e: int, fault: int) -> None:
    """Show what is wrong with the signals of encoder e, and leave out the edges it does not see.

    Without signals it sees none. With disturbed ones two change at once in every period in which
    it turns: one edge, that towards which it turns, is lost.
    """
    raw_cnt: float = F[motors.raw_count[e]]
    I[ef.word[e]] |= fault & (ef.ENCODER_SIGNAL_FAULT | ef.ENCODER_SIGNAL_LOST)
    if fault != ef.ENCODER_SIGNAL_FAULT:
        F[encoders.raw_old_cnt[e]] = raw_cnt
    elif raw_cnt > F[encoders.raw_old_cnt[e]]:
        F[encoders.raw_old_cnt[e]] += 1.0
    elif raw_cnt < F[encoders.raw_old_cnt[e]]:
        F[encoders.raw_old_cnt[e]] -= 1.0


def encoder_step(F: F64, I: I32, e: int, rate_hz: float) -> None:
    """Count what the motor of encoder e has moved since the last tick."""
    fault: int = I[motors.encoder_fault[e]]
    if fault:
        encoder_broken(F, I, e, fault)
    raw_cnt: float = F[motors.raw_count[e]]
    scaled_cnt: float = (raw_cnt - F[encoders.raw_old_cnt[e]]) * I[encoders.mult[e]] * 0.25
    F[encoders.raw_old_cnt[e]] = raw_cnt
    scaled_cnt += F[encoders.partial_cnt[e]]
    whole_cnt: float = floor(scaled_cnt)
    F[encoders.partial_cnt[e]] = scaled_cnt - whole_cnt
    F[encoders.step_cnt[e]] = whole_cnt
    I[encoders.encoder_position[e]] = wrap32(I[encoders.encoder_position[e]] + int(whole_cnt))
    I[encoders.encoder_velocity[e]] = round32(whole_cnt * rate_hz)


def encoder_links_step(I: I32, rate_hz: float) -> None:
    """Add the counts of encoders to those locked to them, wrap and copy (LOCK, ROTARY, DST)."""
    for e in range(ENCODER_COUNT):
        leader: int = I[encoders.locked_to[e]] - 1
        if 0 <= leader < ENCODER_COUNT:
            now: int = encoder_count(I, leader)
            step: int = wrap32(now - I[encoders.seen[e]])
            I[encoders.seen[e]] = now
            I[encoders.encoder_position[e]] = wrap32(I[encoders.encoder_position[e]] + step)
            I[encoders.encoder_velocity[e]] = round32(step * rate_hz)
        encoder_wrap(I, e)
        destination: int = I[encoders.destination[e]]
        if FLAG_WORD_BASE <= destination <= LAST_PARAMETER:
            store_long(I, destination, I[encoders.encoder_position[e]])


def ideal_follows(I: I32, S: F32, n: int) -> bool:
    """Whether an axis without a modelled motor follows its setpoint."""
    if I[af1.word[n]] & (af1.OPEN_SERVO_LOOP | af1.CLAMP_OUTPUT_SIGNAL):
        return False
    if not drive_driven(I, n):
        return False
    if S[axes.plus_torque_limit[n]] == 0.0 and S[axes.minus_torque_limit[n]] == 0.0:
        return False
    return S[axes.proportional_gain[n]] != 0.0 or S[axes.kvp[n]] != 0.0


def adc_counts(S: F32, k: int) -> int:
    """ADC input k in counts of 1/1000 volt."""
    volts: float = S[adcs.adc_input[k]]
    return int(rint(max(-1e6, min(1e6, volts)) * ADC_COUNTS_PER_VOLT))


def feedback_set(F: F64, I: I32, S: F32, n: int, actual: int) -> None:
    """Make the position feedback of axis n read `actual` where it is now."""
    source: int = I[axes.position_source[n]]
    k: int = I[axes.position_index[n]]
    if source == FROM_ENCODER and 0 <= k < ENCODER_COUNT:
        encoder_set(F, I, k, actual)
    elif source == FROM_ADC and 0 <= k < 16:
        I[axes.position_offset[n]] = wrap32(actual - adc_counts(S, k))
    elif source == FROM_STEPPER and 0 <= k < 16:
        I[steppers.stepper_count[k]] = actual
    I[axes.actual_position[n]] = actual
    I[axes.shown_actual[n]] = actual


def feedback_read(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> int:
    """Actual position of axis n from whatever is attached as its position feedback."""
    source: int = I[axes.position_source[n]]
    k: int = I[axes.position_index[n]]
    if source == FROM_ENCODER and 0 <= k < ENCODER_COUNT:
        if k < FITTED and I[kernel.missing_encoders] >> k & 1:
            return 0
        modelled: bool = k < MODELLED and I[motors.kind[k]] != 0
        if not modelled:
            F[encoders.step_cnt[k]] = 0.0
            locked: bool = I[encoders.locked_to[k]] != 0
            if not locked and ideal_follows(I, S, n):
                ideal_step(F, I, n, k, rate_hz)
        if I[kernel.linked_encoders]:
            return encoder_count(I, k)
        return I[encoders.encoder_position[k]]
    if source == FROM_ADC and 0 <= k < 16:
        return wrap32(adc_counts(S, k) + I[axes.position_offset[n]])
    if source == FROM_STEPPER and 0 <= k < 16:
        return I[steppers.stepper_count[k]]
    return 0


def ideal_step(F: F64, I: I32, n: int, e: int, rate_hz: float) -> None:
    """Ideal feedback: encoder e is where axis n was commanded to be."""
    now: int = round32(F[axes.ssp_cnt[n]])
    step: int = wrap32(now - encoder_count(I, e))
    I[encoders.encoder_position[e]] = wrap32(I[encoders.encoder_position[e]] + step)
    I[encoders.encoder_velocity[e]] = round32(step * rate_hz)
    F[encoders.step_cnt[e]] = step
    if I[kernel.linked_encoders]:
        encoder_wrap(I, e)


def feedback_step(F: F64, I: I32, S: F32, n: int, rate_hz: float) -> None:
    """Bring the actual position of axis n up to date.

    If it was written since the last tick, the feedback is set to that value.
    """
    if I[axes.actual_position[n]] != I[axes.shown_actual[n]]:
        feedback_set(F, I, S, n, I[axes.actual_position[n]])
    else:
        I[axes.actual_position[n]] = feedback_read(F, I, S, n, rate_hz)
    I[axes.shown_actual[n]] = I[axes.actual_position[n]]
