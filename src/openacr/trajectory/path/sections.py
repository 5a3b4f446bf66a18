"""What rules along a chain: feeds, the tolerance and the source line of every section."""

from bisect import bisect_right
from typing import Any

import numpy as np

from openacr.trajectory.path.segments import Piece
from openacr.trajectory.path.setpoints import Reals, Whole


class Sections:
    """Sections of a growing chain by the distance at which each of them ends.

    A section is a piece, or a part of one that has another factor of its feeds.
    """

    __slots__ = ("_feeds", "_pieces", "_tolerances", "_tools", "ends", "factors", "lines")

    def __init__(self) -> None:
        self.ends: list[float] = []
        self.lines: list[int] = []
        self.factors: list[float] = []  # of the feeds
        self._pieces: list[Piece] = []
        self._feeds: list[float] = []
        self._tools: list[float] = []  # feeds of the tool
        self._tolerances: list[float] = []

    def add(self, piece: Piece, end_u: float) -> None:
        """Append the section of a piece."""
        self.ends.append(end_u)
        self.lines.append(piece.segment.line)
        self.factors.append(piece.factor)
        self._pieces.append(piece)
        self._feeds.append(piece.feed_ups)
        self._tools.append(piece.tool_ups)
        self._tolerances.append(piece.segment.tolerance_u)

    def hasten(self, since_u: float, factor: float) -> None:
        """Raise the factor of the feeds from a distance on; where it is higher it stays."""
        first = bisect_right(self.ends, since_u)
        if first < len(self.ends) and self.factors[first] < factor:
            for each in self._lists():
                each.insert(first, each[first])
            self.ends[first] = since_u
            first += 1
        for i in range(first, len(self.ends)):
            piece = self._pieces[i]
            piece.factor = self.factors[i] = max(factor, self.factors[i])
            self._feeds[i], self._tools[i] = piece.feed_ups, piece.tool_ups

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

    def marks(self, s: Reals) -> tuple[Whole, Reals]:
        """The source lines at distances, and the factors of the feeds."""
        places = self._places(s)
        return np.array(self.lines)[places], np.array(self.factors)[places]

    def drop(self, before_u: float) -> None:
        """Forget the sections that end before a distance."""
        gone = int(np.searchsorted(self.ends, before_u)) - 1
        if gone > 0:
            for each in self._lists():
                del each[:gone]

    def _lists(self) -> tuple[list[Any], ...]:
        return (self.ends, self.lines, self.factors, self._pieces, self._feeds, self._tools,
                self._tolerances)  # fmt: skip

    def _places(self, s: Reals) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        return np.minimum(np.searchsorted(self.ends, s), len(self.ends) - 1)
