"""Skip lines at load that can have no error: their count, their labels, the last motion in them.

A line of a shape is read by the loader once. If it finds nothing that depends on the values of
the words, or on the place of the line, lines of that shape are skipped from then on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.codes.table import Step
from openacr.cnc.reading import skim_cy
from openacr.cnc.reading.line_shapes import MOST_ROWS, LineShapes
from openacr.cnc.rows import scans
from openacr.cnc.rows.room import integers
from openacr.compiled import pick

if TYPE_CHECKING:
    from openacr.cnc.codes.block_plan import Plan
    from openacr.cnc.program.labels import Rows
    from openacr.cnc.reading.text import Text

END = "M30"  # doubtful as the last block
KNOWN = 0  # what the loader knows of a shape: that there is nothing to find
TENTHS = 10
_skim_lines = pick(skim_cy.skim_lines)


class Skimmer:
    """Skips the lines of a text that are like those the loader has read."""

    def __init__(self, axes: dict[str, int], bracket: str) -> None:
        self._shapes = LineShapes(axes, bracket)
        self._labels = integers(3 * MOST_ROWS)
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
        count = _skim_lines(data, place, stop, shapes.F, shapes.I, self._labels, MOST_ROWS)
        I = shapes.I
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
        is_known = plan is not None and _is_settled(plan)
        self._shapes.learn(asked, KNOWN if is_known else scans.SLOW_SHAPE)


def _is_settled(plan: Plan) -> bool:
    """Whether a line like this one has nothing new for the loader."""
    if any(code.takes_all or code.step is Step.STOP or code.name == END for code in plan.codes):
        return False
    return not any(limit.letter in plan.words for code in plan.acts for limit in code.limits)
