"""One run from its first tick to its last line of output."""

import sys
import time
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

from openacr.cli.results import Event, Watched
from openacr.cli.run import card_view, output
from openacr.cli.run.machine import Machine, MachineWorld
from openacr.cli.run.progress import Bar, bar_for
from openacr.cli.run.report import (
    Report,
    report_on,
    show_failures,
    show_report,
    show_verdicts,
    summary,
)
from openacr.cli.signals import terminations_as_interrupts
from openacr.compiled import is_compiled
from openacr.lang.characters import shown
from openacr.scenario import Condition, Play, Scenario

SCAN_S = 0.05  # the slow scan of the card: time between two looks whether it is idle
LOOK_S = 0.5  # between two looks at the progress bar
BAR_S = 0.1  # of real time between two changes of the bar
IDLE_S = 0.1  # a card is idle when nothing ran or moved for two slow scans
TRACE_SAMPLES = 400_000  # per axis at most: every tick for 200 s at the default period
PLOT_SAMPLES = 40_000  # far more than a picture has pixels; peaks between them are kept
TABLE_COLUMNS = 72
MOST_EVENTS = 200  # of a run; what repeats in every period says no more
OK, FAILED, INTERRUPTED = 0, 1, 130


class Stop(Enum):
    """Why a run ended."""

    TIME = "time"
    BIT = "bit"
    IDLE = "idle"
    INTERRUPT = "interrupt"


@dataclass(frozen=True, slots=True)
class Until:
    """When a run ends before its time: a flag has a state, or nothing happens any more."""

    bit: int | None = None
    is_on: bool = True

    def __str__(self) -> str:
        if self.bit is None:
            return "idle"
        return f"BIT{self.bit} {'set' if self.is_on else 'clear'}"


@dataclass(frozen=True, slots=True)
class Options:
    """How long and how fast a run is, and which files it writes."""

    project: Path
    limit_s: float
    until: Until | None = None
    realtime: bool = False
    trace: Path | None = None
    trace_every_tk: int | None = None
    plot: Path | None = None
    watched: tuple[Watched, ...] = ()
    summary: Path | None = None
    is_quiet: bool = False
    is_json: bool = False


