"""Skip lines at load that can have no error: their count, their labels, the last motion in them.

A line of a shape is read by the loader once. If it finds nothing that depends on the values of
the words, or on the place of the line, lines of that shape are skipped from then on.
"""

from __future__ import annotations

from array import array
from itertools import chain
from typing import TYPE_CHECKING

from openacr.cnc.codes.table import Step
from openacr.cnc.reading import rich_cy, skim_cy
from openacr.cnc.reading.line_shapes import MOST_ROWS, LineShapes
from openacr.cnc.rows import scans
from openacr.cnc.rows.room import doubles, integers
from openacr.compiled import pick

if TYPE_CHECKING:
    from openacr.cnc.codes.block_plan import Plan
    from openacr.cnc.codes.table import Limit
    from openacr.cnc.program.labels import Rows
    from openacr.cnc.reading.text import Text

END_OF_LIMITS = -1.0
END = "M30"  # doubtful as the last block
MOST_LIMITS = 1024  # of the words of all shapes
TENTHS = 10
_skim_lines = pick(skim_cy.skim_lines)


class Skimmer:
    """Skips the lines of a text that are like those the loader has read."""

    def __init__(self, axes: dict[str, int], bracket: str) -> None:
        self._shapes = LineShapes(axes, bracket)
        self._labels = integers(3 * MOST_ROWS)
        self._limits = doubles(skim_cy.LIMIT * MOST_LIMITS)
        self._limits[skim_cy.LETTER] = END_OF_LIMITS  # for shapes without any
        self._limits_end = skim_cy.LIMIT
        self._asked: list[int] = []  # the shape of the line that comes next, if it is new
        self.motion = -1  # the last of G0 to G3 in these lines, -1 none
        self.has_words = False  # whether one of these lines was not empty
        self._place = 0  # of the lines in the window

    def skim(self, text: Text, offset: int) -> tuple[int, int]:
        """Skip lines at an offset; returns their count and the offset after them."""
        self._asked = []
        if offset >= text.end:
            return 0, offset
        shapes = self._shapes
        data, place = shapes.bytes(text, offset)
        stop = min(len(data), text.end - offset + place)
        F, I = shapes.F, shapes.I
        count = _skim_lines(data, place, stop, F, I, self._limits, self._labels, MOST_ROWS)
        if I[scans.status] == scans.NEW:
            self._asked = shapes.tokens()
        self.motion = I[scans.motion] // TENTHS if I[scans.motion] >= 0 else -1
        self.has_words = bool(I[scans.has_words])
        self._place = place
        return count, offset + I[scans.next_at] - place

    @property
    def labels(self) -> Rows | None:
        """The labels of these lines: label, line from 0, offset from the first line."""
        count = self._shapes.I[scans.label_cnt]
        if not count:
            return None
        import numpy as np

        return np.array(self._labels[: 3 * count], np.int64).reshape(-1, 3) - (0, 0, self._place)

    def take(self) -> list[int]:
        """The shape of the line that comes next, if it is new; for `learn`."""
        asked, self._asked = self._asked, []
        return asked

    def learn(self, asked: list[int], plan: Plan | None) -> None:
        """Note the plan of a line of that shape; None: the loader had something to say."""
        known = scans.SLOW_SHAPE
        if plan is not None and _is_settled(plan):
            known = self._kept(_limits(plan), is_rich=asked[:1] == [rich_cy.RICH_LINE])
        self._shapes.learn(asked, known)

    def _kept(self, limits: list[Limit], *, is_rich: bool) -> int:
        """Where the limits of words are kept; their values are not known of rich lines."""
        if not limits:
            return 0
        first, end = self._limits_end, self._limits_end + skim_cy.LIMIT * (len(limits) + 1)
        if is_rich or end > len(self._limits):
            return scans.SLOW_SHAPE
        rows = [(ord(one.letter) - ord("A"), one.low, one.high, one.is_whole) for one in limits]
        numbers = [*chain(*rows), END_OF_LIMITS, 0.0, 0.0, 0.0]
        self._limits[first:end] = memoryview(array("d", numbers))
        self._limits_end = end
        return first


def _limits(plan: Plan) -> list[Limit]:
    return [one for code in plan.acts for one in code.limits if one.letter in plan.words]


def _is_settled(plan: Plan) -> bool:
    """Whether a line like this one has nothing new for the loader."""
    return not any(
        code.takes_all or code.step is Step.STOP or code.name == END for code in plan.codes
    )
