"""A tree of boxes: which curves can be near which others.

Elements that follow each other along a contour lie near each other, so nothing needs to be
sorted: every box of a level is that of `FAN` neighbours of the level below.
"""

import numpy as np

from openacr.cnc.compensation.nearness import Array, Curves, Index, distances

FAN = 8
AT_ONCE = 1024  # curves that are asked about together, which bounds the memory


class Tree:
    """Boxes around curves, around eight boxes each, and so on up to a few."""

    def __init__(self, curves: Curves) -> None:
        self._curves = curves
        self._levels = [curves.boxes()]
        while len(self._levels[-1][0]) > FAN:
            low, high = self._levels[-1]
            starts = np.arange(0, len(low), FAN)
            self._levels.append(
                (np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts))
            )

    def nearer(self, curves: Curves, reach: Array) -> tuple[Index, Index, Array]:
        """Pairs (curve asked about, curve of the tree) nearer than the reach, and how near."""
        low, high = curves.boxes()
        found: list[tuple[Index, Index, Array]] = []
        for begin in range(0, len(reach), AT_ONCE):
            part = np.arange(begin, min(begin + AT_ONCE, len(reach)))
            asked, own = self._candidates(low, high, reach, part)
            near = distances(curves[asked], self._curves[own])
            is_near = near < reach[asked]
            found.append((asked[is_near], own[is_near], near[is_near]))
        asked_all, own_all, near_all = zip(*found, strict=True)
        return np.concatenate(asked_all), np.concatenate(own_all), np.concatenate(near_all)

    def _candidates(
        self, low: Array, high: Array, reach: Array, part: Index
    ) -> tuple[Index, Index]:
        top = len(self._levels[-1][0])
        asked = np.repeat(part, top)
        node = np.tile(np.arange(top), len(part))
        for depth in reversed(range(len(self._levels))):
            box_low, box_high = self._levels[depth]
            gap = np.maximum(box_low[node] - high[asked], low[asked] - box_high[node])
            gap = np.maximum(gap, 0.0)
            is_near = np.hypot(gap[:, 0], gap[:, 1]) < reach[asked]
            asked, node = asked[is_near], node[is_near]
            if depth:
                asked = np.repeat(asked, FAN)
                node = (node[:, None] * FAN + np.arange(FAN)).ravel()
                is_there = node < len(self._levels[depth - 1][0])
                asked, node = asked[is_there], node[is_there]
        return asked, node