class Session:
    """One run from its first tick to its last line of output."""

    def __init__(
        self,
        options: Options,
        machine: Machine,
        scenario: Scenario | None,
    ) -> None:
        self._options = options
        self._machine = machine
        self._until = options.until
        self._limit_s = options.limit_s
        self._play = Play(scenario or Scenario(), machine.period_s)
        self._has_scenario = scenario is not None
        self._world = MachineWorld(machine)
        # The run counts from here, whatever the loading took.
        self._begin_tk = machine.tick
        self._end_tk = machine.tick + max(1, round(options.limit_s / machine.period_s))
        self._scan_tk = max(1, round(SCAN_S / machine.period_s))
        self._busy_tk = machine.tick
        self._was_other = False
        self._watched: tuple[Condition, ...] | None = None
        self._events: list[Event] = []
        self._has_lost_events = False
        self._sees_every_tick = False

    def run(self) -> int:
        """Let the card live, write and show what came out, and give the exit code."""
        if not is_compiled:
            self._note("no compiled core is used: running the slower pure-Python kernel")
        self._prepare()
        with terminations_as_interrupts():
            stop, wall_s = self._live()
        has_failed = self._conclude(wall_s)
        if stop is Stop.INTERRUPT:
            return INTERRUPTED
        return FAILED if has_failed else OK

    def _prepare(self) -> None:
        """Connect what listens to the card and records it."""
        self._machine.listen(self._hear, self._play.heard)
        if not self._has_scenario:
            self._start()
        lived_tk, watched = self._end_tk - self._begin_tk, self._options.watched
        if self._options.trace:
            every_tk = self._options.trace_every_tk or -(-lived_tk // TRACE_SAMPLES)
            self._machine.record(every_tk, keep_peaks=False, watched=watched)
        elif self._options.plot:
            every_tk = -(-lived_tk // PLOT_SAMPLES)
            self._machine.record(every_tk, keep_peaks=every_tk > 1, watched=watched)

    def _start(self) -> None:
        """Start the stored programs unless one runs already."""
        memory = self._machine.memory
        stored = [p for p in card_view.PROGRAMS if card_view.has_program(memory, p)]
        if stored and not card_view.running_programs(memory):
            names = ", ".join(f"PROG{program}" for program in stored)
            self._note(f"no program starts by itself: starting {names} as RUN ALL does")
            self._machine.start_all()

    def _hear(self, text: str) -> None:
        self._play.heard(text)
        # Looked up each time: the bar takes the place of these streams while it shows.
        # With --json standard output holds the summary and nothing else.
        stream = sys.stderr if self._options.is_json else sys.stdout
        stream.write(text.replace("\r\n", "\n"))
        if self._options.realtime:
            stream.flush()

    def _live(self) -> tuple[Stop, float]:
        """Let the card live until the run is over; why it is, and the real seconds it took."""
        with bar_for(sys.stderr, self._limit_s, is_wanted=not self._options.is_quiet) as bar:
            started_s = time.perf_counter()
            try:
                stop = self._pace(bar, started_s)
            except KeyboardInterrupt:
                stop = Stop.INTERRUPT
            wall_s = time.perf_counter() - started_s
        sys.stdout.flush()
        if stop is Stop.INTERRUPT:
            lived_s = self._world.tick * self._machine.period_s
            self._note(f"interrupted after {lived_s:g} s; the results end there")
        else:
            self._play.finish(self._world)
        if stop is Stop.TIME and self._until is not None:
            self._note(f"{self._until} was not reached within {self._limit_s:g} s")
        return stop, wall_s

    def _pace(self, bar: Bar, started_s: float) -> Stop:
        machine = self._machine
        shown_s = 0.0
        while True:
            self._play.step(self._world)
            if stop := self._reached():
                return stop
            self._watch()
            is_over = self._advance(self._next_tick() - machine.tick)
            self._tell_events()
            if is_over:
                self._play.step(self._world)
                return Stop.BIT
            lived_s = (machine.tick - self._begin_tk) * machine.period_s
            wall_s = max(1e-9, time.perf_counter() - started_s)
            if self._options.realtime and lived_s > wall_s:
                time.sleep(lived_s - wall_s)
            if wall_s - shown_s >= BAR_S:
                shown_s = wall_s
                running = card_view.running_programs(machine.memory)
                bar.show(lived_s, lived_s / wall_s, running)

    def _tell_events(self) -> None:
        """Show what has happened to the machine, as it happens."""
        for event in self._machine.events():
            if len(self._events) < MOST_EVENTS:
                self._events.append(event)
                self._note(str(event))
            elif not self._has_lost_events:
                self._has_lost_events = True
                self._note(f"more than {MOST_EVENTS} events: the rest is not shown")

    def _watch(self) -> None:
        """Have the card watch what the scenario waits for, or look at every tick instead."""
        conditions = self._play.conditions
        if conditions != self._watched or self._machine.has_new_events():
            self._watched = conditions
            self._sees_every_tick = not self._machine.watch(conditions)

    def _next_tick(self) -> int:
        """How far the card may run before the next look."""
        now = self._machine.tick
        if self._sees_every_tick:
            return now + 1
        is_scanned = self._until == Until() or self._options.realtime
        look_tk = self._scan_tk if is_scanned else max(1, round(LOOK_S / self._machine.period_s))
        known = self._play.next_tick(self._world.tick)
        planned_tk = self._end_tk if known is None else self._begin_tk + known
        return min(self._end_tk, now - now % look_tk + look_tk, planned_tk)

    def _advance(self, ticks: int) -> bool:
        """Let the card live; True when the flag to wait for has come."""
        until, machine = self._until, self._machine
        if until is None or until.bit is None:
            machine.advance(ticks)
            return False
        # A flag that is to be clear has to be set first: at power-up nearly all are clear.
        if not until.is_on and not self._was_other:
            self._was_other = machine.advance_until(until.bit, True, ticks)
            return False
        return machine.advance_until(until.bit, until.is_on, ticks)

    def _reached(self) -> Stop | None:
        machine = self._machine
        if machine.tick >= self._end_tk:
            return Stop.TIME
        # Only the ticks of the slow scan count, whatever else the run was stopped for.
        if self._until != Until() or machine.tick % self._scan_tk:
            return None
        play = self._play
        awaits_more = play.conditions or play.next_tick(self._world.tick) is not None
        if awaits_more or not card_view.is_idle(machine.memory):
            self._busy_tk = machine.tick
        quiet_s = (machine.tick - self._busy_tk) * machine.period_s
        return Stop.IDLE if quiet_s >= IDLE_S else None

    def _conclude(self, wall_s: float) -> bool:
        """Write the files and print the table; True if something has failed."""
        report = report_on(self._machine, self._begin_tk, wall_s)
        report = replace(report, events=tuple(self._events))
        if self._has_scenario:
            period_s = self._machine.period_s
            times = {name: tick * period_s for name, tick in self._play.checkpoints.items()}
            verdicts = tuple(self._play.verdicts)
            unjudged = tuple(self._play.unjudged)
            report = replace(report, verdicts=verdicts, unjudged=unjudged, checkpoints_s=times)
        self._show(report)
        self._write(report)
        return report.has_failed

    def _write(self, report: Report) -> None:
        options = self._options
        if options.summary:
            output.write_summary(options.summary, summary(report))
        if options.trace or options.plot:
            curves = self._machine.curves(shown(options.project.resolve().stem))
            curves = replace(curves, events=report.events)
            if options.trace:
                output.write_trace(options.trace, curves)
            if options.plot:
                from openacr.cli.plots import draw

                output.write_whole(options.plot, lambda partial: draw(curves, partial))

    def _show(self, report: Report) -> None:
        from rich.console import Console

        if self._options.is_json:
            sys.stdout.write(output.summary_text(summary(report)))
        elif not self._options.is_quiet:
            # Rather lines that the terminal wraps than tables that hide their numbers.
            show_report(report, Console(width=max(TABLE_COLUMNS, Console().width)))
        show_failures(report, Console(stderr=True))
        show_verdicts(report, Console(stderr=True))
        for moment in self._play.idle_actions:
            self._note(f"an action of the scenario never came: {moment}")

    def _note(self, text: str) -> None:
        if not self._options.is_quiet:
            print(f"note: {text}", file=sys.stderr)
