"""`openacr sysvar`: system parameters, offsets and variables of the SYSVAR store."""

import json as json_format
import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.sysvar import Parameter, Store

SHOWN = 60  # of what was found by a name
FIRST_SYSTEM = 100_000
PASSWORD = "OPENACR_PASSWORD"
INCH, MM = "inch", "mm"


def complete_name(incomplete: str) -> list[str]:
    """Names that begin with these letters, for the completion of a shell."""
    from openacr.sysvar.lookup import parameters
    from openacr.sysvar.tabs import TABS

    begun = incomplete.lower()
    names = [tab.name for tab in TABS] + [
        found.row.name for found in parameters() if not found.row.is_series and not found.index
    ]
    return sorted({name for name in names if name.lower().startswith(begun)})


AtStore = Annotated[
    Path | None,
    typer.Option(
        "--store",
        metavar="PATH",
        help="File of the store (else OPENACR_STORE, else in the data folder of the user).",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print a JSON array.")]
InUnit = Annotated[
    str | None,
    typer.Option("--unit", metavar="inch|mm", help="Show and read lengths in this unit."),
]
Password = Annotated[
    str | None,
    typer.Option("--password", help=f"Service password, where one is asked (or {PASSWORD})."),
]
Names = Annotated[
    list[str],
    typer.Argument(
        metavar="NUMBER|NAME|TAB...",
        help="Number, name or tab: P650002, 'cut speed', 'jog feedrate x', SPEEDS.",
        autocompletion=complete_name,
    ),
]
Settings = Annotated[
    list[str],
    typer.Argument(
        metavar="NAME=VALUE...",
        help="Numbers or names with values: P650002=12.5, 'block skip=disable', 'cut speed=300mm'.",
        autocompletion=complete_name,
    ),
]


def get(names: Names, store: AtStore = None, unit: InUnit = None, as_json: AsJson = False) -> None:
    """Show parameters with value, unit, default and range."""
    with _opened(store) as cells:
        found = {each.number: each for name in names for each in cells.find(name)}
        _show(cells, list(found.values()), unit, as_json)


def list_values(
    tab: Annotated[
        str | None,
        typer.Argument(metavar="TAB", help="One tab, e.g. SPEEDS.", autocompletion=complete_name),
    ] = None,
    store: AtStore = None,
    unit: InUnit = None,
    as_json: AsJson = False,
) -> None:
    """List what was changed, or all parameters of a tab."""
    from openacr.sysvar.lookup import in_tab, parameters, tab_named
    from openacr.sysvar.tabs import TABS

    with _opened(store) as cells:
        if tab is None:
            _show(cells, [each for each in parameters() if _is_changed(cells, each)], unit, as_json)
            return
        named = tab_named(tab)
        if named is None:
            raise UserError(f"there is no tab {tab} (one of {', '.join(t.name for t in TABS)})")
        _show(cells, in_tab(named), unit, as_json, limit=None if as_json else SHOWN)


def set_values(
    settings: Settings,
    store: AtStore = None,
    unit: InUnit = None,
    password: Password = None,
) -> None:
    """Change parameters: all of them, or none when one is refused."""
    from openacr.sysvar.lookup import one

    with _opened(store) as cells:
        changes = [(one(name), text) for name, text in map(_split, settings)]
        _require_service(cells, [parameter for parameter, _ in changes], password)
        with cells.transaction():
            for parameter, text in changes:
                _set(cells, parameter, text, unit)
        for parameter, _ in changes:
            typer.echo(_sentence(cells, parameter, unit))


def export_values(
    file: Annotated[
        Path | None, typer.Argument(metavar="[FILE]", help="TOML file; else standard output.")
    ] = None,
    store: AtStore = None,
    everything: Annotated[bool, typer.Option("--all", help="Defaults, too.")] = False,
) -> None:
    """Write the settings that were changed as TOML."""
    from openacr.cli.output import require_writable, write_whole
    from openacr.sysvar.exchange import exported

    if file is not None:
        require_writable(file)
    with _opened(store) as cells:
        text = exported(cells, everything=everything)
    if file is None:
        typer.echo(text, nl=False)
    else:
        write_whole(file, lambda partial: _write(partial, text))


def import_values(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="TOML file as export writes it.")],
    store: AtStore = None,
    password: Password = None,
) -> None:
    """Read settings from TOML: all of them, or none when one is refused."""
    from openacr.sysvar import parameter
    from openacr.sysvar.exchange import imported

    text = _read(file)
    with _opened(store) as cells:
        first = parameter(FIRST_SYSTEM)
        _require_service(cells, [] if first is None else [first], password)
        count = imported(cells, text, str(file))
    typer.echo(f"{count} settings were stored")


