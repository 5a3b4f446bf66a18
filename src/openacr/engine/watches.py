"""Select the values the engine watches, so that a caller need not poll in every tick."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from openacr.compiled import pick
from openacr.engine import watch_cy
from openacr.map import numbers as at
from openacr.map.kinds_cy import kind_of
from openacr.map.memory import Memory
from openacr.map.rows import engine, every, thread_code, trace_values
from openacr.map.rows import watches as watch_rows

WATCHES = watch_rows.COUNT
_ROWS = (
    every(engine.ints, engine.INTS_SIZE),
    every(watch_rows.ints, watch_rows.INTS_SIZE),
    every(trace_values.ints, trace_values.INTS_SIZE),
)
_OF_PROCESS = (*_ROWS, every(thread_code.ints, thread_code.INTS_SIZE))
_BOUNDS = every(watch_rows.reals, watch_rows.REALS_SIZE)
_IN_TICK = engine.in_tick
# The progress within the tick, which is no request.
_PROGRESS = (_IN_TICK, engine.line_announced, engine.statements)

_watch_fired = pick(watch_cy.watch_fired)

Places: TypeAlias = npt.NDArray[np.uint32]
Words: TypeAlias = npt.NDArray[np.uint64]


class Watched(Enum):
    """The location and kind of a watched value."""

    WORD = watch_cy.WATCH_WORD
    LONG = watch_cy.WATCH_LONG
    FP32 = watch_cy.WATCH_FP32
    FP64 = watch_cy.WATCH_FP64
    AXIS = watch_cy.WATCH_AXIS


_PLACES = {at.KIND_LONG: Watched.LONG, at.KIND_FP32: Watched.FP32, at.KIND_FP64: Watched.FP64}


def parameter_place(memory: Memory, number: int) -> tuple[Watched, int] | None:
    """The location of a parameter; None if the card has no such number."""
    place = _PLACES.get(kind_of(memory.I, number))
    if place is None:
        return None
    return place, number + at.USER_BASE if place is Watched.FP64 else number


@dataclass(frozen=True, slots=True)
class Watch:
    """The masked bits of a word, or whether a number is above or below a bound."""

    place: Watched
    row: int
    mask: int = -1
    bound: float = 0.0
    is_above: bool = True


def set_watches(memory: Memory, watches: Sequence[Watch]) -> None:
    """Watch these values, at most WATCHES, from the present state on."""
    rows = memory.I
    for index, watch in enumerate(watches):
        rows[watch_rows.kind[index]] = watch.place.value
        rows[watch_rows.row[index]] = watch.row
        rows[watch_rows.mask[index]] = watch.mask
        rows[watch_rows.is_above[index]] = watch.is_above
        memory.F[watch_rows.bound[index]] = watch.bound
    rows[engine.watch_count] = len(watches)
    see_present(memory)


@dataclass(frozen=True, slots=True)
class Orders:
    """The requests of this process to the engine, which are not part of the card's state."""

    rows: tuple["memoryview[int]", ...]
    bounds: "memoryview[float]"


def state_image(memory: Memory) -> bytearray:
    """A copy of the state of the card, without what belongs to this process.

    That is, without its requests to the engine and the location of compiled programs: a card
    restored in another process compiles them again.
    """
    image = memory.image()
    rows = memoryview(image).cast("i")
    in_tick = rows[_IN_TICK]
    for places in _OF_PROCESS:
        rows[places] = memoryview(bytes(rows[places].nbytes)).cast("i")
    rows[_IN_TICK] = in_tick
    image[8 * _BOUNDS.start : 8 * _BOUNDS.stop] = bytes(8 * (_BOUNDS.stop - _BOUNDS.start))
    return image


def state_differences(memory: Memory, image: Words) -> tuple[Places, Words]:
    """The words of 64 bits of `state_image` that are others in `image`: their places and values.

    Nothing of the size of the state is copied for it.
    """
    present = np.frombuffer(memory.I, np.uint64)
    differ = present != image
    own, kept_bits = _words_of_process()
    differ[own] = False
    places = np.flatnonzero(differ)
    own_values = present[own] & kept_bits
    others = own_values != image[own]
    values = np.concatenate((present[places], own_values[others]))
    return np.concatenate((places, own[others])).astype(np.uint32), values


@cache
def _words_of_process() -> tuple[npt.NDArray[np.intp], Words]:
    """The words of 64 bits that belong to this process, and their bits that do not."""
    bits = np.full(at.MEMORY_BYTES // 8, -1, np.int64)
    rows = bits.view(np.int32)
    for places in _OF_PROCESS:
        rows[places] = 0
    rows[_IN_TICK] = -1
    bits[_BOUNDS] = 0
    own = np.flatnonzero(bits != -1)
    return own, bits[own].view(np.uint64)


def take_orders(memory: Memory) -> Orders:
    """Remove all requests and return them; `give_orders` restores them."""
    taken = []
    progress = [memory.I[row] for row in _PROGRESS]
    for places in _ROWS:
        part = memory.I[places]
        taken.append(memoryview(part.tobytes()).cast("i"))
        part[:] = memoryview(bytes(part.nbytes)).cast("i")
    for row, value in zip(_PROGRESS, progress, strict=True):
        memory.I[row] = value
    bounds = memoryview(memory.F[_BOUNDS].tobytes()).cast("d")
    memory.F[_BOUNDS] = memoryview(bytes(8 * len(bounds))).cast("d")
    return Orders(tuple(taken), bounds)


def give_orders(memory: Memory, orders: Orders) -> None:
    """Restore what `take_orders` removed; the progress within the tick is not changed."""
    progress = [memory.I[row] for row in _PROGRESS]
    for places, part in zip(_ROWS, orders.rows, strict=True):
        memory.I[places] = part
    for row, value in zip(_PROGRESS, progress, strict=True):
        memory.I[row] = value
    memory.F[_BOUNDS] = orders.bounds


def see_present(memory: Memory) -> None:
    """Let watches fire on changes from the present state on."""
    _watch_fired(memory.F, memory.I, memory.S)
    take_fired(memory)


def take_fired(memory: Memory) -> list[int]:
    """The watches that have fired since the last call, by their places in `set_watches`."""
    fired = [place for place, row in enumerate(watch_rows.fired) if memory.I[row]]
    for place in fired:
        memory.I[watch_rows.fired[place]] = 0
    return fired
