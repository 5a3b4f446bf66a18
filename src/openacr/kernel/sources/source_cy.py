"""Sources of pulses: what gears, cams, time bases and objects follow.

Each user of a source has a tap. Once per tick the tap reads its source and keeps the change:

    delta = value - old        wrapped to 32 bits where the value is a 32-bit count,

so a counter may run over without a jump. Choosing another source only reads `old` anew.
Deltas are float64: a fraction of a pulse (the clock has 1000 pulses per second) is carried
by the caller that adds them up. A value that is no finite number counts as standing still.

A trigger says when a follower engages: when a parameter passes a setpoint, or at an edge
captured as INTCAP does, of the signals of the source or of another encoder. `over_cnt` is then
the part of this tick's delta after the event.
"""

from openacr.cmath import fabs
from openacr.kernel.axis.capture_cy import (
    FALLING,
    FIRST_EXTERNAL,
    MARKER,
    MARKER_AND_EXTERNAL,
    OTHER_MARKER,
    SOFTWARE,
    SOFTWARE_TRIGGER,
    capture_signal,
    external_input,
    input_edge,
    input_fraction,
    marker_edge,
)
from openacr.kernel.axis.feedback_cy import (
    ENCODER_COUNT,
    FROM_ENCODER,
    adc_counts,
    encoder_count,
    encoder_turn,
)
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.kinds_cy import kind_of, store_long
from openacr.map.numbers import KIND_FP32, KIND_FP64, KIND_LONG, USER_BASE, W_INPUTS, W_MISC_OUTPUTS
from openacr.map.rows import (
    axes,
    encoders,
    followers,
    kernel,
    limiters,
    motors,
    ratchets,
    sources,
    steppers,
    system,
    triggers,
)
from openacr.views import F32, F64, I32

__all__ = ["parameter_value", "source_follow", "source_prime", "source_reading", "trigger_step"]
__inlined__ = ["source_follow"]

FROM_NONE = 0
FROM_CLOCK = 1
FROM_COUNTER = 2  # an encoder
FROM_STEPS = 3
FROM_AXIS = 4
FROM_RATCHET = 5
FROM_LIMITER = 6
FROM_ANALOG = 7
FROM_PARAMETER = 8
FROM_SELF = 9  # the axis itself: default of a ballscrew table

# taps
USE_GEAR = 0
USE_CAM = 1
USE_BALLSCREW = 2
USE_FILTER = 3
USE_WHEEL = 4
USE_JOG = 5
USES = 6
TAPS_KNOWN = 64  # beyond the bits of the taps of an axis
RATCHET_TAPS = 96
LIMITER_TAPS = 104
SWITCH_TAPS = 112
OUTPUT_TAPS = 120
TIME_TAPS = 128  # time bases of the masters

PULSES_PER_S = 1000.0
LARGEST_DELTA = 1e15

# triggers
GEAR_ON = 0
GEAR_OFF = 1
CAM_ON = 2
TRIGGERS = 3
DISARMED = 0
ABOVE = 1
BELOW = 2
CAPTURE = 3
CAPTURED = 4  # in this tick; travel_cnt is the part of the tick after the edge
TRAVELLING = 5
WAITING = 0
FIRED = 1
EXPIRED = 2
NO_EDGE = -1.0


def parameter_value(F: F64, I: I32, S: F32, number: int) -> float:
    """Value of a parameter or user variable; 0 where there is none."""
    kind: int = kind_of(I, number)
    if kind == KIND_LONG:
        return I[number]
    if kind == KIND_FP32:
        return S[number]
    if kind == KIND_FP64:
        return F[USER_BASE + number]
    return 0.0


