"""The programs and PLCs in the lines of a controller file, and what each of them names."""

from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass, field

from msgspec import Struct

from openacr.basic.language.registry import Level
from openacr.editing.controller.facts import NOTHING, Facts, facts_of
from openacr.editing.document import Document
from openacr.project import Place, place_of

_LEVELS = {Place.SETUP: Level.SYS, Place.PROGRAM: Level.PROG, Place.PLC: Level.PLC}


class Section(Struct, frozen=True):
    """Lines of one level: from the first one up to the last one, which is excluded."""

    first: int
    last: int
    level: Level
    number: int

    @property
    def title(self) -> str:
        """As the prompt names it: `PROG3`."""
        return (
            str(self.level.name) if self.level is Level.SYS else f"{self.level.name}{self.number}"
        )

    @property
    def is_plc(self) -> bool:
        """Whether its lines belong to a PLC."""
        return self.level is Level.PLC


@dataclass(slots=True)
class Outline:
    """The sections of a document and the facts of its lines."""

    sections: list[Section] = field(default_factory=list)
    facts: list[tuple[int, Facts]] = field(default_factory=list)  # of lines that say something
    lines: list[str] = field(default_factory=list)  # the text it was made of

    def section_at(self, line: int) -> Section:
        """The section of a line."""
        found = [section for section in self.sections if section.first <= line]
        return found[-1]

    def labels(self, section: Section) -> Iterator[tuple[str, int]]:
        """The labels of a section with their lines."""
        for line, facts in self.facts[_from(self.facts, section.first) :]:
            if line >= section.last:
                break
            if facts.label:
                yield facts.label, line


def outline(document: Document, known: Outline | None = None) -> Outline:
    """The outline of a document; of `known`, an earlier one, what has not changed is kept."""
    lines = list(document.lines)
    before = [] if known is None else known.lines
    first = _equal(before, lines)
    last = _equal(before[first:][::-1], lines[first:][::-1])
    said = [] if known is None else known.facts
    kept, beyond = _from(said, first), _from(said, len(before) - last)
    fresh = ((line, facts_of(lines[line])) for line in range(first, len(lines) - last))
    middle = [(line, facts) for line, facts in fresh if facts is not NOTHING]
    shift = len(lines) - len(before)
    moved = [(line + shift, facts) for line, facts in said[beyond:]] if shift else said[beyond:]
    facts = [*said[:kept], *middle, *moved]
    return Outline(_sections(document, facts), facts, lines)


def _equal(one: list[str], other: list[str]) -> int:
    """How many lines at the beginning of two texts are equal."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if one[low:middle] == other[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low


def _from(said: list[tuple[int, Facts]], line: int) -> int:
    """The place of the first facts of a line or of one after it."""
    return bisect_left(said, line, key=lambda each: each[0])


def _sections(document: Document, said: list[tuple[int, Facts]]) -> list[Section]:
    place, number = place_of(document.path)
    starts = [(0, _LEVELS[place], number)]
    starts += [(line, *facts.level) for line, facts in said if facts.level is not None]
    ends = [first for first, _, _ in starts[1:]] + [len(document.lines)]
    return [
        Section(first, last, level, number)
        for (first, level, number), last in zip(starts, ends, strict=True)
    ]
