"""`openacr replay`: live through a journal or a recorded session once more."""

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.errors import UserError
from openacr.lang.characters import readable, shown

if TYPE_CHECKING:
    from openacr.controller.replay import Replay

DIFFERS = 1
RECORDINGS = "for recordings of `openacr record`"


def replay(
    journal: Annotated[
        Path | None,
        typer.Argument(help="Journal of `openacr run` or `openacr serve`; default: list those."),
    ] = None,
    until: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS", help="Stop at this time after the beginning of the journal."
        ),
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Only compare the states; exit code 1 if they differ.")
    ] = False,
    project: Annotated[
        Path | None,
        typer.Option(
            help="Of a recording: the machine (default: eight exact axes); of a journal: the folder"
            " of the Python files of its devices."
        ),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Of a recording: print the first difference as JSON.")
    ] = False,
    trace: Annotated[
        Path | None,
        typer.Option(help="Of a journal: write the motion of all axes (.csv, .parquet)."),
    ] = None,
    trace_every: Annotated[
        int,
        typer.Option(metavar="TICKS", min=1, help="Ticks between two rows of the trace."),
    ] = 1,
) -> None:
    """Replay a journal: the same inputs at the same ticks, the same states.

    Shows what programs print and, at the end, the state of the card. With --check it only
    says whether every digest of the journal was met again. Without a name it lists the
    journals that served cards have left. With --trace it writes what the axes did, tick by tick:
    of a part program that was run on a served card, too.

    A recording of `openacr record` is given to a virtual card, and the first answer that differs
    is reported; exit code 1 if there is one.
    """
    if until is not None and not 0.0 <= until < float("inf"):
        raise UserError(f"--until {until:g}: give a number of seconds, 0 or more")
    if journal is None:
        _refuse(RECORDINGS, {"--json": as_json})
        _refuse("for one journal: name it", {"--trace": trace is not None})
        from openacr.cli.run.journals import listing

        typer.echo(listing())
        return
    if _is_recording(journal):
        options = {"--until": until is not None, "--check": check, "--trace": trace is not None}
        _refuse("for journals", options)
        from openacr.cli.run.recorded import replay_recording

        replay_recording(journal, project, as_json=as_json)
        return
    _refuse(RECORDINGS, {"--json": as_json})
    from openacr.cli.run import output
    from openacr.cli.run.controlled import ControlledMachine
    from openacr.controller.journal import read_journal
    from openacr.controller.replay import Replay

    if trace is not None:
        output.require_trace(trace)
        output.require_writable(trace)
    read = read_journal(journal)
    again = Replay(read, project)
    if not check:
        again.card.listen(_show_text)
    if trace is not None:
        machine = ControlledMachine(again.card)
        machine.record(trace_every, keep_peaks=False, watched=())
    started_s = time.perf_counter()
    again.run(until)
    if trace is not None:
        output.write_trace(trace, machine.curves(shown(journal.stem)))
    if not check:
        _show_state(again, time.perf_counter() - started_s)
    if not read.is_whole:
        typer.echo("note: the journal was not closed; it is replayed to its last record", err=True)
    _conclude(again, is_check=check)


def _is_recording(path: Path) -> bool:
    from openacr.io.recorded_session import is_recording

    try:
        return is_recording(path)
    except OSError:
        return False  # reading it as a journal says why


def _refuse(why: str, given: dict[str, bool]) -> None:
    for option, is_given in given.items():
        if is_given:
            raise UserError(f"{option} is {why}")


def _show_text(program: int, text: str) -> None:
    sys.stdout.write(readable(text).replace("\r\n", "\n"))


def _show_state(again: "Replay", wall_s: float) -> None:
    from rich.console import Console

    from openacr.cli.run.controlled import ControlledMachine
    from openacr.cli.run.report import report_on, show_report

    machine = ControlledMachine(again.card)
    show_report(report_on(machine, again.journal.header.tick, wall_s), Console())


def _conclude(again: "Replay", *, is_check: bool) -> None:
    """Say how the replay compares with the journal."""
    header, first = again.journal.header, again.difference
    lived = f"{again.lived_s:g} s replayed, {again.entered} entries"
    if first is not None:
        at_s = (first.tick - header.tick) * header.period_s
        text = f"{lived}: the state differs from the journal at {at_s:g} s (tick {first.tick})"
        typer.echo(f"{'error' if is_check else 'warning'}: {text}", err=True)
        if is_check:
            raise typer.Exit(DIFFERS)
    elif is_check and not again.equal:
        raise UserError(f"{lived}: no digest was reached, nothing could be compared")
    else:
        typer.echo(f"{lived}: {again.equal} digests equal", err=not is_check)
