"""The texts of a program, their labels and the lines they name.

Labels of parsed lines are added one by one; those of plain lines, of which there can be
hundreds of thousands, as arrays that are sorted when the first label is looked up.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, TypeAlias

from msgspec import Struct, field

from openacr.cnc.reading.text import Text, decoded

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Rows: TypeAlias = "NDArray[np.int64]"  # label, line, offset


class Place(Struct, frozen=True):
    """The position of a line in a text."""

    part: Part
    offset: int
    line: int


class Labels:
    """The labels of texts that share them."""

    def __init__(self) -> None:
        self._places: dict[int, Place] = {}
        self._rows: list[tuple[Part, Rows]] = []
        self._sorted: list[tuple[Part, Rows]] = []
        self._row_cnt = 0

    def __len__(self) -> int:
        return len(self._places) + self._row_cnt

    def add(self, label: int, place: Place) -> None:
        """Add a label; the first definition stays."""
        self._places.setdefault(label, place)

    def add_rows(self, part: Part, rows: Rows) -> None:
        """Add the labels of many lines of a text."""
        self._rows.append((part, rows))
        self._row_cnt += len(rows)

    def get(self, label: int) -> Place | None:
        """The line with a label."""
        place = self._places.get(label)
        if place is not None or not self._row_cnt:
            return place
        import numpy as np

        for part, rows in self._in_order():
            k = int(np.searchsorted(rows[:, 0], label))
            if k < len(rows) and rows[k, 0] == label:
                return Place(part, int(rows[k, 2]), int(rows[k, 1]))
        return None

    def _in_order(self) -> list[tuple[Part, Rows]]:
        if self._rows:
            by_part: dict[int, tuple[Part, list[Rows]]] = {}
            for part, rows in [*self._sorted, *self._rows]:
                by_part.setdefault(id(part), (part, []))[1].append(rows)
            self._sorted = [(part, _sorted(many)) for part, many in by_part.values()]
            self._rows.clear()
        return self._sorted

    def above(self, limit: int) -> Iterator[tuple[int, Place]]:
        """Labels above a number, with their places."""
        yield from ((label, place) for label, place in self._places.items() if label > limit)
        for part, rows in self._in_order():
            for label, line, offset in rows[rows[:, 0] > limit].tolist():
                yield label, Place(part, offset, line)

    def doubles(self) -> Iterator[tuple[int, Place, Place]]:
        """Labels defined again by rows: with the first definition and each later line."""
        if not self._row_cnt:
            return
        import numpy as np

        firsts, texts = dict(self._places), self._in_order()
        for part, rows in texts:
            labels = rows[:, 0]
            again = labels[1:][labels[1:] == labels[:-1]]
            known = np.fromiter(firsts, np.int64, len(firsts))
            for label in np.union1d(again, np.intersect1d(labels, known)).tolist():
                low, high = np.searchsorted(labels, (label, label + 1)).tolist()
                places = [_place(part, row) for row in rows[low:high]]
                first = firsts.get(label) or places.pop(0)
                yield from ((label, first, place) for place in places)
            if len(texts) > 1:
                firsts = {row[0]: _place(part, row) for row in rows[::-1].tolist()} | firsts


class Part(Struct, eq=False):
    """One text of a program; `labels` are shared with the texts it is added to."""

    text: Text
    labels: Labels = field(default_factory=Labels)
    is_cycles: bool = False
    continues_at: Place | None = None  # where to continue after an included text
    line_cnt: int = 0

    @property
    def start(self) -> Place:
        """The first line."""
        return Place(self, self.text.begin, 1)

    def line(self, number: int) -> str:
        """A line by its number; empty after the last one."""
        found, after = None, self.text.begin
        for _ in range(number):
            found = self.text.line(after)
            if found is None:
                return ""
            after = found[1]
        return decoded(found[0]) if found else ""


def _sorted(many: list[Rows]) -> Rows:
    """Rows by label, equal ones by line."""
    import numpy as np

    rows = np.concatenate(many)
    return rows[np.lexsort((rows[:, 1], rows[:, 0]))]


def _place(part: Part, row: Sequence[int]) -> Place:
    return Place(part, int(row[2]), int(row[1]))
