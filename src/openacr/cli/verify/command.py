"""`openacr verify`: check every part program of a folder, in parallel."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.mill.check import AtStore, Dialect, clock, printable
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from collections.abc import Iterable

    from openacr.verify.checking import Task, Verdict

FAILED = 1
INTERRUPTED = 130
DAY_S = 86400.0
MOST_S = 1e9
MOST_SHOWN = 5  # errors of a program


def verify(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of part programs.")],
    store: AtStore = None,
    dialect: Dialect = None,
    files: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATTERN",
            help="Names of programs; may be repeated; default: *.nc *.ngc *.cnc *.tap *.gcode.",
        ),
    ] = None,
    has_stock: Annotated[
        bool, typer.Option("--stock", help="Also cut the blank of the store with each program.")
    ] = False,
    limit_s: Annotated[
        float, typer.Option("--limit", metavar="SECONDS", help="Machine time a program may take.")
    ] = DAY_S,
    workers: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Processes; default: one for each core.")
    ] = None,
    html: Annotated[Path | None, typer.Option(help="Write a page (.html).")] = None,
    junit: Annotated[Path | None, typer.Option(help="Write JUnit XML (.xml).")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print one JSON object.")] = False,
) -> None:
    """Check all part programs of a folder against the machine, its tools and its stock.

    Every program is read as `mill check` reads it; its time is predicted. Exit code 1: a
    program has errors, cannot be read, or takes longer than it may.
    """
    if not 0.0 < limit_s <= MOST_S:
        raise UserError(f"--limit {limit_s:g}: give seconds above 0, at most {MOST_S:.0f}")
    _check_outputs(html, junit)
    from openacr.sysvar.location import open_to_read
    from openacr.verify.checking import Task
    from openacr.verify.programs import PATTERNS, programs

    found = programs(folder, files or PATTERNS)
    with open_to_read(store):  # a store that cannot be opened is one error, not one for each
        pass
    tasks = [Task(path, store, dialect, has_stock, limit_s) for path in found]
    try:
        verdicts = _all_checked(tasks, workers)
    except KeyboardInterrupt:
        raise typer.Exit(INTERRUPTED) from None
    _write(verdicts, folder, html, junit)
    if as_json:
        typer.echo(json.dumps(report(verdicts, folder), indent=1))
    else:
        _show(verdicts, folder)
    if not all(verdict.is_good for verdict in verdicts):
        raise typer.Exit(FAILED)


def _check_outputs(html: Path | None, junit: Path | None) -> None:
    """Refuse what could not be written, before anything is checked."""
    from openacr.cli.run import output

    output.require_different((html, junit))
    for path, suffix in ((html, ".html"), (junit, ".xml")):
        if path is not None:
            if path.suffix.lower() != suffix:
                raise UserError(f"{path}: its name has to end in {suffix}")
            output.require_writable(path)


def _all_checked(tasks: "Iterable[Task]", workers: int | None) -> "list[Verdict]":
    """The verdicts in the order of the files."""
    from openacr.cli.signals import terminations_as_interrupts
    from openacr.verify.checking import check_all
    from openacr.workers import LocalPool

    with terminations_as_interrupts(), LocalPool(workers) as pool:
        found = list(check_all(tasks, pool))
    return sorted(found, key=lambda verdict: verdict.file)


def report(verdicts: "list[Verdict]", folder: Path) -> dict[str, Any]:
    """All verdicts as JSON data: counts of each result, and the programs."""
    from openacr.verify.checking import Status

    states = [verdict.status for verdict in verdicts]
    programs = [
        verdict.data() | {"name": str(verdict.file.relative_to(folder)), "is_good": verdict.is_good}
        for verdict in verdicts
    ]
    counts = {str(status): states.count(status) for status in Status if status in states}
    return {"folder": _plain(str(folder)), "counts": counts, "programs": _plain(programs)}


def _plain(data: Any) -> Any:
    """JSON data whose texts are valid: names of files may be any bytes."""
    if isinstance(data, str):
        return data.encode("utf-8", "replace").decode()
    if isinstance(data, dict):
        return {key: _plain(value) for key, value in data.items()}
    return [_plain(value) for value in data] if isinstance(data, list | tuple) else data


def _write(verdicts: "list[Verdict]", folder: Path, html: Path | None, junit: Path | None) -> None:
    from openacr.cli.run.output import write_whole

    if html is not None:
        from openacr.cli.plots.template import filled

        title = f"Part programs of {printable(str(folder))}"
        page = filled("verify.html", title, report(verdicts, folder)).encode("utf-8", "replace")
        write_whole(html, lambda partial: _put(partial, page))
    if junit is not None:
        from openacr.verify.junit import junit as as_junit

        data = as_junit(verdicts, folder)
        write_whole(junit, lambda partial: _put(partial, data))


def _put(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def _show(verdicts: "list[Verdict]", folder: Path) -> None:
    """A line for each program, then errors and warnings with their places."""
    names = [printable(str(verdict.file.relative_to(folder))) for verdict in verdicts]
    width = max(len("program"), *map(len, names))
    typer.echo(f"{'program':<{width}}  {'result':<10}  errors  warnings     time  tools")
    for name, verdict in zip(names, verdicts, strict=True):
        time = "-" if verdict.time_s is None else clock(verdict.time_s)
        tools = " ".join(
            f"T{tool}{'*' if tool in verdict.without_radius else ''}" for tool in verdict.tools
        )
        line = f"{name:<{width}}  {verdict.status:<10}  {len(verdict.errors):>6}"
        typer.echo(f"{line}  {len(verdict.warnings):>8}  {time:>7}  {tools}".rstrip())
    if any(verdict.without_radius for verdict in verdicts):
        typer.echo("*: the store has no radius of this tool")
    good = sum(verdict.is_good for verdict in verdicts)
    typer.echo(f"{counted(len(verdicts), 'program')}: {good} good, {len(verdicts) - good} not")
    for verdict in verdicts:
        _show_notes(verdict)


def _show_notes(verdict: "Verdict") -> None:
    if verdict.reason:
        typer.secho(printable(f"{verdict.file}: {verdict.reason}"), fg=typer.colors.RED, err=True)
    for notes, colour in (
        (verdict.errors, typer.colors.RED),
        (verdict.warnings, typer.colors.YELLOW),
    ):
        for note in notes[:MOST_SHOWN]:
            typer.secho(printable(str(note)), fg=colour, err=True)
        if len(notes) > MOST_SHOWN:
            typer.echo(f"    and {len(notes) - MOST_SHOWN} more", err=True)
