"""The pieces of a chain and the moves beside them, in the table that the core works on."""

from array import array
from typing import Generic, TypeVar, cast

from openacr.cnc.canonical import AXES, PLANES
from openacr.cnc.compensation import chain_cy as core
from openacr.cnc.compensation.curve_cy import START
from openacr.cnc.compensation.many import Many, Watch
from openacr.cnc.compensation.moves import element_of
from openacr.cnc.compensation.rows import Piece, Table
from openacr.cnc.geometry.elements import Element
from openacr.cnc.rows import chains, moves
from openacr.compiled import pick
from openacr.views import F64, I32

Held = TypeVar("Held")

CODES = {plane: code for code, plane in PLANES.items()}
_lay = pick(core.chain_lay)


class Pieces(Generic[Held]):
    """The table of a chain: elements go in, one or many, and entries and moves come out."""

    def __init__(self, table: Table, watch: Watch | None) -> None:
        self.away = 0.0  # signed distance for the elements to come
        self.news: list[tuple[str, str]] = []  # findings to report with the next element
        self._ready: list[Held | Element] = []
        self._watch = watch
        self._table = table
        self._F, self._I = table.F, table.I
        self._row: I32 = memoryview(array("i", [0] * moves.ROW))  # of one element
        self._end: F64 = memoryview(array("d", [0.0] * AXES))
        self._arc: F64 = memoryview(array("d", [0.0] * moves.CURVE))
        self._pieces: list[Piece[Held] | None] = [None] * chains.SLOTS
        self._many: Many | None = None  # what elements and pieces are numbers of

    def put(self, thing: Held | Element) -> None:
        """Issue an entry, or a move that is not a part of the contour."""
        self._collect()
        self._ready.append(thing)

    def drain(self) -> list[Held | Element]:
        """Return what was issued since the last call."""
        self._collect()
        ready = self._ready
        self._ready = []
        return ready

    def _collect(self) -> None:
        """Take the moves out of the table."""
        count = self._I[chains.out_cnt]
        if not count:
            return
        self._I[chains.out_cnt] = 0
        if self._many is not None:
            issued = self._many.issued(self._table, count)
            self._ready.append(cast(Held, issued))  # many are added where `Held` is any entry
            if self._watch:
                self._watch.tool_moves(issued, self._table.extra[: count * chains.EXTRA].tolist())
            return
        for k in range(count):
            element = element_of(self._table, k, self._pieces)
            self._ready.append(element)
            if self._watch:
                self._watch.centre_path(element, self._table.extra[chains.EXTRA * k + 2])

    def _laid_out(self, element: Element) -> Piece[Held]:
        """Lay out the element that a chain begins with."""
        self._take(element)
        slot = self._I[chains.next_slot]
        _lay(self._F, self._I, self._row, self._end, self._arc, 0)
        return self._piece(slot)

    def _take(self, element: Element) -> None:
        """Write one element where the core takes it from; the next slot is its."""
        F, I, row, slot = self._F, self._I, self._row, self._I[chains.next_slot]
        arc = element.centre is not None
        kind = moves.RAPID if element.pace is None else moves.ARC if arc else moves.LINE
        row[0], row[2], row[3], row[4] = kind, slot, CODES[element.plane], slot
        if element.centre is not None:
            self._arc[0], self._arc[1] = element.centre
            self._arc[2] = element.sweep_rad
        self._end[:] = array("d", element.end)
        self._table.at[:] = array("d", element.start)
        F[chains.away_u] = self.away
        I[chains.tag], I[chains.has_news] = -1, bool(self.news)
        self._pieces[slot] = Piece(element, slot, I)

    def _piece(self, slot: int) -> Piece[Held]:
        """The piece of a slot."""
        at = chains.piece[slot * chains.PIECE] + chains.TAG
        tag, piece = self._I[at], self._pieces[slot]
        if tag >= 0 and self._many is not None:
            start = START + slot * chains.COLUMNS
            element = self._many.element(tag, tuple(self._F[start : start + AXES]))
            piece = self._pieces[slot] = Piece(element, slot, self._I)
            self._I[at] = -1
        if piece is None:
            raise LookupError(slot)
        return piece

    @property
    def _last(self) -> Piece[Held] | None:
        """The piece that was issued last."""
        slot = self._I[chains.last_slot]
        return None if slot < 0 else self._piece(slot)

    @property
    def _chain(self) -> list[Piece[Held]]:
        return [self._piece(slot) for slot in self._table.chain]

    def _known(self) -> list[Piece[Held]]:
        """The pieces of the chain, and the one before them."""
        last = self._last
        return self._chain if last is None else [last, *self._chain]
