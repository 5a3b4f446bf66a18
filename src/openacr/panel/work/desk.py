"""Texts that browsers edit, as the engine of editors holds them, in a process of their own.

A browser names its text by a mark of its own and sends it whole once, then only what changes. Each
text is in a folder of its own, which is on no disk, beside the set-up of the card that it is for.
"""

from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from openacr.editing.document import Edit, Place, Span, units_of
from openacr.editing.engine import Engine

FOLDERS = Path("/no-folder")
MOST_OPEN = 16
SETUP = "setup.8k"

Change = tuple[int, int, int, int, str]  # from line and column, to line and column, new text


@dataclass(frozen=True, slots=True)
class State:
    """How a browser brings its text up to date: whole, or changes of the version it sent last."""

    mark: str
    name: str  # of a file: prog3.8k and plc0.8k are programs of the card
    version: int
    base: int = 0
    text: str | None = None
    changes: tuple[Change, ...] = ()
    setup: str = ""  # names and memory of the card, as set-up code; sent with the whole text


class Opened:
    """A text with its engine; lines and columns of questions and answers are those of browsers."""

    def __init__(self, state: State) -> None:
        self.engine = Engine()
        folder = FOLDERS / state.mark
        self.path = folder / state.name
        self.version = state.version
        if state.setup and self.path.name.lower() != SETUP:
            self.engine.open(folder / SETUP, state.setup)
        self.document = self.engine.open(self.path, state.text or "")

    def change(self, state: State) -> None:
        """Take changes over, one after the other."""
        for line, column, last_line, last_column, text in state.changes:
            span = Span(self.place(line, column), self.place(last_line, last_column))
            self.engine.change(self.path, [Edit(span, text)])
        self.version = state.version

    def place(self, line: int, column: int) -> Place:
        """The place of a line and a column in 16-bit units, from 0."""
        return self.document.place_of(line, column, units_of)

    def columns(self, line: int, *columns: int) -> list[int]:
        """Columns of a line in 16-bit units."""
        text = self.document.lines[line]
        return list(columns) if text.isascii() else [units_of(text[:each]) for each in columns]

    def span(self, span: Span) -> list[int]:
        """From line and column to line and column, in 16-bit units."""
        start, end = map(self.document.nearest, span)
        return [
            start.line, *self.columns(start.line, start.column),
            end.line, *self.columns(end.line, end.column),
        ]  # fmt: skip

    def edits(self, edits: Iterable[Edit]) -> list[list[object]]:
        """Changes of the text, as a browser sends them."""
        return [[*self.span(edit.span), edit.text] for edit in edits]


class Desk:
    """The texts that are open; the one that was not used longest is closed for another one."""

    def __init__(self) -> None:
        self._open: OrderedDict[str, Opened] = OrderedDict()

    def at(self, state: State) -> Opened | None:
        """A text brought up to date; None where it has to be sent whole."""
        if state.text is not None:
            self._open[state.mark] = Opened(state)
        opened = self._open.get(state.mark)
        if opened is None:
            return None
        self._open.move_to_end(state.mark)
        if len(self._open) > MOST_OPEN:
            self._open.popitem(last=False)
        if state.version != opened.version:
            if state.base != opened.version:
                return None
            opened.change(state)
        return opened
