"""A loaded program: its texts, labels and findings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from msgspec import Struct, field

from openacr.cnc.canonical import Source
from openacr.cnc.program.labels import Part, Place
from openacr.cnc.reading.findings import Finding
from openacr.cnc.reading.text import decoded

CYCLES_FILE = "CYCLES.TXT"
MANY = 20_000  # nodes kept


class Node:
    """One line in use: its text, its prepared block, and the next line."""

    __slots__ = ("after", "is_include", "line", "next", "offset", "part", "raw", "ready", "source")

    def __init__(self, part: Part, line: int, raw: str, after: int, offset: int = -1) -> None:
        self.part = part
        self.offset = offset  # -1: not of the text
        self.line = line
        self.raw = raw
        self.after = after  # offset of the next line
        self.is_include = False  # another text follows
        self.next: Node | None = None
        self.ready: Any = None  # the block prepared by the interpreter
        self.source = Source(part.text.name, line, raw)


class OPlace(Struct, frozen=True):
    """An O-word and its position."""

    kind: str
    place: Place


class Program(Struct, eq=False):
    """Texts with their labels, includes and M codes of the user."""

    main: Part
    folder: Path | None = None
    parts: list[Part] = field(default_factory=list)
    includes: dict[tuple[str, int], Part] = field(default_factory=dict)  # by file and line
    customs: dict[int, Part] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    has_cycles: bool = False
    own_cycles: Part | None = None  # those of a dialect that needs no $I
    o_words: dict[str, list[OPlace]] = field(default_factory=dict)

    @property
    def errors(self) -> list[Finding]:
        """The errors, for which the program cannot be started."""
        return [finding for finding in self.findings if finding.is_error]

    @property
    def cycles(self) -> Part:
        """The text whose labels lead to the cycles."""
        return self.own_cycles or self.main

    @property
    def line_cnt(self) -> int:
        """Lines of the main text."""
        return self.main.line_cnt

    def text_of(self, source: Source) -> str:
        """The text of the line an entry comes from; entries of polylines do not carry it."""
        if source.text:
            return source.text
        for part in (self.main, *self.parts):
            if part.text.name == source.file:
                return part.line(source.line)
        return ""


class Nodes:
    """Lines of a program as nodes; those in use are kept."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._kept: dict[tuple[int, int], Node] = {}

    def at(self, place: Place) -> Node | None:
        """The line at a position; None after the last line of a program."""
        key = (id(place.part), place.offset)
        node = self._kept.get(key)
        if node is None:
            node = self._made(place)
            if node is not None:
                self._cache(key, node)
        return node

    def _made(self, place: Place) -> Node | None:
        found = place.part.text.line(place.offset)
        if found is None:
            continues_at = place.part.continues_at
            return self.at(continues_at) if continues_at else None
        node = Node(place.part, place.line, decoded(found[0]), found[1], place.offset)
        node.is_include = (place.part.text.name, place.line) in self._program.includes
        return node

    def _cache(self, key: tuple[int, int], node: Node) -> None:
        if len(self._kept) >= MANY:
            for kept in self._kept.values():
                kept.next = None
            self._kept.clear()
        self._kept[key] = node

    def next_after(self, node: Node) -> Node | None:
        """The next line, which is in the included text after an $I."""
        part = self._program.includes.get((node.part.text.name, node.line))
        if part is not None:
            return self.at(part.start)
        return self.at(Place(node.part, node.after, node.line + 1))
