"""`openacr download`: controller files to a card, virtual or real."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.live.online import (
    BAUD,
    PATIENCE_S,
    Baud,
    Plc,
    Program,
    Silence,
    Target,
    chosen_level,
    connected,
    level_of,
    progress_bar,
)

if TYPE_CHECKING:
    from openacr.client import Level, Report
    from openacr.project import SourceFile


def download(
    target: Target,
    path: Annotated[Path, typer.Argument(help="Controller file (.8k) or project folder.")],
    program: Program = None,
    plc: Plc = None,
    no_verify: Annotated[
        bool,
        typer.Option("--no-verify", help="Do not compare with the listing of the card afterwards."),
    ] = False,
    baud: Baud = BAUD,
    silence: Silence = PATIENCE_S,
) -> None:
    """Send a controller file, or all files of a project, to a card.

    Line by line, each after the prompt of the one before; ends at the first line the card
    refuses (exit code 1). Stored programs are compared with what the card then lists.
    """
    files = _files(path, chosen_level(program, plc))
    with connected(target, baud, silence) as card:
        for source, level in files:
            with progress_bar(source.path.name) as progress:
                report = card.download(
                    source.text,
                    path=str(source.path),
                    to=level,
                    progress=progress,
                    is_verified=not no_verify,
                )
            _show(source, report, is_verified=not no_verify)


def _files(path: Path, level: "Level | None") -> "list[tuple[SourceFile, Level]]":
    """The files to send and the levels to send them at."""
    from openacr.project import find_project, place_of, read_source

    if not path.is_dir():
        place, number = place_of(path)
        return [(read_source(path, place, number), level or level_of(place, number))]
    return [(file, level_of(file.place, file.number)) for file in find_project(path).sources]


def _show(source: "SourceFile", report: "Report", *, is_verified: bool) -> None:
    entered = ", ".join(str(level) for level in report.entered)
    checked = " verified" if is_verified else " stored, not verified"
    typer.echo(f"{source.path}: {report.sent} lines" + (f", {entered}{checked}" * bool(entered)))
    for remark in report.remarks:
        typer.echo(f"{source.path}:{remark.line}: the card says: {remark.text}", err=True)
