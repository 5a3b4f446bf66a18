"""Position capture (INTCAP): latch the encoder count at the edge of a signal.

Modes 0-15: bit 2 selects the falling edge; the table below names the signal. The plant
reports where within the tick an edge fell, so a captured count is exact at any speed.

    0 1  4 5    first / second marker          2 3  6 7   first / second external input
    8 9 12 13   third / fourth external        10 14      marker and first external
    11 15       software (BIT113)

The second marker is that of the other encoder of the pair (0-1, 2-3, ...). External inputs
of axis n are inputs 24, 16, 8 and 0 plus n mod 8.
"""

from openacr.cmath import floor, rint
from openacr.kernel.axis.feedback_cy import ENCODER_COUNT, FROM_ENCODER, MODELLED, feedback_set
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.kinds_cy import store_long
from openacr.map.numbers import FLAG_WORD_BASE, W_INPUTS, W_MISC_OUTPUTS
from openacr.map.rows import axes, bus_motors, encoders, kernel, motors, plant
from openacr.map.words import af1, af2
from openacr.views import F32, F64, I32

__all__ = ["capture_arm", "capture_step"]

FALLING = 4
RISING_EDGE = 1
FALLING_EDGE = 2
SOFTWARE_TRIGGER = 131072  # BIT113
FLAG_LAST = 40959
# Signals: 0 marker, 1 marker of the pair, 2-5 external inputs, 6 marker and external, 7 software
MARKER = 0
OTHER_MARKER = 1
FIRST_EXTERNAL = 2
MARKER_AND_EXTERNAL = 6
SOFTWARE = 7


def capture_arm(F: F64, I: I32, n: int, mode: int) -> None:
    """Arm the capture of axis n in `mode`, without a copy, or disarm it with -1."""
    I[axes.capture_mode[n]] = mode
    I[axes.capture_copy[n]] = 0
    if mode >= 0:
        I[af1.word[n]] &= ~af1.CAPTURE_COMPLETE
        F[axes.capture_cnt[n]] = 0.0


def capture_signal(mode: int) -> int:
    """Signal watched in `mode`, see the table above."""
    low: int = mode & 3
    if mode & 8:
        if low < 2:
            return FIRST_EXTERNAL + 2 + low
        return MARKER_AND_EXTERNAL if low == 2 else SOFTWARE
    return low


def marker_edge(I: I32, encoder: int, falling: bool) -> bool:
    """Whether the marker of an encoder had an edge in this tick."""
    if not 0 <= encoder < 16:
        return False
    edges: int = I[motors.marker_edges[encoder]]
    return edges & (FALLING_EDGE if falling else RISING_EDGE) != 0


def capture_found(F: F64, I: I32, n: int, position_cnt: int) -> None:
    """Store a captured position of axis n and disarm."""
    word2: int = af2.word[n]
    if I[word2] & af2.DONT_USE_CAPTURE_REGISTER:
        position_cnt = I[axes.primary_setpoint[n]]
        if I[axes.show_due[n]]:
            position_cnt = round32(F[axes.psp_cnt[n]])
    I[axes.hardware_capture[n]] = position_cnt
    F[axes.capture_cnt[n]] = position_cnt
    copy: int = I[axes.capture_copy[n]]
    if FLAG_WORD_BASE <= copy <= FLAG_LAST:
        store_long(I, copy, position_cnt)
    I[axes.capture_mode[n]] = -1
    I[af1.word[n]] |= af1.CAPTURE_COMPLETE


def external_input(n: int, order: int) -> int:
    """Input number of external capture input `order` (0-3) of axis n."""
    return 24 - 8 * order + (n & 7)


def input_edge(I: I32, number: int, falling: bool) -> bool:
    """Whether input `number` had an edge in this tick, also one taken back within it."""
    now: int = I[W_INPUTS]
    old: int = I[kernel.inputs_old]
    changed: int = 0
    if falling:
        changed = (old & ~now) | I[plant.falls]
    else:
        changed = (now & ~old) | I[plant.rises]
    return (changed >> number) & 1 != 0


def input_fraction(F: F64, I: I32, number: int, falling: bool) -> float:
    """When within the tick the edge came: the plant knows for wired inputs, else the end."""
    wired: int = I[plant.falls] if falling else I[plant.rises]
    if not (wired >> number) & 1:
        return 1.0
    if falling:
        return F[plant.fall_fraction + number]
    return F[plant.rise_fraction + number]


def position_at_fraction(F: F64, I: I32, n: int, fraction: float) -> int:
    """Actual position of axis n at a fraction of this tick.

    A modelled motor moves on a straight line during the tick, its encoder shows whole
    counts; without a model the counts of the tick are spread evenly.
    """
    e: int = I[axes.position_index[n]]
    now: int = I[axes.actual_position[n]]
    if I[axes.position_source[n]] != FROM_ENCODER or not 0 <= e < ENCODER_COUNT:
        return now
    if e < MODELLED and I[motors.kind[e]]:
        travel_cnt: float = F[motors.position_cnt[e]] - F[motors.previous_cnt[e]]
        raw_cnt: float = floor(F[motors.previous_cnt[e]] + fraction * travel_cnt)
        return position_before(F, I, n, e, F[motors.raw_count[e]] - raw_cnt)
    step_cnt: float = F[encoders.step_cnt[e]]
    return wrap32(now - int(rint((1.0 - fraction) * step_cnt)))


