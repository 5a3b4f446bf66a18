"""Ratchets, limiters, limit switches and output objects.

A ratchet treats source deltas by their sign. Mode 4a + b: a is what happens to positive, b
to negative ones - 0 passed on, 1 dropped, 2 passed on with the other sign, 3 buffered.
What is buffered adds to a backlog that deltas of the other sign must first work off.

A limiter follows MULT * delta but moves at most FREQ pulses per second; what is held back
comes later, nothing is lost.

A limit switch writes table values under a mask, an output object sets a flag inside windows
of its source.
"""

from openacr.cmath import fabs, floor
from openacr.kernel.followers.cam_cy import LONGS, array_header
from openacr.kernel.sources.source_cy import (
    LIMITER_TAPS,
    OUTPUT_TAPS,
    RATCHET_TAPS,
    SWITCH_TAPS,
    source_follow,
    source_reading,
)
from openacr.map.kinds_cy import kind_of, store_long
from openacr.map.numbers import FLAG_LAST, FLAG_WORD_BASE, KIND_LONG, W_MISC_OUTPUTS
from openacr.map.rows import limit_switches, limiters, output_objects, ratchets, sources
from openacr.map.words import mo
from openacr.views import F32, F64, I32

__all__ = ["limiter_follow", "object_outputs_step", "object_sources_step", "ratchet_follow"]

OBJECTS = 8
PASSED = 0
DROPPED = 1
TURNED = 2
BUFFERED = 3


def ratchet_follow(F: F64, I: I32, k: int, delta_cnt: float) -> None:
    """Ratchet k gets a source delta."""
    mode: int = I[ratchets.mode[k]]
    backlog_cnt: float = F[ratchets.backlog_cnt[k]]
    if backlog_cnt * delta_cnt < 0.0:
        if fabs(delta_cnt) <= fabs(backlog_cnt):
            F[ratchets.backlog_cnt[k]] = backlog_cnt + delta_cnt
            return
        delta_cnt += backlog_cnt
        F[ratchets.backlog_cnt[k]] = 0.0
    treatment: int = mode >> 2 if delta_cnt > 0.0 else mode
    treatment = treatment & 3
    if treatment == PASSED:
        F[ratchets.output_cnt[k]] += delta_cnt
    elif treatment == TURNED:
        F[ratchets.output_cnt[k]] -= delta_cnt
    elif treatment == BUFFERED:
        F[ratchets.backlog_cnt[k]] += delta_cnt


def limiter_follow(F: F64, k: int, delta_cnt: float, period_s: float) -> None:
    """Limiter k gets a source delta."""
    due_cnt: float = F[limiters.backlog_cnt[k]] + F[limiters.mult[k]] * delta_cnt
    step_cnt: float = due_cnt
    if F[limiters.freq_hz[k]] > 0.0:
        most_cnt: float = F[limiters.freq_hz[k]] * period_s
        step_cnt = max(-most_cnt, min(most_cnt, due_cnt))
    F[limiters.backlog_cnt[k]] = due_cnt - step_cnt
    F[limiters.output_cnt[k]] += step_cnt


def object_sources_step(F: F64, I: I32, S: F32, period_s: float) -> None:
    """Ratchets, then limiters, ahead of everything that may follow them."""
    for k in range(OBJECTS):
        source_follow(F, I, S, RATCHET_TAPS + k)
        ratchet_follow(F, I, k, F[sources.delta[RATCHET_TAPS + k]])
    for j in range(OBJECTS):
        source_follow(F, I, S, LIMITER_TAPS + j)
        delta_cnt: float = F[sources.delta[LIMITER_TAPS + j]]
        limiter_follow(F, j, delta_cnt, period_s)


def tap_value(F: F64, I: I32, S: F32, t: int) -> float:
    """Present value of the source of tap t."""
    return source_reading(F, I, S, I[sources.kind[t]], I[sources.index[t]])


def switch_step(F: F64, I: I32, S: F32, k: int) -> None:
    """Limit switch k: DST = (DST and not MASK) or (array(index) and MASK).

    Without BASE it writes nothing; one whose array was freed is switched off.
    """
    if I[limit_switches.array[k]] == 0:
        return
    header: int = array_header(
        I, I[limit_switches.program[k]], LONGS, I[limit_switches.array[k]] - 1, 1
    )
    if header == 0 or kind_of(I, I[limit_switches.destination[k]]) != KIND_LONG:
        I[W_MISC_OUTPUTS] &= ~(mo.PLS0_ON << k)
        return
    source_cnt: float = tap_value(F, I, S, SWITCH_TAPS + k)
    index: float = floor(
        (source_cnt - F[limit_switches.base_cnt[k]] + F[limit_switches.flz_cnt[k]])
        * F[limit_switches.ratio[k]]
    )
    if F[limit_switches.rotary[k]] > 0.0:
        index -= floor(index / F[limit_switches.rotary[k]]) * F[limit_switches.rotary[k]]
    if 0.0 <= index < I[header]:
        mask: int = I[limit_switches.mask[k]]
        row: int = I[limit_switches.destination[k]]
        store_long(I, row, (I[row] & ~mask) | (I[header + 1 + int(index)] & mask))


def output_inside(F: F64, I: I32, k: int, source_cnt: float) -> bool:
    """Whether a source value lies in the window of POS or one of those of INC."""
    if F[output_objects.from_cnt[k]] <= source_cnt < F[output_objects.to_cnt[k]]:
        return True
    pitch_cnt: float = F[output_objects.pitch_cnt[k]]
    if pitch_cnt <= 0.0:
        return False
    distance_cnt: float = source_cnt - F[output_objects.start_cnt[k]]
    window: float = floor(distance_cnt / pitch_cnt)
    windows: int = I[output_objects.windows[k]]
    if window < 0.0 or (windows > 0 and window >= windows):
        return False
    return distance_cnt - window * pitch_cnt < F[output_objects.width_cnt[k]]


def output_step(F: F64, I: I32, S: F32, k: int) -> None:
    """Output object k: its flag is set inside the windows."""
    bit: int = I[output_objects.bit[k]]
    if not 0 <= bit <= FLAG_LAST:
        return
    word: int = FLAG_WORD_BASE + (bit >> 5)
    one: int = 1
    mask: int = one << (bit & 31)
    if output_inside(F, I, k, tap_value(F, I, S, OUTPUT_TAPS + k)):
        I[word] |= mask
    else:
        I[word] &= ~mask


def object_outputs_step(F: F64, I: I32, S: F32) -> None:
    """Limit switches and output objects, after the servo loops."""
    switches: int = I[W_MISC_OUTPUTS]
    for k in range(OBJECTS):
        if switches & (mo.PLS0_ON << k):
            switch_step(F, I, S, k)
        if I[output_objects.on[k]]:
            output_step(F, I, S, k)
