"""`openacr sysvar set`, `export`, `import` and `password`: changes to the SYSVAR store."""

import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from openacr.cli.sysvar.read import MM, AtStore, InUnit, complete_name, is_metric_in, sentence
from openacr.errors import UserError
from openacr.wording import counted

if TYPE_CHECKING:
    from openacr.sysvar import Parameter, Store

PASSWORD = "OPENACR_PASSWORD"

Password = Annotated[
    str | None,
    typer.Option("--password", help=f"Service password, if one is set (or {PASSWORD})."),
]
Settings = Annotated[
    list[str],
    typer.Argument(
        metavar="NAME=VALUE...",
        help="Numbers or names with values: P650002=12.5, 'block skip=disable', 'cut speed=300mm'.",
        autocompletion=complete_name,
    ),
]


def set_values(
    settings: Settings,
    store: AtStore = None,
    unit: InUnit = None,
    password: Password = None,
) -> None:
    """Change parameters: all, or none if one is refused."""
    from openacr.sysvar.location import open_to_write
    from openacr.sysvar.lookup import one

    with open_to_write(store) as cells:
        changes = [(one(name), text) for name, text in map(_split, settings)]
        require_service(cells, [parameter.number for parameter, _ in changes], password)
        with cells.transaction():
            for parameter, text in changes:
                _set(cells, parameter, text, unit)
        for parameter, _ in changes:
            typer.echo(sentence(cells, parameter, unit))


def export_values(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="TOML file; default: standard output.")
    ] = None,
    store: AtStore = None,
    everything: Annotated[bool, typer.Option("--all", help="Include defaults.")] = False,
) -> None:
    """Write the changed settings as TOML."""
    from openacr.cli.run.output import require_writable, write_whole
    from openacr.sysvar.exchange import exported
    from openacr.sysvar.location import open_to_read

    if file is not None:
        require_writable(file)
    with open_to_read(store) as cells:
        text = exported(cells, everything=everything)
    if file is None:
        typer.echo(text, nl=False)
    else:
        write_whole(file, lambda partial: _write(partial, text))


def import_values(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="TOML file written by export.")],
    store: AtStore = None,
    password: Password = None,
) -> None:
    """Read settings from TOML: all, or none if one is refused."""
    from openacr.sysvar.exchange import imported, text_of
    from openacr.sysvar.location import open_to_write
    from openacr.sysvar.schema import FIRST_SYSTEM

    text = text_of(file)
    with open_to_write(store) as cells:
        require_service(cells, [FIRST_SYSTEM], password)
        count = imported(cells, text, str(file))
    typer.echo(f"{counted(count, 'setting')} stored")


def change_password(
    store: AtStore = None,
    password: Password = None,
    new: Annotated[
        str | None, typer.Option("--new", help="New password, empty to remove it; default: ask.")
    ] = None,
) -> None:
    """Set or remove the password that protects the system parameters."""
    from openacr.sysvar.location import open_to_write
    from openacr.sysvar.password import CELL, change

    with open_to_write(store) as cells:
        require_service(cells, [CELL], password)
        if new is None:
            if not sys.stdin.isatty():
                raise UserError("no terminal to ask for the new password; give --new")
            new = typer.prompt(
                "New password", hide_input=True, confirmation_prompt=True, default=""
            )
        change(cells, new)
    typer.echo("password changed" if new else "password removed")


# --- pieces -----------------------------------------------------------------------------


def _split(setting: str) -> tuple[str, str]:
    name, sign, value = setting.partition("=")
    if not sign or not name.strip():
        raise UserError(f"{setting!r} sets nothing (write NAME=VALUE, e.g. 'cut speed=12.5')")
    return name, value


def _set(cells: "Store", parameter: "Parameter", text: str, unit: str | None) -> None:
    from openacr.sysvar.password import CELL
    from openacr.sysvar.values import ROTARY, parsed

    if parameter.number == CELL:
        raise UserError("a password is set by `openacr sysvar password`")
    letter = cells.letter_of(parameter)
    is_length = (parameter.is_length or parameter.is_per_length) and letter not in ROTARY
    if unit and is_length and text.strip()[-1:].isdigit():
        text = f"{text} {MM if is_metric_in(cells, unit) else 'in'}"
    value = parsed(parameter, text, cells.is_metric, letter)
    if isinstance(value, str):
        cells.write_text(parameter.number, value)
    else:
        cells.write(parameter.number, value)


def require_service(cells: "Store", numbers: Iterable[int], password: str | None) -> None:
    """Require the password for changes of system parameters."""
    from openacr.sysvar.password import is_asked, is_right
    from openacr.sysvar.schema import FIRST_SYSTEM

    if not is_asked(cells) or all(n < FIRST_SYSTEM for n in numbers):
        return
    given = password or os.environ.get(PASSWORD)
    if given is None and sys.stdin.isatty():
        given = typer.prompt("Service password", hide_input=True)
    if given is None:
        raise UserError(f"system parameters are protected: give --password, or {PASSWORD}")
    if not is_right(cells, given):
        raise UserError("wrong service password")


# --- files ------------------------------------------------------------------------------


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
