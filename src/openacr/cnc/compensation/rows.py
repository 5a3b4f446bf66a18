"""Pieces of a chain: elements, each with its row of numbers for the geometry."""

from typing import Generic, TypeVar

from openacr.cnc.compensation.curve_cy import comp_fit, comp_place, comp_range
from openacr.cnc.compensation.join_cy import comp_join
from openacr.cnc.compensation.rules import Rules
from openacr.cnc.geometry.elements import Element
from openacr.cnc.rows import chains
from openacr.cnc.rows.moves import ROW
from openacr.cnc.rows.room import Memory
from openacr.compiled import pick
from openacr.views import I32

Held_co = TypeVar("Held_co", covariant=True)

fit = pick(comp_fit)
join = pick(comp_join)
place = pick(comp_place)
distance = pick(comp_range)


class Piece(Generic[Held_co]):
    """An element of a chain that is being made, and what waits for its end."""

    __slots__ = ("_I", "_at", "element", "held", "held_after", "row", "slot")

    def __init__(self, element: Element, slot: int, I: I32) -> None:
        self.element = element
        self.slot = slot
        self.row = slot * chains.COLUMNS  # in the table
        self.held: list[Held_co | Element] | None = None
        self.held_after: list[Held_co | Element] | None = None
        self._I = I
        self._at = chains.piece[slot * chains.PIECE]

    @property
    def fits(self) -> int:
        """What `comp_fit` found."""
        return self._I[self._at + chains.FITS]

    @fits.setter
    def fits(self, found: int) -> None:
        self._I[self._at + chains.FITS] = found

    @property
    def meets(self) -> int:
        """How the next piece follows."""
        return self._I[self._at + chains.MEETS]

    @meets.setter
    def meets(self, found: int) -> None:
        self._I[self._at + chains.MEETS] = found

    @property
    def is_lead_in(self) -> bool:
        """Whether the tool comes to the contour here."""
        return self._I[self._at + chains.IS_LEAD_IN] != 0

    @is_lead_in.setter
    def is_lead_in(self, is_one: bool) -> None:
        self._I[self._at + chains.IS_LEAD_IN] = is_one

    @property
    def left_out_cnt(self) -> int:
        """How many elements were left out after it."""
        return self._I[self._at + chains.LEFT_OUT]

    @left_out_cnt.setter
    def left_out_cnt(self, count: int) -> None:
        self._I[self._at + chains.LEFT_OUT] = count

    def note_held(self) -> None:
        """Let the core know whether anything waits."""
        self._I[self._at + chains.HOLDS] = bool(self.held or self.held_after)

    def number(self, line: int, pace: int, text: int) -> None:
        """Say in which lines, paces and texts the numbers of the element are to be found."""
        row = self._I[self._at : self._at + ROW]
        row[1], row[2], row[4], row[5], row[6] = line, pace, self.slot, self.slot, text


class Table:
    """The rows of the pieces, which are used in turn; the state of the chain; what is issued."""

    def __init__(self, rules: Rules, waiting_cnt: int) -> None:
        memory = Memory(chains.SIZE)
        self.F, self.I = memory.F, memory.I
        self.F[chains.epsilon_u] = rules.epsilon
        self.F[chains.sweep_epsilon_rad] = rules.sweep_epsilon
        self.F[chains.root_u2] = rules.root
        self.I[chains.most_waiting], self.I[chains.last_slot] = waiting_cnt, -1
        self.at, self.shift = memory.reals(chains.at_u), memory.reals(chains.shift_u)
        self.rows, self.ends = memory.wholes(chains.out_row), memory.reals(chains.out_end_u)
        self.arcs, self.extra = memory.reals(chains.out_arc), memory.reals(chains.out_extra)

    @property
    def chain(self) -> list[int]:
        """The slots of the pieces that are not issued yet."""
        first = chains.waiting.start
        return self.I[first : first + self.I[chains.piece_cnt]].tolist()

    def scratch(self, number: int, row: int) -> int:
        """A copy of a row, to try something on."""
        there = chains.COLUMNS * (chains.SLOTS + number)
        self.F[there : there + chains.COLUMNS] = self.F[row : row + chains.COLUMNS]
        return there
