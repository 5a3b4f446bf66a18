"""What is left to say when a run is over: the closing table and the summary."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from openacr.cli.results import AxisReport, Event
from openacr.lang.characters import shown
from openacr.scenario import State, Verdict, card_view
from openacr.scenario.played import Failure

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from openacr.cli.run.controlled import ControlledMachine


@dataclass(frozen=True, slots=True)
class ProgramReport:
    """One program at the end of a run."""

    number: int
    state: State
    line: int
    failure: Failure | None


@dataclass(frozen=True, slots=True)
class Report:
    """The outcome of a run."""

    time_s: float
    ticks: int
    digest: str
    speed: float
    axes: tuple[AxisReport, ...]
    programs: tuple[ProgramReport, ...]
    flags: tuple[int, ...]
    verdicts: tuple[Verdict, ...] = ()
    unjudged: tuple[str, ...] = ()  # expectations whose moment an interrupted run did not reach
    checkpoints_s: dict[str, float] = field(default_factory=dict)
    events: tuple[Event, ...] = ()

    @property
    def has_failed(self) -> bool:
        """Whether a program ended in an error or an expectation was not met."""
        return any(p.failure for p in self.programs) or any(not v.ok for v in self.verdicts)


def report_on(machine: "ControlledMachine", begin_tk: int, wall_s: float) -> Report:
    """Collect the outcome of a run that began at a tick and took `wall_s` of real time."""
    ticks = machine.clock.lived_tk - begin_tk
    time_s = ticks * machine.clock.period_s
    memory = machine.memory
    attached = card_view.masters_of_axes(memory)
    return Report(
        time_s=time_s,
        ticks=ticks,
        digest=machine.digest(),
        speed=time_s / wall_s if wall_s > 0.0 else 0.0,
        axes=tuple(
            axis
            for axis in machine.axis_reports()
            if axis.number in attached or axis.distance_u > 0.0
        ),
        programs=tuple(
            _program(machine, number)
            for number in card_view.PROGRAMS
            if card_view.has_program(memory, number)
        ),
        flags=tuple(card_view.set_flags(memory)),
    )


def _program(machine: "ControlledMachine", number: int) -> ProgramReport:
    memory = machine.memory
    failure = machine.failure(number) if card_view.has_failed(memory, number) else None
    state, line = card_view.program_state(memory, number), card_view.program_line(memory, number)
    return ProgramReport(number, state, line, failure)


def summary(report: Report) -> dict[str, Any]:
    """Give the report as the stable structure of the summary file."""
    result: dict[str, Any] = {
        "time_s": report.time_s,
        "ticks": report.ticks,
        "digest": report.digest,
        "speed": round(report.speed, 3),
        "axes": {
            str(axis.number): {
                "position": axis.position_u,
                "actual": axis.actual_u,
                "peak_velocity": axis.peak_velocity_ups,
                "peak_following_error": axis.peak_following_error_u,
            }
            for axis in report.axes
        },
        "programs": {
            str(program.number): {
                "state": program.state.value,
                "line": program.line,
                "error": program.failure.error if program.failure else None,
                "file": program.failure.file if program.failure else None,
                "file_line": program.failure.file_line if program.failure else None,
            }
            for program in report.programs
        },
        "flags": list(report.flags),
        "events": [_event(event) for event in report.events],
    }
    if report.verdicts or report.unjudged or report.checkpoints_s:
        result["scenario"] = {
            "checkpoints": report.checkpoints_s,
            "expectations": [_verdict(verdict) for verdict in report.verdicts],
            "not_reached": list(report.unjudged),
        }
    return result


def _event(event: Event) -> dict[str, Any]:
    return {
        "time_s": event.time_s,
        "text": event.text,
        "flag": event.flag,
        "program": event.program,
    }


def _verdict(verdict: Verdict) -> dict[str, Any]:
    return {
        "name": verdict.name,
        "ok": verdict.ok,
        "expected": verdict.expected,
        "found": verdict.actual,
        "time_s": verdict.time_s,
    }


def show_report(report: Report, console: "Console") -> None:
    """Print the closing tables."""
    if report.axes:
        console.print(_axis_table(report.axes))
    if report.programs:
        console.print(_program_table(report.programs))
    if not report.axes and not report.programs:
        console.print("no axis is attached and no program is stored")
    console.print(
        f"{report.time_s:.4f} s simulated in {report.ticks} ticks, "
        f"{_times(report.speed)} real time, digest {report.digest}",
        highlight=False,
        soft_wrap=True,
    )


def show_failures(report: Report, console: "Console") -> None:
    """Print what ended programs with an error, and the line that did."""
    for program in report.programs:
        if (failure := program.failure) is not None:
            place = f"{failure.place}: " if failure.place else ""
            text = f"error: {place}PROG{program.number} line {program.line}: {failure.error}"
            text += f"\n    {failure.text}" if failure.text else ""
            console.print(text, style="red", highlight=False, markup=False, soft_wrap=True)


def show_verdicts(report: Report, console: "Console") -> None:
    """Print how the expectations of the scenario came out; every failed one in full."""
    if not report.verdicts and not report.unjudged:
        return
    failed = [verdict for verdict in report.verdicts if not verdict.ok]
    for verdict in failed:
        text = f"failed: {shown(str(verdict))}"
        console.print(text, style="red", highlight=False, markup=False, soft_wrap=True)
    met = len(report.verdicts) - len(failed)
    text = f"{met} of {len(report.verdicts) + len(report.unjudged)} expectations met"
    if report.unjudged:
        text += f", {len(report.unjudged)} not reached"
    console.print(text, highlight=False)


def _times(speed: float) -> str:
    return f"{speed:.0f} times" if speed >= 10 else f"{speed:.2g} times"


def _table(*columns: str) -> "Table":
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD)
    for index, column in enumerate(columns):
        table.add_column(column, justify="left" if index == 0 else "right", no_wrap=True)
    return table


def _axis_table(axes: Iterable[AxisReport]) -> "Table":
    table = _table("axis", "position", "distance", "peak velocity", "peak following error")
    for axis in axes:
        values = (axis.position_u, axis.distance_u, axis.peak_velocity_ups)
        table.add_row(
            str(axis.number),
            *(f"{value:.4f}" for value in values),
            f"{axis.peak_following_error_u:.6f}",
        )
    return table


def _program_table(programs: Iterable[ProgramReport]) -> "Table":
    table = _table("program", "state", "line", "error")
    table.columns[1].justify = table.columns[3].justify = "left"
    table.columns[3].no_wrap = False
    for program in programs:
        error = f"[red]{program.failure.error}[/red]" if program.failure else ""
        table.add_row(f"PROG{program.number}", program.state.value, str(program.line), error)
    return table