def source_reading(F: F64, I: I32, S: F32, kind: int, k: int) -> float:
    """Present value of a source."""
    if kind == FROM_CLOCK:
        return F[system.time_s] * PULSES_PER_S
    if kind == FROM_COUNTER and 0 <= k < ENCODER_COUNT:
        return I[encoders.encoder_position[k]]
    if kind == FROM_STEPS and 0 <= k < 16:
        return I[steppers.stepper_count[k]]
    if kind == FROM_AXIS and 0 <= k < 16:
        return F[axes.psp_cnt[k]]
    if kind == FROM_RATCHET and 0 <= k < 8:
        return F[ratchets.output_cnt[k]]
    if kind == FROM_LIMITER and 0 <= k < 8:
        return F[limiters.output_cnt[k]]
    if kind == FROM_ANALOG and 0 <= k < 16:
        return adc_counts(S, k)
    if kind == FROM_PARAMETER:
        return parameter_value(F, I, S, k)
    return 0.0


def source_count(F: F64, I: I32, S: F32, kind: int, k: int) -> float:
    """Present value of a source for those who follow it: of an encoder, without its wraps."""
    if kind == FROM_COUNTER and 0 <= k < ENCODER_COUNT:
        return encoder_count(I, k)
    return source_reading(F, I, S, kind, k)


def source_shown(I: I32, t: int, value: float) -> float:
    """What the source of tap t showed when it had counted to `value`."""
    k: int = I[sources.index[t]]
    if I[sources.kind[t]] != FROM_COUNTER or not 0 <= k < ENCODER_COUNT:
        return value
    return encoder_turn(I, k, wrap32(round32(value) - I[encoders.turned[k]]))


def source_wraps(I: I32, kind: int, k: int) -> bool:
    """Whether a source is a 32-bit count."""
    if kind == FROM_PARAMETER:
        return kind_of(I, k) == KIND_LONG
    return kind == FROM_COUNTER or kind == FROM_STEPS


def source_prime(F: F64, I: I32, S: F32, t: int) -> None:
    """Let tap t count from the present value of its source."""
    F[sources.old[t]] = source_count(F, I, S, I[sources.kind[t]], I[sources.index[t]])
    F[sources.delta[t]] = 0.0


def source_follow(F: F64, I: I32, S: F32, t: int) -> None:
    """Take the change of the source of tap t in this tick."""
    kind: int = I[sources.kind[t]]
    k: int = I[sources.index[t]]
    if kind == FROM_COUNTER and 0 <= k < ENCODER_COUNT:
        now: float = encoder_count(I, k)
        F[sources.delta[t]] = round32(now - F[sources.old[t]])
        F[sources.old[t]] = now
        return
    if kind == FROM_NONE or kind == FROM_SELF:
        F[sources.delta[t]] = 0.0
        return
    if kind == FROM_CLOCK:
        F[sources.old[t]] = F[system.time_s] * PULSES_PER_S
        F[sources.delta[t]] = F[system.period_s] * PULSES_PER_S
        return
    value: float = source_count(F, I, S, kind, k)
    delta: float = value - F[sources.old[t]]
    if source_wraps(I, kind, k):
        delta = round32(delta)
    elif not fabs(delta) < LARGEST_DELTA:
        delta = 0.0
    F[sources.old[t]] = value
    F[sources.delta[t]] = delta


def sources_follow(F: F64, I: I32, S: F32, n: int) -> None:
    """All taps of axis n that have a source: the others have moved nothing (`source_prime`)."""
    taps: int = I[followers.taps[n]]
    if taps == 0:
        taps = taps_found(I, n)
        if I[kernel.untouched]:
            I[followers.taps[n]] = taps
    taps = taps & (TAPS_KNOWN - 1)
    t: int = n * USES
    while taps:
        if taps & 1:
            source_follow(F, I, S, t)
        taps = taps >> 1
        t += 1


