"""A card whose loop runs on the wall clock: what Python does for it, beside the loop.

Python works on a copy of the state, brought up to date before; what has changed goes to the loop
as a list (docs/decisions/0148-the-loop-on-the-wall-clock.md).
"""

from __future__ import annotations

import logging
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from openacr.basic.channels.channel_words import take_escapes
from openacr.basic.execute.threads import KINEMATICS
from openacr.basic.vm import opcodes_cy as vm
from openacr.basic.vm.scheduler_cy import THREAD_AWAY, THREAD_READY
from openacr.channels import StreamKind
from openacr.controller.handler_lists import HandlerLists
from openacr.controller.parts import CardParts
from openacr.controller.realtime_loop import RealtimeFigures, RealtimeLoop
from openacr.engine import realtime_cy as loop
from openacr.engine.changes import Changes
from openacr.errors import CardError, UserError
from openacr.host import CardHost
from openacr.map.rows import threads
from openacr.messages import NOT_SUPPORTED
from openacr.views import F64

if TYPE_CHECKING:
    from openacr.fieldbus.machine.realtime_bus import RealtimeBus
    from openacr.fieldbus.machine.report import BusReport

log = logging.getLogger(__name__)

SILENCE_S = 1.0
LOOK_S = 0.5  # the memory of Python is at most that old
BUS_LOOK_S = 0.004  # between two looks at the drives of a bus
SHORTEST_S = 200e-6  # a period in which the state can be copied, too


