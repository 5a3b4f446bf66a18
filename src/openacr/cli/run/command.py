"""`openacr run`: run a project in simulated time, show and write what came out.

Everything the user said is checked before anything runs: the project, the scenario, and
that every result can be written.
"""

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.conversions import given_quantity
from openacr.cli.refusals import failed_json
from openacr.cli.run.watched import watched
from openacr.errors import UserError
from openacr.lang.characters import shown
from openacr.project import decode, find_project

if TYPE_CHECKING:
    from collections.abc import Sequence

    from openacr.errors import SourceError
    from openacr.scenario import Scenario
    from openacr.scenario.course import Until

BAD_INPUT = 2
MOST_S = 1e7  # some 116 days of a machine


def run(
    project: Annotated[
        Path, typer.Argument(metavar="PROJECT", help="Project folder or controller file (.8k).")
    ],
    for_text: Annotated[
        str | None,
        typer.Option("--for", metavar="TIME", help="Limit of the simulated time: 90, 10min, 2h."),
    ] = None,
    until: Annotated[
        str | None,
        typer.Option(
            metavar="BIT|idle",
            help="End when a flag is set (516), is clear again (-516), or nothing runs or moves.",
        ),
    ] = None,
    realtime: Annotated[bool, typer.Option("--realtime", help="No faster than real time.")] = False,
    scenario: Annotated[
        Path | None, typer.Option(help="Inputs, actions, expectations; default: the project's.")
    ] = None,
    trace: Annotated[
        Path | None, typer.Option(help="Write the motion of all axes (.csv, .parquet).")
    ] = None,
    trace_every: Annotated[
        int | None,
        typer.Option(
            metavar="TICKS",
            min=1,
            help="Ticks between two rows of the trace; default: 1, more for runs above 200 s.",
        ),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the motion of all axes (.png, .svg, .html).")
    ] = None,
    watch: Annotated[
        list[str] | None,
        typer.Option(
            metavar="P12290|BIT516|IN3|OUT0|NAME",
            help="Also trace and plot this parameter, flag, input or output; may be repeated.",
        ),
    ] = None,
    summary: Annotated[Path | None, typer.Option(help="Write the outcome as JSON.")] = None,
    journal: Annotated[
        Path | None, typer.Option(help="Write all inputs of the card, for `openacr replay`.")
    ] = None,
    keep_going: Annotated[
        bool, typer.Option("--keep-going", help="Run even if the card refuses lines of a file.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", help="Show only the output of the programs.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the outcome as JSON, program output on stderr.")
    ] = False,
) -> None:
    """Run a project: as fast as possible, or paced by the wall clock.

    Programs that begin with PBOOT start by themselves. If none does and there is no
    scenario, all programs are started as RUN ALL does; with a scenario it is the scenario
    that starts them.

    Without --for and --until the run ends when no program runs and nothing moves, or after
    600 simulated seconds. Exit code 1: a program ended in an error or an expectation
    failed; 2: something about the input is wrong.
    """
    for_s = None if for_text is None else given_quantity("--for", for_text, "s")
    found = find_project(project)
    wanted = parse_until(until)
    check_outputs(trace, plot, summary, journal)
    chosen = watched(watch or [])
    if chosen and not (trace or plot):
        raise UserError("--watch: nothing shows the values; give --trace or --plot, too")

    from openacr.cli.run.session import Options, Session  # heavy: not for a slip above
    from openacr.scenario import load_scenario
    from openacr.scenario.course import Until

    scenario_path = scenario or found.scenario
    story = load_scenario(scenario_path) if scenario_path else None
    if wanted is None and for_s is None and not (story and story.duration_s):
        wanted = Until()
    options = Options(
        project=project,
        limit_s=limit_s(for_s, story),
        until=wanted,
        realtime=realtime,
        trace=trace,
        trace_every_tk=trace_every,
        plot=plot,
        watched=chosen,
        summary=summary,
        is_quiet=quiet,
        is_json=as_json,
    )
    from openacr.cli.run.controlled import load

    machine, refused = load(found)
    show_refused(refused, "warning" if keep_going else "error")
    if refused and not keep_going:
        typer.echo(f"`openacr check {project}` shows more about each", err=True)
        if as_json:
            typer.echo(failed_json(refused))
        raise typer.Exit(BAD_INPUT)
    if found.machine is None:
        _note_open_inputs(project, machine.closed_switches())
    session = Session(options, machine, story)
    with machine.journalled(journal, found) if journal else nullcontext():
        code = session.run()
    raise typer.Exit(code)


def _note_open_inputs(project: Path, switches: dict[int, list[int]]) -> None:
    """Say that without a machine nothing closes the limit switches that the set-up expects."""
    if switches:
        axes = ", ".join(map(str, switches))
        inputs = ", ".join(str(number) for each in switches.values() for number in each)
        typer.echo(
            f"note: {project} has no machine.toml, so inputs {inputs} are open: to the set-up these"
            f" are limit switches that have been reached (axes {axes}), and nothing moves"
            f" (`openacr configure --machine {project}` prints a first machine.toml)",
            err=True,
        )


def show_refused(refused: "Sequence[SourceError]", word: str) -> None:
    """Print the lines the card has refused, each with its text."""
    for error in refused:
        typer.echo(f"{word}: {shown(str(error))}", err=True)
        path = Path(error.path)
        lines = decode(path.read_bytes()).splitlines() if path.is_file() else []
        if 0 < error.line <= len(lines):
            typer.echo(f"    {shown(lines[error.line - 1].strip())}", err=True)


def parse_until(text: str | None) -> "Until | None":
    """Read `--until`: idle, a flag number, or a flag number with `-` for clear."""
    if text is None:
        return None
    from openacr.scenario.course import read_until

    try:
        return read_until(text)
    except UserError as error:
        raise UserError(f"--until {text}: {error}") from None


def limit_s(for_s: float | None, scenario: "Scenario | None") -> float:
    """Say how long a run lasts at most."""
    if for_s is not None:
        if not 0.0 < for_s <= MOST_S:
            raise UserError(
                f"--for {for_s:g}: give a number of seconds above 0, at most {MOST_S:.0f}"
            )
        return for_s
    from openacr.scenario.course import LONGEST_S

    return (scenario.duration_s if scenario else None) or LONGEST_S


def check_outputs(
    trace: Path | None, plot: Path | None, summary: Path | None, journal: Path | None
) -> None:
    """Refuse results that could not be written, before anything runs."""
    from openacr.cli.run import output

    paths = (trace, plot, summary, journal)
    output.require_different(paths)
    if trace:
        output.require_trace(trace)
    if plot:
        from openacr.cli.plots import require

        require(plot)
    for path in paths:
        if path:
            output.require_writable(path)
