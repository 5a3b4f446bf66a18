"""A text that is being edited: its lines, changes of it, and columns in UTF-16.

Lines end with CR LF, LF or CR, as editors count them. Places are counted from 0; columns count
characters, those of editors other units: bytes, or 16-bit units.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

_LINE = re.compile(r"([^\r\n]*)(\r\n|\n|\r|\Z)")
_HALF = re.compile("[\ud800-\udfff]")  # half a character, which no file can hold
REPLACEMENT = "\ufffd"  # as wide for editors
BEYOND_16_BITS = 0xFFFF


class Place(NamedTuple):
    """A line and a column, from 0."""

    line: int
    column: int


class Span(NamedTuple):
    """From a place up to another one."""

    start: Place
    end: Place


class Edit(NamedTuple):
    """A text that takes the place of a span."""

    span: Span
    text: str


@dataclass(slots=True)
class Document:
    """The lines of a text without their ends, and the ends; the last one is empty."""

    path: Path
    lines: list[str] = field(default_factory=lambda: [""])
    ends: list[str] = field(default_factory=lambda: [""])
    language: str = ""  # as the editor names it
    revision: int = 0  # another one after every change

    @classmethod
    def of(cls, path: Path, text: str, language: str = "") -> "Document":
        """A document with this text."""
        lines, ends = _split(text)
        return cls(path, lines, ends, language)

    @property
    def text(self) -> str:
        """The whole text."""
        return "".join(part for pair in zip(self.lines, self.ends, strict=True) for part in pair)

    @property
    def data(self) -> bytes:
        """The whole text as a file would hold it."""
        return self.text.encode(errors="replace")

    @property
    def whole(self) -> Span:
        """From the first to the last character."""
        last = len(self.lines) - 1
        return Span(Place(0, 0), Place(last, len(self.lines[last])))

    def replace(self, text: str) -> None:
        """Take over another text."""
        self.lines, self.ends = _split(text)
        self.revision += 1

    def apply(self, edit: Edit) -> None:
        """Change a span; a place that does not exist is the nearest one that does."""
        start, end = sorted(map(self.nearest, edit.span))
        first, last = start.line, end.line
        before, after = self.lines[first][: start.column], self.lines[last][end.column :]
        if first and self.ends[first - 1] == "\r":  # it may become one end with what follows
            first -= 1
            before = f"{self.lines[first]}\r{before}"
        lines, ends = _split(f"{before}{edit.text}{after}{self.ends[last]}")
        if self.ends[last]:  # the empty line after that end is the next one
            lines.pop(), ends.pop()
        self.lines[first : last + 1] = lines
        self.ends[first : last + 1] = ends
        self.revision += 1

    def nearest(self, place: Place) -> Place:
        """The place itself, or the nearest one in the text."""
        line = min(max(place.line, 0), len(self.lines) - 1)
        if place.line > line:
            return Place(line, len(self.lines[line]))
        if place.line < line:
            return Place(0, 0)
        return Place(line, min(max(place.column, 0), len(self.lines[line])))

    def place_of(self, line: int, units: int, width: Callable[[str], int]) -> Place:
        """The place of a column in other units; within a character it is that character."""
        if not 0 <= line < len(self.lines):
            return self.nearest(Place(line, 0))
        text = self.lines[line]
        if text.isascii():
            return self.nearest(Place(line, units))
        column = 0
        for character in text:
            units -= width(character)
            if units < 0:
                break
            column += 1
        return Place(line, column)


def units_of(text: str) -> int:
    """The 16-bit units of a text."""
    return len(text) if text.isascii() else len(text) + sum(map(_is_long, text))


def _is_long(character: str) -> bool:
    return ord(character) > BEYOND_16_BITS


def _split(text: str) -> tuple[list[str], list[str]]:
    found: Iterable[tuple[str, str]] = _LINE.findall(_HALF.sub(REPLACEMENT, text))
    lines, ends = [], []
    for line, end in found:
        lines.append(line)
        ends.append(end)
        if not end:
            break
    return lines, ends