def change_password(
    store: AtStore = None,
    password: Password = None,
    new: Annotated[
        str | None, typer.Option("--new", help="The new one, empty for none; else it is asked.")
    ] = None,
) -> None:
    """Guard the system parameters with a password, or guard them no more."""
    from openacr.sysvar import parameter
    from openacr.sysvar.password import CELL, change

    guarded = parameter(CELL)
    with _opened(store) as cells:
        _require_service(cells, [] if guarded is None else [guarded], password)
        if new is None:
            new = typer.prompt(
                "New password", hide_input=True, confirmation_prompt=True, default=""
            )
        change(cells, new)
    typer.echo("the password was changed" if new else "no password is asked any more")


# --- pieces -----------------------------------------------------------------------------


def _opened(path: Path | None) -> "Store":
    from openacr.sysvar import Store
    from openacr.sysvar.location import default_path

    return Store(path or default_path())


def _is_changed(cells: "Store", parameter: "Parameter") -> bool:
    return cells.value(parameter.number) != cells.default(parameter.number)


def _split(setting: str) -> tuple[str, str]:
    name, sign, value = setting.partition("=")
    if not sign or not name.strip():
        raise UserError(f"{setting!r} sets nothing (write NAME=VALUE, e.g. 'cut speed=12.5')")
    return name, value


def _set(cells: "Store", parameter: "Parameter", text: str, unit: str | None) -> None:
    from openacr.sysvar.password import CELL
    from openacr.sysvar.values import parsed

    if parameter.number == CELL:
        raise UserError("a password is set by `openacr sysvar password`")
    is_length = parameter.is_length or parameter.is_per_length
    if unit and is_length and text.strip()[-1:].isdigit():
        text = f"{text} {MM if _is_metric(cells, unit) else 'in'}"
    value = parsed(parameter, text, cells.is_metric)
    if isinstance(value, str):
        cells.write_text(parameter.number, value)
    else:
        cells.write(parameter.number, value)


def _is_metric(cells: "Store", unit: str | None) -> bool:
    if unit is None:
        return cells.is_metric
    if unit not in (INCH, MM):
        raise UserError(f"unit {unit!r} is neither {INCH} nor {MM}")
    return unit == MM


def _require_service(
    cells: "Store", parameters: Iterable["Parameter"], password: str | None
) -> None:
    """Ask for the password where system parameters change."""
    from openacr.sysvar.password import is_asked, is_right

    if not is_asked(cells) or all(each.number < FIRST_SYSTEM for each in parameters):
        return
    given = password or os.environ.get(PASSWORD)
    if given is None and sys.stdin.isatty():
        given = typer.prompt("Service password", hide_input=True)
    if given is None:
        raise UserError(f"system parameters are guarded: give --password, or {PASSWORD}")
    if not is_right(cells, given):
        raise UserError("that is not the service password")


# --- showing ----------------------------------------------------------------------------


