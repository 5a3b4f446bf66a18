"""Write the page of all codes from the tables: `python -m openacr.cnc.reference FILE`."""

import sys
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path

from openacr.cnc import occupied
from openacr.cnc.codes.dialects import acromill, rs274ngc  # noqa: F401  fill the dialects
from openacr.cnc.codes.ngc.named import PREDEFINED
from openacr.cnc.codes.table import DIALECTS, Axes, Code, Dialect, Group, Limit, Step
from openacr.cnc.reading.findings import TEXTS
from openacr.cnc.reading.refusals import other_dialect

MADE_BY = "Written by `make docs` from the tables of `openacr.cnc`; do not edit."
LETTERS = "Words that act by themselves. Other letters are data of the codes of their block."
REFUSED = (
    "What other controls accept and this dialect refuses, with the hint of the error."
    " In addition there are limits of values, and the errors at the end of this page."
)
NAMED = (
    "They show the state where the program is read and cannot be assigned. Other names that begin"
    " with _ belong to the whole program, names without it to one call."
)
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
    """The page as Markdown."""
    parts = ["# Codes of part programs", MADE_BY]
    for dialect in DIALECTS.values():
        parts += _dialect(dialect)
    parts += ["## Named parameters of rs274ngc", NAMED, _named()]
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
    yield f"### Refused by {dialect.name}"
    yield REFUSED
    yield _rows(("what", "error", "reason"), _refused(dialect))


def _refused(dialect: Dialect) -> Iterator[tuple[str, ...]]:
    """Rows of what the dialect refuses with a reason, then of codes only other dialects have."""
    refusals = dialect.grammar.refusals
    for row in refusals.rows:
        yield row.shown, row.error, row.reason
    for other in DIALECTS.values():
        own, theirs = dialect.table, other.table
        pairs = (own.gcodes, theirs.gcodes), (own.mcodes, theirs.mcodes)
        unknown = [[rows[n] for n in sorted(set(rows) - set(known))] for known, rows in pairs]
        left = [[code for code in codes if not refusals.of_code(code.name)] for codes in unknown]
        if any(left):
            yield " ".join(map(_names, filter(None, left))), "E203, E205", other_dialect(other.name)


def _codes(codes: Iterable[Code], *, has_groups: bool) -> str:
    """Rows of codes; codes of one function share a row."""
    ordered = sorted(codes, key=lambda code: code.number)
    head = ("code", "group", "words", "meaning") if has_groups else ("code", "words", "meaning")
    rows = []
    for _, same in groupby(ordered, key=lambda code: (id(code.act), code.group, code.words)):
        run = list(same)
        names = _names(run)
        cells = [names, words_of(run[0]), run[0].summary]
        if has_groups:
            cells.insert(1, group_of(run[0]))
        rows.append(tuple(cells))
    return _rows(head, rows)


def _names(codes: list[Code]) -> str:
    """`G17 G18 G19`, or `G101 … G199` for many in a row."""
    runs: list[list[Code]] = []
    for code in codes:
        if runs and code.number == runs[-1][-1].number + 1:
            runs[-1].append(code)
        else:
            runs.append([code])
    return " ".join(map(_run, runs))


def _run(codes: list[Code]) -> str:
    """Codes of consecutive numbers."""
    if len(codes) > 4:
        return f"{codes[0].name} … {codes[-1].name}"
    return " ".join(code.name for code in codes)


def group_of(code: Code) -> str:
    """The group of codes that replace each other; empty for a code that has none."""
    return GROUPS[code.group] if code.group else ""


def words_of(code: Code) -> str:
    """The words a code uses beside itself, with their limits."""
    if code.takes_all:
        return "all letters are arguments"
    words = [letter for letter in dict.fromkeys(code.words) if letter != code.letter]
    parts = [AXES[code.axes], " ".join(words), *map(_limit, code.limits)]
    return "; ".join(part for part in parts if part)


def _limit(limit: Limit) -> str:
    need = " needed" if limit.is_needed else ""
    return f"{limit.letter} {limit.low:g} to {limit.high:g}{need} ({limit.error})"


def _named() -> str:
    rows = ((named.shown, named.meaning) for named in PREDEFINED.values())
    return _rows(("name", "value"), rows)


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
