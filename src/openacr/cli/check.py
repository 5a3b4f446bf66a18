"""`openacr list` and `openacr check`: a controller file as the card would read it."""

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.live.online import Plc, Program
from openacr.errors import SourceError, UserError
from openacr.lang.characters import readable, shown
from openacr.models import MODELS
from openacr.project import Place, Project, find_project, place_of, read_source

if TYPE_CHECKING:
    from openacr.plant.schema import Card
    from openacr.source_check.faults import Fault
    from openacr.source_check.source import Reader

HAS_ERRORS = 1

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="Controller file (.8k) or project folder.")
]


def list_file(
    file: File,
    ladder: Annotated[bool, typer.Option("--ladder", help="Draw PLCs as ladders instead.")] = False,
) -> None:
    """Print a controller file as the card lists it."""
    from openacr.source_check.source import ladders, listing

    reader = read(file, find_project(file))
    for line in ladders(reader) if ladder and not reader.faults else listing(reader):
        typer.echo(readable(line))
    if reader.faults:
        _show(reader.faults, on_stderr=True)
        raise typer.Exit(HAS_ERRORS)


def check_file(
    file: File,
    program: Program = None,
    plc: Plc = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the errors as a JSON array.")
    ] = False,
) -> None:
    """Find every error in a controller file.

    A project folder is checked as a whole: machine file, scenario and all controller files.
    --program and --plc say for which one a file is whose name does not, as for download.
    Exit code 1: there are errors; 2: the input cannot be read at all. Warnings leave it 0.
    """
    at = _place(file, program, plc)
    project = find_project(file)
    faults = [*_table_faults(project), *read(file, project, at).faults]
    if as_json:
        records = [asdict(fault) for fault in faults]
        typer.echo(json.dumps(records, indent=2, ensure_ascii=False))
    elif faults:
        _show(faults, on_stderr=False)
    else:
        typer.echo(f"{file}: no errors")
    if not all(fault.is_warning for fault in faults):
        raise typer.Exit(HAS_ERRORS)


def read(file: Path, project: Project, at: tuple[Place, int] | None = None) -> "Reader":
    """Read all files; one of a project alone is read after the set-up beside it.

    `at` is the level of a file whose name does not say it.
    """
    from openacr.basic.memory.storage import Storage
    from openacr.map.memory import Memory
    from openacr.source_check.cutoffs import Cutoffs
    from openacr.source_check.room import Room
    from openacr.source_check.source import Reader

    place, number = place_of(file) if at is None else at
    is_whole = file.is_dir() or place is Place.SETUP
    home = project if is_whole else _home(file.parent, is_needed=at is None)
    card = _card(home)
    model = MODELS[card.model]
    reader = Reader(
        room=Room(Storage(Memory(), streams=model.streams)),
        has_digits_in_names=model.has_digits_in_names,
        axis_count=model.axes,
        cutoffs=Cutoffs(card.period_s),
    )
    if is_whole:
        reader.sizes.is_complete = reader.room.is_complete = file.is_dir()
        for source in project.sources:
            reader.read(source)
        return reader
    if home.setup:
        reader.room.is_complete = True
        reader.read(home.setup)
        reader.faults.clear()
        reader.parts.clear()
    reader.read(read_source(file, place, number))
    return reader


def _place(file: Path, program: int | None, plc: int | None) -> tuple[Place, int] | None:
    """What a file is for by the options; UserError where they have no meaning."""
    if program is None and plc is None:
        return None
    if program is not None and plc is not None:
        raise UserError("--program and --plc exclude each other")
    if file.is_dir():
        raise UserError(f"{file}: a folder says itself for what its files are")
    if program is not None:
        return Place.PROGRAM, program
    return Place.PLC, plc or 0


def _home(folder: Path, *, is_needed: bool) -> Project:
    """The project a file lies in; one without files where there is none and none is needed."""
    try:
        return find_project(folder)
    except SourceError:
        raise
    except UserError:
        if is_needed:
            raise
        return Project(folder)


def _card(project: Project) -> "Card":
    """The card the files are for; the usual one unless a readable machine file says which."""
    from openacr.plant.load import load_world
    from openacr.plant.schema import Card

    if project.machine is None:
        return Card()
    try:
        return load_world(project.machine).card
    except SourceError:
        return Card()


def _table_faults(project: Project) -> Iterator["Fault"]:
    """What is wrong in the machine and scenario files of a project."""
    from openacr.plant.load import load_world
    from openacr.scenario import load_scenario
    from openacr.source_check.faults import Fault

    for path, load in ((project.machine, load_world), (project.scenario, load_scenario)):
        try:
            if path:
                load(path)
        except SourceError as wrong:
            text = (path.read_text(errors="replace") if path else "").split("\n")
            for error in wrong.errors:
                line = text[error.line - 1].rstrip() if 0 < error.line <= len(text) else ""
                place = (error.line, error.column, 1)
                yield Fault(error.path, *place, error.text, error.hint, line)


def _show(faults: list["Fault"], *, on_stderr: bool) -> None:
    for fault in faults:
        typer.echo(shown(str(fault)), err=on_stderr)
        for line in fault.marker.split("\n") if fault.text else ():
            typer.echo(f"    {shown(line)}", err=on_stderr)
    warnings = sum(fault.is_warning for fault in faults)
    counts = ((len(faults) - warnings, "error"), (warnings, "warning"))
    found = [f"{count} {kind}{'s' if count != 1 else ''}" for count, kind in counts if count]
    typer.echo(", ".join(found), err=True)