def position_before(F: F64, I: I32, n: int, e: int, since_cnt: float) -> int:
    """Actual position of axis n when its encoder e had `since_cnt` raw counts less.

    MULT below 4 counts only some of them: the present fraction tells which.
    """
    scaled_cnt: float = since_cnt * I[encoders.mult[e]] * 0.25
    back_cnt: float = floor(F[encoders.partial_cnt[e]] - scaled_cnt)
    if I[encoders.limit_hz[e]] > 0:  # counts lost in the filter are no distance
        step_cnt: float = F[encoders.step_cnt[e]]
        back_cnt = max(min(0.0, -step_cnt), min(max(0.0, -step_cnt), back_cnt))
    return wrap32(I[axes.actual_position[n]] + int(back_cnt))


def position_at_marker(F: F64, I: I32, n: int, encoder: int, falling: bool) -> int:
    """Actual position of axis n at the marker edge of its own encoder."""
    raw_cnt: float = (
        F[motors.marker_fall_cnt[encoder]] if falling else F[motors.marker_rise_cnt[encoder]]
    )
    return position_before(F, I, n, encoder, F[motors.raw_count[encoder]] - raw_cnt)


def capture_input_position(F: F64, I: I32, n: int, number: int, falling: bool) -> float:
    """Actual position of axis n at the edge of an input in this tick."""
    fraction: float = 1.0
    if 0 <= number < 32:
        fraction = input_fraction(F, I, number, falling)
    return position_at_fraction(F, I, n, fraction)


def encoder_shift(F: F64, I: I32, S: F32, n: int, origin_cnt: int) -> None:
    """Let the feedback of axis n read 0 where it read `origin_cnt`."""
    I[axes.actual_position[n]] = wrap32(I[axes.actual_position[n]] - origin_cnt)
    feedback_set(F, I, S, n, I[axes.actual_position[n]])


def has_probe(I: I32, encoder: int, order: int) -> bool:
    """Whether external capture input `order` (0-3) is latched by the drive of a motor."""
    return order == 0 and 0 <= encoder < MODELLED and I[bus_motors.has_probe[encoder]] != 0


def capture_probe(F: F64, I: I32, n: int, e: int, falling: bool) -> None:
    """Take the position of axis n that the drive of its motor e has latched, if it has."""
    if I[bus_motors.probe_edges[e]] & (FALLING_EDGE if falling else RISING_EDGE):
        latched_cnt: float = (
            F[bus_motors.probe_fall_cnt[e]] if falling else F[bus_motors.probe_rise_cnt[e]]
        )
        since_cnt: float = F[motors.raw_count[e]] - floor(latched_cnt)
        capture_found(F, I, n, position_before(F, I, n, e, since_cnt))


def capture_axis(F: F64, I: I32, n: int, mode: int) -> None:
    """Look for the edge axis n is armed for."""
    signal: int = capture_signal(mode)
    falling: bool = mode & FALLING != 0
    own: int = I[axes.position_index[n]]
    if signal == MARKER or signal == MARKER_AND_EXTERNAL:
        external: int = external_input(n, 0)
        if marker_edge(I, own, falling) and (signal == MARKER or (I[W_INPUTS] >> external) & 1):
            capture_found(F, I, n, position_at_marker(F, I, n, own, falling))
    elif signal == OTHER_MARKER:
        if marker_edge(I, own ^ 1, falling):
            capture_found(F, I, n, position_at_fraction(F, I, n, 1.0))
    elif signal == SOFTWARE:
        if I[W_MISC_OUTPUTS] & SOFTWARE_TRIGGER:
            capture_found(F, I, n, position_at_fraction(F, I, n, 1.0))
    elif has_probe(I, own, signal - FIRST_EXTERNAL):
        capture_probe(F, I, n, own, falling)
    else:
        number: int = external_input(n, signal - FIRST_EXTERNAL)
        if input_edge(I, number, falling):
            fraction: float = input_fraction(F, I, number, falling)
            capture_found(F, I, n, position_at_fraction(F, I, n, fraction))


def capture_step(F: F64, I: I32) -> None:
    """Captures of this tick, and the software capture of all axes on BIT113."""
    for n in range(I[kernel.axes]):
        mode: int = I[axes.capture_mode[n]]
        if mode >= 0:
            capture_axis(F, I, n, mode)
    if I[W_MISC_OUTPUTS] & SOFTWARE_TRIGGER:
        for n in range(axes.COUNT):
            I[axes.software_capture[n]] = I[axes.actual_position[n]]
        I[W_MISC_OUTPUTS] &= ~SOFTWARE_TRIGGER
    I[kernel.inputs_old] = I[W_INPUTS]
