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
from openacr.kernel.cam_cy import array_header
from openacr.kernel.source_cy import (
    LIMITER_TAPS,
    OUTPUT_TAPS,
    RATCHET_TAPS,
    SWITCH_TAPS,
    source_follow,
    source_reading,
)
from openacr.map.kinds_cy import kind_of, store_long
from openacr.map.numbers import (
    FLAG_LAST,
    FLAG_WORD_BASE,
    KIND_LONG,
    LTF_BACKLOG_CNT,
    LTF_BASE,
    LTF_FREQ_HZ,
    LTF_MULT,
    LTF_OUTPUT_CNT,
    LTF_STRIDE,
    MO_PLS0_ON,
    OOF_BASE,
    OOF_FROM_CNT,
    OOF_PITCH_CNT,
    OOF_START_CNT,
    OOF_STRIDE,
    OOF_TO_CNT,
    OOF_WIDTH_CNT,
    OOI_BASE,
    OOI_BIT,
    OOI_ON,
    OOI_STRIDE,
    OOI_WINDOWS,
    PSF_BASE,
    PSF_BASE_CNT,
    PSF_FLZ_CNT,
    PSF_RATIO,
    PSF_ROTARY,
    PSF_STRIDE,
    PSI_ARRAY,
    PSI_BASE,
    PSI_DESTINATION,
    PSI_MASK,
    PSI_PROGRAM,
    PSI_STRIDE,
    RTF_BACKLOG_CNT,
    RTF_BASE,
    RTF_OUTPUT_CNT,
    RTF_STRIDE,
    RTI_BASE,
    RTI_MODE,
    RTI_STRIDE,
    SRF_BASE,
    SRF_DELTA,
    SRF_STRIDE,
    SRI_BASE,
    SRI_INDEX,
    SRI_KIND,
    SRI_STRIDE,
    STI_LA_BASE,
    W_MISC_OUTPUTS,
)
from openacr.views import F32, F64, I32

__all__ = ["limiter_follow", "object_outputs_step", "object_sources_step", "ratchet_follow"]

OBJECTS = 8
PASSED = 0
DROPPED = 1
TURNED = 2
BUFFERED = 3


def ratchet_follow(F: F64, I: I32, k: int, delta: float) -> None:
    """Ratchet k gets a source delta."""
    f: int = RTF_BASE + k * RTF_STRIDE
    mode: int = I[RTI_BASE + k * RTI_STRIDE + RTI_MODE]
    backlog: float = F[f + RTF_BACKLOG_CNT]
    if backlog * delta < 0.0:
        if fabs(delta) <= fabs(backlog):
            F[f + RTF_BACKLOG_CNT] = backlog + delta
            return
        delta += backlog
        F[f + RTF_BACKLOG_CNT] = 0.0
    treatment: int = mode >> 2 if delta > 0.0 else mode
    treatment = treatment & 3
    if treatment == PASSED:
        F[f + RTF_OUTPUT_CNT] += delta
    elif treatment == TURNED:
        F[f + RTF_OUTPUT_CNT] -= delta
    elif treatment == BUFFERED:
        F[f + RTF_BACKLOG_CNT] += delta


def limiter_follow(F: F64, k: int, delta: float, period_s: float) -> None:
    """Limiter k gets a source delta."""
    f: int = LTF_BASE + k * LTF_STRIDE
    due: float = F[f + LTF_BACKLOG_CNT] + F[f + LTF_MULT] * delta
    step: float = due
    if F[f + LTF_FREQ_HZ] > 0.0:
        most: float = F[f + LTF_FREQ_HZ] * period_s
        step = max(-most, min(most, due))
    F[f + LTF_BACKLOG_CNT] = due - step
    F[f + LTF_OUTPUT_CNT] += step


def object_sources_step(F: F64, I: I32, S: F32, period_s: float) -> None:
    """Ratchets, then limiters, ahead of everything that may follow them."""
    for k in range(OBJECTS):
        source_follow(F, I, S, RATCHET_TAPS + k)
        ratchet_follow(F, I, k, F[SRF_BASE + (RATCHET_TAPS + k) * SRF_STRIDE + SRF_DELTA])
    for j in range(OBJECTS):
        source_follow(F, I, S, LIMITER_TAPS + j)
        delta: float = F[SRF_BASE + (LIMITER_TAPS + j) * SRF_STRIDE + SRF_DELTA]
        limiter_follow(F, j, delta, period_s)


def tap_value(F: F64, I: I32, S: F32, t: int) -> float:
    """Present value of the source of tap t."""
    i: int = SRI_BASE + t * SRI_STRIDE
    return source_reading(F, I, S, I[i + SRI_KIND], I[i + SRI_INDEX])


def switch_step(F: F64, I: I32, S: F32, k: int) -> None:
    """Limit switch k: DST = (DST and not MASK) or (array(index) and MASK).

    Without BASE it writes nothing; one whose array was freed is switched off.
    """
    i: int = PSI_BASE + k * PSI_STRIDE
    f: int = PSF_BASE + k * PSF_STRIDE
    if I[i + PSI_ARRAY] == 0:
        return
    header: int = array_header(I, I[i + PSI_PROGRAM], STI_LA_BASE, I[i + PSI_ARRAY] - 1, 1)
    if header == 0 or kind_of(I, I[i + PSI_DESTINATION]) != KIND_LONG:
        I[W_MISC_OUTPUTS] &= ~(MO_PLS0_ON << k)
        return
    source: float = tap_value(F, I, S, SWITCH_TAPS + k)
    index: float = floor((source - F[f + PSF_BASE_CNT] + F[f + PSF_FLZ_CNT]) * F[f + PSF_RATIO])
    if F[f + PSF_ROTARY] > 0.0:
        index -= floor(index / F[f + PSF_ROTARY]) * F[f + PSF_ROTARY]
    if 0.0 <= index < I[header]:
        mask: int = I[i + PSI_MASK]
        row: int = I[i + PSI_DESTINATION]
        store_long(I, row, (I[row] & ~mask) | (I[header + 1 + int(index)] & mask))


def output_inside(F: F64, I: I32, k: int, source: float) -> bool:
    """Whether a source value lies in the window of POS or one of those of INC."""
    f: int = OOF_BASE + k * OOF_STRIDE
    if F[f + OOF_FROM_CNT] <= source < F[f + OOF_TO_CNT]:
        return True
    pitch: float = F[f + OOF_PITCH_CNT]
    if pitch <= 0.0:
        return False
    way: float = source - F[f + OOF_START_CNT]
    window: float = floor(way / pitch)
    windows: int = I[OOI_BASE + k * OOI_STRIDE + OOI_WINDOWS]
    if window < 0.0 or (windows > 0 and window >= windows):
        return False
    return way - window * pitch < F[f + OOF_WIDTH_CNT]


def output_step(F: F64, I: I32, S: F32, k: int) -> None:
    """Output object k: its flag is set inside the windows."""
    bit: int = I[OOI_BASE + k * OOI_STRIDE + OOI_BIT]
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
    """Limit switches and output objects, behind the servo loops."""
    switches: int = I[W_MISC_OUTPUTS]
    for k in range(OBJECTS):
        if switches & (MO_PLS0_ON << k):
            switch_step(F, I, S, k)
        if I[OOI_BASE + k * OOI_STRIDE + OOI_ON]:
            output_step(F, I, S, k)
