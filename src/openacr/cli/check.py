"""`openacr list` and `openacr check`: controller files as a card would read them."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from msgspec.structs import asdict

from openacr.cli.live.online import Plc, Program
from openacr.cli.printing import print_json
from openacr.errors import UserError
from openacr.lang.characters import readable, shown
from openacr.project import Place, find_project, place_of

if TYPE_CHECKING:
    from openacr.source_check import Fault

HAS_ERRORS = 1

File = Annotated[
    Path, typer.Argument(metavar="FILE", help="Controller file (.8k) or project folder.")
]


def list_file(
    file: File,
    ladder: Annotated[bool, typer.Option("--ladder", help="Draw PLCs as ladders instead.")] = False,
) -> None:
    """Print a controller file as the card lists it; exit code 1: it has errors."""
    from openacr.source_check import ladders, listing, read

    reader = read(file, find_project(file))
    errors = [fault for fault in reader.faults if not fault.is_warning]
    for line in ladders(reader) if ladder and not errors else listing(reader):
        typer.echo(readable(line))
    if errors:
        _show(errors, on_stderr=True)
        raise typer.Exit(HAS_ERRORS)


def check_file(
    file: File,
    program: Program = None,
    plc: Plc = None,
    axes: Annotated[
        str, typer.Option(help="Axes of a part of a program without ATTACH: XYZ, or X,Y,SP.")
    ] = "",
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the errors as a JSON array.")
    ] = False,
) -> None:
    """Find all errors in a controller file.

    A project folder is checked as a whole: machine file, scenario and all controller files.
    --program and --plc say for which one a file is whose name does not, as for download;
    with --axes it is for a program.
    Exit code 1: there are errors; 2: the input cannot be read at all. Warnings leave it 0.
    """
    from openacr.source_check import check

    if axes and program is plc is None and not file.is_dir():
        program = place_of(file)[1] if place_of(file)[0] is Place.PROGRAM else 0
    faults = check(file, _place(file, program, plc), axes=_names(axes))
    if as_json:
        records = [asdict(fault) for fault in faults]
        print_json(records)
    elif faults:
        _show(faults, on_stderr=False)
    else:
        typer.echo(f"{file}: no errors")
    if not all(fault.is_warning for fault in faults):
        raise typer.Exit(HAS_ERRORS)


def _names(axes: str) -> list[str]:
    """The names of axes 0, 1 ... as given with --axes; UserError if one is no name."""
    names = axes.split(",") if "," in axes else list(axes)
    if wrong := [name for name in names if not name.isalpha()]:
        raise UserError(f"--axes {axes}: {wrong[0]!r} is no name of an axis; write XYZ or X,Y,SP")
    return names


def _place(file: Path, program: int | None, plc: int | None) -> tuple[Place, int] | None:
    """The purpose of a file by the options; UserError if they do not apply."""
    if program is None and plc is None:
        return None
    if program is not None and plc is not None:
        raise UserError("--program and --plc exclude each other")
    if file.is_dir():
        raise UserError(f"{file}: --program and --plc do not apply to a folder")
    if program is not None:
        return Place.PROGRAM, program
    return Place.PLC, plc or 0


def _show(faults: list["Fault"], *, on_stderr: bool) -> None:
    for fault in faults:
        typer.echo(shown(str(fault)), err=on_stderr)
        for line in fault.marker.split("\n") if fault.text else ():
            typer.echo(f"    {shown(line)}", err=on_stderr)
    warnings = sum(fault.is_warning for fault in faults)
    counts = ((len(faults) - warnings, "error"), (warnings, "warning"))
    found = [f"{count} {kind}{'s' if count != 1 else ''}" for count, kind in counts if count]
    typer.echo(", ".join(found), err=True)
