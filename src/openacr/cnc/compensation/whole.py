"""Whole chains: every move of the tool compared with every element of its contour.

numpy is imported when the first chain ends: most programs have none.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec.structs import replace

from openacr.cnc.compensation.moves import tool_element_at
from openacr.cnc.rows.chains import EXTRA

if TYPE_CHECKING:
    from collections.abc import Sequence

    from openacr.cnc.canonical import Moves, Point
    from openacr.cnc.compensation.many import Many
    from openacr.cnc.compensation.nearness import Curves
    from openacr.cnc.compensation.rules import Report
    from openacr.cnc.geometry.elements import Element

LEADS = 2
LEAST_SINE = 1e-9  # of the angle of two lines that cross


class ChainCheck:
    """Collects a chain, and at its end reports moves nearer than the radius: W323.

    Neighbours are checked while a chain is made; this finds narrow places between elements
    far from each other in the program. Where a contour closes on itself, or its first and
    last line cross, the leads to it and away from it are not edges of the part.
    """

    def __init__(self, epsilon: float, report: Report) -> None:
        self._epsilon = epsilon
        self._report = report
        self._contour: list[Element] = []
        self._tool_moves: list[Element] = []
        self._radii: list[float] = []

    def contour(self, element: Element) -> None:
        """An element of the programmed contour."""
        self._contour.append(element)

    def centre_path(self, element: Element, radius: float) -> None:
        """A move of the tool."""
        self._tool_moves.append(element)
        self._radii.append(radius)

    def elements(self, many: Many) -> None:
        """Elements of the programmed contour."""
        self._contour += many.elements()

    def tool_moves(self, moves: Moves, extra: Sequence[float]) -> None:
        """Moves of the tool."""
        for k in range(len(moves)):
            self._tool_moves.append(tool_element_at(moves, k, extra))
            self._radii.append(extra[EXTRA * k + 2])

    def end(self) -> None:
        """Report what is too near, once for each pair of lines, its nearest point."""
        if self._contour and self._tool_moves:
            for move, element, near, radius in self._found():
                text = f"tool comes to {near:.6g} from line {element.source.line}"
                self._report("W323", f"{text}, its radius is {radius:g}", move)
        self._contour, self._tool_moves, self._radii = [], [], []

    def _found(self) -> list[tuple[Element, Element, float, float]]:
        import numpy as np

        from openacr.cnc.compensation.boxes import Tree

        radii = np.array(self._radii)
        reach = np.maximum(radii - self._epsilon, 0.0)
        contour = _without_leads(self._contour, self._epsilon)
        asked, own, near = Tree(_curves(contour)).nearer(_curves(self._tool_moves), reach)
        pairs: dict[tuple[int, int], tuple[Element, Element, float, float]] = {}
        for k in np.lexsort((near, asked)):
            move, element = self._tool_moves[asked[k]], contour[own[k]]
            lines = (move.source.line, element.source.line)
            if lines not in pairs or pairs[lines][2] > near[k]:
                pairs[lines] = (move, element, float(near[k]), self._radii[asked[k]])
        return list(pairs.values())


def _without_leads(contour: list[Element], epsilon: float) -> list[Element]:
    """The contour without what leads to it and away from it, where it closes on itself.

    Its first and last element lead in and out where it closes between them. Two lines that
    overrun the corner at which they meet end there.
    """
    if len(contour) <= LEADS:
        return contour
    first, last = contour[0], contour[-1]
    if _distance(first, first.end, last.start) <= epsilon:
        return contour[1:-1]
    corner = _crossing(first, last, epsilon)
    if corner is None:
        return contour
    ends = replace(first, start=corner), replace(last, end=corner)
    kept = [each for each in ends if _distance(each, each.start, each.end) > epsilon]
    return [*contour[1:-1], *kept]


def _distance(element: Element, one: Point, other: Point) -> float:
    """The distance of two points in the plane of an element."""
    x, y = element.plane.first, element.plane.second
    return math.hypot(one[x] - other[x], one[y] - other[y])


def _crossing(first: Element, last: Element, epsilon: float) -> Point | None:
    """Where two lines cross or touch; None for arcs, parallels, and lines apart."""
    if first.centre is not None or last.centre is not None:
        return None
    x, y = first.plane.first, first.plane.second
    ax, ay = first.end[x] - first.start[x], first.end[y] - first.start[y]
    bx, by = last.end[x] - last.start[x], last.end[y] - last.start[y]
    turn = ax * by - ay * bx
    lengths = math.hypot(ax, ay), math.hypot(bx, by)
    if abs(turn) <= LEAST_SINE * lengths[0] * lengths[1]:
        return None
    dx, dy = last.start[x] - first.start[x], last.start[y] - first.start[y]
    parts = (dx * by - dy * bx) / turn, (dx * ay - dy * ax) / turn
    for part, length in zip(parts, lengths, strict=True):
        if not -epsilon <= part * length <= length + epsilon:
            return None
    corner = list(first.start)
    corner[x] += parts[0] * ax
    corner[y] += parts[0] * ay
    return tuple(corner)


def _curves(elements: list[Element]) -> Curves:
    import numpy as np

    from openacr.cnc.compensation.nearness import Curves

    plane = elements[0].plane
    first, second = plane.first, plane.second
    return Curves.of(
        np.array([(each.start[first], each.start[second]) for each in elements]),
        np.array([(each.end[first], each.end[second]) for each in elements]),
        np.array([each.centre or (0.0, 0.0) for each in elements]),
        np.array([0.0 if each.centre is None else each.sweep_rad for each in elements]),
    )
