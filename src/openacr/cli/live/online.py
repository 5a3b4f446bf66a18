"""What the commands that talk to a card share: how to reach it, what is shown meanwhile."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.errors import SourceError, UserError

if TYPE_CHECKING:
    from openacr.client import Card, Level
    from openacr.client.transfer import Progress
    from openacr.project import Place

FAILED = 1
PROGRAM_LAST, PLC_LAST = 15, 7
BAUD = 38400
SILENCE_S = 5.0
PATIENCE_S = 10.0  # of transfers

Target = Annotated[str, typer.Argument(metavar="HOST", help="HOST, HOST:PORT or a serial port.")]
Baud = Annotated[int, typer.Option(min=1, help="Speed of a serial port.")]
Silence = Annotated[
    float, typer.Option("--timeout", help="Longest silence [s] while a reply is awaited.")
]
Program = Annotated[int | None, typer.Option(help="Program 0-15.", min=0, max=PROGRAM_LAST)]
Plc = Annotated[int | None, typer.Option(help="PLC 0-7.", min=0, max=PLC_LAST)]


@contextmanager
def connected(target: str, baud: int, silence_s: float) -> "Iterator[Card]":
    """A card for the time of a command; what goes wrong on the card ends it with 1."""
    from openacr.client import Card, ConnectionLostError, Options

    try:
        with Card.open(target, Options(timeout_s=silence_s), baud=baud) as card:
            yield card
    except SourceError as wrong:  # a line that the card refuses or lists differently
        typer.echo(f"error: {wrong}", err=True)
        raise typer.Exit(FAILED) from None
    except ConnectionLostError as lost:
        raise UserError(str(lost)) from None


@contextmanager
def progress_bar(title: str) -> "Iterator[Progress]":
    """A bar on a terminal, nothing in a file or pipe."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(bar_width=30), MofNCompleteColumn())
    with Progress(
        *columns, console=console, transient=True, disable=not console.is_terminal
    ) as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def level_of(place: "Place", number: int) -> "Level":
    """The level a controller file is meant for."""
    from openacr.client import Level
    from openacr.project import Place

    if place is Place.SETUP:
        return Level()
    return Level.program(number) if place is Place.PROGRAM else Level.plc(number)


def chosen_level(program: int | None, plc: int | None) -> "Level | None":
    """The level chosen by options; UserError if there are two."""
    from openacr.client import Level

    if program is not None and plc is not None:
        raise UserError("--program and --plc exclude each other")
    if program is not None:
        return Level.program(program)
    return None if plc is None else Level.plc(plc)
