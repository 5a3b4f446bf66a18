"""Distances between many lines and arcs, all at once.

The points of two curves that are nearest to each other are crossings, ends of one of them,
or inner points with a common normal. For two lines the last are never nearer than an end.
For a line and a circle around C with the radius R, and the foot of C on the line at the
distance h > R, they are the foot and the point of the circle towards it, h - R apart. For
two circles they lie on the line of centres: L - R - S apart for circles outside of each
other, |R - S| - L for one within the other. (Where the circles cross, such points are
farthest, not nearest.)
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]
Bools = npt.NDArray[np.bool_]

TINY = 1e-100  # keeps divisions by nothing finite
TURN = 2.0 * np.pi


@dataclass(frozen=True, slots=True)
class Curves:
    """Lines and arcs, a row each; the sweep of a line is 0."""

    start: Array
    end: Array
    centre: Array
    radius: Array
    sweep: Array

    @classmethod
    def of(cls, start: Array, end: Array, centre: Array, sweep: Array) -> "Curves":
        """Arcs whose ends have different radii get their mean."""
        first, last = start - centre, end - centre
        radius = 0.5 * (np.hypot(*first.T) + np.hypot(*last.T))
        return cls(start, end, centre, radius, sweep)

    def __getitem__(self, chosen: Index | Bools) -> "Curves":
        return Curves(
            self.start[chosen],
            self.end[chosen],
            self.centre[chosen],
            self.radius[chosen],
            self.sweep[chosen],
        )

    @property
    def is_line(self) -> Bools:
        """Which are lines."""
        return np.asarray(self.sweep == 0.0)

    def boxes(self) -> tuple[Array, Array]:
        """Low and high corners."""
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        arcs = np.flatnonzero(~self.is_line)
        if len(arcs):
            round_ones = self[arcs]
            for axis, sign in ((0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)):
                direction = np.zeros((len(arcs), 2))
                direction[:, axis] = sign
                top = round_ones.centre[:, axis] + sign * round_ones.radius
                is_there = round_ones.spans(direction)
                side, better = (high, np.maximum) if sign > 0.0 else (low, np.minimum)
                reached = arcs[is_there]
                side[reached, axis] = better(side[reached, axis], top[is_there])
        return low, high

    def spans(self, direction: Array) -> Bools:
        """Whether arcs have a point in a direction from their centre."""
        first = self.start - self.centre
        sign = np.where(self.sweep >= 0.0, 1.0, -1.0)
        cross = first[:, 0] * direction[:, 1] - first[:, 1] * direction[:, 0]
        dot = (first * direction).sum(axis=1)
        turned = np.mod(sign * np.arctan2(cross, dot), TURN)
        return np.asarray(turned <= np.abs(self.sweep), dtype=np.bool_)


def distances(a: Curves, b: Curves) -> Array:
    """The distance of each pair: 0 where they cross."""
    near = np.minimum.reduce([_ends(a, b), _ends(b, a)])
    for chosen, inner in (
        (a.is_line & b.is_line, _line_line),
        (a.is_line & ~b.is_line, _line_arc),
        (~a.is_line & b.is_line, lambda arc, line: _line_arc(line, arc)),
        (~a.is_line & ~b.is_line, _arc_arc),
    ):
        if chosen.any():
            near[chosen] = np.minimum(near[chosen], inner(a[chosen], b[chosen]))
    return np.asarray(near)


def _ends(a: Curves, b: Curves) -> Array:
    """From the ends of curves a to curves b."""
    return np.asarray(np.minimum(_from_points(a.start, b), _from_points(a.end, b)))


def _from_points(points: Array, curves: Curves) -> Array:
    along = curves.end - curves.start
    there = points - curves.start
    square = np.maximum((along * along).sum(axis=1), TINY)
    u = np.clip((there * along).sum(axis=1) / square, 0.0, 1.0)
    straight = np.hypot(*(there - u[:, None] * along).T)
    out = points - curves.centre
    to_circle = np.abs(np.hypot(*out.T) - curves.radius)
    to_ends = np.minimum(np.hypot(*there.T), np.hypot(*(points - curves.end).T))
    to_arc = np.where(curves.spans(out), to_circle, to_ends)
    return np.asarray(np.where(curves.is_line, straight, to_arc))


def _line_line(a: Curves, b: Curves) -> Array:
    of_a = _side(a, b.start) * _side(a, b.end) < 0.0
    of_b = _side(b, a.start) * _side(b, a.end) < 0.0
    return np.where(of_a & of_b, 0.0, np.inf)


def _side(line: Curves, points: Array) -> Array:
    dx, dy = (line.end - line.start).T
    px, py = (points - line.start).T
    return np.asarray(dx * py - dy * px)


def _line_arc(line: Curves, arc: Curves) -> Array:
    along = line.end - line.start
    length = np.maximum(np.hypot(*along.T), TINY)
    unit = along / length[:, None]
    s = ((arc.centre - line.start) * unit).sum(axis=1)
    direction = line.start + s[:, None] * unit - arc.centre  # from the centre to the foot
    h = np.hypot(*direction.T)
    is_between = (s >= 0.0) & (s <= length) & arc.spans(direction) & (h >= arc.radius)
    near = np.where(is_between, h - arc.radius, np.inf)
    half = np.sqrt(np.maximum(arc.radius**2 - h**2, 0.0))
    for sign in (-1.0, 1.0):
        at = s + sign * half
        is_hit = (h < arc.radius) & (at >= 0.0) & (at <= length)
        is_hit &= arc.spans(direction + (sign * half)[:, None] * unit)
        near[is_hit] = 0.0
    return near


def _arc_arc(a: Curves, b: Curves) -> Array:
    apart = b.centre - a.centre
    distance = np.maximum(np.hypot(*apart.T), TINY)
    unit = apart / distance[:, None]
    near = np.full(len(distance), np.inf)
    # On the line of centres: outside of each other, b within a, a within b.
    for gap, of_a, of_b in (
        (distance - a.radius - b.radius, unit, -unit),
        (a.radius - b.radius - distance, unit, unit),
        (b.radius - a.radius - distance, -unit, -unit),
    ):
        is_between = (gap >= 0.0) & a.spans(of_a) & b.spans(of_b)
        near = np.where(is_between, np.minimum(near, gap), near)
    u = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance)
    square = a.radius**2 - u**2
    half = np.sqrt(np.maximum(square, 0.0))
    normal = np.column_stack([-unit[:, 1], unit[:, 0]])
    for sign in (-1.0, 1.0):
        direction = u[:, None] * unit + (sign * half)[:, None] * normal
        is_hit = (square >= 0.0) & a.spans(direction) & b.spans(direction - apart)
        near[is_hit] = 0.0
    return near
