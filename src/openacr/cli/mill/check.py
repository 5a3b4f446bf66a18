"""`openacr mill check` and `time`: analysis of a part program without a machine."""

import json as json_format
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.mill.trace import Every, ToTrace, require_trace, trace_file
from openacr.wording import counted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from openacr.cnc.interpreter.interpreter import Options
    from openacr.cnc.interpreter.survey import Survey
    from openacr.cnc.program.program import Program
    from openacr.cnc.reading.findings import Finding
    from openacr.mill.plan.estimate.predicting import Prediction, Reader
    from openacr.sysvar import Store

FAILED = 1
S_PER_MIN = 60
CONTEXT_COLUMNS = 72

PartProgram = Annotated[Path, typer.Argument(metavar="FILE.nc", help="Part program.")]
AtStore = Annotated[
    Path | None,
    typer.Option(
        "--store",
        metavar="PATH",
        help="File of the store; default: OPENACR_STORE, then the data folder of the user.",
    ),
]
Dialect = Annotated[
    str | None,
    typer.Option(help="acromill, rs274ngc or auto; default: from the file, the store or features."),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object.")]
Dry = Annotated[bool, typer.Option("--dry", help="DRY RUN: trial speed, M codes without effect.")]


@contextmanager
def opened_store(path: Path | None, *, is_written: bool = False) -> "Iterator[Store]":
    """Open the store of a machine; it is created only for writing."""
    from openacr.sysvar.location import open_to_read, open_to_write

    with (open_to_write if is_written else open_to_read)(path) as store:
        yield store


def loaded(file: Path, store: "Store", dialect: str | None) -> tuple["Program", str]:
    """Load a program with its macros; returns it and the name of its dialect.

    An unusual dialect found by the features of the file is reported on standard error.
    """
    from openacr.mill.plan.estimate.checking import opened

    program, choice = opened(file, store, dialect)
    if choice.is_worth_reporting or (program.errors and choice.is_doubtful):
        typer.echo(f"{file}: {choice.text}", err=True)
    return program, choice.name


def printable(text: str) -> str:
    """A line safe for a terminal: control characters become question marks."""
    return "".join(letter if letter.isprintable() else "?" for letter in text.expandtabs(1))


def in_folder(findings: "list[Finding]", file: Path) -> "list[Finding]":
    """The findings with their files in the folder of `file`, as the user named it."""
    from msgspec.structs import replace

    def placed(name: str) -> str:
        path = file.parent / name
        return str(path) if name == file.name or path.exists() else name

    return [replace(finding, file=placed(finding.file)) for finding in findings]


def show_findings(findings: "list[Finding]") -> None:
    """Every error and warning with its line and a mark at the column."""
    for finding in findings:
        colour = typer.colors.RED if finding.is_error else typer.colors.YELLOW
        typer.secho(printable(str(finding)), fg=colour, err=True)
        block = printable(finding.block)
        if block.strip() and finding.column <= min(len(block), CONTEXT_COLUMNS):
            typer.echo(f"    {block[:CONTEXT_COLUMNS]}", err=True)
            typer.echo("    " + " " * (finding.column - 1) + "^", err=True)


def check_program(
    file: PartProgram,
    store: AtStore = None,
    dialect: Dialect = None,
    as_json: AsJson = False,
) -> None:
    """Find all errors of a part program, and summarize what it does."""
    from openacr.mill.plan.estimate.checking import checked

    with opened_store(store) as cells:
        program, name = loaded(file, cells, dialect)
        with _shown(program, cells, name) as progress:
            survey, prediction = checked(program, cells, name, progress=progress)
    survey.findings = in_folder(survey.findings, file)
    if as_json:
        data = {"dialect": name} | _as_data(survey, prediction) | _planned(prediction)
        typer.echo(json_format.dumps(data, indent=1))
    else:
        show_findings(survey.findings)
        _show_survey(survey, prediction)
        if not survey.errors:
            _show_planned(prediction)
    if survey.errors:
        raise typer.Exit(FAILED)


def time_program(
    file: PartProgram,
    store: AtStore = None,
    dialect: Dialect = None,
    is_dry: Dry = False,
    is_exact: Annotated[
        bool, typer.Option("--exact", help="Ignore the tolerance of G64 P, as a real card does.")
    ] = False,
    as_json: AsJson = False,
    trace: ToTrace = None,
    every_s: Every = None,
) -> None:
    """Predict the run time of a part program from the plan of its moves."""
    from openacr.cnc.interpreter.interpreter import Options
    from openacr.mill.plan.estimate.checking import Watchers, surveyed

    require_trace(trace, every_s)
    with opened_store(store) as cells:
        program, name = loaded(file, cells, dialect)
        options = Options(is_dry=is_dry)
        with (
            _sampled(cells, trace, every_s) as reader,
            _shown(program, cells, name, options) as progress,
        ):
            watchers = Watchers(reader, progress=progress)
            survey, prediction = surveyed(
                program, cells, name, watchers, options=options, rounds=not is_exact
            )
    survey.findings = in_folder(survey.findings, file)
    if survey.errors:
        show_findings(survey.errors)
        if as_json:
            errors = {"errors": survey.data()["errors"]}
            typer.echo(json_format.dumps({"dialect": name} | errors, indent=1))
        raise typer.Exit(FAILED)
    record = _times(prediction)
    if as_json:
        typer.echo(json_format.dumps({"dialect": name} | record, indent=1))
        return
    moves = counted(prediction.moves, "move")
    typer.echo(f"{clock(prediction.time_s)}  ({prediction.time_s:.2f} s, {moves})")
    for key, text in (("feed_s", "cutting"), ("rapid_s", "rapids"), ("dwell_s", "dwells")):
        typer.echo(f"  {text:<8} {record[key]:10.2f} s")


@contextmanager
def _shown(
    program: "Program", cells: "Store", dialect: str, options: "Options | None" = None
) -> "Iterator[Callable[[int], None] | None]":
    """Where paths are planned, a terminal gets an estimate at once and a bar by lines."""
    from openacr.cli.live import online
    from openacr.mill.plan.estimate.checking import estimated

    seconds = estimated(program, cells, dialect, options=options) if is_attended() else None
    if seconds is None:
        yield None
        return
    typer.echo(f"about {clock(seconds)} without jerk; its path is planned now", err=True)
    with online.progress_bar(program.main.text.name) as show:
        last = 0

        def progress(line: int) -> None:
            nonlocal last
            if line != last:  # many moves have the same
                last = line
                show(line, program.line_cnt)

        yield progress


def is_attended() -> bool:
    """Whether standard error is a terminal."""
    return sys.stderr.isatty()


@contextmanager
def _sampled(cells: "Store", path: Path | None, every_s: float | None) -> "Iterator[Reader | None]":
    """A sampler that writes the plan of a program to a trace, if one is requested."""
    if path is None:
        yield None
        return
    from openacr.mill.config.settings import Settings
    from openacr.mill.plan.estimate.trajectory import PERIOD_S, Trajectory

    settings = Settings(cells)
    with trace_file(path, [axis.name for axis in settings.axes]) as write:
        trajectory = Trajectory(settings, every_s or PERIOD_S, write)
        yield trajectory
        trajectory.close()


def _times(prediction: "Prediction") -> dict[str, float]:
    return {
        "time_s": round(prediction.time_s, 4),
        "feed_s": round(prediction.feed_s, 4),
        "rapid_s": round(prediction.rapid_s, 4),
        "dwell_s": round(prediction.dwell_s, 4),
    }


def _planned(prediction: "Prediction") -> dict[str, dict[str, float]]:
    """What jerk and tolerance cost the planned moves, and the line where they cost most."""
    return {
        "planned": {
            "moves": prediction.planned,
            "lost_s": round(prediction.lost_s, 4),
            "line": prediction.slowest_line,
            "line_s": round(prediction.slowest_s, 4),
        }
    }


def _show_planned(prediction: "Prediction") -> None:
    if prediction.planned:
        typer.echo(
            f"planned with tolerance and jerk: {counted(prediction.planned, 'move')},"
            f" {prediction.lost_s:.2f} s more than at their feeds; most at line"
            f" {prediction.slowest_line} ({prediction.slowest_s:.3f} s)"
        )


def _as_data(survey: "Survey", prediction: "Prediction") -> dict[str, Any]:
    data: dict[str, Any] = rounded(survey.data())
    data["time_s"] = None if survey.errors else round(prediction.time_s, 4)
    return data


def rounded(data: Any) -> Any:
    """JSON data with its floats rounded to what they mean: 9 significant digits."""
    if isinstance(data, float):
        return float(f"{data:.9g}")
    if isinstance(data, dict):
        return {key: rounded(value) for key, value in data.items()}
    return [rounded(value) for value in data] if isinstance(data, list) else data


def _show_survey(survey: "Survey", prediction: "Prediction") -> None:
    counts = survey.move_cnts
    typer.echo(
        ", ".join(
            (
                counted(survey.line_cnt, "line"),
                counted(len(survey.errors), "error"),
                counted(len(survey.warnings), "warning"),
            )
        )
    )
    if survey.errors:
        return
    typer.echo(
        "moves: "
        + ", ".join(
            counted(counts[kind], noun)
            for kind, noun in (
                ("feed", "line"),
                ("arc", "arc"),
                ("rapid", "rapid"),
                ("dwell", "dwell"),
            )
        )
    )
    lengths, unit = survey.shown_lengths, survey.unit
    typer.echo(
        f"length: {lengths['feed']:.4g} {unit} at feed, {lengths['rapid']:.4g} {unit} at rapid"
    )
    for letter, axis in survey.letters.items():
        low, high = (survey.shown(letter, ends[axis]) for ends in (survey.low, survey.high))
        if low < high:
            typer.echo(f"  {letter}: {low:.4f} to {high:.4f} {survey.unit_of(letter)}")
    if survey.tools:
        typer.echo("tools: " + " ".join(map(str, survey.tools)))
    typer.echo(f"time: {clock(prediction.time_s)}")


def clock(seconds: float) -> str:
    """A time as h:mm:ss or m:ss."""
    minutes, rest = divmod(round(seconds), S_PER_MIN)
    hours, minutes = divmod(minutes, S_PER_MIN)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
