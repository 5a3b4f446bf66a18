"""`openacr backup` and `openacr restore`: everything a terminal can read of a card."""

import sys
from itertools import count
from pathlib import Path
from typing import Annotated

import typer

from openacr.cli.live.online import (
    BAUD,
    FAILED,
    PATIENCE_S,
    Baud,
    Silence,
    Target,
    connected,
    progress_bar,
)
from openacr.errors import UserError, unwritable


def backup(
    target: Target,
    folder: Annotated[Path, typer.Argument(help="New or empty folder.")],
    baud: Baud = BAUD,
    silence: Silence = PATIENCE_S,
) -> None:
    """Store settings, attachments, variables and programs of a card in a folder.

    The folder is a project: `openacr run` and `openacr serve` take it as it is. Its machine.toml
    is a first guess of motors and switches, made of the set-up. Not kept: network address,
    passwords, local variables, strings, positions. What the card reports in a form that cannot be
    written back is listed (exit code 1).
    """
    from openacr.client.backup import not_understood

    with connected(target, baud, silence) as card, progress_bar("reading") as progress:
        names = card.backup(folder, progress)
        made = _guess_machine(folder, card.command("VER"))
    typer.echo(f"{folder}: {', '.join([*names, *made])}")
    if made:
        typer.echo(f"{folder / made[0]} is a guess: look for the word in it", err=True)
    lost = not_understood(folder)
    for remark in lost:
        typer.echo(f"not kept: {remark}", err=True)
    if lost:
        raise typer.Exit(FAILED)


def _guess_machine(folder: Path, version: list[str]) -> list[str]:
    """Write a first machine.toml beside a backup, from a virtual card that has it."""
    from openacr.client.identity import VERSION
    from openacr.configure.guessed import first_machine
    from openacr.configure.queries import Virtual
    from openacr.controller import Controller
    from openacr.models import DEFAULT_MODEL, MODELS
    from openacr.plant.describe.schema import default_world
    from openacr.project import find_project

    path = folder / "machine.toml"
    if path.exists():
        return []
    found = VERSION.match(" ".join(version))
    model = MODELS.get(found["model"] if found else "", DEFAULT_MODEL)
    controller, _ = Controller.load(find_project(folder), world=default_world(model))
    text = first_machine(Virtual(controller), model.name)
    try:
        path.write_text(text, encoding="utf-8", newline="\n")
    except OSError as failure:
        raise unwritable(path, failure) from None
    return [path.name]


def restore(
    target: Target,
    folder: Annotated[Path, typer.Argument(help="Folder of a backup.")],
    is_sure: Annotated[bool, typer.Option("--yes", help="Do not ask.")] = False,
    baud: Baud = BAUD,
    silence: Silence = PATIENCE_S,
) -> None:
    """Stop a card, clear it and restore a backup.

    All programs and PLCs of the card are halted and replaced, memory is cleared. Before that the
    card is asked whether it knows every setting. If it refuses a line after all, it gets its
    former contents back.
    """
    from openacr.client import RestoreError
    from openacr.client.backup import read_folder

    read_folder(folder)  # what is wrong with it is said before anything is cleared
    if not is_sure:
        if not sys.stdin.isatty():
            raise UserError("restore clears the card: say --yes")
        typer.confirm(f"Clear the card at {target} and restore {folder}?", abort=True)
    try:
        with connected(target, baud, silence) as card, progress_bar("restoring") as progress:
            reports = card.restore(folder, progress)
    except RestoreError as failed:
        typer.echo(f"error: {failed}", err=True)
        if not failed.is_back:
            kept = _keep(failed.former, folder)
            typer.echo(
                f"what was on the card is in {kept}: openacr restore {target} {kept}", err=True
            )
        raise typer.Exit(FAILED) from None
    entered = [str(level) for report in reports for level in report.entered]
    sent = sum(report.sent for report in reports)
    typer.echo(f"{folder}: {sent} lines, {', '.join(entered) or 'no programs'}, verified")


def _keep(files: dict[str, str], beside: Path) -> Path:
    """Store what was on a card in a new folder beside the backup; its name."""
    from openacr.client.backup import write_folder

    names = (beside.with_name(f"{beside.resolve().name}-before{n or ''}") for n in count())
    folder = next(name for name in names if not name.exists())
    write_folder(files, folder)
    return folder
