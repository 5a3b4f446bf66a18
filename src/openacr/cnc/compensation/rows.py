"""Pieces of a chain: elements, each with its row of numbers for the geometry."""

from typing import Generic, TypeVar

from openacr.cnc.compensation.curve_cy import (
    COLUMNS,
    FITS,
    comp_fit,
    comp_lay,
    comp_place,
    comp_range,
)
from openacr.cnc.compensation.join_cy import JOINED, comp_join, comp_meet
from openacr.cnc.geometry.elements import Element
from openacr.compiled import pick
from openacr.views import F64

Held_co = TypeVar("Held_co", covariant=True)

fit = pick(comp_fit)
lay = pick(comp_lay)
join = pick(comp_join)
meet = pick(comp_meet)
place = pick(comp_place)
distance = pick(comp_range)

SCRATCH_CNT = 3  # rows of the search for the largest radius
ROWS = 16  # more than the pieces that are not issued yet


class Piece(Generic[Held_co]):
    """An element of a chain that is being made, and what waits for its end."""

    __slots__ = (
        "element",
        "fits",
        "held",
        "held_after",
        "is_lead_in",
        "left_out_cnt",
        "meets",
        "row",
    )

    def __init__(self, element: Element, row: int, is_lead_in: bool = False) -> None:
        self.element = element
        self.row = row
        self.is_lead_in = is_lead_in
        self.fits = FITS
        self.meets = JOINED  # how the next piece follows
        self.left_out_cnt = 0  # elements left out after it
        self.held: list[Held_co | Element] | None = None
        self.held_after: list[Held_co | Element] | None = None


class Table:
    """The rows of the pieces; they are used in turn, the last ones stay readable."""

    def __init__(self) -> None:
        self.F: F64 = memoryview(bytearray(8 * COLUMNS * (ROWS + SCRATCH_CNT))).cast("d")
        self.row = 0  # the row to be filled next

    def keep(self) -> int:
        """Let the row that was filled last be that of a piece."""
        row = self.row
        self.row = (row + COLUMNS) % (COLUMNS * ROWS)
        return row

    def scratch(self, number: int, row: int) -> int:
        """A copy of a row, to try something on."""
        there = COLUMNS * (ROWS + number)
        self.F[there : there + COLUMNS] = self.F[row : row + COLUMNS]
        return there
