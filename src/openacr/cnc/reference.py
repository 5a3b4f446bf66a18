"""Write the page of all codes from their tables: `python -m openacr.cnc.reference FILE`."""

import sys
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path

from openacr.cnc import occupied
from openacr.cnc.codes import DIALECTS, Axes, Code, Dialect, Group, Limit, Step
from openacr.cnc.dialects import acromill, rs274ngc  # noqa: F401  fill the dialects
from openacr.cnc.findings import TEXTS

MADE_BY = "Written by `make docs` from the tables of `openacr.cnc`; do not edit."
LETTERS = "Words that act by themselves. Other letters are data of the codes of their block."
OCCUPIED = (
    "Programs of the card, part programs and other hosts leave these alone; part programs may read"
    " them."
)
GROUPS = {
    Group.MOTION: "motion",
    Group.PLANE: "plane",
    Group.DISTANCE: "distance",
    Group.UNIT: "unit",
    Group.COMPENSATION: "radius compensation",
    Group.LENGTH: "length",
    Group.CYCLE: "cycle",
    Group.RETURN_LEVEL: "return level",
    Group.SCALE: "scale",
    Group.WORK: "work system",
    Group.MACRO: "modal macro",
    Group.PATH: "path mode",
    Group.ROTATION: "rotation",
    Group.CENTRES: "I and J",
    Group.FEED_MODE: "feed mode",
    Group.ZERO: "floating zero",
}
AXES = {
    Axes.NONE: "",
    Axes.DATA: "axes",
    Axes.MOVE: "axes",
    Axes.MODAL: "",
    Axes.BARRED: "no axes",
}
STEPS = {step: step.name.lower().replace("_", " ") for step in Step}


def page() -> str:
    """The whole page."""
    parts = ["# Codes of part programs", MADE_BY]
    for dialect in DIALECTS.values():
        parts += _dialect(dialect)
    parts += ["## What the front end occupies on a card", OCCUPIED, _occupied()]
    parts += ["## Errors and warnings", _findings()]
    return "\n\n".join(parts) + "\n"


def _dialect(dialect: Dialect) -> Iterator[str]:
    table = dialect.table
    yield f"## Dialect {dialect.name}"
    order = ", ".join(STEPS[step] for step in dialect.order)
    yield f"A block acts in this order, whatever the order of its words: {order}."
    yield f"### G codes of {dialect.name}"
    yield _codes(table.gcodes.values(), has_groups=True)
    yield f"### M codes of {dialect.name}"
    yield _codes(table.mcodes.values(), has_groups=False)
    named = [code for name, code in table.letters.items() if len(name) == 1]
    if named:
        yield f"### Words of {dialect.name}"
        yield LETTERS
        yield _rows(("word", "meaning"), ((code.letter, code.summary) for code in named))


def _codes(codes: Iterable[Code], *, has_groups: bool) -> str:
    """Codes of one function stand in one row."""
    ordered = sorted(codes, key=lambda code: code.number)
    head = ("code", "group", "words", "meaning") if has_groups else ("code", "words", "meaning")
    rows = []
    for _, same in groupby(ordered, key=lambda code: (id(code.act), code.group, code.words)):
        run = list(same)
        names = _names(run)
        cells = [names, _words(run[0]), run[0].summary]
        if has_groups:
            cells.insert(1, GROUPS[run[0].group] if run[0].group else "")
        rows.append(tuple(cells))
    return _rows(head, rows)


def _names(codes: list[Code]) -> str:
    """`G17`, `G17 G18 G19`, or `G101 ... G199` for many."""
    if len(codes) > 4:
        return f"{codes[0].name} … {codes[-1].name}"
    return " ".join(code.name for code in codes)


def _words(code: Code) -> str:
    if code.takes_all:
        return "all letters are arguments"
    words = [letter for letter in dict.fromkeys(code.words) if letter != code.letter]
    parts = [AXES[code.axes], " ".join(words), *map(_limit, code.limits)]
    return "; ".join(part for part in parts if part)


def _limit(limit: Limit) -> str:
    need = " needed" if limit.is_needed else ""
    return f"{limit.letter} {limit.low:g} to {limit.high:g}{need} ({limit.error})"


def _occupied() -> str:
    rows = ((row.shown, row.name, row.meaning) for row in occupied.TABLE)
    return _rows(("number", "name", "meaning"), rows)


def _findings() -> str:
    return _rows(("code", "meaning"), TEXTS.items())


def _rows(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [f"| {' | '.join(head)} |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def main() -> None:
    """Write the page to the file named in the arguments."""
    Path(sys.argv[1]).write_text(page(), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
