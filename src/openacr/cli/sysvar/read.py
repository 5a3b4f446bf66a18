"""`openacr sysvar get` and `list`: contents of the SYSVAR store."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from openacr.cli.printing import print_json, print_rich
from openacr.errors import UserError

if TYPE_CHECKING:
    from openacr.sysvar import Parameter, Store

SHOWN = 60  # matches of a name that are listed
INCH, MM = "inch", "mm"


def complete_name(incomplete: str) -> list[str]:
    """Names with this beginning, for shell completion."""
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
        help="File of the store; default: OPENACR_STORE, then the data folder of the user.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print a JSON array.")]
InUnit = Annotated[
    str | None,
    typer.Option("--unit", metavar="inch|mm", help="Show and read lengths in this unit."),
]
Names = Annotated[
    list[str],
    typer.Argument(
        metavar="NUMBER|NAME|TAB...",
        help="Number, name or tab: P650002, 'cut speed', 'jog feedrate x', SPEEDS.",
        autocompletion=complete_name,
    ),
]


def get(names: Names, store: AtStore = None, unit: InUnit = None, as_json: AsJson = False) -> None:
    """Show parameters with value, unit, default and range."""
    from openacr.sysvar.location import open_to_read

    with open_to_read(store) as cells:
        found = {each.number: each for name in names for each in cells.find(name)}
        each_is_one = len(found) <= len(names)
        _show(cells, list(found.values()), unit, as_json, is_full=each_is_one)


def list_values(
    tab: Annotated[
        str | None,
        typer.Argument(metavar="TAB", help="One tab, e.g. SPEEDS.", autocompletion=complete_name),
    ] = None,
    store: AtStore = None,
    unit: InUnit = None,
    as_json: AsJson = False,
) -> None:
    """List changed parameters, or all of a tab."""
    from openacr.sysvar.location import open_to_read
    from openacr.sysvar.lookup import in_tab, parameters, tab_like, tab_named
    from openacr.sysvar.tabs import TABS

    with open_to_read(store) as cells:
        if tab is None:
            _show(cells, [each for each in parameters() if _is_changed(cells, each)], unit, as_json)
            return
        named = tab_named(tab)
        if named is None:
            there = tab_like(tab) or f"one of {', '.join(t.name for t in TABS)}"
            raise UserError(f"unknown tab {tab} ({there})")
        _show(cells, in_tab(named), unit, as_json)


# --- pieces -----------------------------------------------------------------------------


def _is_changed(cells: "Store", parameter: "Parameter") -> bool:
    return cells.value(parameter.number) != cells.default(parameter.number)


def is_metric_in(cells: "Store", unit: str | None) -> bool:
    """Whether lengths are shown and read in millimetres."""
    if unit is None:
        return cells.is_metric
    if unit not in (INCH, MM):
        raise UserError(f"unit {unit!r} is neither {INCH} nor {MM}")
    return unit == MM


# --- showing ----------------------------------------------------------------------------


def _show(
    cells: "Store",
    found: list["Parameter"],
    unit: str | None,
    as_json: bool,
    *,
    is_full: bool = False,
) -> None:
    if as_json:
        records = [_fields(cells, each, unit) for each in found]
        print_json(records)
    elif len(found) == 1 or (found and is_full):
        for each in found:
            typer.echo(sentence(cells, each, unit))
            typer.echo(_about(cells, each, unit))
    elif found:
        _print_table(cells, found[:SHOWN], unit)
        if len(found) > SHOWN:
            typer.echo(f"and {len(found) - SHOWN} more; --json lists all", err=True)
    else:
        typer.echo("all parameters have their defaults")


def _in_unit(cells: "Store", parameter: "Parameter", value: float, unit: str | None) -> float:
    from openacr.sysvar.values import SHOWN_DIGITS, rounded, scaled
    from openacr.units import MM_PER_INCH

    if is_metric_in(cells, unit) == cells.is_metric:
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
    name = unit_of(parameter, is_metric_in(cells, unit), cells.letter_of(parameter))
    return f"{text} {name}" if name else text


def sentence(cells: "Store", parameter: "Parameter", unit: str | None) -> str:
    """A parameter with its value."""
    value = _value_text(cells, parameter, cells.value(parameter.number), unit)
    return f"{parameter} = {value}"


def _about(cells: "Store", parameter: "Parameter", unit: str | None) -> str:
    from openacr.sysvar.values import accepted

    n = parameter.number
    default = _value_text(cells, parameter, cells.default(n), unit)
    typical = _typical(cells, parameter, unit)
    typical = f", typically {typical}" if typical else ""
    takes = accepted(parameter, is_metric_in(cells, unit), cells.letter_of(parameter))
    return f"  {parameter.tab}: {parameter.row.doc}\n  default {default}{typical}; takes {takes}"


def _typical(cells: "Store", parameter: "Parameter", unit: str | None) -> str:
    from openacr.sysvar.values import typical

    return typical(parameter, is_metric_in(cells, unit), cells.letter_of(parameter))


def _print_table(cells: "Store", found: list["Parameter"], unit: str | None) -> None:
    from rich.box import SIMPLE
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
    print_rich(table)


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
        "unit": unit_of(parameter, is_metric_in(cells, unit), cells.letter_of(parameter)),
        "value": given(cells.value(n)),
        "default": given(cells.default(n)),
        "typical": _typical(cells, parameter, unit),
        "choices": {str(value): word for value, word in parameter.row.words.items()},
        "description": parameter.row.doc,
    }
