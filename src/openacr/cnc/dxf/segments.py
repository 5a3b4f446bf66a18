"""Lines and arcs of a drawing, in the plane.

A segment goes from `start` to `end`; with a centre it is an arc of `sweep_rad`, positive
counter-clockwise, a full circle where it is a whole turn.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

Point = tuple[float, float]
FULL_TURN = 2.0 * math.pi


@dataclass(frozen=True, slots=True)
class Segment:
    """A line, or an arc."""

    start: Point
    end: Point
    centre: Point | None = None
    sweep_rad: float = 0.0

    @property
    def radius(self) -> float:
        """The radius of an arc."""
        return math.dist(self.centre, self.start) if self.centre else 0.0

    @property
    def is_full(self) -> bool:
        """Whether it is a full circle."""
        return abs(self.sweep_rad) >= FULL_TURN - 1e-9

    @property
    def length(self) -> float:
        """The length along the segment."""
        if self.centre is None:
            return math.dist(self.start, self.end)
        return self.radius * abs(self.sweep_rad)

    @property
    def area(self) -> float:
        """The contribution to the area of a closed chain, positive counter-clockwise.

        The triangle between origin and chord, and the circular segment between chord and arc.
        """
        (x0, y0), (x1, y1) = self.start, self.end
        triangle = (x0 * y1 - x1 * y0) / 2.0
        cap = self.radius**2 * (self.sweep_rad - math.sin(self.sweep_rad)) / 2.0
        return triangle + cap

    @property
    def height(self) -> float:
        """How far an arc bends away from its chord."""
        return self.radius * (1.0 - math.cos(min(abs(self.sweep_rad) / 2.0, math.pi)))

    def tangent(self, at: Point) -> Point:
        """The direction of travel at one end, of length 1 (0 for no length)."""
        if self.centre is None:
            return _unit(self.end[0] - self.start[0], self.end[1] - self.start[1])
        x, y = at[0] - self.centre[0], at[1] - self.centre[1]
        return _unit(-y, x) if self.sweep_rad > 0 else _unit(y, -x)

    def at(self, share: float) -> Point:
        """The point at a share of the length."""
        (x0, y0), (x1, y1) = self.start, self.end
        if self.centre is None:
            return (x0 + (x1 - x0) * share, y0 + (y1 - y0) * share)
        angle = math.atan2(y0 - self.centre[1], x0 - self.centre[0]) + self.sweep_rad * share
        radius = self.radius
        x, y = self.centre
        return (x + radius * math.cos(angle), y + radius * math.sin(angle))

    def reversed(self) -> "Segment":
        """The segment in the opposite direction."""
        return Segment(self.end, self.start, self.centre, -self.sweep_rad)

    def moved_to(self, start: Point) -> "Segment":
        """From a start that is the same but for the gap of a joint."""
        return replace(self, start=start)


def _unit(x: float, y: float) -> Point:
    length = math.hypot(x, y)
    return (x / length, y / length) if length else (0.0, 0.0)


def bulged(start: Point, end: Point, bulge: float) -> Segment:
    """A segment of a polyline: the bulge is the tangent of a quarter of the sweep.

    The centre lies on the perpendicular bisector of the chord, at (1 - b²) / 4b chord
    lengths to its left.
    """
    if not bulge:
        return Segment(start, end)
    (x0, y0), (x1, y1) = start, end
    aside = (1.0 - bulge * bulge) / (4.0 * bulge)
    centre = ((x0 + x1) / 2.0 - (y1 - y0) * aside, (y0 + y1) / 2.0 + (x1 - x0) * aside)
    return Segment(start, end, centre, 4.0 * math.atan(bulge))


def polyline(points: Sequence[Point]) -> tuple[Segment, ...]:
    """Lines through all points, without those of no length."""
    return tuple(Segment(a, b) for a, b in pairwise(points) if a != b)


def reverse_all(segments: Iterable[Segment]) -> tuple[Segment, ...]:
    """A run of segments in the opposite direction."""
    return tuple(segment.reversed() for segment in reversed(tuple(segments)))
