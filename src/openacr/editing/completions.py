"""What an editor proposes while typing, and how a call is written."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from openacr.editing.document import Span
from openacr.editing.marks import Kind
from openacr.editing.texts import short
from openacr.map import explain, flags, parameters
from openacr.map.lookup import Flag, Parameter

MOST_RECORDS = 100
FEWEST_LETTERS = 3  # of a word that is looked for in names of parameters and flags


@dataclass(frozen=True, slots=True)
class Item:
    """A proposal: what is shown, what is written, and the row that says what it is."""

    label: str
    kind: Kind
    detail: str = ""
    text: str = ""  # written instead of the label
    sought: str = ""  # compared with what was typed instead of the label
    row: object = None


@dataclass(slots=True)
class Completion:
    """Proposals for the part of a line that is being typed."""

    span: Span
    items: list[Item] = field(default_factory=list)
    is_whole: bool = True  # no other proposals appear while the word goes on


class Signature(NamedTuple):
    """How a command or function is written, its parts, and the one at the cursor (-1: unknown)."""

    label: str
    row: object
    parts: tuple[str, ...] = ()
    active: int = -1


def beginning_with(typed: str, items: Iterable[Item]) -> list[Item]:
    """The items that what was typed may become; one of each label."""
    begin = typed.upper()
    found = [item for item in items if (item.sought or item.label).upper().startswith(begin)]
    first: dict[str, Item] = {}
    for item in found:
        first.setdefault(item.label, item)
    return list(first.values())


def by_number(records: Iterable[Parameter | Flag], digits: str, prefix: str) -> Iterator[Item]:
    """Parameters or flags whose number begins with the digits typed so far."""
    kind = Kind.FLAG if prefix == "BIT" else Kind.PARAMETER
    count = 0
    for record in records:
        if str(record.number).startswith(digits) and explain.has_meaning(record):
            name = str(record.number)
            yield Item(f"{prefix}{name}", kind, short(record), name, name, record)
            count += 1
            if count == MOST_RECORDS:
                return


def by_name(word: str) -> Iterator[Item]:
    """Parameters and flags whose names hold what was typed."""
    if len(word) < FEWEST_LETTERS:
        return
    wanted = word.lower()
    for records, kind in ((parameters(), Kind.PARAMETER), (flags(), Kind.FLAG)):
        count = 0
        prefix = "P" if kind is Kind.PARAMETER else "BIT"
        for record in records.values():
            if wanted in record.name.lower() and explain.has_meaning(record):
                name = f"{prefix}{record.number}"
                yield Item(f"{short(record)} ({name})", kind, name, name, word, record)
                count += 1
                if count == MOST_RECORDS:
                    break