class RealtimeCard(HandlerLists):
    """A card for servers; it lives from `start` to `close` whatever Python does."""

    def __init__(
        self,
        card: CardHost,
        parts: CardParts,
        trace: F64,
        silence_s: float,
        bus: RealtimeBus | None = None,
    ) -> None:
        if parts.inputs.file is not None:
            raise UserError("a card in real time keeps no journal: it could not be replayed")
        if card.period_s < SHORTEST_S:
            raise UserError(
                f"a servo period of {1e6 * card.period_s:g} us: the real-time loop takes"
                f" {1e6 * SHORTEST_S:g} us and more (PERIOD, or period_s of machine.toml)"
            )
        self._card, self._parts = card, parts
        self._bus = bus
        self._look_s = LOOK_S if bus is None else BUS_LOOK_S
        self._loop = RealtimeLoop(trace, silence_s, None if bus is None else bus.memory)
        self._pending: deque[Changes] = deque()
        self._served = self._loop.asked()
        self._said = 0  # of what the loop has passed over
        self._looked_s = 0.0
        self.is_closed = False
        super().__init__(parts.executor.threads)

    def start(self, prepare: Callable[[], None] = lambda: None) -> None:
        """Begin to live; `prepare` is called first, on the thread of the loop.

        The bus, if there is one, is brought up before: BusError if it is not as described.
        """
        if self._bus is not None:
            self._bus.connect()
        self._loop.start(self._memory, self._latest, prepare)

    def close(self) -> None:
        """Bring all axes to rest and end the loop; the drives of a bus are off then."""
        if self.is_closed:
            return
        if self._loop.has_begun:
            self._loop.end()
            self.see()
        if self._bus is not None:
            self._bus.close()
        self.end()
        self.is_closed = True

    def figures(self) -> RealtimeFigures:
        """How well time has been kept so far."""
        return self._loop.figures(self._card.period_s)

    def report(self) -> BusReport:
        """The state of the bus with the figures of the loop; UserError without a bus."""
        if self._bus is None:
            raise UserError("the card has no bus")
        return self._bus.report(self.figures().report())

    def reset_counters(self) -> None:
        """Let the figures of the loop and the counters of the bus begin at 0."""
        self._loop.begin_figures()

    @property
    def is_alive(self) -> bool:
        """Whether the loop lives."""
        return self._loop.is_alive

    @property
    def is_settled(self) -> bool:
        """Whether the loop has taken over all that Python has changed."""
        return self._loop.untaken == 0

    @property
    def is_wanted(self) -> bool:
        """Whether there is work for Python that `advance` will do."""
        rows = self._loop.machine.I
        return (
            self._loop.asked() != self._served
            or any(rows[place] == THREAD_AWAY for place in threads.state)
            or self._parts.streams.is_overdue
        )

    # as a host sees it

    @property
    def period_s(self) -> float:
        """Seconds of card time per tick."""
        return self._card.period_s

    def open_stream(self, kind: StreamKind) -> int:
        """Open a stream for a new connection; NoFreeStreamError if all are in use."""
        with self._work():
            return self._card.open_stream(kind)

    def close_stream(self, stream: int) -> None:
        """Close the stream of an ended connection; motion and programs continue."""
        with self._work():
            self._card.close_stream(stream)

    def receive(self, stream: int, data: bytes) -> None:
        """Process bytes that arrived together."""
        with self._work():
            self._card.receive(stream, data)

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""
        return self._card.accepts_input(stream)

    def replying(self, stream: int) -> bool:
        """True while received input is being processed and is not blocked."""
        return self._card.replying(stream)

    def take_output(self, stream: int) -> bytes:
        """Return the bytes of the next write, empty when there is nothing to send."""
        return self._card.take_output(stream)

    def fast_status(self) -> bytes:
        """The datagram of the status service, as the card is now."""
        self.see()
        return self._card.fast_status()

    def advance(self, ticks: int = 0) -> None:
        """Do what the loop wants of Python; the loop itself keeps time, `ticks` or not.

        UserError if the loop has ended because it heard nothing of Python for too long.
        """
        self._loop.beat()
        if not self._loop.is_alive:
            raise UserError(
                "the real-time loop has ended: it heard nothing of Python for too long, and has"
                " brought all axes to rest"
            )
        asked = self._loop.asked()
        if self.is_wanted or time.monotonic() > self._looked_s + self._look_s:
            with self._work():
                self._attend(asked)

    # the work beside the loop

    def _attend(self, asked: tuple[int, ...]) -> None:
        parts = self._parts
        requests, room, networks, devices = map(int.__ne__, asked, self._served)
        self._served = asked
        if requests:
            parts.control.scan()
            for name in take_escapes(self._memory):
                parts.streams.escape(name)
        if room:
            parts.streams.moves.drain()
        if devices:
            parts.devices.attend(parts.clock.tick, parts.clock.period_s)
        if networks:
            parts.networks.attend()
        for thread, place in enumerate(threads.state):
            if self._memory.I[place] == THREAD_AWAY:
                self._attend_thread(thread)
        parts.streams.settle()
        if parts.streams.is_overdue:
            parts.streams.take_turns()
        parts.reboot_if_requested()
        parts.nonvolatile.battery.follow_in_time()
        self._tell_passed()

    def _attend_thread(self, thread: int) -> None:
        executor = self._parts.executor
        event = executor.threads.row(thread, threads.event)
        if thread >= KINEMATICS and event in (vm.VM_TRAP, vm.VM_CALL, vm.VM_FLAGS):
            log.error("INVK of master %d needs Python within a tick: killed", thread - KINEMATICS)
            executor.threads.end(thread, CardError(NOT_SUPPORTED))
            return
        executor.threads.set_row(thread, threads.state, THREAD_READY)
        executor.attend(thread)

    def _tell_passed(self) -> None:
        passed, self._said = self._loop.passed & ~self._said, self._loop.passed
        if passed & loop.PASSED_TRACE:
            log.warning("the recording is full and has ended")

    @contextmanager
    def _work(self) -> Iterator[None]:
        self.see()
        self._looked_s = time.monotonic()  # who only sees, however often, leads no drive
        yield
        if self._bus is not None:
            self._bus.look()  # a drive that is to be enabled is held before the loop learns of it
        self._commit()

    def see(self) -> None:
        """Bring the memory of Python up to date: the machine, and what it has not taken yet."""
        untaken = self._loop.copy_to(self._memory)
        while len(self._pending) > untaken:
            self._pending.popleft()
        for each in self._pending:
            each.take(self._memory)
        self._before = self._memory.snapshot()

    def _commit(self) -> None:
        if self._memory.renewals != self._renewals:  # another card: nothing is left of this one
            self._pending.clear()
            self._begin()
            self._loop.renew(self._memory, self._latest)
            return
        changes = self._collected()
        code = self._compiled_anew()
        if changes or code is not None:
            self._pending.append(changes)
            self._loop.give(changes, code)

    def _order(self, orders: Changes) -> None:
        self._changes.extend(orders)
