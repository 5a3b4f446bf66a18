"""`openacr list` and `openacr check`: a controller file as the card would read it."""

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.errors import SourceError
from openacr.lang.characters import readable, shown
from openacr.models import MODELS
from openacr.project import Place, Project, find_project, place_of, read_source

if TYPE_CHECKING:
    from openacr.cli.faults import Fault
    from openacr.cli.source import Reader
    from openacr.plant.schema import Card

HAS_ERRORS = 1

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="Controller file (.8k) or project folder.")
]


def list_file(
    file: File,
    ladder: Annotated[bool, typer.Option("--ladder", help="Draw PLCs as ladders instead.")] = False,
) -> None:
    """Print a controller file as the card lists it."""
    from openacr.cli.source import ladders, listing

    reader = read(file, find_project(file))
    for line in ladders(reader) if ladder and not reader.faults else listing(reader):
        typer.echo(readable(line))
    if reader.faults:
        _show(reader.faults, on_stderr=True)
        raise typer.Exit(HAS_ERRORS)


def check_file(
    file: File,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the errors as a JSON array.")
    ] = False,
) -> None:
    """Find every error in a controller file.

    A project folder is checked as a whole: machine file, scenario and all controller files.
    Exit code 1: there are errors; 2: the input cannot be read at all. Warnings leave it 0.
    """
    project = find_project(file)
    faults = [*_table_faults(project), *read(file, project).faults]
    if as_json:
        records = [asdict(fault) for fault in faults]
        typer.echo(json.dumps(records, indent=2, ensure_ascii=False))
    elif faults:
        _show(faults, on_stderr=False)
    else:
        typer.echo(f"{file}: no errors")
    if not all(fault.is_warning for fault in faults):
        raise typer.Exit(HAS_ERRORS)


def read(file: Path, project: Project) -> "Reader":
    """Read all files; one of a project alone is read behind the set-up beside it."""
    from openacr.cli.cutoffs import Cutoffs
    from openacr.cli.source import Reader

    place, number = place_of(file)
    is_whole = file.is_dir() or place is Place.SETUP
    home = project if is_whole else find_project(file.parent)
    card = _card(home)
    model = MODELS[card.model]
    reader = Reader(
        has_digits_in_names=model.has_digits_in_names,
        axis_count=model.axes,
        cutoffs=Cutoffs(card.period_s),
    )
    if is_whole:
        reader.sizes.is_complete = file.is_dir()
        for source in project.sources:
            reader.read(source)
        return reader
    if home.setup:
        reader.read(home.setup)
        reader.faults.clear()
        reader.parts.clear()
    reader.read(read_source(file, place, number))
    return reader


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
    from openacr.cli.faults import Fault
    from openacr.plant.load import load_world
    from openacr.scenario import load_scenario

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
