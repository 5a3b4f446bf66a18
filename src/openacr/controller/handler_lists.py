"""What a handler has changed on the memory of Python, collected as a list for the loop."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from contextlib import contextmanager

from openacr.basic.execute.threads import ENDS_WITH_PROGRAM, Threads
from openacr.basic.memory.program_memory import PROGRAMS
from openacr.engine.changes import Changes
from openacr.map.rows import threads
from openacr.map.words import pf
from openacr.views import F64, I32


class HandlerLists:
    """Python's side of a card whose loop has a state of its own."""

    def __init__(self, running: Threads) -> None:
        self._running, self._memory, self._space = running, running.memory, running.space
        self._begin()
        self._memory.noted = self._calling

    def end(self) -> None:
        """From now on the memory of Python is the card's only one."""
        self._memory.noted = None

    def _begin(self) -> None:
        """The loop's state is equal to the memory of Python."""
        self._renewals = self._memory.renewals
        self._lives = list(self._running.lives)
        self._changes = Changes()
        self._before = self._memory.snapshot()
        self._latest = self._copied()

    def _order(self, orders: Changes) -> None:
        """Requests to the engine were made."""
        raise NotImplementedError

    def _collected(self) -> Changes:
        """What has been changed since the memory was brought up to date, as one list."""
        self._order(self._changes.note(self._before, self._memory))
        changes, self._changes = self._changes, Changes()
        self._note_threads(changes)
        self._before = self._memory.snapshot()
        return changes

    def _note_threads(self, changes: Changes) -> None:
        """Threads that have begun or ended: the loop may have taken the old ones on meanwhile."""
        lives, self._lives = self._lives, list(self._running.lives)
        for thread, (old, new) in enumerate(zip(lives, self._lives, strict=True)):
            if old != new:
                changes.note_as_they_are(self._memory, threads.ints[thread], threads.INTS_SIZE)
                if thread < PROGRAMS:
                    changes.note_as_they_are(self._memory, pf.word[thread], mask=ENDS_WITH_PROGRAM)

    def _copied(self) -> tuple[I32, F64]:
        code, nums = self._space.code, self._space.nums
        return memoryview(array("i", code)), memoryview(array("d", nums))

    def _compiled_anew(self) -> tuple[I32, F64] | None:
        """A copy of the code of all programs if it is not what the loop has or will have."""
        code, nums = self._latest
        space = self._space
        if space.code.tobytes() == code.tobytes() and space.nums.tobytes() == nums.tobytes():
            return None
        self._latest = self._copied()
        return self._latest

    @contextmanager
    def _calling(self, call: int, number: int, whole: int, value: float) -> Iterator[None]:
        """Note a call of the kernel; what it changes here the loop changes itself."""
        self._order(self._changes.note(self._before, self._memory))
        yield
        self._changes.note_call(call, number, whole, value)
        self._before = self._memory.snapshot()
