"""Handlers that take time: ticks go on while they run, and what they have changed is merged later.

The loop has a state of its own, the machine's. A handler (a statement of a program that Python
executes, packets and lines of hosts, networks, devices, requests) works on the memory that all of
Python knows, which is brought up to date before. What it has changed becomes a list, and the loop
takes the list over between two ticks, as many ticks later as were drawn for it. The same seed
gives the same life. Design: docs/decisions/0144-handlers-run-while-ticks-go-on.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from random import Random

from openacr.basic.execute.threads import Threads
from openacr.basic.vm.scheduler_cy import THREAD_AWAY, THREAD_READY
from openacr.controller.handler_lists import HandlerLists
from openacr.engine.changes import Changes
from openacr.map.memory import Memory
from openacr.map.rows import engine, kernel, system, threads
from openacr.views import F64, I32


class Handler(StrEnum):
    """What runs while ticks go on; each kind has a generator of its own."""

    STATEMENT = "statement"  # of a program or a typed line that waits
    OUTSIDE = "outside"  # lines, packets, keys, what a caller has done between two calls
    REQUESTS = "requests"  # flags that request something
    ROOM = "room"  # binary moves that have waited for room
    NETWORKS = "networks"
    DEVICES = "devices"


@dataclass(slots=True)
class _Pending:
    """What one handler has changed, and the tick after which the loop takes it over."""

    due_tk: int
    changes: Changes
    code: tuple[I32, F64] | None  # programs as they are compiled from then on
    lives: list[int]  # of the threads, as Python knows them


class LateHandlers(HandlerLists):
    """The two states of a card whose handlers take 0 to `longest_tk` ticks each."""

    def __init__(self, running: Threads, longest_tk: int, seed: int) -> None:
        self.machine = Memory()
        self._longest_tk = longest_tk
        self._drawn = {kind: Random(f"{seed} {kind}") for kind in Handler}
        self._pending: list[_Pending] = []
        self._set_aside_tk = 0  # of the ticks that the engine was asked for
        super().__init__(running)

    @property
    def code(self) -> tuple[I32, F64]:
        """The programs as the machine knows them."""
        return self._code

    @property
    def tick(self) -> int:
        """Ticks of the machine."""
        rows = self.machine.I
        return rows[system.tick_high] * 2**31 + rows[system.tick_low]

    @property
    def pending_tk(self) -> int:
        """Ticks until all that is pending now has been taken over."""
        return self._pending[-1].due_tk - self.tick if self._pending else 0

    def see(self) -> None:
        """Bring the memory of Python up to date: the machine, and what is still pending."""
        self._memory.replace(self.machine)
        for each in self._pending:
            each.changes.take(self._memory)
        self._before = self._memory.snapshot()

    def commit(self, kind: Handler, *, at_once: bool = False) -> None:
        """A handler has done its work: the loop takes it over in some ticks, or `at_once`."""
        if self._memory.renewals != self._renewals:  # another card: nothing is left of this one
            self._begin()
            return
        changes = self._collected()
        code = self._compiled_anew()
        if not changes and code is None:
            return
        due_tk = self.tick + (0 if at_once else self._drawn[kind].randint(0, self._longest_tk))
        if not at_once and self._pending:
            due_tk = max(due_tk, self._pending[-1].due_tk)
        lives = self._machine_lives if at_once and self._pending else self._lives
        pending = _Pending(due_tk, changes, code, lives)
        if at_once or (due_tk == self.tick and not self._pending):
            self._take(pending)
        else:
            self._pending.append(pending)
            self.reckon()

    def is_wanted(self, thread: int) -> bool:
        """Whether a thread is what Python knows; if it has ended or begun anew, the loop leaves it.

        The loop learns of it with what is pending; until then the thread does nothing.
        """
        if self._running.lives[thread] == self._machine_lives[thread]:
            return True
        self.machine.I[threads.state[thread]] = THREAD_AWAY
        return False

    @contextmanager
    def handler(self, kind: Handler, thread: int | None = None) -> Iterator[None]:
        """Around the work of a handler, that of a statement for its thread, which waits for it."""
        room = self.machine.I[kernel.moves_waiting]
        if thread is not None:
            self.machine.I[threads.state[thread]] = THREAD_AWAY
        elif kind is Handler.ROOM:
            self.machine.I[kernel.moves_waiting] = 0  # or the loop would ask again
        self.see()
        if thread is not None:
            self._memory.I[threads.state[thread]] = THREAD_READY
        elif kind is Handler.ROOM:
            self._memory.I[kernel.moves_waiting] = room
        yield
        self.commit(kind)

    def begin(self) -> None:
        """The engine has been asked for ticks anew."""
        self._set_aside_tk = 0
        self.reckon()

    def reckon(self) -> None:
        """Let the engine stop where something is to be taken over."""
        rows = self.machine.I
        left_tk = rows[engine.ticks_left] + self._set_aside_tk
        next_tk = min((each.due_tk - self.tick for each in self._pending), default=left_tk)
        now_tk = max(min(left_tk, next_tk), 0)
        rows[engine.ticks_left] = now_tk
        self._set_aside_tk = left_tk - now_tk

    def take_due(self) -> bool:
        """Between two ticks: take over what is due; True if ticks are left to the engine."""
        while self._pending and self._pending[0].due_tk <= self.tick:
            self._take(self._pending.pop(0))
        self.reckon()
        return self.machine.I[engine.ticks_left] > 0

    def _take(self, pending: _Pending) -> None:
        pending.changes.take(self.machine)
        self._machine_lives = pending.lives
        if pending.code is not None:
            self._code = pending.code

    def _begin(self) -> None:
        """The memory of Python is the machine's from now on."""
        super()._begin()
        self.machine.replace(self._memory)
        self._pending.clear()
        self._machine_lives = self._lives
        self._code = self._latest

    def _order(self, orders: Changes) -> None:
        orders.take(self.machine)
