"""The text of one program or PLC as a file enters it."""

import re
from dataclasses import dataclass, field
from typing import NamedTuple

from msgspec import Struct

from openacr.basic.language.loader import FileLine
from openacr.basic.language.parser import LONGEST_LABEL
from openacr.basic.language.scope import Scope
from openacr.basic.memory.program_store import StoredLine
from openacr.basic.vm.outline import Outline
from openacr.errors import CardError
from openacr.lang.lexer import Token, plain, tokens
from openacr.lang.source import Span
from openacr.plc.reader import PlcLine

HIDDEN_STEP = 10
_LABEL = re.compile(r"[ \t]*_[ \t]*([A-Za-z0-9]+)")


class Finding(Struct, frozen=True):
    """What is wrong in a line of a text: an error of the card, or a warning with its text."""

    line: FileLine
    error: CardError | None
    span: Span | None = None
    warning: str = ""
    hint: str = ""


class TextLine(NamedTuple):
    """A stored line, its place in the file, and the column before which it begins there.

    `rung` is what the line of a PLC means; `scope` is what the line of a program refers to.
    """

    number: int
    place: FileLine
    outline: Outline
    scope: Scope
    start: int = 0
    rung: PlcLine | None = None

    @property
    def tokens(self) -> tuple[Token, ...]:
        """The tokens without a line number, with their columns in the file."""
        return tuple(token for token in tokens(self.place.text) if token.column > self.start)

    @property
    def stored(self) -> StoredLine:
        """The line as the card holds it."""
        text = plain(self.place.text[self.start :])
        read = None if self.rung is None else (self.tokens, self.rung)
        return StoredLine(self.number, text, self.scope, 0, read)


@dataclass(slots=True)
class Text:
    """The text of one program or PLC as it is stored."""

    lines: dict[int, TextLine] = field(default_factory=dict)
    lost: set[str] = field(default_factory=set)  # the words of lines that could not be read
    last: int = 0  # no line has a higher number
    _is_sorted: bool = True  # the lines have been stored in their order

    def next_number(self) -> int:
        """The hidden number of the next line of free-form text."""
        return self.last - self.last % HIDDEN_STEP + HIDDEN_STEP

    def put(self, line: TextLine) -> None:
        """Store a line."""
        self.lines[line.number] = line
        if line.number > self.last:
            self.last = line.number
        else:
            self._is_sorted = False

    def clear(self) -> None:
        """Forget all lines."""
        self.lines.clear()
        self.lost.clear()
        self.last, self._is_sorted = 0, True

    def in_order(self) -> list[TextLine]:
        """The lines by their numbers."""
        if self._is_sorted:
            return list(self.lines.values())
        return [self.lines[number] for number in sorted(self.lines)]

    def stored(self) -> list[StoredLine]:
        """The lines as the card holds them."""
        return [line.stored for line in self.in_order()]

    def rungs(self) -> list[tuple[int, PlcLine]]:
        """The lines of a PLC with their numbers."""
        return [(line.number, line.rung) for line in self.in_order() if line.rung is not None]


def label_of(text: str, start: int = 0) -> str | None:
    """The label of a line; None if there is none or it is too long."""
    found = _LABEL.match(text, start)
    return found[1] if found and len(found[1]) <= LONGEST_LABEL else None
