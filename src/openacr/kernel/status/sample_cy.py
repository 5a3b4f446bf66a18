"""The sampler: up to eight parameters recorded into arrays (SAMP).

Sample Trigger Armed begins at index 0 and waits for the trigger flag; then Trigger Latched
and In Progress set and every Sample Timer Period one sample of all channels is stored, the
first at once. With Mode Select the sampler only stores while the trigger holds and waits
for it again. When the shortest array is full, or an array no longer exists, it ends.
"""

from openacr.kernel.followers.cam_cy import DOUBLES, LONGS, SINGLES, array_header
from openacr.kernel.sources.source_cy import parameter_value
from openacr.kernel.words_cy import wrap32
from openacr.map import numbers as at
from openacr.map.rows import sampler
from openacr.map.words import mo
from openacr.views import F32, F64, I32

__all__ = ["sample_step"]

CHANNELS = 8
INTO_LONG = 1
INTO_SINGLE = 2
INTO_DOUBLE = 3
EPS_MS = 1e-9
LONG_LIMIT = 9.2e18


def sample_header(I: I32, c: int) -> int:
    """Header of the array of channel c, 0 if it does not exist."""
    kind: int = I[sampler.kind + c]
    table: int = LONGS
    words: int = 1
    if kind == INTO_SINGLE:
        table = SINGLES
    elif kind == INTO_DOUBLE:
        table = DOUBLES
        words = 2
    return array_header(I, I[sampler.program + c], table, I[sampler.array + c], words)


def sample_room(I: I32) -> int:
    """Elements of the shortest array in use; 0 if there is none or one is missing."""
    room: int = 0
    for c in range(CHANNELS):
        if I[sampler.source + c] and I[sampler.kind + c]:
            header: int = sample_header(I, c)
            if header == 0:
                return 0
            room = I[header] if room == 0 else min(room, I[header])
    return room


def sample_store(F: F64, I: I32, S: F32, index: int) -> None:
    """One sample of all channels; a LONG array gets values without their fraction."""
    for c in range(CHANNELS):
        kind: int = I[sampler.kind + c]
        if not I[sampler.source + c] or not kind:
            continue
        header: int = sample_header(I, c)
        value: float = parameter_value(F, I, S, I[sampler.source + c] - 1)
        if kind == INTO_SINGLE:
            S[header + 1 + index] = value
        elif kind == INTO_DOUBLE:
            F[((header + 1) >> 1) + index] = value
        elif -LONG_LIMIT < value < LONG_LIMIT:
            I[header + 1 + index] = wrap32(int(value))
        else:
            I[header + 1 + index] = 0


def sample_triggered(I: I32) -> bool:
    """Whether the trigger condition holds; without a trigger it always does."""
    flag: int = I[sampler.trigger] - 1
    if not 0 <= flag <= at.FLAG_LAST:
        return True
    state: int = (I[at.FLAG_WORD_BASE + (flag >> 5)] >> (flag & 31)) & 1
    return state != I[sampler.trigger_clear]


def sample_begin(F: F64, I: I32) -> None:
    """The trigger has come: the next sample is due at once."""
    I[at.W_MISC_OUTPUTS] |= mo.SAMPLE_IN_PROGRESS | mo.SAMPLE_TRIGGER_LATCHED
    I[at.P_SAMPLE_TRIGGER_INDEX] = I[at.P_SAMPLE_ARRAY_INDEX]
    F[sampler.timer_ms] = max(I[at.P_SAMPLE_TIMER_PERIOD], 0)


def sample_take(F: F64, I: I32, S: F32, period_ms: float) -> None:
    """Store a sample if one is due; end when the arrays are full."""
    every: int = I[at.P_SAMPLE_TIMER_PERIOD]
    room: int = sample_room(I)
    index: int = I[at.P_SAMPLE_ARRAY_INDEX]
    timer: float = F[sampler.timer_ms]
    if timer >= every - EPS_MS and 0 <= index < room:
        sample_store(F, I, S, index)
        index += 1
        I[at.P_SAMPLE_ARRAY_INDEX] = index
        timer = max(timer - every, 0.0) if every > 0 else 0.0
    I[at.P_SAMPLE_TIMER_CLOCK] = int(min(timer + EPS_MS, 2e9))
    F[sampler.timer_ms] = timer + period_ms
    if not 0 <= index < room:
        I[at.W_MISC_OUTPUTS] &= ~(mo.SAMPLE_IN_PROGRESS | mo.SAMPLE_TRIGGER_ARMED)


def sample_step(F: F64, I: I32, S: F32, period_s: float) -> None:
    """The sampler in one tick, while it is or was armed."""
    armed: int = 1 if I[at.W_MISC_OUTPUTS] & mo.SAMPLE_TRIGGER_ARMED else 0
    if armed and not I[sampler.armed_old]:
        I[at.P_SAMPLE_ARRAY_INDEX] = 0
        I[at.W_MISC_OUTPUTS] &= ~(mo.SAMPLE_IN_PROGRESS | mo.SAMPLE_TRIGGER_LATCHED)
    I[sampler.armed_old] = armed
    if not armed:
        I[at.W_MISC_OUTPUTS] &= ~mo.SAMPLE_IN_PROGRESS
        return
    running: int = I[at.W_MISC_OUTPUTS] & mo.SAMPLE_IN_PROGRESS
    gated: int = I[at.W_MISC_OUTPUTS] & mo.SAMPLE_MODE_SELECT
    if not running or gated:
        if not sample_triggered(I):
            I[at.W_MISC_OUTPUTS] &= ~mo.SAMPLE_IN_PROGRESS
            return
        if not running:
            sample_begin(F, I)
    sample_take(F, I, S, period_s * 1000.0)
    I[sampler.armed_old] = 1 if I[at.W_MISC_OUTPUTS] & mo.SAMPLE_TRIGGER_ARMED else 0
