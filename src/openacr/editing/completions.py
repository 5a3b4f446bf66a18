"""What an editor proposes while typing, and how a call is written."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import NamedTuple

from msgspec import Struct

from openacr.editing.document import Place, Span
from openacr.editing.marks import Kind
from openacr.editing.texts import short
from openacr.map import Flag, Parameter, flag, flag_names, parameter, parameter_names

MOST_RECORDS = 100
MOST_ITEMS = 500  # at once; more are proposed as the word goes on
FEWEST_LETTERS = 3  # of a word that is looked for in names of parameters and flags
_Rows = tuple[Callable[[int], Parameter | Flag], Callable[[], dict[int, str]], str]
_RECORDS: dict[Kind, _Rows] = {
    Kind.PARAMETER: (parameter, parameter_names, "P"),
    Kind.FLAG: (flag, flag_names, "BIT"),
}


class Item(Struct, frozen=True):
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

    @classmethod
    def of(
        cls, place: Place, typed: str, items: Iterable[Item], *, is_whole: bool = True
    ) -> "Completion":
        """The items that what was typed before a place may become, the first of very many."""
        span = Span(Place(place.line, place.column - len(typed)), place)
        found = beginning_with(typed, items)
        return cls(span, found[:MOST_ITEMS], is_whole and len(found) <= MOST_ITEMS)


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


def by_number(digits: str, kind: Kind) -> list[Item]:
    """Parameters or flags whose number begins with the digits typed so far."""
    row_of, names, prefix = _RECORDS[kind]
    found = (str(number) for number in names() if str(number).startswith(digits))
    return [
        Item(f"{prefix}{name}", kind, short(row := row_of(int(name))), name, name, row)
        for name in islice(found, MOST_RECORDS)
    ]


def by_name(word: str) -> Iterator[Item]:
    """Parameters and flags whose names hold what was typed."""
    if len(word) < FEWEST_LETTERS:
        return
    wanted = word.lower()
    for kind, (row_of, names, prefix) in _RECORDS.items():
        found = (number for number, name in names().items() if wanted in name.lower())
        for number in islice(found, MOST_RECORDS):
            row, name = row_of(number), f"{prefix}{number}"
            yield Item(f"{short(row)} ({name})", kind, name, name, word, row)
