"""Write the page of all cells from the tables: `python -m openacr.sysvar.reference FILE`."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

from openacr.sysvar.homes import HOMES, Host, Writer
from openacr.sysvar.lookup import known
from openacr.sysvar.schema import AXIS_CELLS, CellKind, Parameter, Row, Tab
from openacr.sysvar.store import Store
from openacr.sysvar.tabs import CELLS, TABS
from openacr.sysvar.values import shown, span

MADE_BY = "Written by `make docs` from the tables of `openacr.sysvar`; do not edit."
UNITS = "Units: u is the default unit (inch or mm), u/m per minute, u/s and u/s2 per second."
KINDS = {
    CellKind.REAL: "number",
    CellKind.INTEGER: "whole number",
    CellKind.BOOLEAN: "true, false",
    CellKind.CHOICE: "choice",
    CellKind.TEXT: "text",
}
WRITERS = {
    Writer.PROGRAM: "yes",
    Writer.WARNED: "yes, with W220",
    Writer.NONE: "no (E212)",
    Writer.SERVICE: "MDI with the service role, else E212",
    Writer.CARD: "where the card allows",
}


def page() -> str:
    """The page as Markdown."""
    parts = ["# Parameters of the CNC side", MADE_BY, UNITS, "## Where numbers live", _map()]
    for tab in (*TABS, CELLS.tab):
        parts += [f"## {tab.name}", _numbers(tab), _table(tab)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _map() -> str:
    lines = ["| P | use | kept by | written by programs |", "|---|---|---|---|"]
    for home in HOMES:
        if home.host is not Host.NONE:
            span = f"{home.first}" if home.first == home.last else f"{home.first}-{home.last}"
            kept = {Host.STORE: "store", Host.CARD: "card, lost with its power"}.get(home.host)
            words = (span, home.use, kept or "card", WRITERS[home.writer])
            lines.append(f"| {' | '.join(words)} |")
    return "\n".join(lines)


def _numbers(tab: Tab) -> str:
    return f"Numbers are those of axis 0; add {AXIS_CELLS} a for axis a." if tab.is_per_axis else ""


def _table(tab: Tab) -> str:
    head = [
        "| P | name | type | unit | default | values | meaning |",
        "|---|---|---|---|---|---|---|",
    ]
    return "\n".join(head + list(_rows(tab)))


def facts_of_cell(found: Parameter) -> dict[str, str]:
    """What the page says of one parameter, by the names of its columns; what is empty is left out.

    The meaning is the text of its row.
    """
    facts = {
        "Tab": found.tab,
        "Type": KINDS[found.kind],
        "Unit": found.row.unit,
        "Default": _defaults(Store(), found.number, found.number),
        "Values": _takes(found),
    }
    return {name: value for name, value in facts.items() if value}


def _rows(tab: Tab) -> Iterator[str]:
    store = Store()
    for row in sorted(tab.rows, key=lambda each: each.k):
        if "reserved" in row.name.lower():
            continue
        found = known(tab.base + row.k)
        words = (
            _span(tab, row),
            row.name.replace("{}", "n") + ("" if row.axis is None else f", axis {row.axis}"),
            KINDS[row.kind],
            row.unit,
            _defaults(store, found.number, found.number + row.step * (row.count - 1)),
            _takes(found),
            row.doc,
        )
        yield f"| {' | '.join(words)} |"


def _span(tab: Tab, row: Row) -> str:
    first = tab.base + row.k
    if row.count == 1:
        return str(first)
    last = first + row.step * (row.count - 1)
    counted = "axis" if row.is_by_axis else f"n = {row.first}..{row.first + row.count - 1}"
    step = f", step {row.step}" if row.step > 1 else ""
    return f"{first}-{last} ({counted}{step})"


def _defaults(store: Store, first: int, last: int) -> str:
    """The default of a cell, or those of the first and last cell of a series."""
    ends = (_default(store, first), _default(store, last))
    return ends[0] if ends[0] == ends[1] else " ... ".join(ends)


def _default(store: Store, n: int) -> str:
    value = store.default(n)
    return value if isinstance(value, str) else shown(store.parameter(n), value)


def _takes(found: Parameter) -> str:
    row = found.row
    if row.is_fixed:
        return "fixed"
    if row.kind is CellKind.CHOICE:
        return ", ".join(_choice(value, word) for value, word in row.words.items())
    return "" if row.kind in (CellKind.BOOLEAN, CellKind.TEXT) else span(found)


def _choice(value: int, word: str) -> str:
    return word if word == str(value) else f"{value} {word}"


def main(arguments: list[str], say: Callable[[str], None] = print) -> None:
    """Write the page into a file."""
    path = Path(arguments[0])
    path.write_text(page(), encoding="utf-8")
    say(str(path))


if __name__ == "__main__":
    main(sys.argv[1:])
