"""`openacr configure`: controller files generated from configuration answers."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.live.online import BAUD, SILENCE_S, Baud, Silence, connected
from openacr.errors import UserError, read_bytes, unwritable

if TYPE_CHECKING:
    from openacr.client import Card as OnlineCard
    from openacr.configure.queries import Card

REFUSED = 1


def configure(
    answers: Annotated[
        Path,
        typer.Argument(
            metavar="ANSWERS",
            help="Answers (.toml), or the listing of a card's program that holds them (.8k).",
        ),
    ],
    folder: Annotated[
        Path | None,
        typer.Argument(help="Project folder for the files; default: print them."),
    ] = None,
    is_forced: Annotated[bool, typer.Option("--force", help="Replace existing files.")] = False,
    is_explained: Annotated[
        bool, typer.Option("--explain", help="Explain every line of the set-up file by a remark.")
    ] = False,
    is_recovered: Annotated[
        bool,
        typer.Option(
            "--recover",
            help="Print the answers for the set-up of a card: ANSWERS is a project, one of its"
            " files (.8k), HOST, HOST:PORT or a serial port. What answers cannot hold is noted.",
        ),
    ] = False,
    is_machine: Annotated[
        bool,
        typer.Option(
            "--machine",
            help="Print a first machine.toml for a card, its motors and switches guessed from its"
            " set-up: ANSWERS is as with --recover.",
        ),
    ] = False,
    baud: Baud = BAUD,
    silence: Silence = SILENCE_S,
) -> None:
    """Generate the configuration code of a machine from answers in a file.

    A set-up file and, for older firmware, limit code; a program keeps the answers on the card.
    """
    if is_recovered or is_machine:
        if folder is not None or is_forced or is_explained or (is_recovered and is_machine):
            word, what = ("--machine", "a file") if is_machine else ("--recover", "answers")
            raise UserError(f"{word} prints {what}: it takes neither a folder nor other options")
        with _opened(answers, baud, silence) as (card, model):
            if is_machine:
                from openacr.configure.guessed import first_machine

                typer.echo(first_machine(card, model), nl=False)
            else:
                _recover(card, model)
    else:
        _generate(answers, folder, is_forced=is_forced, is_explained=is_explained)


def _recover(card: "Card", model: str) -> None:
    from openacr.configure import parse_answers
    from openacr.configure.differences import differences
    from openacr.configure.recovered import recovered
    from openacr.configure.written import written
    from openacr.errors import SourceError

    found = recovered(card, model)
    text = written(found)
    for sentence in differences(card, found):
        typer.echo(f"note: {sentence}", err=True)
    typer.echo(text, nl=False)
    try:
        parse_answers(text, "recovered")
    except SourceError as error:
        typer.echo(f"error: no valid answers: {error}", err=True)
        raise typer.Exit(REFUSED) from None


@contextmanager
def _opened(source: Path, baud: int, silence_s: float) -> "Iterator[tuple[Card, str]]":
    """A card that answers, virtual for a project, and its model."""
    if source.is_dir() or source.suffix.lower() == ".8k":
        from openacr.configure.queries import Virtual
        from openacr.controller import Controller
        from openacr.project import find_project

        if source.is_dir() and find_project(source).setup is None:
            raise UserError(
                f"{source}: setup.8k is missing: without it nothing is known of the set-up"
                " (`openacr backup HOST FOLDER` reads it from a card)"
            )
        controller = Controller.from_project(source)
        yield Virtual(controller), controller.model.name
        return
    from openacr.client.identity import identify
    from openacr.client.options import Options

    found = identify(str(source), Options(timeout_s=silence_s), baud=baud)
    if found.hardware is None:
        raise UserError(f"{source}: the model {found.model or found.version!r} is not known")
    with connected(str(source), baud, silence_s) as card:
        yield Answering(card), found.model


class Answering:
    """A card over a link, for which a line that it refuses has no answer."""

    def __init__(self, card: "OnlineCard") -> None:
        self._card = card
        self.read, self.read_bit = card.read, card.read_bit

    def command(self, line: str, *, program: int | None = None) -> list[str]:
        """Type a line at SYS or at a program."""
        from openacr.client import Level, RefusedError

        self._card.go(Level() if program is None else Level.program(program))
        try:
            return self._card.command(line)
        except RefusedError:
            return []


def _generate(answers: Path, folder: Path | None, *, is_forced: bool, is_explained: bool) -> None:
    from openacr.configure import code_files, parse_answers
    from openacr.configure.answers import warnings
    from openacr.configure.watch_code import kept_answers
    from openacr.project import decode

    text = decode(read_bytes(answers))
    if answers.suffix.lower() == ".8k":
        text = kept_answers(text.splitlines())
    found = parse_answers(text, str(answers))
    files = code_files(found, text, is_explained=is_explained)
    for sentence in warnings(found):
        typer.echo(f"warning: {sentence}", err=True)
    if folder is None:
        for name, code in files.items():
            typer.echo(f"==> {name} <==\n{code}")
    else:
        _write(folder, files, is_forced=is_forced)


def _write(folder: Path, files: dict[str, str], *, is_forced: bool) -> None:
    there = [name for name in files if (folder / name).exists()]
    if there and not is_forced:
        raise UserError(f"{folder / there[0]} exists; --force replaces it")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, code in files.items():
            (folder / name).write_text(code, encoding="utf-8", newline="\n")
            typer.echo(str(folder / name))
    except OSError as failure:
        raise unwritable(folder, failure) from None
