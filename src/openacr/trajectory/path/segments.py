"""Segments of a path: straight lines, arcs and helices, with what rules on each of them."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from openacr.trajectory.path.limits import TrajectoryError

Point = tuple[float, ...]
Direction = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Arc:
    """The circular part of a segment: centre on two axes, sweep + from the first to the second.

    Other axes move linearly over the sweep.
    """

    first_axis: int
    second_axis: int
    centre: tuple[float, float]
    sweep_rad: float


@dataclass(frozen=True, slots=True)
class Segment:
    """One programmed move: where it ends, how fast, and how far the path may be left.

    `feed_ups` counts along all axes, `tool_ups` along those that carry the tool (`Limits`). An
    override raises both by the factor `fastest` at most.
    """

    line: int
    end: Point
    feed_ups: float
    tolerance_u: float
    is_rapid: bool = False
    arc: Arc | None = None
    tool_ups: float = math.inf
    fastest: float = 1.0


class Piece:
    """A segment with its start: lengths, points and tangents by programmed length.

    `factor` is that of its feeds, 1 as programmed.
    """

    __slots__ = ("_offset_rad", "_radius", "_radius_end", "factor", "length_u", "segment", "start")

    def __init__(self, start: Point, segment: Segment) -> None:
        if len(start) != len(segment.end):
            raise TrajectoryError(
                f"line {segment.line}: an end with {len(segment.end)} axes, not {len(start)}"
            )
        self.start, self.segment, self.factor = start, segment, 1.0
        arc = segment.arc
        self._radius = self._radius_end = self._offset_rad = 0.0
        if arc is None:
            self.length_u = math.dist(start, segment.end)
            return
        (a, b), (x, y) = (arc.first_axis, arc.second_axis), arc.centre
        self._radius = math.hypot(start[a] - x, start[b] - y)
        self._radius_end = math.hypot(segment.end[a] - x, segment.end[b] - y)
        self._offset_rad = math.atan2(start[b] - y, start[a] - x)
        across = [q - p for k, (p, q) in enumerate(zip(start, segment.end, strict=True))
                  if k not in (a, b)]  # fmt: skip
        mean = 0.5 * (self._radius + self._radius_end)
        self.length_u = math.hypot(mean * arc.sweep_rad, *across)

    def row(self) -> list[float]:
        """The numbers of the piece as compiled functions take them (piece_cy.py)."""
        segment, arc = self.segment, self.segment.arc
        circle = [-1.0] + [0.0] * 7
        if arc is not None:
            circle = [arc.first_axis, arc.second_axis, *arc.centre, self._radius,
                      self._radius_end, self._offset_rad, arc.sweep_rad]  # fmt: skip
        rules = [segment.tolerance_u, self.feed_ups]
        return [self.length_u, *circle, *rules, *self.start, *segment.end]

    @property
    def feed_ups(self) -> float:
        """The feed along all axes, with the factor."""
        return self.segment.feed_ups * min(self.factor, self.segment.fastest)

    @property
    def tool_ups(self) -> float:
        """The feed of the axes that carry the tool, with the factor."""
        return self.segment.tool_ups * min(self.factor, self.segment.fastest)

    @property
    def is_line(self) -> bool:
        """Whether the segment is straight."""
        return self.segment.arc is None

    @property
    def radius_u(self) -> float:
        """The radius of an arc."""
        return self._radius

    def point(self, s: float) -> Point:
        """The point at distance s from the start."""
        share = s / self.length_u
        if share >= 1.0:
            return self.segment.end
        end, arc = self.segment.end, self.segment.arc
        point = [p + (q - p) * share for p, q in zip(self.start, end, strict=True)]
        if arc is not None:
            r = self._radius + (self._radius_end - self._radius) * share
            angle = self._offset_rad + arc.sweep_rad * share
            point[arc.first_axis] = arc.centre[0] + r * math.cos(angle)
            point[arc.second_axis] = arc.centre[1] + r * math.sin(angle)
        return tuple(point)

    def tangent(self, s: float) -> Direction:
        """The unit tangent at distance s from the start."""
        end, arc = self.segment.end, self.segment.arc
        slope = [(q - p) / self.length_u for p, q in zip(self.start, end, strict=True)]
        if arc is not None:
            share = s / self.length_u
            rate = (self._radius_end - self._radius) / self.length_u
            r = self._radius + (self._radius_end - self._radius) * share
            angle = self._offset_rad + arc.sweep_rad * share
            turn = r * arc.sweep_rad / self.length_u
            slope[arc.first_axis] = rate * math.cos(angle) - turn * math.sin(angle)
            slope[arc.second_axis] = rate * math.sin(angle) + turn * math.cos(angle)
        size = math.hypot(*slope)
        return tuple(part / size for part in slope)

    def chords(self, largest_u: float, side: int = 1) -> Iterator[Point]:
        """Points after the start (`side` -1: before the end) at most `largest_u` apart.

        A line has one.
        """
        count = 1 if self.is_line else max(1, math.ceil(self.length_u / largest_u))
        for n in range(1, count + 1):
            share = n / count
            yield self.point(self.length_u * (share if side > 0 else 1.0 - share))


def turn_rad(before: Direction, after: Direction) -> float:
    """The angle between two unit tangents, 0 straight on, pi reversal; exact near both."""
    apart = math.sqrt(sum((a - b) ** 2 for a, b in zip(before, after, strict=True)))
    along = math.sqrt(sum((a + b) ** 2 for a, b in zip(before, after, strict=True)))
    return 2.0 * math.atan2(apart, along)
