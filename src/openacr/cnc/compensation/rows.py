"""Pieces of a chain: elements, each with its row of numbers for the geometry."""

from typing import Generic, TypeVar

from openacr.cnc.canonical import AXES
from openacr.cnc.compensation import chain_cy as core
from openacr.cnc.compensation.curve_cy import COLUMNS, comp_fit, comp_place, comp_range
from openacr.cnc.compensation.join_cy import comp_join
from openacr.cnc.compensation.rules import Rules
from openacr.cnc.geometry.elements import Element
from openacr.cnc.reading.line_shapes import doubles, integers
from openacr.cnc.rows.moves import ROW
from openacr.compiled import pick
from openacr.views import I32

Held_co = TypeVar("Held_co", covariant=True)

fit = pick(comp_fit)
join = pick(comp_join)
place = pick(comp_place)
distance = pick(comp_range)


class Piece(Generic[Held_co]):
    """An element of a chain that is being made, and what waits for its end."""

    __slots__ = ("_S", "_at", "element", "held", "held_after", "row", "slot")

    def __init__(self, element: Element, slot: int, S: I32) -> None:
        self.element = element
        self.slot = slot
        self.row = slot * COLUMNS  # in the table
        self.held: list[Held_co | Element] | None = None
        self.held_after: list[Held_co | Element] | None = None
        self._S = S
        self._at = core.S_PIECES + slot * core.PIECE

    @property
    def fits(self) -> int:
        """What `comp_fit` found."""
        return self._S[self._at + core.P_FITS]

    @fits.setter
    def fits(self, found: int) -> None:
        self._S[self._at + core.P_FITS] = found

    @property
    def meets(self) -> int:
        """How the next piece follows."""
        return self._S[self._at + core.P_MEETS]

    @meets.setter
    def meets(self, found: int) -> None:
        self._S[self._at + core.P_MEETS] = found

    @property
    def is_lead_in(self) -> bool:
        """Whether the tool comes to the contour here."""
        return self._S[self._at + core.P_IS_LEAD_IN] != 0

    @is_lead_in.setter
    def is_lead_in(self, is_one: bool) -> None:
        self._S[self._at + core.P_IS_LEAD_IN] = is_one

    @property
    def left_out_cnt(self) -> int:
        """How many elements were left out after it."""
        return self._S[self._at + core.P_LEFT_OUT]

    @left_out_cnt.setter
    def left_out_cnt(self, count: int) -> None:
        self._S[self._at + core.P_LEFT_OUT] = count

    def note_held(self) -> None:
        """Let the core know whether anything waits."""
        self._S[self._at + core.P_HOLDS] = bool(self.held or self.held_after)

    def number(self, line: int, pace: int, text: int) -> None:
        """Say in which lines, paces and texts the numbers of the element are to be found."""
        row = self._S[self._at : self._at + ROW]
        row[1], row[2], row[4], row[5], row[6] = line, pace, self.slot, self.slot, text


class Table:
    """The rows of the pieces, which are used in turn; the state of the chain; what is issued."""

    def __init__(self, rules: Rules, waiting_cnt: int) -> None:
        self.F, self.S = doubles(core.T_SIZE), integers(core.S_SIZE)
        F, S = self.F, self.S
        F[core.T_EPSILON], F[core.T_SWEEP], F[core.T_ROOT] = (
            rules.epsilon, rules.sweep_epsilon, rules.root,
        )  # fmt: skip
        S[core.S_WAITING], S[core.S_LAST] = waiting_cnt, -1
        self.rows, self.ends = integers(core.MOST_OUT * ROW), doubles(core.MOST_OUT * AXES)
        self.arcs = doubles(core.MOST_OUT * core.CURVE)
        self.extra = doubles(core.MOST_OUT * core.EXTRA)
        self.out = self.rows, self.ends, self.arcs, self.extra

    @property
    def chain(self) -> list[int]:
        """The slots of the pieces that are not issued yet."""
        return self.S[core.S_CHAIN : core.S_CHAIN + self.S[core.S_COUNT]].tolist()

    def scratch(self, number: int, row: int) -> int:
        """A copy of a row, to try something on."""
        there = COLUMNS * (core.SLOTS + number)
        self.F[there : there + COLUMNS] = self.F[row : row + COLUMNS]
        return there
