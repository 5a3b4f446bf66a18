"""Many elements at once: a contour as rows of moves, the rows beside it, and who watches them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from openacr.cnc.canonical import AXES, PLANES, Moves
from openacr.cnc.canonical.batches import Origin
from openacr.cnc.geometry.elements import Element
from openacr.cnc.rows.moves import ARC, CURVE, RAPID, ROW
from openacr.cnc.rows.room import doubles, integers

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from openacr.cnc.canonical import Pace, Point
    from openacr.cnc.compensation.rows import Piece, Table


class Many:
    """A contour, with the paces and texts of its elements and of those that wait from before."""

    def __init__(self, contour: Moves, start: Point, waiting: Iterable[Piece[object]]) -> None:
        self.contour = contour
        self.start = start
        self.still: set[int] = set()  # those that move nothing in the plane
        self._paces: list[Pace] = list(contour.paces)
        self._origins = list(contour.origins)
        self._texts: dict[int, str] = {}  # of what waits, by slot
        for piece in waiting:
            self._number(piece)

    def _number(self, piece: Piece[object]) -> None:
        source, pace = piece.element.source, piece.element.pace
        self._texts[piece.slot] = source.text
        files = [origin.file for origin in self._origins[len(self.contour.origins) :]]
        if source.file not in files:
            files.append(source.file)
            self._origins.append(Origin(source.file, lambda slot, _: self._texts[slot]))
        text = len(self.contour.origins) + files.index(source.file)
        piece.number(source.line, len(self._paces), text)
        if pace is not None:
            self._paces.append(pace)

    def element(self, k: int, start: Point) -> Element:
        """One element by itself."""
        kind, _, pace, plane, *_ = self.contour.rows[ROW * k : ROW * (k + 1)]
        x, y, sweep = self.contour.arcs[CURVE * k : CURVE * k + 3] if kind == ARC else (0.0,) * 3
        return Element(
            self.contour.source_of(k),
            PLANES[plane],
            start,
            self.contour.end_of(k),
            None if kind == RAPID else self._paces[pace],
            (x, y) if kind == ARC else None,
            sweep,
        )

    def elements(self) -> Iterator[Element]:
        """The elements of the contour one by one."""
        start = self.start
        for k in range(len(self.contour)):
            if k not in self.still:
                yield self.element(k, start)
            start = self.contour.end_of(k)

    def issued(self, table: Table, count: int) -> Moves:
        """The moves of the tool that are in the table."""
        rows, ends = integers(count * ROW), doubles(count * AXES)
        arcs = doubles(count * CURVE)
        rows[:], ends[:] = table.rows[: count * ROW], table.ends[: count * AXES]
        arcs[:] = table.arcs[: count * CURVE]
        return Moves(tuple(self._origins), rows, ends, arcs, tuple(self._paces))


class Watch(Protocol):
    """An observer of whole chains (`ChainCheck`)."""

    def contour(self, element: Element) -> None:
        """Receive an element of the programmed contour."""

    def centre_path(self, element: Element, radius: float) -> None:
        """Receive a move of the tool."""

    def elements(self, many: Many) -> None:
        """Receive many elements of the programmed contour."""

    def tool_moves(self, moves: Moves, extra: Sequence[float]) -> None:
        """Receive many moves of the tool; `extra`: EXTRA numbers of each (`chain_cy`)."""

    def end(self) -> None:
        """Receive the end of the chain."""
