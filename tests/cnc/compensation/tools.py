"""Contours for tests: written in a few letters, run through a compensator."""

from dataclasses import dataclass, field
from math import atan2, hypot, tau

from openacr.cnc.canonical import Pace, Plane, Point, Source
from openacr.cnc.compensation import ChainCheck, Compensator, Rules, Side
from openacr.cnc.geometry.elements import Element

FEED = Pace(10.0)
EXACT = Rules(epsilon=1e-6, sweep_epsilon=1e-4, root_epsilon=-12)


@dataclass
class Trace:
    """What was reported, and what came out."""

    findings: list[tuple[str, str, int]] = field(default_factory=list)
    out: list[Element | str] = field(default_factory=list)

    def report(self, code: str, text: str, element: Element) -> None:
        self.findings.append((code, text, element.source.line))

    @property
    def codes(self) -> list[str]:
        return [code for code, _, _ in self.findings]

    @property
    def elements(self) -> list[Element]:
        return [each for each in self.out if isinstance(each, Element)]

    @property
    def ends(self) -> list[tuple[float, float]]:
        """Where the moves end in their plane, rounded for reading."""
        return [plane_point(each.plane, each.end) for each in self.elements]

    @property
    def inserted(self) -> list[Element]:
        return [each for each in self.elements if each.is_inserted]


def plane_point(plane: Plane, point: Point) -> tuple[float, float]:
    return (round(point[plane.first], 9) + 0.0, round(point[plane.second], 9) + 0.0)


class Path:
    """Builds elements one after the other, as blocks of a program."""

    def __init__(self, x: float, y: float, z: float = 0.0, plane: Plane = Plane.XY) -> None:
        self.plane = plane
        self.at = self._point((0.0,) * 8, x, y, z)
        self.line = 0
        self.elements: list[Element] = []

    def _point(self, point: Point, x: float, y: float, z: float | None) -> Point:
        values = list(point)
        values[self.plane.first], values[self.plane.second] = x, y
        if z is not None:
            values[self.plane.drill] = z
        return tuple(values)

    def _add(self, end: Point, pace: Pace | None, centre=None, sweep=0.0) -> "Path":  # type: ignore[no-untyped-def]
        self.line += 1
        source = Source("TEST", self.line, "")
        self.elements.append(Element(source, self.plane, self.at, end, pace, centre, sweep))
        self.at = end
        return self

    def to(self, x: float, y: float, z: float | None = None) -> "Path":
        return self._add(self._point(self.at, x, y, z), FEED)

    def rapid(self, x: float, y: float, z: float | None = None) -> "Path":
        return self._add(self._point(self.at, x, y, z), None)

    def arc(
        self, x: float, y: float, cx: float, cy: float, turn: int, z: float | None = None
    ) -> "Path":
        """An arc about a centre, counter-clockwise with turn 1; a circle where it ends."""
        first, second = self.plane.first, self.plane.second
        sx, sy = self.at[first] - cx, self.at[second] - cy
        angle = (turn * (atan2(y - cy, x - cx) - atan2(sy, sx))) % tau
        if hypot(x - self.at[first], y - self.at[second]) < 1e-6:
            angle = tau
        return self._add(self._point(self.at, x, y, z), FEED, (cx, cy), turn * angle)


def compensate(
    elements: list[Element],
    radius: float,
    side: Side = Side.LEFT,
    rules: Rules = EXACT,
    *,
    has_lead_out: bool = True,
    is_checked: bool = False,
) -> Trace:
    """The first element leads in, the last one out; checked: as a whole, too."""
    trace = Trace()
    watch = ChainCheck(rules.epsilon, trace.report) if is_checked else None
    compensator: Compensator[str] = Compensator(rules, trace.report, watch)
    trace.out += compensator.switch(side, radius)
    for element in elements[:-1] if has_lead_out else elements:
        trace.out += compensator.add(element)
    if has_lead_out:
        trace.out += compensator.switch(None)
        trace.out += compensator.add(elements[-1])
    trace.out += compensator.stop()
    return trace
