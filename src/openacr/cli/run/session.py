"""One run from its first tick to its last line of output."""

import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from openacr.cli.results import Event, Watched
from openacr.cli.run import output
from openacr.cli.run.controlled import ControlledMachine
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
from openacr.errors import UserError
from openacr.lang.characters import shown
from openacr.scenario import Scenario, card_view
from openacr.scenario.course import Course, Stop, Until, stored_but_idle

BAR_S = 0.1  # of real time between two changes of the bar
TRACE_SAMPLES = 400_000  # per axis at most: every tick for 200 s at the default period
PLOT_SAMPLES = 40_000  # far more than a picture has pixels; peaks between them are kept
TABLE_COLUMNS = 72
MOST_EVENTS = 200  # of a run; what repeats in every period says no more
OK, FAILED, INTERRUPTED = 0, 1, 130


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
        machine: ControlledMachine,
        scenario: Scenario | None,
    ) -> None:
        self._options = options
        self._machine = machine
        self._course = Course(
            machine, scenario, options.limit_s, options.until, is_paced=options.realtime
        )
        self._play = self._course.play
        self._has_scenario = scenario is not None
        self._events: list[Event] = []
        self._has_lost_events = False

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
        lived_tk = self._course.end_tk - self._course.begin_tk
        watched = self._options.watched
        if self._options.trace:
            every_tk = self._options.trace_every_tk or -(-lived_tk // TRACE_SAMPLES)
            self._machine.record(every_tk, keep_peaks=False, watched=watched)
        elif self._options.plot:
            every_tk = -(-lived_tk // PLOT_SAMPLES)
            self._machine.record(every_tk, keep_peaks=every_tk > 1, watched=watched)

    def _start(self) -> None:
        """Start the stored programs unless one runs already."""
        if stored := stored_but_idle(self._machine):
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
        with bar_for(
            sys.stderr, self._options.limit_s, is_wanted=not self._options.is_quiet
        ) as bar:
            started_s = time.perf_counter()
            try:
                stop = self._pace(bar, started_s)
            except KeyboardInterrupt:
                stop = Stop.INTERRUPT
            wall_s = time.perf_counter() - started_s
        sys.stdout.flush()
        if stop is Stop.INTERRUPT:
            self._note(f"interrupted after {self._course.lived_s:g} s; the results end there")
        else:
            self._play.finish(self._course.world)
        until, limit_s = self._options.until, self._options.limit_s
        if stop is Stop.TIME and until is not None:
            self._note(f"{until} was not reached within {limit_s:g} s")
        return stop, wall_s

    def _pace(self, bar: Bar, started_s: float) -> Stop:
        shown_s = 0.0
        while True:
            stop = self._course.step()
            if stop in (Stop.TIME, Stop.IDLE):
                return stop
            self._tell_events()
            if stop is not None:
                return stop
            lived_s = self._course.lived_s
            wall_s = max(1e-9, time.perf_counter() - started_s)
            if self._options.realtime and lived_s > wall_s:
                time.sleep(lived_s - wall_s)
            if wall_s - shown_s >= BAR_S:
                shown_s = wall_s
                running = card_view.running_programs(self._machine.memory)
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

    def _conclude(self, wall_s: float) -> bool:
        """Write the files and print the table; True if something has failed."""
        report = report_on(self._machine, self._course.begin_tk, wall_s)
        report = replace(report, events=tuple(self._events))
        if self._has_scenario:
            period_s = self._machine.clock.period_s
            times = {name: tick * period_s for name, tick in self._play.checkpoints.items()}
            verdicts = tuple(self._play.verdicts)
            unjudged = tuple(self._play.unjudged)
            report = replace(report, verdicts=verdicts, unjudged=unjudged, checkpoints_s=times)
        self._show(report)
        self._write(report)
        return report.has_failed

    def _write(self, report: Report) -> None:
        """Write the files; one that cannot be written leaves the others alone."""
        failures: list[UserError] = []
        for write in self._files(report):
            try:
                write()
            except UserError as failure:
                failures.append(failure)
        for earlier in failures[:-1]:
            print(f"error: {earlier}", file=sys.stderr)
        if failures:
            raise failures[-1]

    def _files(self, report: Report) -> Iterator[Callable[[], None]]:
        options = self._options
        if options.summary:
            yield partial(output.write_summary, options.summary, summary(report))
        if options.trace or options.plot:
            curves = self._machine.curves(shown(options.project.resolve().stem))
            curves = replace(curves, events=report.events)
            if options.trace:
                yield partial(output.write_trace, options.trace, curves)
            if options.plot:
                from openacr.cli.plots import draw

                yield partial(output.write_whole, options.plot, partial(draw, curves))

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