def _show(
    cells: "Store",
    found: list["Parameter"],
    unit: str | None,
    as_json: bool,
    limit: int | None = SHOWN,
) -> None:
    if as_json:
        records = [_fields(cells, each, unit) for each in found]
        typer.echo(json_format.dumps(records, indent=2, ensure_ascii=False))
    elif len(found) == 1:
        typer.echo(_sentence(cells, found[0], unit))
        typer.echo(_about(cells, found[0], unit))
    elif found:
        _print_table(cells, found[:limit], unit)
        if limit and len(found) > limit:
            typer.echo(f"and {len(found) - limit} more; --json lists all", err=True)
    else:
        typer.echo("everything is as in a new store")


def _in_unit(cells: "Store", parameter: "Parameter", value: float, unit: str | None) -> float:
    from openacr.sysvar.values import MM_PER_INCH, SHOWN_DIGITS, rounded, scaled

    if _is_metric(cells, unit) == cells.is_metric:
        return value
    factor = 1.0 / MM_PER_INCH if cells.is_metric else MM_PER_INCH
    there = scaled(parameter, value, factor, cells.letter_of(parameter))
    return rounded(there, SHOWN_DIGITS)


def _value_text(
    cells: "Store", parameter: "Parameter", value: float | str, unit: str | None
) -> str:
    from openacr.sysvar.password import CELL
    from openacr.sysvar.values import shown, unit_of

    if isinstance(value, str):
        return ("set" if value else "none") if parameter.number == CELL else repr(value)
    text = shown(parameter, _in_unit(cells, parameter, value, unit))
    name = unit_of(parameter, _is_metric(cells, unit), cells.letter_of(parameter))
    return f"{text} {name}" if name else text


def _sentence(cells: "Store", parameter: "Parameter", unit: str | None) -> str:
    value = _value_text(cells, parameter, cells.value(parameter.number), unit)
    return f"{parameter} = {value}"


def _about(cells: "Store", parameter: "Parameter", unit: str | None) -> str:
    from openacr.sysvar.values import accepted

    n = parameter.number
    default = _value_text(cells, parameter, cells.default(n), unit)
    typical = f", typically {parameter.row.typical}" if parameter.row.typical else ""
    takes = accepted(parameter, 25.4 if cells.is_metric else 1.0)
    return f"  {parameter.tab}: {parameter.row.doc}\n  default {default}{typical}; takes {takes}"


def _print_table(cells: "Store", found: list["Parameter"], unit: str | None) -> None:
    from rich.box import SIMPLE
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table("Number", "Name", "Axis", "Value", "Default", "Tab", box=SIMPLE)
    for each in found:
        value, default = cells.value(each.number), cells.default(each.number)
        table.add_row(
            f"P{each.number}",
            Text(each.name),
            "" if each.axis is None else str(each.axis),
            Text(_value_text(cells, each, value, unit), style="bold" if value != default else ""),
            Text(_value_text(cells, each, default, unit)),
            each.tab,
        )
    Console(highlight=False).print(table)


def _fields(cells: "Store", parameter: "Parameter", unit: str | None) -> dict[str, Any]:
    from openacr.sysvar.password import CELL
    from openacr.sysvar.values import unit_of

    def given(value: float | str) -> float | str:
        if isinstance(value, str):
            return "***" if value and parameter.number == CELL else value
        return _in_unit(cells, parameter, value, unit)

    n = parameter.number
    return {
        "number": n,
        "name": parameter.name,
        "tab": parameter.tab,
        "axis": parameter.axis,
        "type": parameter.kind.value,
        "unit": unit_of(parameter, _is_metric(cells, unit), cells.letter_of(parameter)),
        "value": given(cells.value(n)),
        "default": given(cells.default(n)),
        "typical": parameter.row.typical,
        "choices": {str(value): word for value, word in parameter.row.words.items()},
        "description": parameter.row.doc,
    }


# --- files ------------------------------------------------------------------------------


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {(error.strerror or '').lower()}") from None
    except UnicodeDecodeError:
        raise UserError(f"{path}: is no text in UTF-8") from None
