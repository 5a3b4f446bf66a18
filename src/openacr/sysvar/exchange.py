"""Settings as a TOML file: exported with names and units as comments, and imported.

    layout = 1
    unit = "inch"

    [SPEEDS]
    P650002 = 12.5  # Cut Speed [in/min]

Keys are numbers or unique names; lengths are in the unit of the file unless they name one.
"""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from openacr.errors import MapError, UserError, read_bytes
from openacr.plant.describe.toml_file import require_shallow
from openacr.sysvar import lookup, password, rules, values
from openacr.sysvar.held import UNITS
from openacr.sysvar.schema import CellKind, Parameter
from openacr.sysvar.store import AT_START, Store
from openacr.sysvar.tabs import CELLS, GENERAL
from openacr.sysvar.values import SettingError, Value
from openacr.units import MM_PER_INCH

LAYOUT = 1
INCH, MM = "inch", "mm"
_HEAD = ("layout", "unit")
# Cells that show the state of a run are not settings.
_OF_A_RUN = frozenset(
    (
        *range(CELLS.tool_selected, CELLS.run_time + 1),
        *AT_START,
        password.CELL,
        UNITS,
        rules.RUN_STATE,
    )
)


def exported(store: Store, *, everything: bool = False) -> str:
    """The settings that differ from a new store, or all of them, as TOML."""
    lines = [f"layout = {LAYOUT}", f'unit = "{MM if store.is_metric else INCH}"']
    tab = ""
    for parameter in lookup.parameters():
        if not _belongs(store, parameter, everything):
            continue
        if parameter.tab != tab:
            tab = parameter.tab
            lines += ["", f"[{_key(tab)}]"]
        lines.append(_line(store, parameter))
    return "\n".join(lines) + "\n"


def _belongs(store: Store, parameter: Parameter, everything: bool) -> bool:
    n = parameter.number
    if parameter.row.is_fixed or n in _OF_A_RUN:
        return False
    if parameter.is_per_length and (parameter.axis or 0) < store.read(GENERAL.axis_count):
        return True  # its default is the same number in either unit
    return everything or store.value(n) != store.default(n)


def _line(store: Store, parameter: Parameter) -> str:
    value = store.value(parameter.number)
    unit = values.unit_of(parameter, store.is_metric, store.letter_of(parameter))
    axis = "" if parameter.axis is None else f", axis {parameter.axis}"
    word = parameter.row.words.get(int(value), "") if isinstance(value, float) else ""
    notes = f" = {word}" if word else (f" [{unit}]" if unit else "")
    return f"P{parameter.number} = {_literal(parameter, value)}  # {parameter.name}{axis}{notes}"


def _literal(parameter: Parameter, value: Value) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)  # a TOML string of printable characters
    if parameter.kind is CellKind.BOOLEAN:
        return "true" if value else "false"
    return values.plain(value) if parameter.kind is not CellKind.REAL else repr(value)


def _key(name: str) -> str:
    return name if name.replace("-", "").isalnum() else json.dumps(name)


def imported(store: Store, text: str, place: str = "the file") -> int:
    """Store the settings of a file, all or none; returns their count.

    An empty store takes over the unit of the file, any other keeps its own.
    """
    require_shallow(text, place)
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise UserError(f"{place}: {error}") from None
    is_metric = _checked_head(document, place)
    try:
        with store.transaction():
            if is_metric:
                store.begin_metric()
            return _apply(store, list(_entries(document)), is_metric)
    except (MapError, SettingError) as error:
        raise UserError(f"{place}: {error}") from None


def text_of(path: Path) -> str:
    """The text of a file of settings; UserError if it cannot be read."""
    try:
        return read_bytes(path).decode()
    except UnicodeDecodeError:
        raise UserError(f"{path}: not UTF-8 text") from None


def begun(path: Path, settings: Path) -> Store:
    """Open the store of a machine; a new one gets the settings of a file, or is not created."""
    is_new = not path.exists()
    store = Store(path)
    if is_new:
        try:
            imported(store, text_of(settings), str(settings))
        except BaseException:
            store.close()
            path.unlink(missing_ok=True)
            raise
    return store


def _checked_head(document: dict[str, Any], place: str) -> bool:
    layout, unit = document.get("layout", LAYOUT), document.get("unit", INCH)
    if layout != LAYOUT:
        raise UserError(f"{place}: layout {layout} is not supported, only {LAYOUT}")
    if unit not in (INCH, MM):
        raise UserError(f'{place}: unit {unit!r} is neither "{INCH}" nor "{MM}"')
    return bool(unit == MM)


def _entries(document: dict[str, Any]) -> Iterator[tuple[Parameter, object]]:
    for key, value in document.items():
        if isinstance(value, dict):
            yield from _entries(value)
        elif key not in _HEAD:
            yield lookup.one(key), value


def _apply(store: Store, entries: list[tuple[Parameter, object]], is_metric: bool) -> int:
    """Store names of axes and the unit first: the meaning of lengths depends on them."""
    for parameter, value in sorted(entries, key=lambda each: _rank(each[0])):
        if parameter.is_text:
            store.write_text(parameter.number, value)  # type: ignore[arg-type]
        else:
            store.write(parameter.number, _number(store, parameter, value, is_metric))
    return len(entries)


def _rank(parameter: Parameter) -> int:
    return 0 if parameter.is_text else 1 if parameter.number == UNITS else 2


def _number(store: Store, parameter: Parameter, value: object, is_metric: bool) -> float:
    """A number from the file, in the unit of the store."""
    letter = store.letter_of(parameter)
    if isinstance(value, str):
        number = values.parsed(parameter, value, is_metric, letter)
    else:
        number = _plain_number(parameter, value)
    if is_metric == store.is_metric:
        return float(number)
    factor = 1.0 / MM_PER_INCH if is_metric else MM_PER_INCH
    return values.scaled(parameter, float(number), factor, letter)


def _plain_number(parameter: Parameter, value: object) -> float:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, OverflowError):
        raise SettingError(parameter, value, values.accepted(parameter)) from None
