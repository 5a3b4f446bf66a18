"""The fast status block (FSTAT): groups of eight parameters copied at a fixed rate.

FSTAT On Request loads the ten entries (group code, index, type) and starts the cycle. A group
is that of a binary packet: the same parameter of eight objects, or eight neighbours. The
copies stay as they are when FSTAT On is cleared.
"""

from openacr.kernel.source_cy import parameter_value
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.numbers import (
    FSB_COUNT,
    FSBF_BASE,
    FSBF_PHASE_MS,
    FSBI_BASE,
    FSBI_CODE,
    FSBI_INDEX,
    FSBI_STRIDE,
    FSBI_TYPE,
    FSBI_WORDS,
    FSF_FSTAT_ON,
    FSF_FSTAT_ON_REQUEST,
    FST_BASE,
    FST_FSTAT_CODE,
    FST_FSTAT_INDEX,
    FST_FSTAT_TYPE,
    FST_STRIDE,
    P_FSTAT_COUNT,
    P_FSTAT_PERIOD,
    W_FSTAT,
)
from openacr.views import F32, F64, I32

__all__ = ["fast_status_step", "group_number"]

FIELDS = 8
AS_FP32 = 1
FLAG_WORDS = 0x10
MISCELLANEOUS = 0x1B
STREAMS = 0x50
FIRST_LARGE = 0x20
LAST_LARGE = 0x4F
EPS_MS = 1e-9


def group_number(code: int, index: int, field: int) -> int:
    """Number of one of the eight parameters of a group; they are 1, 16 or 256 apart."""
    if code == FLAG_WORDS or code == MISCELLANEOUS or code == STREAMS:
        return 256 * code + 8 * index + field
    if FIRST_LARGE <= code <= LAST_LARGE:
        return 256 * (code + field) + index
    return 256 * code + (index & 128) + 16 * field + (index & 15)


def fast_status_load(I: I32) -> None:
    """Take the entries over."""
    for n in range(FSB_COUNT):
        entry: int = FST_BASE + n * FST_STRIDE
        row: int = FSBI_BASE + n * FSBI_STRIDE
        I[row + FSBI_CODE] = I[entry + FST_FSTAT_CODE] & 255
        I[row + FSBI_INDEX] = I[entry + FST_FSTAT_INDEX] & 255
        I[row + FSBI_TYPE] = I[entry + FST_FSTAT_TYPE]


def fast_status_copy(F: F64, I: I32, S: F32) -> None:
    """Copy all groups in use."""
    for n in range(FSB_COUNT):
        row: int = FSBI_BASE + n * FSBI_STRIDE
        if I[row + FSBI_CODE] == 0:
            continue
        for field in range(FIELDS):
            number: int = group_number(I[row + FSBI_CODE], I[row + FSBI_INDEX], field)
            value: float = parameter_value(F, I, S, number)
            if I[row + FSBI_TYPE] == AS_FP32:
                S[row + FSBI_WORDS + field] = value
            else:
                I[row + FSBI_WORDS + field] = round32(value)
    I[P_FSTAT_COUNT] = wrap32(I[P_FSTAT_COUNT] + 1)


def fast_status_step(F: F64, I: I32, S: F32, period_s: float) -> None:
    """One tick while FSTAT runs or is asked to."""
    flags: int = I[W_FSTAT]
    phase: float = F[FSBF_BASE + FSBF_PHASE_MS] + period_s * 1000.0
    if flags & FSF_FSTAT_ON_REQUEST:
        I[W_FSTAT] = (flags & ~FSF_FSTAT_ON_REQUEST) | FSF_FSTAT_ON
        fast_status_load(I)
        phase = I[P_FSTAT_PERIOD]  # the first copy at once
    elif not flags & FSF_FSTAT_ON:
        return
    if phase >= I[P_FSTAT_PERIOD] - EPS_MS:
        fast_status_copy(F, I, S)
        phase = 0.0
    F[FSBF_BASE + FSBF_PHASE_MS] = phase