def taps_found(I: I32, n: int) -> int:
    """The taps of axis n that have a source, a bit each, and TAPS_KNOWN.

    That of a jog by the clock is read by nothing: while nothing is written it may wait.
    """
    taps: int = TAPS_KNOWN
    for use in range(USES):
        kind: int = I[sources.kind[n * USES + use]]
        waits: bool = use == USE_JOG and kind == FROM_CLOCK and I[kernel.untouched] != 0
        if kind != FROM_NONE and kind != FROM_SELF and not waits:
            taps |= 1 << use
    return taps


def taps_settle(F: F64, I: I32, S: F32) -> None:
    """Let all taps be looked at anew, and those of jogs by the clock come up to date."""
    for n in range(followers.COUNT):
        if I[followers.taps[n]]:
            I[followers.taps[n]] = 0
            if I[sources.kind[n * USES + USE_JOG]] == FROM_CLOCK:
                source_follow(F, I, S, n * USES + USE_JOG)


def source_parameter(I: I32, t: int) -> int:
    """The parameter that shows the source of tap t, -1 if none does."""
    kind: int = I[sources.kind[t]]
    k: int = I[sources.index[t]]
    if kind == FROM_PARAMETER:
        return k
    if kind == FROM_COUNTER and 0 <= k < encoders.COUNT:
        return encoders.encoder_position[k]
    if kind == FROM_STEPS and 0 <= k < steppers.COUNT:
        return steppers.stepper_count[k]
    if kind == FROM_AXIS and 0 <= k < axes.COUNT:
        return axes.primary_setpoint[k]
    return -1


# captured edges


def source_encoder(I: I32, t: int, n: int) -> int:
    """Encoder whose markers trigger a follower of axis n with tap t, -1 if there is none."""
    if I[sources.kind[t]] == FROM_COUNTER:
        return I[sources.index[t]]
    axis: int = source_inputs(I, t, n)
    return I[axes.position_index[axis]] if I[axes.position_source[axis]] == FROM_ENCODER else -1


def source_inputs(I: I32, t: int, n: int) -> int:
    """Axis whose capture inputs trigger a follower of axis n with tap t."""
    k: int = I[sources.index[t]]
    kind: int = I[sources.kind[t]]
    if (kind == FROM_COUNTER or kind == FROM_AXIS) and 0 <= k < 16:
        return k
    return n


def marker_remainder(F: F64, I: I32, e: int, falling: bool, delta: float) -> float:
    """Part of the tick after the marker edge of encoder e, which moved `delta` in it."""
    edge: float = F[motors.marker_fall_cnt[e]] if falling else F[motors.marker_rise_cnt[e]]
    since: float = (F[motors.raw_count[e]] - edge) * I[encoders.mult[e]] * 0.25
    if delta == 0.0:
        return 0.0
    return max(0.0, min(1.0, since / delta))


def edge_remainder(F: F64, I: I32, mode: int, e: int, inputs: int, moved: float) -> float:
    """Part of the tick after the edge that `mode` names, NO_EDGE if it did not come."""
    signal: int = capture_signal(mode)
    falling: bool = mode & FALLING != 0
    if signal == MARKER or signal == MARKER_AND_EXTERNAL:
        gate: int = I[W_INPUTS] >> external_input(inputs, 0)
        if marker_edge(I, e, falling) and (signal == MARKER or gate & 1):
            return marker_remainder(F, I, e, falling, moved)
    elif signal == OTHER_MARKER:
        if marker_edge(I, e ^ 1, falling):
            return 0.0
    elif signal == SOFTWARE:
        if I[W_MISC_OUTPUTS] & SOFTWARE_TRIGGER:
            return 0.0
    else:
        number: int = external_input(inputs, signal - FIRST_EXTERNAL)
        if input_edge(I, number, falling):
            return 1.0 - input_fraction(F, I, number, falling)
    return NO_EDGE


