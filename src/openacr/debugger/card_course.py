"""A debugged card: it runs, stops, steps and goes back.

A session knows no protocol. `run` advances the card and returns why it has stopped; the
present moment then may be before a line, within a tick.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from openacr.controller.controller import Controller
from openacr.debugger import rungs
from openacr.debugger.breakpoints import (
    MASTERS,
    DataBreakpoint,
    Fault,
    LineBreakpoint,
    Watching,
    kill_watch,
    running_watch,
    watches_of,
)
from openacr.debugger.calls import PROGRAMS, is_running, name_of
from openacr.debugger.line_stops import LineStops
from openacr.debugger.stops import Reason, Stop
from openacr.engine.watches import WATCHES
from openacr.errors import UserError
from openacr.timeline import Moment, Timeline


class CardCourse:
    """The card of a debugger."""

    def __init__(
        self,
        card: Controller,
        show: Callable[[str], None] = lambda text: None,
        timeline: Timeline | None = None,
    ) -> None:
        """`show` gets the texts of breakpoints that print, and conditions that fail.

        Without a timeline the history of the card begins now.
        """
        self.card = card
        self.timeline = timeline or Timeline(card)
        self._lines = LineStops(card, show)
        self._rungs: list[LineBreakpoint] = []  # of PLCs
        self._data: list[DataBreakpoint] = []
        self._faults: frozenset[Fault] = frozenset()
        self._stop: Stop | None = None
        self._watching = Watching()
        self._driven: tuple[int, int, int] | None = None  # tick, PLC, line of the last such stop

    # what stops it

    def set_lines(self, breakpoints: list[LineBreakpoint]) -> None:
        """Stop before these lines, after scans that change coils of lines of PLCs; at no others."""
        of_plcs = [each for each in breakpoints if each.program >= PROGRAMS]
        self._require_watches(self._data, of_plcs)
        self._rungs = of_plcs
        self._lines.set_lines(each for each in breakpoints if each.program < PROGRAMS)

    def set_data(self, breakpoints: list[DataBreakpoint]) -> None:
        """Stop at these changes, and no others; UserError for a value that does not exist."""
        self._require_watches(breakpoints, self._rungs)
        self._data = list(breakpoints)

    def _require_watches(self, data: list[DataBreakpoint], of_plcs: list[LineBreakpoint]) -> None:
        """Refuse more than the engine can watch beside all faults and a step."""
        wanted = sum(len(each.watches(self.card)) for each in data)
        wanted += sum(len(rungs.coils(self.card, each.program, each.line)) for each in of_plcs)
        most = WATCHES - PROGRAMS - MASTERS - 1
        if wanted > most:
            raise UserError(f"{wanted} values and coils to be watched: there is room for {most}")

    def set_faults(self, faults: frozenset[Fault]) -> None:
        """Stop at these faults, and no others."""
        self._faults = faults

    @property
    def period_s(self) -> float:
        """The servo period [s]."""
        return self.card.period_s

    @property
    def is_live(self) -> bool:
        """False: time stands with the debugger."""
        return False

    def listen(self, show: Callable[[str], None]) -> None:
        """Show what programs print."""
        self.card.listen(lambda program, text: show(text))

    def entry(self) -> Stop:
        """The stop at the first moment."""
        return Stop(Reason.ENTRY)

    def paused(self, program: int) -> Stop:
        """The stop of a pause."""
        self._lines.steps.clear()
        return Stop(Reason.PAUSE, program)

    def resume(self, program: int) -> None:
        """Do nothing: all go on by `run`."""

    # forward

    def begin_step(self, program: int, *, into: bool = False, out: bool = False) -> None:
        """Let `run` end before the next line of a program.

        Routines that it calls are passed over unless `into`; with `out`, the rest of its own.
        """
        self._lines.begin_step(program, into=into, out=out)

    def run(self, ticks: int) -> Stop | None:
        """Advance by a number of ticks; why it has stopped before their end, or None."""
        end_tk = self.card.lived_tk + ticks
        self._arm()
        try:
            while self.card.lived_tk < end_tk or self.card.within:
                if not self.timeline.advance(end_tk - self.card.lived_tk):
                    return None
                stop = self._stopped()
                if stop is not None:
                    self._lines.steps.clear()
                    return stop
        finally:
            self._disarm()
        return None

    def tick(self) -> Stop:
        """Complete the present tick, or advance by one."""
        self._lines.steps.clear()
        self.timeline.advance(0 if self.card.within else 1)
        return Stop(Reason.STEP, None, "one servo interrupt")

    # back

    def run_back(self) -> Stop:
        """Go back to the last stop before the present, or to the first moment."""
        self._lines.steps.clear()
        return self._seek_stop()

    def step_back(self, program: int) -> Stop:
        """Go back to the line that a program has executed before the present."""
        self._lines.steps = {program: None}
        try:
            return self._seek_stop(only_step=True)
        finally:
            self._lines.steps.clear()

    def tick_back(self) -> Stop:
        """Go back to the end of the servo interrupt before."""
        before = Moment(self.card.lived_tk - 1)
        if before.order < self.timeline.branch.first.order:
            return self._at_first()
        self.timeline.seek(before)
        return Stop(Reason.STEP, None, "one servo interrupt back")

    def seek(self, moment: Moment) -> Stop:
        """Go to any moment of the present branch."""
        self.timeline.seek(moment)
        return Stop(Reason.GOTO)

    def _seek_stop(self, *, only_step: bool = False) -> Stop:
        found: list[Stop] = []

        def counts() -> bool:
            stop = self._stopped()
            if stop is not None:
                found.append(stop)
            return stop is not None

        self._arm(only_step=only_step)
        try:
            there = self.timeline.seek_stop(counts)
        finally:
            self._disarm()
        return found[-1] if there else self._at_first()

    def _at_first(self) -> Stop:
        self.timeline.seek(self.timeline.branch.first)
        return Stop(Reason.ENTRY, None, "the beginning of what is known")

    # stops

    def _arm(self, *, only_step: bool = False) -> None:
        """Let the card stop at what is set now."""
        self._stop = None
        self._watching = Watching()
        if not only_step:
            self._watch()
        for program in self._lines.steps:
            self._watching.add([running_watch(program)], partial(self._ended, program))
        self.card.watch(self._watching.watches)
        programs = self._lines.programs(only_steps=only_step)
        self.card.announce_lines(
            sum(1 << program for program in programs), self._ask if programs else None
        )

    def _watch(self) -> None:
        for each in self._data:
            self._watching.add(each.watches(self.card), partial(self._changed, each))
        for rung in self._rungs:
            driven = rungs.coils(self.card, rung.program, rung.line)
            watches = [watch for coil in driven for watch in watches_of(self.card, f"BIT{coil}")]
            self._watching.add(watches, partial(self._coil_changed, rung, driven))
        if Fault.PROGRAM in self._faults:
            for program in range(PROGRAMS):
                self._watching.add([running_watch(program)], partial(self._ended, program))
        if Fault.KILL in self._faults:
            for master in range(MASTERS):
                self._watching.add([kill_watch(master)], partial(self._killed, master))

    def _disarm(self) -> None:
        self.card.watch()
        self.card.announce_lines()

    def _ask(self, program: int, line: int) -> bool:
        """Whether the card stops before a line."""
        self._stop = self._lines.reason(program, line)
        return self._stop is not None

    def _stopped(self) -> Stop | None:
        """Why `advance` has ended, or None if that is no reason to stop."""
        stop, self._stop = self._stop, None
        fired = self.card.take_fired()
        if self.card.within:
            return stop
        for meaning in dict.fromkeys(self._watching.meanings[place] for place in fired):
            stop = meaning()
            if stop is not None:
                return stop
        return None

    def _changed(self, breakpoint: DataBreakpoint) -> Stop | None:
        if not self._lines.conditions.holds(0, breakpoint.condition):
            return None
        return Stop(Reason.DATA, None, f"{breakpoint.name} has changed")

    def _coil_changed(self, rung: LineBreakpoint, driven: list[int]) -> Stop | None:
        if not self._lines.conditions.are_met(rung, rung.program):
            return None
        self._driven = self.card.lived_tk, rung.program, rung.line
        return Stop(Reason.BREAKPOINT, rung.program, rungs.states(self.card, driven))

    def rung_at(self, plc: int) -> int | None:
        """The line of a PLC (16-23) at which the card stands; None if it stands elsewhere."""
        if self._driven is None or self._driven[:2] != (self.card.lived_tk, plc):
            return None
        return self._driven[2]

    def _killed(self, master: int) -> Stop | None:
        watch = kill_watch(master)
        if not self.card.memory.I[watch.row] & watch.mask:
            return None  # the kill is cleared
        return Stop(Reason.EXCEPTION, None, f"the motion of MASTER{master} is killed")

    def _ended(self, program: int) -> Stop | None:
        failures = self.card.executor.threads.failures
        if is_running(self.card, program):
            return None  # it has started
        if program in failures and Fault.PROGRAM in self._faults:
            return Stop(Reason.EXCEPTION, program, failures[program])
        if program in self._lines.steps:
            return Stop(Reason.STEP, program, f"{name_of(program)} has ended")
        return None
