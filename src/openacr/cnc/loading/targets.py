"""Labels and the jumps to them, collected while a program is loaded."""

from __future__ import annotations

from collections.abc import Iterator

from openacr.cnc.loading.checks import Report
from openacr.cnc.program.labels import Labels, Part, Place
from openacr.cnc.reading.findings import CodeError, Finding, found
from openacr.cnc.reading.text import decoded

MOST_LABELS = 1_000_000
FIRST_CYCLE_LABEL = 70_000


class Targets:
    """The labels and jumps of a program, to find jumps without a target."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._jumps: list[tuple[Part, int, str, int, int]] = []

    def add_label(self, label: int, place: Place, *, is_barred: bool) -> None:
        """Add a label; `is_barred`: labels of the cycles are refused."""
        labels = place.part.labels
        first = labels.get(label)
        if first is not None:
            raise CodeError("E221", 1, f"N{label}", first_at(first))
        if is_barred and label > FIRST_CYCLE_LABEL:
            raise CodeError("E263", 1, f"N{label}")
        if len(labels) >= MOST_LABELS:
            raise CodeError("E270", 1)
        labels.add(label, place)

    def make_room(self, part: Part, count: int, line: int) -> None:
        """Check that `count` more labels of plain lines fit."""
        if len(part.labels) + count > MOST_LABELS and "E270" not in self._report.warned:
            self._report.warned.add("E270")
            self._report.findings.append(found("E270", part.text.name, line))

    def jump(self, place: Place, column: int, label: int) -> None:
        """Add a jump of the present line to a label."""
        _, line, raw = self._report.where
        self._jumps.append((place.part, line, raw, column, label))

    def missed(self) -> Iterator[Finding]:
        """Jumps without a label, or to a label that belongs to the cycles."""
        for part, line, raw, column, label in self._jumps:
            place = part.labels.get(label)
            if place is None or (place.part.is_cycles and not part.is_cycles):
                code = "E220" if place is None else "E264"
                yield found(code, part.text.name, line, column, f"N{label}", "", raw)


def double_labels(parts: list[Part]) -> Iterator[Finding]:
    """Labels that plain lines define twice."""
    for part in {id(part.labels): part for part in parts}.values():
        for label, first, second in part.labels.doubles():
            text = second.part.text
            taken = text.line(second.offset)
            raw = decoded(taken[0]) if taken else ""
            yield found("E221", text.name, second.line, 1, f"N{label}", first_at(first), raw)


def labels_of_cycles(labels: Labels) -> Iterator[Finding]:
    """Labels of a program that belong to the cycles."""
    for label, place in labels.above(FIRST_CYCLE_LABEL):
        if not place.part.is_cycles:
            yield found("E263", place.part.text.name, place.line, detail=f"N{label}")


def first_at(place: Place) -> str:
    """The hint that names the first definition of a label."""
    return f"first in line {place.line} of {place.part.text.name}"
