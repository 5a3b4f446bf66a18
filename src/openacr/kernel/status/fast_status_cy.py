"""The fast status block (FSTAT): groups of eight parameters copied at a fixed rate.

FSTAT On Request loads the ten entries (group code, index, type) and starts the cycle. A group
is that of a binary packet: the same parameter of eight objects, or eight neighbours. The
copies stay as they are when FSTAT On is cleared.
"""

from openacr.kernel.sources.source_cy import parameter_value
from openacr.kernel.words_cy import round32, wrap32
from openacr.map.numbers import P_FSTAT_COUNT, P_FSTAT_PERIOD, W_FSTAT
from openacr.map.rows import fast_status
from openacr.map.words import fsf
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
    for n in range(fast_status.COUNT):
        I[fast_status.code[n]] = I[fast_status.fstat_code[n]] & 255
        I[fast_status.index[n]] = I[fast_status.fstat_index[n]] & 255
        I[fast_status.type[n]] = I[fast_status.fstat_type[n]]


def fast_status_copy(F: F64, I: I32, S: F32) -> None:
    """Copy all groups in use."""
    for n in range(fast_status.COUNT):
        if I[fast_status.code[n]] == 0:
            continue
        for field in range(FIELDS):
            number: int = group_number(I[fast_status.code[n]], I[fast_status.index[n]], field)
            value: float = parameter_value(F, I, S, number)
            if I[fast_status.type[n]] == AS_FP32:
                S[fast_status.words[n] + field] = value
            else:
                I[fast_status.words[n] + field] = round32(value)
    I[P_FSTAT_COUNT] = wrap32(I[P_FSTAT_COUNT] + 1)


def fast_status_step(F: F64, I: I32, S: F32, period_s: float) -> None:
    """One tick while FSTAT runs or is asked to."""
    flags: int = I[W_FSTAT]
    phase: float = F[fast_status.phase_ms[0]] + period_s * 1000.0
    if flags & fsf.FSTAT_ON_REQUEST:
        I[W_FSTAT] = (flags & ~fsf.FSTAT_ON_REQUEST) | fsf.FSTAT_ON
        fast_status_load(I)
        phase = I[P_FSTAT_PERIOD]  # the first copy at once
    elif not flags & fsf.FSTAT_ON:
        return
    if phase >= I[P_FSTAT_PERIOD] - EPS_MS:
        fast_status_copy(F, I, S)
        phase = 0.0
    F[fast_status.phase_ms[0]] = phase
