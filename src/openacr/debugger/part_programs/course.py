"""A part program on the virtual card of its machine: it runs, stops, steps and goes back.

The program runs as in `openacr mill run`: stopping lets time stand still and changes nothing of
the motion. The runner reads and sends ahead of the machine and lives at the latest moment only.
Going back takes the card back, whose inputs are in its timeline; what the program was at each
block is in the log of blocks, with the tick at which the machine came to it.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence

from openacr.debugger.breakpoints import DataBreakpoint, Fault, LineBreakpoint
from openacr.debugger.conditions import Conditions
from openacr.debugger.part_programs.blocks import MOST_BLOCKS, BlockLog
from openacr.debugger.part_programs.run import LiveRun
from openacr.debugger.stops import Reason, Stop
from openacr.errors import UserError
from openacr.timeline import Moment, Timeline

AT_ONCE_S = 10.0  # card time in which a program comes to its first block


def not_watched(name: str) -> UserError:
    """Changes of values are watched on cards alone."""
    return UserError(f"{name}: no value is watched while a part program is debugged")


class PartCourse:
    """The run of a part program, in both directions; `at` is the present block."""

    def __init__(
        self,
        live: LiveRun,
        log: BlockLog,
        timeline: Timeline,
        texts: Callable[[], Sequence[str]],
        answer: Callable[[int, str], str],
        show: Callable[[str], None],
    ) -> None:
        """`texts` gives the names of the texts of the program, in the order of their numbers.

        `answer` gives the value of an expression before a block acts (UserError if it has none),
        `show` gets the texts of breakpoints that print, and conditions that fail.
        """
        self.live, self.log, self.timeline = live, log, timeline
        self.at = 0
        self.most_blocks = MOST_BLOCKS
        self._texts = texts
        self._conditions = Conditions(answer, show)
        self._lines: dict[tuple[str, int], LineBreakpoint] = {}
        self._stops_at_alarms = False
        self._alarm_cnt = 0
        self._step: Callable[[int], bool] | None = None  # whether it ends at a block

    # what stops it

    def set_lines(self, breakpoints: list[LineBreakpoint]) -> None:
        """Stop before these lines, and no others."""
        names = self._texts()
        self._lines = {(names[each.program], each.line): each for each in breakpoints}

    def set_data(self, breakpoints: list[DataBreakpoint]) -> None:
        """Refuse all but none."""
        for each in breakpoints:
            raise not_watched(each.name)

    def set_faults(self, faults: frozenset[Fault]) -> None:
        """Stop at alarms, or not."""
        self._stops_at_alarms = Fault.PROGRAM in faults

    @property
    def period_s(self) -> float:
        """The servo period [s]."""
        return self.live.card.period_s

    @property
    def is_live(self) -> bool:
        """False: time stands with the debugger."""
        return False

    def listen(self, show: Callable[[str], None]) -> None:
        """Show what programs of the card print."""
        self.live.card.listen(lambda program, text: show(text))

    def entry(self) -> Stop:
        """Come to the first block."""
        self.live.advance(round(AT_ONCE_S / self.live.card.period_s), until=self._has_begun)
        return Stop(Reason.ENTRY)

    def _has_begun(self) -> bool:
        return self.live.reached_cnt > 0

    def paused(self, owner: int) -> Stop:
        """The stop of a pause."""
        self._step = None
        return Stop(Reason.PAUSE, owner)

    def resume(self, owner: int) -> None:
        """Do nothing: all go on by `run`."""

    # forward

    def begin_step(self, owner: int, *, into: bool = False, out: bool = False) -> None:
        """Let `run` end at the next block; routines are passed over unless `into`."""
        depth = len(self.log[self.at].callers) - (1 if out else 0)
        self._step = lambda block: into or len(self.log[block].callers) <= depth

    def run(self, ticks: int) -> Stop | None:
        """Advance by a number of ticks; why it has stopped before their end, or None."""
        end_tk = self.live.card.lived_tk + ticks
        while True:
            stop = self._next_stop(end_tk)
            if stop is not None:
                self._step = None
                return stop
            if self.live.card.lived_tk >= end_tk:
                return None
            self._advance(end_tk)

    def _next_stop(self, end_tk: int) -> Stop | None:
        """Go to the next block that stops among those that are reached by a tick."""
        last = self._reached_by(end_tk)
        while self.at < last:
            self.at += 1
            stop = self._stop_at(self.at)
            if stop is not None:
                self._go_to(self.live.reached_tk(self.at))
                return stop
        if self.timeline.is_past:
            return None
        if self._stops_at_alarms and self.live.alarms > self._alarm_cnt:
            return self._alarmed()
        return None if self.live.is_busy else self._ended()

    def _alarmed(self) -> Stop:
        self._alarm_cnt = self.live.alarms
        return Stop(Reason.EXCEPTION, 0, self.live.last_alarm)

    def _ended(self) -> Stop:
        return Stop(Reason.END, 0, "the part program has ended")

    def _stop_at(self, block: int) -> Stop | None:
        """Why it stops before a block; None if it does not."""
        is_met = self._is_met(block)
        if self._step is not None and self._step(block):
            return Stop(Reason.STEP, 0)
        return Stop(Reason.BREAKPOINT, 0) if is_met else None

    def _is_met(self, block: int) -> bool:
        """Whether a breakpoint stops before a block; the card goes there to see."""
        found = self._lines.get(self.log[block].place)
        if found is None:
            return False
        self._go_to(self.live.reached_tk(block))
        return self._conditions.are_met(found, block)

    def tick(self) -> Stop:
        """Advance by one servo interrupt; where the runner acts, to the end of what it does."""
        self._step = None
        self._advance(self.live.card.lived_tk + 1)
        self.at = max(self.at, self._reached_by(self.live.card.lived_tk))
        return Stop(Reason.STEP, 0, "one servo interrupt")

    def _advance(self, end_tk: int) -> None:
        """Advance to a tick, in the past at most to the end of what is known."""
        card, timeline = self.live.card, self.timeline
        if timeline.is_past:
            last_tk = timeline.branch.last.tick
            timeline.advance(min(end_tk, last_tk) - card.lived_tk)
            card.streams.discard_output()  # the runner has read it already
        else:
            self._forget()
            known = self.live.reached_cnt
            self.live.advance(
                end_tk - card.lived_tk,
                until=lambda: self.live.reached_cnt > known or not self.live.is_busy,
            )

    def _forget(self) -> None:
        """Drop the earliest blocks where there are twice as many as are kept."""
        before = self.at - self.most_blocks
        if before - self.log.first > self.most_blocks:
            self.log.forget(before)
            self.live.forget(before)

    # back

    def step_back(self, owner: int) -> Stop:
        """Go back to the beginning of the present block, or from there to the block before."""
        if self.live.card.lived_tk == self.live.reached_tk(self.at):
            if self.at == self.log.first:
                return self._at_first()
            self.at -= 1
        self._go_to(self.live.reached_tk(self.at))
        return Stop(Reason.STEP, owner)

    def run_back(self) -> Stop:
        """Go back to the last breakpoint before the present, or to the first block."""
        is_within = self.live.card.lived_tk > self.live.reached_tk(self.at)
        for block in range(self.at - (0 if is_within else 1), self.log.first - 1, -1):
            if self._is_met(block):
                self.at = block
                return Stop(Reason.BREAKPOINT, 0)
        return self._at_first()

    def tick_back(self) -> Stop:
        """Go back to the end of the servo interrupt before."""
        before_tk = self.live.card.lived_tk - 1
        if before_tk < self.live.reached_tk(self.log.first):
            return self._at_first()
        return self.seek(Moment(before_tk), Stop(Reason.STEP, 0, "one servo interrupt back"))

    def seek(self, moment: Moment, stop: Stop | None = None) -> Stop:
        """Go to any tick since the first block."""
        if moment.tick < self.live.reached_tk(self.log.first):
            raise UserError(f"tick {moment.tick} is before the first block that is known")
        self._go_to(moment.tick)
        self.at = self._reached_by(moment.tick)
        return stop or Stop(Reason.GOTO)

    def _at_first(self) -> Stop:
        self.at = self.log.first
        self._go_to(self.live.reached_tk(self.at))
        return Stop(Reason.ENTRY, 0, "the beginning of what is known")

    def _go_to(self, tick: int) -> None:
        if tick != self.live.card.lived_tk:
            self.timeline.seek(tick)

    def _reached_by(self, tick: int) -> int:
        """The last block that the machine had come to at a tick."""
        return bisect_right(
            range(self.log.first, self.live.reached_cnt), tick, key=self.live.reached_tk
        ) + self.log.first - 1  # fmt: skip
