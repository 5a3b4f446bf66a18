"""Values of forms: read with units and limits, stored together or not at all."""

from collections.abc import Mapping
from typing import Any

from openacr.errors import MapError, UserError
from openacr.panel.forms.form import Form, Group, axes_of
from openacr.sysvar import Store
from openacr.sysvar.driven import is_driven
from openacr.sysvar.lookup import known
from openacr.sysvar.rules import RUN_STATE, RUNNING
from openacr.sysvar.schema import ANY, Parameter
from openacr.sysvar.values import (
    SHOWN_DIGITS,
    SettingError,
    Value,
    limits,
    parsed,
    plain,
    rounded,
    typical,
    unit_of,
)

MOST_ROWS = 400  # of one page


class RefusedError(UserError):
    """Values that were not stored, each with its reason; nothing of the page was stored."""

    def __init__(self, refused: Mapping[str, str]) -> None:
        super().__init__("; ".join(refused.values()))
        self.refused = dict(refused)


# --- reading --------------------------------------------------------------------------


def form_data(form: Form, store: Store, *, axis: int | None, first: int, count: int) -> Any:
    """A form with its rows and values."""
    axes = axes_of(store)
    chosen = None
    if form.is_per_axis:
        known_axes = [index for index, _ in axes]
        chosen = known_axes[0] if axis is None else axis
        if chosen not in known_axes:
            raise UserError(f"axis {chosen} is not configured")
    groups = list(form.groups(store, chosen))
    page = None
    if form.is_paged:
        cells = groups[0].cells
        first = min(max(1, first), len(cells))
        count = min(max(1, count), MOST_ROWS)
        groups = [Group(groups[0].title, cells[first - 1 : first - 1 + count])]
        page = {"first": first, "count": len(groups[0].cells), "total": len(cells)}
    return {
        "name": form.name,
        "title": form.title,
        "section": form.section,
        "role": form.role.word,
        "per_axis": form.is_per_axis,
        "axis": chosen,
        "axes": [{"index": index, "name": name} for index, name in axes],
        "locked": _locked(store),
        "groups": [
            {"title": group.title, "rows": [row_data(store, known(n)) for n in group.cells]}
            for group in groups
        ],
        "page": page,
    }


def _locked(store: Store) -> str:
    """Why rows of motion cannot be stored now; empty if they can."""
    is_running = store.read(RUN_STATE) in RUNNING and is_driven(store.path)
    return "a program is running" if is_running else ""


def row_data(store: Store, found: Parameter) -> dict[str, Any]:
    """One row: what it is, and its value as text."""
    row, letter = found.row, store.letter_of(found)
    value, default = store.value(found.number), store.default(found.number)
    low, high = (None, None) if found.is_text else _range(store, found)
    return {
        "number": found.number,
        "name": found.name,
        "kind": found.kind.name.lower(),
        "axis": found.axis,
        "axis_name": letter,
        "unit": unit_of(found, store.is_metric, letter),
        "value": _text(value),
        "number_value": None if isinstance(value, str) else value,
        "default": _text(default),
        "is_default": value == default,
        "low": low,
        "high": high,
        "low_open": row.is_low_open,
        "words": {str(key): word for key, word in row.words.items()} or None,
        "bits": list(row.bits),
        "noun": row.noun,
        "typical": typical(found, store.is_metric, letter),
        "help": row.doc,
        "motion": row.is_motion,
        "fixed": row.is_fixed,
        "wire": row.wire.value if row.wire else None,
    }


def _range(store: Store, found: Parameter) -> tuple[float | None, float | None]:
    low, high = limits(found, store.is_metric, store.letter_of(found))
    return (None if low == -ANY else low), (None if high == ANY else high)


def _text(value: Value) -> str:
    return value if isinstance(value, str) else plain(rounded(value, SHOWN_DIGITS))


# --- storing --------------------------------------------------------------------------


def save(form: Form, store: Store, values: Mapping[str, str]) -> dict[str, Any]:
    """Store values by cell number: all of them, or none and RefusedError with the reasons.

    Cells that a change of this form implies are stored with it, unless they are given.
    """
    allowed = form.all_cells(store)
    refused: dict[str, str] = {}
    changes: list[tuple[Parameter, Value]] = []
    for key, text in values.items():
        try:
            found = known(_number(key))
            if found.number not in allowed:
                raise UserError(f"P{found.number} is not on the page {form.name}")
            changes.append((found, _parsed(store, found, text)))
        except (UserError, MapError) as error:
            refused[key] = str(error)
    given = {found.number for found, _ in changes}
    changes += [(known(n), v) for n, v in form.implied.items() if changes and n not in given]
    try:
        with store.transaction():
            for found, value in changes:
                _write(store, found, value, refused)
            if refused:
                raise RefusedError(refused)
    except SettingError as error:  # a rule between settings, checked at the end
        raise RefusedError({str(error.parameter.number): str(error)}) from None
    return {"stored": {str(found.number): _text(store.value(found.number)) for found, _ in changes}}


def _write(store: Store, found: Parameter, value: Value, refused: dict[str, str]) -> None:
    try:
        if isinstance(value, str):
            store.write_text(found.number, value)
        else:
            store.write(found.number, value)
    except SettingError as error:
        refused[str(found.number)] = str(error)


def _parsed(store: Store, found: Parameter, text: str) -> Value:
    return parsed(found, text, store.is_metric, store.letter_of(found))


def _number(key: str) -> int:
    try:
        return int(key.strip().lstrip("Pp"))
    except ValueError:
        raise UserError(f"{key!r} is not the number of a cell") from None
