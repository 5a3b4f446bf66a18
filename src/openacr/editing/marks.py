"""What the parts of a line are: the one view of a line that all questions of an editor share."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum, auto

from msgspec import Struct


class Kind(Enum):
    """The kind of a part of a line."""

    COMMAND = auto()  # a command, an instruction of a PLC, a statement
    KEYWORD = auto()  # a word that belongs to a command
    FUNCTION = auto()
    OPERATOR = auto()
    CODE = auto()  # G and M codes
    WORD = auto()  # a letter and its number
    PARAMETER = auto()
    FLAG = auto()
    VARIABLE = auto()
    CELL = auto()  # a parameter of the machine
    AXIS = auto()
    ALIAS = auto()  # of #DEFINE
    LABEL = auto()
    ROUTINE = auto()  # an O-word
    NAMED = auto()  # a named parameter of a part program
    NUMBER = auto()
    STRING = auto()
    REMARK = auto()
    UNKNOWN = auto()


SYMBOLS = frozenset((Kind.ALIAS, Kind.LABEL, Kind.ROUTINE, Kind.NAMED, Kind.AXIS))


class Mark(Struct, frozen=True):
    """A part of a line: columns from 0, the last one excluded.

    `name` is what identifies it among its kind, `number` that of a parameter or flag; `row` is
    the row of a table that says what it is. `place` is the part that is the name itself.
    """

    start: int
    end: int
    kind: Kind
    name: str = ""
    number: int = -1
    row: object = None
    is_definition: bool = False
    place: tuple[int, int] = (0, 0)

    @property
    def own(self) -> tuple[int, int]:
        """The columns of the name itself."""
        return self.place if self.place != (0, 0) else (self.start, self.end)


class Symbol(Struct, frozen=True):
    """What a name stands for, so that equal names of different programs are different."""

    kind: Kind
    name: str
    scope: str = ""


@dataclass(slots=True)
class Names:
    """The names that the files of a project give, for the words of one line."""

    aliases: frozenset[str] = field(default_factory=frozenset)
    axes: frozenset[str] = field(default_factory=frozenset)


def at(marks: Iterable[Mark], column: int) -> Mark | None:
    """The mark at a column, or that ends there."""
    found = [mark for mark in marks if mark.start <= column <= mark.end]
    return next((mark for mark in found if column < mark.end), found[0] if found else None)


def symbols_in(marks: Iterable[Mark]) -> Iterator[Mark]:
    """Those with a name that is defined somewhere."""
    for mark in marks:
        if mark.kind in SYMBOLS and mark.name:
            yield mark
