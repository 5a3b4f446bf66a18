"""The log of changes of a card: which bits changed in which tick, and which axes moved."""

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from openacr.engine import change_log_cy as at
from openacr.map.memory import Memory
from openacr.views import I32

ROOM = 1 << 15  # entries between two calls of `take`
Integers: TypeAlias = npt.NDArray[np.signedinteger[Any]]


class Changes(NamedTuple):
    """Changes in the order of time; `words` are places in what is logged, MOVED of the numbers."""

    ticks: Integers  # of the life of the card
    words: Integers
    values: Integers

    def after(self, tick: int) -> "Changes":
        """Those after a tick."""
        return self._part(slice(np.searchsorted(self.ticks, tick, "right"), None))

    def until(self, tick: int) -> "Changes":
        """Those up to a tick, with it."""
        return self._part(slice(0, np.searchsorted(self.ticks, tick, "right")))

    def _part(self, rows: slice) -> "Changes":
        return Changes(self.ticks[rows], self.words[rows], self.values[rows])

    @classmethod
    def joined(cls, parts: Sequence["Changes"]) -> "Changes":
        """Several in a row."""
        ticks, words, values = map(np.concatenate, zip(NOTHING, *parts, strict=True))
        return cls(ticks, words, values)

    @property
    def size_bytes(self) -> int:
        """What they take in memory."""
        return sum(each.nbytes for each in self)


MOVED = at.MOVED_WORD
_NONE = np.zeros(0, np.int64)
NOTHING = Changes(_NONE, _NONE, _NONE)


class ChangeLog:
    """What the engine notes of changes; `view` is its buffer."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._rows: Any = np.zeros(at.HEAD, np.int32)
        self.view: I32 = memoryview(self._rows.data)
        self._first = at.HEAD

    def begin(self, words: Sequence[tuple[int, int]], numbers: Sequence[int] = ()) -> None:
        """Note changes of words (place and mask), and of numbers (F rows), from now on."""
        self._first = at.HEAD + at.PLACE * (len(words) + len(numbers))
        self._rows = rows = np.zeros(self._first + at.ENTRY * ROOM, np.int32)
        rows[at.WORDS], rows[at.NUMBERS], rows[at.ROOM] = len(words), len(numbers), ROOM
        places = rows[at.HEAD : self._first].reshape(-1, at.PLACE)
        if words:
            places[: len(words), :2] = words
        places[len(words) :, 0] = numbers
        self.view = memoryview(rows.data)
        self.see_present()

    def see_present(self) -> None:
        """Note changes from the present state on: the card is at another moment."""
        rows, count = self._rows, int(self._rows[at.WORDS])
        if not count:
            return
        state = np.frombuffer(self._memory.I, np.int32)
        places = rows[at.HEAD : self._first].reshape(-1, at.PLACE)
        words, numbers = places[:count], places[count:]
        words[:, 2] = state[words[:, 0]] & words[:, 1]
        numbers[:, 1], numbers[:, 2] = state[2 * numbers[:, 0]], state[2 * numbers[:, 0] + 1]
        rows[at.MOVED], rows[at.NOTED] = at.UNKNOWN if len(numbers) else 0, 0

    def present(self) -> list[int]:
        """The values of the words now."""
        count = int(self._rows[at.WORDS])
        words = self._rows[at.HEAD : self._first].reshape(-1, at.PLACE)[:count]
        return [self._memory.I[row] & mask for row, mask, _value in words.tolist()]

    def take(self, before_tk: int) -> Changes:
        """What was noted since the last call; `before_tk`: ticks of the life before power-up."""
        count = int(self._rows[at.NOTED])
        if not count:
            return NOTHING
        entries = self._rows[self._first : self._first + at.ENTRY * count].astype(np.int64)
        self._rows[at.NOTED] = 0
        low, high, words, values = entries.reshape(-1, at.ENTRY).T
        return Changes(before_tk + (high << 31) + low, words, values)
