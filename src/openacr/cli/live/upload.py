"""`openacr upload`: programs of a card, virtual or real, as controller files."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.live.online import (
    BAUD,
    FAILED,
    PATIENCE_S,
    PLC_LAST,
    PROGRAM_LAST,
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
from openacr.errors import UserError, unwritable
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.client import Card, Level


def upload(
    target: Target,
    path: Annotated[
        Path | None,
        typer.Argument(help="File (.8k) or folder to write; without it the text is printed."),
    ] = None,
    program: Program = None,
    plc: Plc = None,
    baud: Baud = BAUD,
    silence: Silence = PATIENCE_S,
) -> None:
    """Read a program or PLC of a card, or all of them into a folder.

    Downloading the file stores the same program again. A file called prog3.8k or plc0.8k
    needs no --program or --plc. Exit code 1: nothing is stored there.
    """
    level = chosen_level(program, plc) or _meant_by(path)
    if level is None and (path is None or path.suffix):
        raise UserError("which program? give --program, --plc, or a folder for all of them")
    with connected(target, baud, silence) as card:
        if level is None and path is not None:
            _write_all(card, path)
        elif level is not None:
            _write_one(card, level, path)


def _meant_by(path: Path | None) -> "Level | None":
    """The level that a file name such as prog3.8k stands for."""
    from openacr.project import Place, place_of

    place, number = place_of(path) if path is not None else (Place.SETUP, 0)
    return None if place is Place.SETUP else level_of(place, number)


def _write_one(card: "Card", level: "Level", path: Path | None) -> None:
    text = card.upload(level)
    if not text:
        typer.echo(f"{level} is empty", err=True)
        raise typer.Exit(FAILED)
    if path is None:
        typer.echo(text, nl=False)
    else:
        _write(path, text)


def _write_all(card: "Card", folder: Path) -> None:
    from openacr.client import Level

    levels = [Level.program(n) for n in range(PROGRAM_LAST + 1)]
    levels += [Level.plc(n) for n in range(PLC_LAST + 1)]
    texts: dict[str, str] = {}
    with progress_bar("reading") as progress:
        for done, level in enumerate(levels, start=1):
            texts[f"{level}".lower() + ".8k"] = card.upload(level)
            progress(done, len(levels))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as failure:
        raise unwritable(folder, failure) from None
    for name, text in texts.items():
        if text:
            _write(folder / name, text)


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="latin-1", newline="\n")
    except OSError as failure:
        raise unwritable(path, failure) from None
    typer.echo(f"{path}: {counted(len(text.splitlines()), 'line')}")
