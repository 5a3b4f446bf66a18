"""`openacr configure`: controller files generated from configuration answers."""

from pathlib import Path
from typing import Annotated

import typer

from openacr.errors import UserError, read_bytes, unwritable


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
) -> None:
    """Generate the configuration code of a machine from answers in a file.

    A set-up file and, for older firmware, limit code; a program keeps the answers on the card.
    """
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
