"""Watched values, so that a caller waiting for them need not poll in every tick."""

from openacr.map import numbers as at
from openacr.map.rows import engine, watches
from openacr.views import F32, F64, I32

__all__ = ["watch_fired"]

# Where a watched value is: masked bits of a word, or a number that is compared.
WATCH_WORD = 0
WATCH_LONG = 1
WATCH_FP32 = 2
WATCH_FP64 = 3
WATCH_AXIS = 4  # actual position in units; row: the first parameter of the axis


def watch_value(F: F64, I: I32, S: F32, kind: int, row: int) -> float:
    """The watched number."""
    value: float = 0.0
    if kind == WATCH_LONG:
        value = I[row]
    elif kind == WATCH_FP32:
        value = S[row]
    elif kind == WATCH_FP64:
        value = F[row]
    elif kind == WATCH_AXIS:
        value = I[row + at.AX_ACTUAL_POSITION]
        ppu: float = S[row + at.AX_PPU]
        if ppu != 0.0:
            value /= ppu
    return value


def watch_state(F: F64, I: I32, S: F32, n: int) -> int:
    """The masked bits of a word, or whether a number is beyond its bound."""
    w: int = at.WATI_BASE + n * at.WATI_STRIDE
    row: int = I[w + at.WATI_ROW]
    if I[w + at.WATI_KIND] == WATCH_WORD:
        return I[row] & I[w + at.WATI_MASK]
    value: float = watch_value(F, I, S, I[w + at.WATI_KIND], row)
    bound: float = F[at.WATF_BASE + n * at.WATF_STRIDE + at.WATF_BOUND]
    if I[w + at.WATI_IS_ABOVE]:
        return 1 if value > bound else 0
    return 1 if value < bound else 0


def watch_fired(F: F64, I: I32, S: F32) -> bool:
    """Whether a watched value has changed since the last call."""
    fired: bool = False
    count: int = min(I[engine.watch_count], watches.COUNT)
    for n in range(count):
        state: int = watch_state(F, I, S, n)
        w: int = at.WATI_BASE + n * at.WATI_STRIDE
        if state != I[w + at.WATI_STATE]:
            I[w + at.WATI_STATE] = state
            I[w + at.WATI_FIRED] = 1
            fired = True
    return fired
