"""Advance a card in time: run the compiled engine and serve its requests to Python."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

from openacr.basic.channels.channel_words import take_escapes
from openacr.compiled import pick
from openacr.controller.machine import CardParts
from openacr.controller.recording import Recording
from openacr.controller.trace import Trace
from openacr.engine import loop_cy
from openacr.engine.samples import Sample
from openacr.engine.watches import Watch, set_watches
from openacr.errors import UserError
from openacr.map.memory import flag_place
from openacr.map.numbers import (
    ENGI_BASE,
    ENGI_STOP,
    ENGI_TICKS_LEFT,
    ENGI_UNTIL_MASK,
    ENGI_UNTIL_STATE,
    ENGI_UNTIL_WORD,
    ENGI_WATCH_COUNT,
)
from openacr.models import DEFAULT_MODEL, Model
from openacr.plant import schema

LONGEST_RUN_TK = 2**31 - 1  # ticks of one run of the engine, which counts down in 32 bits

_engine_run = pick(loop_cy.engine_run)
_TICK_ENDS = (loop_cy.STOPPED, loop_cy.UNTIL_MET, loop_cy.WATCH)


class Running(CardParts):
    """A card whose time can be advanced."""

    def __init__(
        self,
        model: str | Model = DEFAULT_MODEL,
        *,
        world: schema.World | None = None,
        data: Path | None = None,
    ) -> None:
        super().__init__(model, world=world, data=data)
        self._poll: Callable[[], bool] | None = None
        self._recording = Recording(self.card)

    def advance(self, ticks: int = 0, *, seconds: float = 0.0) -> None:
        """Advance the card by `ticks` ticks plus `seconds`, or until a watch ends it.

        UserError for a time that is negative or not a number.
        """
        if not (ticks >= 0 and 0.0 <= seconds < math.inf):
            raise UserError(f"advance by {ticks} ticks and {seconds} s: time only goes forward")
        self._live(ticks + round(seconds / self.period_s))

    def until(
        self, bit: int, is_: bool = True, *, timeout_s: float = 60.0, ticks: int | None = None
    ) -> bool:
        """Advance the card until a flag has this state; False if it does not in time.

        MapError for a flag that does not exist, UserError for a negative time.
        """
        if not (0.0 <= timeout_s < math.inf and (ticks is None or ticks >= 0)):
            limit_s = f"{timeout_s} s" if ticks is None else f"{ticks} ticks"
            raise UserError(f"wait {limit_s} for flag {bit}: time only goes forward")
        if self.memory.bit(bit) == is_:
            return True
        word, mask = flag_place(bit)
        self._set_engine(ENGI_UNTIL_WORD, word)
        self._set_engine(ENGI_UNTIL_MASK, mask)
        self._set_engine(ENGI_UNTIL_STATE, int(is_))
        limit = round(timeout_s / self.period_s) if ticks is None else ticks
        reason = self._live(limit)
        self._set_engine(ENGI_UNTIL_WORD, 0)
        return reason == loop_cy.UNTIL_MET

    def _live(self, ticks: int) -> int:
        """Run the engine, stopping where the journal needs a digest; returns why it ended."""
        while True:
            step = min(ticks, LONGEST_RUN_TK)
            if self.recorder is not None:
                self.recorder.flush()
                step = min(step, self.recorder.next_tk - self.lived_tk)
            before = self.lived_tk
            self._set_engine(ENGI_TICKS_LEFT, step)
            if self.streams.is_overdue:
                self._set_engine(ENGI_STOP, 1)
            reason = self._run()
            ticks -= self.lived_tk - before
            if self.recorder is not None and self.lived_tk >= self.recorder.next_tk:
                self.recorder.mark()
            if reason != loop_cy.DONE or ticks <= 0:
                self.nonvolatile.battery.follow_in_time()
                return reason

    def watch(self, watches: Sequence[Watch] = (), poll: Callable[[], bool] | None = None) -> None:
        """End `advance` and `until` early from now on, after the tick in which an event occurs.

        An event is a change of a watch, or that `poll` returns True; `poll` is called after every
        tick in which statements were executed that can print or answer.
        """
        set_watches(self.memory, watches)
        self._poll = poll

    def _run(self) -> int:
        """Run the engine to the end of its ticks or the awaited event; returns why it ended."""
        memory, space = self.memory, self.executor.threads.space
        while True:
            reason = _engine_run(
                memory.F, memory.I, memory.S, space.code, space.nums, self._recording.view
            )
            if reason in _TICK_ENDS and self.streams.is_overdue:
                self._take_turns()
            if reason in (loop_cy.DONE, loop_cy.UNTIL_MET, loop_cy.WATCH):
                return reason
            if reason == loop_cy.STOPPED:
                if self._poll is not None and self._poll():
                    return reason
            elif reason == loop_cy.TRACE_FULL:
                self._recording.go_on()
            else:
                self._attend(reason)
                if self._wants_reboot:
                    self._reboot()
                    if self._poll is not None or memory.I[ENGI_BASE + ENGI_WATCH_COUNT]:
                        return loop_cy.WATCH

    def _attend(self, reason: int) -> None:
        """Do the work for which the engine returned to Python."""
        if reason == loop_cy.REQUESTS:
            self.control.scan()
            for name in take_escapes(self.memory):
                self.streams.escape(name)
        elif reason == loop_cy.ROOM:
            self.streams.moves.drain()
        elif reason == loop_cy.NETWORKS:
            self.networks.attend()
            self.streams.settle()
        else:
            self.executor.attend(reason - loop_cy.THREAD)
            self.streams.settle()
        if self._poll is not None or self.streams.is_overdue:
            self._set_engine(ENGI_STOP, 1)

    def _take_turns(self) -> None:
        """Continue with the backlog of host input; stop again in the next tick if any is left."""
        self.streams.take_turns()
        if self._wants_reboot:
            self._reboot()
        if self.streams.is_overdue:
            self._set_engine(ENGI_STOP, 1)

    def record(
        self,
        every_tk: int = 1,
        *,
        keep_peaks: bool = False,
        samples: Sequence[Sample] = (),
    ) -> None:
        """Record all axes, and the chosen samples, once in `every_tk` ticks (1 or more) from now.

        With `keep_peaks` no peak of velocity or following error between two samples is lost:
        samples alternate between the lowest and the highest value since the previous pair.
        """
        if every_tk < 1:
            raise UserError(f"record every {every_tk} ticks: the minimum is 1")
        self._recording.start(every_tk, keep_peaks=keep_peaks, samples=samples)

    def trace(self) -> Trace:
        """The samples recorded so far."""
        return self._recording.trace()

    def take_trace(self) -> Trace:
        """The samples recorded since the last call, which are then dropped."""
        return self._recording.take()
