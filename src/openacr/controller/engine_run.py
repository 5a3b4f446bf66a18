"""Advance a card in time: run the compiled engine and serve its requests to Python."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from openacr.basic.channels.channel_words import take_escapes
from openacr.basic.execute.threads import KINEMATICS
from openacr.compiled import is_compiled, pick
from openacr.controller.changes import ChangeLog
from openacr.controller.late_handlers import Handler, LateHandlers
from openacr.controller.parts import CardParts
from openacr.controller.realtime_card import RealtimeCard
from openacr.controller.sample_buffers import Recording
from openacr.engine import loop_cy, quiet_cy
from openacr.engine.watches import (
    Watch,
    give_orders,
    see_present,
    set_watches,
    take_fired,
    take_orders,
)
from openacr.errors import UserError
from openacr.host import CardHost
from openacr.map.memory import flag_place
from openacr.map.numbers import HEAP_BYTE_BASE
from openacr.map.rows import engine

if TYPE_CHECKING:
    from openacr.fieldbus.machine.realtime_bus import RealtimeBus

LONGEST_RUN_TK = 2**31 - 1  # ticks of one run of the engine, which counts down in 32 bits

_engine_run = pick(loop_cy.engine_run)
_TICK_ENDS = (loop_cy.STOPPED, loop_cy.UNTIL_MET, loop_cy.WATCH)
_HANDLERS = {
    loop_cy.REQUESTS: Handler.REQUESTS,
    loop_cy.ROOM: Handler.ROOM,
    loop_cy.DEVICES: Handler.DEVICES,
    loop_cy.NETWORKS: Handler.NETWORKS,
}
_LINE = -1  # the caller stops before a line, within a tick

AskLine = Callable[[int, int], bool]  # program and line; True: stop before it


class EngineRun:
    """The time of a card: the engine runs until its ticks are over or something occurs."""

    def __init__(self, parts: CardParts) -> None:
        self._parts = parts
        self._memory, self._clock = parts.memory, parts.clock
        self._poll: Callable[[], bool] | None = None
        self._ask_line: AskLine | None = None
        self.within = 0
        self.was_ended = False  # the latest `advance`, by an event
        self.recording = Recording(parts.card)
        self._late: LateHandlers | None = None
        self._real_time: RealtimeCard | None = None  # a loop on the wall clock
        self.changes = ChangeLog(parts.memory)
        self._seen = memoryview(bytearray(HEAP_BYTE_BASE)).cast("i")
        self.leave_out_rest(is_compiled)  # as plain Python a trial lasts thousands of ticks

    def leave_out_rest(self, on: bool) -> None:
        """Whether ticks that change nothing but the clocks are left out; the state is the same."""
        self._seen[quiet_cy.PAUSE] = quiet_cy.FIRST_PAUSE if on else 0

    def delay_handlers(self, longest_tk: int, seed: int) -> None:
        """Handlers take 0 to `longest_tk` ticks from now on; with -1 no time."""
        if self._late is not None:
            self._late.end()
            self._late = None
        if longest_tk >= 0:
            running = self._parts.executor.threads
            self._late = LateHandlers(running, longest_tk, seed)

    def real_time(self, card: CardHost, silence_s: float, bus: RealtimeBus | None) -> RealtimeCard:
        """Let a loop on the wall clock advance the card, from its `start` to its `close`."""
        live = RealtimeCard(card, self._parts, self.recording.view, silence_s, bus)
        self._real_time = live
        return live

    def advance(self, ticks: int = 0, *, seconds: float = 0.0) -> None:
        """Advance the card by `ticks` ticks plus `seconds`, or until an event ends it.

        UserError for a time that is negative or not a number.
        """
        if not (ticks >= 0 and 0.0 <= seconds < math.inf):
            raise UserError(f"advance by {ticks} ticks and {seconds} s: time only goes forward")
        reason = self._live(ticks + round(seconds / self._clock.period_s))
        self.was_ended = reason != loop_cy.DONE

    def until(
        self, bit: int, is_: bool = True, *, timeout_s: float = 60.0, ticks: int | None = None
    ) -> bool:
        """Advance the card until a flag has this state; False if it does not in time.

        MapError for a flag that does not exist, UserError for a negative time.
        """
        if not (0.0 <= timeout_s < math.inf and (ticks is None or ticks >= 0)):
            limit_s = f"{timeout_s} s" if ticks is None else f"{ticks} ticks"
            raise UserError(f"wait {limit_s} for flag {bit}: time only goes forward")
        if self._memory.bit(bit) == is_:
            return True
        limit = round(timeout_s / self._clock.period_s) if ticks is None else ticks
        if self._late is not None:  # the flag may be what is still to be taken over
            self._late.commit(Handler.OUTSIDE)
            pending = min(self._late.pending_tk, limit)
            if self._live(pending) != loop_cy.DONE:
                return False
            limit -= pending
        word, mask = flag_place(bit)
        self._set_engine(engine.until_word, word)
        self._set_engine(engine.until_mask, mask)
        self._set_engine(engine.until_state, int(is_))
        reason = self._live(limit)
        self._set_engine(engine.until_word, 0)
        return reason == loop_cy.UNTIL_MET

    def _live(self, ticks: int) -> int:
        """Run the engine, stopping where the journal needs a digest; returns why it ended."""
        if self._real_time is not None and not self._real_time.is_closed:
            raise UserError("the card lives in real time: it cannot be advanced by hand")
        if self._late is not None:
            self._late.commit(Handler.OUTSIDE)
        if self.within:
            self._pass_line()
        while True:
            before = self._clock.lived_tk
            step = self._parts.inputs.flush(min(ticks, LONGEST_RUN_TK), before)
            self._set_engine(engine.ticks_left, step)
            if self._parts.streams.is_overdue:
                self._set_engine(engine.stop, 1)
            self.within = 0
            if self._late is not None:
                self._late.begin()
            reason = self._run()
            if self._late is not None:
                self._late.see()
            now_tk = self._clock.lived_tk
            ticks -= now_tk - before
            if reason == _LINE:
                self.within = self.next_statement
                return reason
            self._parts.inputs.mark_if_due(now_tk)
            if reason != loop_cy.DONE or ticks <= 0:
                self._parts.nonvolatile.battery.follow_in_time()
                return reason

    def watch(self, watches: Sequence[Watch] = (), poll: Callable[[], bool] | None = None) -> None:
        """End `advance` and `until` early from now on, after the tick in which an event occurs.

        An event is a change of a watch, or that `poll` returns True; `poll` is called after every
        tick in which statements were executed that can print or answer.
        """
        set_watches(self._memory, watches)
        self._poll = poll

    def take_fired(self) -> list[int]:
        """The watches that have fired since the last call, by their places in `watch`."""
        return take_fired(self._memory)

    @property
    def announced(self) -> tuple[int, AskLine | None]:
        """What `announce_lines` has set."""
        return self._memory.I[engine.line_stops], self._ask_line

    def announce_lines(self, programs: int, ask: AskLine | None) -> None:
        """Ask before each line of these programs (a mask) from now on whether to stop there."""
        self._set_engine(engine.line_stops, programs if ask is not None else 0)
        self._ask_line = ask

    @property
    def announced_program(self) -> int | None:
        """The program before whose line the card stands; None if it stands between ticks."""
        return self._memory.I[engine.line_announced] - 1 if self.within else None

    @property
    def next_statement(self) -> int:
        """Number of the statement that follows, counted from 1 in each tick."""
        return self._memory.I[engine.statements] + 1

    def moved_in_time(self) -> None:
        """The card is at another moment: no line of it has been announced."""
        self._set_engine(engine.line_announced, 0)
        self.within = 0
        self.changes.see_present()

    @contextmanager
    def undisturbed(self) -> Iterator[None]:
        """Without watches, poll, announced lines and samples, which apply again afterwards."""
        orders = take_orders(self._memory)
        poll, self._poll = self._poll, None
        ask, self._ask_line = self._ask_line, None
        try:
            yield
        finally:
            give_orders(self._memory, orders)
            see_present(self._memory)
            self._poll, self._ask_line = poll, ask

    @contextmanager
    def standing(self) -> Iterator[None]:
        """Keep the progress within the tick, which a return to a snapshot would forget."""
        rows = engine.line_announced, engine.statements
        kept, within = [self._memory.I[row] for row in rows], self.within
        try:
            yield
        finally:
            for row, value in zip(rows, kept, strict=True):
                self._memory.I[row] = value
            self.within = within

    def _run(self) -> int:
        """Run the engine to the end of its ticks or the awaited event; returns why it ended."""
        space = self._parts.executor.threads.space
        late = self._late
        while True:
            memory = self._memory if late is None else late.machine
            code, nums = (space.code, space.nums) if late is None else late.code
            reason = _engine_run(
                memory.F,
                memory.I,
                memory.S,
                code,
                nums,
                self.recording.view,
                self._seen,
                self.changes.view,
            )
            if late is not None and reason == loop_cy.DONE and late.take_due():
                continue
            if reason in _TICK_ENDS and self._parts.streams.is_overdue:
                with self._handled(Handler.OUTSIDE):
                    self._take_turns()
            if reason in (loop_cy.DONE, loop_cy.UNTIL_MET, loop_cy.WATCH):
                return reason
            if reason == loop_cy.STOPPED:
                if self._poll is not None and self._poll():
                    return reason
            elif reason == loop_cy.TRACE_FULL:
                with self._handled(Handler.OUTSIDE):
                    self.recording.go_on()
            elif memory.I[engine.line_announced] < 0:
                if late is not None:
                    late.see()
                if self._stops_before_line(reason - loop_cy.THREAD):
                    return _LINE
            else:
                thread = reason - loop_cy.THREAD
                if late is not None and thread >= 0 and not late.is_wanted(thread):
                    continue
                with self._handled(_HANDLERS.get(reason, Handler.STATEMENT), thread):
                    self._attend(reason)
                    rebooted = self._parts.reboot_if_requested()
                if rebooted and self._is_watched:
                    return loop_cy.WATCH

    @contextmanager
    def _handled(self, kind: Handler, thread: int = -1) -> Iterator[None]:
        """Around what is done for the engine, where that may take time.

        The joints of a master belong to their tick: the loop waits for what computes them.
        """
        if self._late is None:
            yield
        elif thread >= KINEMATICS:
            self._late.see()
            yield
            self._late.commit(kind, at_once=True)
        else:
            with self._late.handler(kind, thread if thread >= 0 else None):
                yield

    @property
    def _is_watched(self) -> bool:
        return self._poll is not None or self._memory.I[engine.watch_count] != 0

    def _pass_line(self) -> None:
        """Go on from a line; if its program is not announced any more, the VM does not notice."""
        announced = self._memory.I[engine.line_announced]
        if announced and not self._memory.I[engine.line_stops] >> announced - 1 & 1:
            self._set_engine(engine.line_announced, 0)

    def _stops_before_line(self, program: int) -> bool:
        """Announce the next line of a program: whether the caller stops before it."""
        self._set_engine(engine.line_announced, program + 1)
        if self._ask_line is None:
            return False
        return self._ask_line(program, self._parts.executor.threads.next_line(program))

    def _attend(self, reason: int) -> None:
        """Do the work for which the engine returned to Python."""
        if reason == loop_cy.REQUESTS:
            self._parts.control.scan()
            for name in take_escapes(self._memory):
                self._parts.streams.escape(name)
        elif reason == loop_cy.ROOM:
            self._parts.streams.moves.drain()
        elif reason == loop_cy.DEVICES:
            self._parts.devices.attend(self._clock.tick, self._clock.period_s)
        elif reason == loop_cy.NETWORKS:
            self._parts.networks.attend()
            self._parts.streams.settle()
        else:
            self._parts.executor.attend(reason - loop_cy.THREAD)
            self._parts.streams.settle()
        if self._poll is not None or self._parts.streams.is_overdue:
            self._set_engine(engine.stop, 1)

    def _take_turns(self) -> None:
        """Continue with the backlog of host input; stop again in the next tick if any is left."""
        self._parts.streams.take_turns()
        self._parts.reboot_if_requested()
        if self._parts.streams.is_overdue:
            self._set_engine(engine.stop, 1)

    def _set_engine(self, row: int, value: int) -> None:
        self._memory.I[row] = value
        if self._late is not None:
            self._late.machine.I[row] = value
