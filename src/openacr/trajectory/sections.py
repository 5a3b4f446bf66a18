"""What rules along a chain: feeds, the tolerance and the source line of every section."""

import numpy as np

from openacr.trajectory.segments import Piece
from openacr.trajectory.setpoints import Reals


class Sections:
    """Sections of a growing chain by the distance at which each of them ends."""

    __slots__ = ("_feeds", "_tolerances", "_tools", "ends", "lines")

    def __init__(self) -> None:
        self.ends: list[float] = []
        self.lines: list[int] = []
        self._feeds: list[float] = []
        self._tools: list[float] = []  # feeds of the tool
        self._tolerances: list[float] = []

    def add(self, piece: Piece, end_u: float) -> None:
        """Append the section of a piece."""
        self.ends.append(end_u)
        self.lines.append(piece.segment.line)
        self._feeds.append(piece.segment.feed_ups)
        self._tools.append(piece.segment.tool_ups)
        self._tolerances.append(piece.segment.tolerance_u)

    def feeds(self, s: Reals) -> Reals:
        """The feeds at distances [units/s]; at the end of a section that of this section."""
        found: Reals = np.array(self._feeds)[self._places(s)]
        return found

    def least(self, starts: Reals, stops: Reals) -> tuple[Reals, Reals, Reals]:
        """The lowest feed, that of the tool, and the smallest tolerance between distances."""
        left, right = self._places(starts), self._places(stops)
        values = np.array([self._feeds, self._tools, self._tolerances])
        found = np.minimum(values[:, left], values[:, right])
        for i in np.flatnonzero(right > left + 1):
            found[:, i] = values[:, left[i] : right[i] + 1].min(axis=1)
        return found[0], found[1], found[2]

    def drop(self, before_u: float) -> None:
        """Forget the sections that end before a distance."""
        gone = int(np.searchsorted(self.ends, before_u)) - 1
        if gone > 0:
            for each in (self.ends, self.lines, self._feeds, self._tools, self._tolerances):
                del each[:gone]

    def _places(self, s: Reals) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        return np.minimum(np.searchsorted(self.ends, s), len(self.ends) - 1)
