"""Many moves at once, as arrays: what readers of whole programs get in place of single entries."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from openacr.cnc.canonical.common import PLANES, Pace, Point, Source
from openacr.cnc.canonical.moves import Arc, Line, Rapid
from openacr.cnc.rows.moves import COMPENSATED, CURVE, INSERTED, LINE, POINT, RAPID, ROW

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from openacr.views import F64, I32


class Origin(Struct, frozen=True, eq=False):
    """A text that moves come from; `text_of` reads the line between two places in it."""

    file: str
    text_of: Callable[[int, int], str]


class Moves(Struct, frozen=True, eq=False):
    """Rapids, lines and arcs in their order.

    Each has in `rows` its kind, line, pace (index in `paces`), plane (17 to 19), where its line
    begins and ends, in which text (index in `origins`), and its flags; in `ends` its end point; in
    `arcs`, for arcs, the centre on the first and second axis of the plane, the sweep in radians,
    and the radii at start and end.
    """

    origins: tuple[Origin, ...]
    rows: I32
    ends: F64
    arcs: F64
    paces: tuple[Pace, ...]

    def __len__(self) -> int:
        return len(self.rows) // ROW

    @property
    def source(self) -> Source:
        """Where the first move comes from."""
        return self.source_of(0)

    def source_of(self, k: int) -> Source:
        """Where a move comes from."""
        _, line, _, _, begin, end, origin, _ = self.rows[ROW * k : ROW * (k + 1)]
        found = self.origins[origin]
        return Source(found.file, line, found.text_of(begin, end))

    def end_of(self, k: int) -> Point:
        """Where a move ends."""
        return tuple(self.ends[POINT * k : POINT * (k + 1)])

    def entry(self, k: int) -> Rapid | Line | Arc:
        """One move by itself."""
        kind, _, pace, plane, _, _, _, flags = self.rows[ROW * k : ROW * (k + 1)]
        source, end = self.source_of(k), self.end_of(k)
        marks = flags & INSERTED != 0, flags & COMPENSATED != 0
        if kind == RAPID:
            waits = pace < len(self.paces) and self.paces[pace].is_confirmed
            return Rapid(source, end, marks[0], waits)
        if kind == LINE:
            return Line(source, end, self.paces[pace], *marks)
        x, y, sweep, r0, r1 = self.arcs[CURVE * k : CURVE * (k + 1)]
        paced = self.paces[pace]
        return Arc(source, end, PLANES[plane], (x, y), sweep, r0, r1, paced, *marks)

    def entries(self) -> Iterator[Rapid | Line | Arc]:
        """The moves one by one."""
        return map(self.entry, range(len(self)))
