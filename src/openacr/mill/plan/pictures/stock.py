"""Material that end mills leave of a blank: a field of heights for stock removal in three axes."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import Any

import numpy as np
import numpy.typing as npt

from openacr.compiled import pick
from openacr.mill.config.tools import Tip
from openacr.mill.plan.pictures import removal_cy as core

Array = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]
Place = tuple[float, float, float]

TOGETHER = 4096  # moves between two reports of progress
_moves = pick(core.removal_moves)


class Sweep(IntEnum):
    """What a move does to material."""

    CUTS = core.CUTS
    CROSSES = core.CROSSES  # a rapid: what it touches is marked
    PASSES = core.PASSES  # a rapid from an unknown place: nothing


class Mark(IntFlag):
    """What happened in a cell, or in a move."""

    RAPID = core.RAPID  # a rapid move touched material
    BELOW = core.BELOW  # a cutting move went below the bottom of the blank


@dataclass(frozen=True, slots=True)
class Cutter:
    """An end mill; its radius in the unit of the places."""

    radius: float
    tip: Tip = Tip.FLAT


@dataclass(frozen=True, slots=True)
class Blank:
    """The box of material before anything is cut."""

    low: Place
    high: Place

    def cells(self, cell: float) -> tuple[int, int]:
        """How many square cells cover it along X and Y."""
        width, depth = (h - l for l, h in zip(self.low[:2], self.high[:2], strict=True))
        return max(1, math.ceil(width / cell - 1e-9)), max(1, math.ceil(depth / cell - 1e-9))


class Stock:
    """Heights of the material: `heights[row, column]` is at the middle of a cell, Y by X."""

    def __init__(self, blank: Blank, cell: float, tolerance: float = 0.0) -> None:
        """`tolerance`: a rapid less deep, or a cut less far below the blank, is not marked."""
        self.blank, self.cell, self.tolerance = blank, cell, tolerance
        columns, rows = blank.cells(cell)
        self.heights: Array = np.full((rows, columns), blank.high[2], np.float64)
        self.marks: Bytes = np.zeros((rows, columns), np.uint8)

    def remove(
        self,
        cutter: Cutter,
        places: Array,
        sweeps: Bytes,
        report: Callable[[int], None] = lambda _cnt: None,
    ) -> Bytes:
        """Remove what moves sweep; the marks of each of them.

        `places` has the begin of the first move and the end of every one, `report` gets the count
        of moves done since the last call. A cutter without a radius removes nothing.
        """
        numbers = np.zeros(core.G_SIZE)
        numbers[[core.G_X_U, core.G_Y_U]] = self.blank.low[:2]
        numbers[[core.G_ROWS, core.G_COLUMNS]] = self.heights.shape
        numbers[[core.G_BOTTOM_U, core.G_TOP_U]] = self.blank.low[2], self.blank.high[2]
        numbers[[core.G_CELL_U, core.G_TOLERANCE_U]] = self.cell, self.tolerance
        numbers[[core.G_RADIUS_U, core.G_IS_BALL]] = cutter.radius, cutter.tip
        found = np.zeros(len(sweeps), np.uint8)
        flat = np.ascontiguousarray(places, np.float64).reshape(-1)
        arrays = (self.heights, self.marks, numbers, flat, sweeps, found)
        H, M, G, P, K, R = (_view(each) for each in arrays)
        for first in range(0, len(sweeps), TOGETHER):
            count = min(TOGETHER, len(sweeps) - first)
            if cutter.radius > 0.0:
                _moves(H, M, G, P, K, R, first, count)
            report(count)
        return found

    @property
    def removed(self) -> float:
        """The volume that was removed."""
        return float((self.blank.high[2] - self.heights).sum()) * self.cell**2


def _view(array: npt.NDArray[Any]) -> Any:
    """The numbers of an array, one after the other."""
    flat: Any = array.reshape(-1)
    return memoryview(flat)