def triggers_watch(F: F64, I: I32, S: F32, n: int) -> None:
    """Look for the edges that triggers of axis n wait for; the edges last one tick."""
    first: int = n * TRIGGERS
    if not (I[triggers.kind[first]] | I[triggers.kind[first + 1]] | I[triggers.kind[first + 2]]):
        return  # all disarmed
    for place in range(TRIGGERS):
        t: int = n * TRIGGERS + place
        if I[triggers.kind[t]] != CAPTURE:
            continue
        tap: int = n * USES + (USE_CAM if place == CAM_ON else USE_GEAR)
        old: float = F[sources.old[tap]]
        moved: float = source_count(F, I, S, I[sources.kind[tap]], I[sources.index[tap]]) - old
        e: int = source_encoder(I, tap, n)
        inputs: int = source_inputs(I, tap, n)
        register: int = I[triggers.register[t]]
        if 1 <= register <= ENCODER_COUNT:
            e = register - 1
            inputs = e
            moved = F[encoders.step_cnt[e]]
        remainder: float = edge_remainder(F, I, I[triggers.mode[t]], e, inputs, moved)
        if remainder >= 0.0:
            I[triggers.kind[t]] = CAPTURED
            F[triggers.travel_cnt[t]] = remainder


# triggers


def trigger_over(over: float, delta: float) -> float:
    """Source pulses remainder an event: never more than the tick has brought."""
    if delta >= 0.0:
        return max(0.0, min(over, delta))
    return min(0.0, max(over, delta))


def trigger_passed(F: F64, I: I32, S: F32, t: int) -> bool:
    """IHPOS: whether the parameter is strictly beyond the setpoint."""
    value: float = parameter_value(F, I, S, I[triggers.parameter[t]])
    setpoint: float = F[triggers.setpoint[t]]
    return value > setpoint if I[triggers.kind[t]] == ABOVE else value < setpoint


def trigger_captured(F: F64, I: I32, t: int, tap: int) -> None:
    """The edge came in this tick: keep the source position at it and count on from there."""
    F[triggers.travel_cnt[t]] = F[triggers.travel_cnt[t]] * F[sources.delta[tap]]
    I[triggers.kind[t]] = TRAVELLING
    copy: int = I[triggers.copy[t]]
    if kind_of(I, copy) == KIND_LONG:
        shown: float = source_shown(I, tap, F[sources.old[tap]] - F[triggers.travel_cnt[t]])
        store_long(I, copy, round32(shown))


def trigger_step(F: F64, I: I32, S: F32, t: int, tap: int, offset_cnt: float) -> int:
    """Advance an armed trigger: WAITING, FIRED (and disarmed, see over_cnt) or EXPIRED.

    A captured edge fires once the source has gone on by `offset_cnt`.
    """
    delta: float = F[sources.delta[tap]]
    over: float = 0.0
    kind: int = I[triggers.kind[t]]
    if kind == CAPTURE:
        return WAITING
    if kind == CAPTURED or kind == TRAVELLING:
        if kind == CAPTURED:
            trigger_captured(F, I, t, tap)
        else:
            F[triggers.travel_cnt[t]] += delta
        over = F[triggers.travel_cnt[t]] - offset_cnt
        if (offset_cnt > 0.0 and over < 0.0) or (offset_cnt < 0.0 and over > 0.0):
            return WAITING
    elif trigger_passed(F, I, S, t):
        if source_parameter(I, tap) == I[triggers.parameter[t]]:
            over = source_shown(I, tap, F[sources.old[tap]]) - F[triggers.setpoint[t]]
    else:
        return trigger_timed(I, t)
    I[triggers.kind[t]] = DISARMED
    F[triggers.over_cnt[t]] = trigger_over(over, delta)
    return FIRED


def trigger_timed(I: I32, t: int) -> int:
    """One tick of waiting less until the timeout."""
    if I[triggers.ticks_left[t]] <= 0:
        return WAITING
    I[triggers.ticks_left[t]] -= 1
    if I[triggers.ticks_left[t]] > 0:
        return WAITING
    I[triggers.kind[t]] = DISARMED
    return EXPIRED
