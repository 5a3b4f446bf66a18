"""Whole chains: every move of the tool compared with every element of its contour."""

import math

import numpy as np

from openacr.cnc.compensation.boxes import Tree
from openacr.cnc.compensation.nearness import Curves
from openacr.cnc.compensation.rules import Report
from openacr.cnc.elements import Element

LEADS = 2


class ChainCheck:
    """Collects a chain, and at its end reports moves nearer than the radius: W323.

    Neighbours are looked after while a chain is made; this finds narrow places between
    elements that are far from each other in the program. Where a contour closes on itself,
    what leads to it and away from it is no edge of the part.
    """

    def __init__(self, epsilon: float, report: Report) -> None:
        self._epsilon = epsilon
        self._report = report
        self._contour: list[Element] = []
        self._ways: list[Element] = []
        self._radii: list[float] = []

    def contour(self, element: Element) -> None:
        """An element of the programmed contour."""
        self._contour.append(element)

    def way(self, element: Element, radius: float) -> None:
        """A move of the tool."""
        self._ways.append(element)
        self._radii.append(radius)

    def end(self) -> None:
        """Report what is too near, once for each pair of lines, its nearest point."""
        if self._contour and self._ways:
            for way, element, near, radius in self._found():
                text = f"tool comes to {near:.6g} from line {element.source.line}"
                self._report("W323", f"{text}, its radius is {radius:g}", way)
        self._contour, self._ways, self._radii = [], [], []

    def _found(self) -> list[tuple[Element, Element, float, float]]:
        radii = np.array(self._radii)
        reach = np.maximum(radii - self._epsilon, 0.0)
        contour = _without_leads(self._contour, self._epsilon)
        asked, own, near = Tree(_curves(contour)).nearer(_curves(self._ways), reach)
        pairs: dict[tuple[int, int], tuple[Element, Element, float, float]] = {}
        for k in np.lexsort((near, asked)):
            way, element = self._ways[asked[k]], contour[own[k]]
            lines = (way.source.line, element.source.line)
            if lines not in pairs or pairs[lines][2] > near[k]:
                pairs[lines] = (way, element, float(near[k]), self._radii[asked[k]])
        return list(pairs.values())


def _without_leads(contour: list[Element], epsilon: float) -> list[Element]:
    """The contour without its first and last element where it closes between them."""
    if len(contour) <= LEADS:
        return contour
    entry, exit_ = contour[0].end, contour[-1].start
    first, second = contour[0].plane.first, contour[0].plane.second
    gap = math.hypot(entry[first] - exit_[first], entry[second] - exit_[second])
    return contour[1:-1] if gap <= epsilon else contour


def _curves(elements: list[Element]) -> Curves:
    plane = elements[0].plane
    first, second = plane.first, plane.second
    return Curves.of(
        np.array([(each.start[first], each.start[second]) for each in elements]),
        np.array([(each.end[first], each.end[second]) for each in elements]),
        np.array([each.centre or (0.0, 0.0) for each in elements]),
        np.array([0.0 if each.centre is None else each.sweep_rad for each in elements]),
    )
