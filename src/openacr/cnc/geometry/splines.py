"""Splines in a plane, cut as arcs that touch each other: biarcs within a tolerance.

A curve is a clamped uniform rational B-spline; those of G5 and G5.1 are special cases. It is
halved until two arcs, tangent to the curve at the ends of a piece and to each other, stay as near
to it as asked. Arcs are what the card cuts exactly and what all checks, limits and pictures know.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from msgspec import Struct

Pair = tuple[float, float]
TOLERANCE_INCH = 0.00004  # 1 micrometre: how far arcs may be from the curve
MOST_ARCS = 5000
SAMPLES = 16  # of a piece, where its distance from the arcs is measured
MARGIN = 0.7  # of the tolerance, for what lies between the samples
FIRST_PIECES = 4  # of every span between knots, so that no inflection hides between the samples
DEEP, DEEPEST = 10, 24  # halvings: a line may do; what is left is shorter than any pulse
FLAT = 1e-12  # of the length: an arc as flat as that is a line


class TooManyArcsError(ValueError):
    """A curve that needs more than `MOST_ARCS` arcs."""


class Piece(Struct, frozen=True):
    """An arc of a curve, or with `centre` None a line; `sweep_rad` + counter-clockwise."""

    end: Pair
    centre: Pair | None
    sweep_rad: float
    length: float


class Spline(Struct, frozen=True):
    """A clamped uniform rational B-spline of an order (degree + 1) over control points."""

    points: tuple[Pair, ...]
    weights: tuple[float, ...]
    order: int

    @property
    def spans(self) -> int:
        """The number of polynomial pieces; the parameter runs from 0 to it."""
        return len(self.points) - self.order + 1

    def at(self, u: float) -> Pair:
        """The point at a parameter."""
        x, y, w = self._homogeneous(u)[0]
        return x / w, y / w

    def direction(self, u: float) -> Pair:
        """The unit tangent; where the curve rests (control points that are one), a secant."""
        (x, y, w), (dx, dy, dw) = self._homogeneous(u)
        tangent = (dx - dw * x / w) / w, (dy - dw * y / w) / w
        size = math.hypot(*tangent)
        first = min(int(u), self.spans - 1)
        reach = max(math.dist(p, self.points[first]) for p in self.points[first:][: self.order])
        step = 1e-3
        while size <= 1e-9 * reach and step > 1e-9:
            before, after = max(0.0, u - step), min(float(self.spans), u + step)
            a, b = self.at(before), self.at(after)
            tangent = b[0] - a[0], b[1] - a[1]
            size = math.hypot(*tangent)
            step *= 4.0 if size == 0.0 else 1e-9
            if step > self.spans:
                return 1.0, 0.0
        return tangent[0] / size, tangent[1] / size

    def _homogeneous(self, u: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Weighted point and its derivative, by de Boor's recursion."""
        degree = self.order - 1
        span = min(int(u), self.spans - 1)
        rows = [
            [x * w, y * w, w]
            for (x, y), w in zip(
                self.points[span : span + self.order],
                self.weights[span : span + self.order],
                strict=True,
            )
        ]
        last = rows
        for level in range(1, degree + 1):
            last = rows
            made = []
            for k in range(len(rows) - 1):
                low = self._knot(span + level + k)
                high = self._knot(span + self.order + k)
                share = (u - low) / (high - low)
                made.append(
                    [a + (b - a) * share for a, b in zip(rows[k], rows[k + 1], strict=True)]
                )
            rows = made
        width = self._knot(span + self.order) - self._knot(span + degree)
        slope = tuple(degree * (b - a) / width for a, b in zip(last[0], last[1], strict=True))
        return tuple(rows[0]), slope

    def _knot(self, k: int) -> float:
        """The k-th knot: the first and the last are there `order` times."""
        return float(min(max(0, k - self.order + 1), self.spans))


def biarcs(curve: Spline, tolerance: float) -> list[Piece]:
    """The arcs and lines of a curve, each no farther from it than a tolerance.

    TooManyArcsError where there would be too many.
    """
    found: list[Piece] = []
    steps = curve.spans * FIRST_PIECES
    for k in range(steps):
        for piece in _halved(curve, k / FIRST_PIECES, (k + 1) / FIRST_PIECES, tolerance, 0):
            found.append(piece)
            if len(found) > MOST_ARCS:
                raise TooManyArcsError
    return found


def _halved(
    curve: Spline, low: float, high: float, tolerance: float, depth: int
) -> Iterator[Piece]:
    start, end = curve.at(low), curve.at(high)
    pair = _pair(start, curve.direction(low), end, curve.direction(high))
    if pair and _distance(curve, low, high, start, pair) <= MARGIN * tolerance:
        yield from pair
        return
    line = Piece(end, None, 0.0, math.dist(start, end))
    may_be_straight = depth >= DEEP or start == end
    is_near = may_be_straight and _distance(curve, low, high, start, [line]) <= MARGIN * tolerance
    if depth >= DEEPEST or is_near:
        if start != end:
            yield line
        return
    middle = (low + high) / 2.0
    yield from _halved(curve, low, middle, tolerance, depth + 1)
    yield from _halved(curve, middle, high, tolerance, depth + 1)


def _pair(start: Pair, out: Pair, end: Pair, into: Pair) -> list[Piece]:
    """Two arcs that leave and arrive in these directions; empty where they turn too far."""
    vx, vy = end[0] - start[0], end[1] - start[1]
    size = math.hypot(vx, vy)
    if size == 0.0:
        return []
    along = vx * (out[0] + into[0]) + vy * (out[1] + into[1])
    apart = 2.0 * (1.0 - out[0] * into[0] - out[1] * into[1])
    if apart < FLAT:
        ahead = 4.0 * (vx * into[0] + vy * into[1])
        if ahead <= FLAT * size:
            return []
        reach = size * size / ahead
    else:
        reach = (math.sqrt(along * along + apart * size * size) - along) / apart
    joint = (
        (start[0] + end[0] + reach * (out[0] - into[0])) / 2.0,
        (start[1] + end[1] + reach * (out[1] - into[1])) / 2.0,
    )
    first = _arc(start, out, joint)
    second = _arc(end, (-into[0], -into[1]), joint)
    if first is None or second is None:
        return []
    back = Piece(end, second.centre, -second.sweep_rad, second.length)
    return [first, back]


def _arc(start: Pair, out: Pair, end: Pair) -> Piece | None:
    """The arc from a point in a direction to another point; None for more than half a turn."""
    cx, cy = end[0] - start[0], end[1] - start[1]
    ahead, aside = out[0] * cx + out[1] * cy, out[0] * cy - out[1] * cx
    chord = math.hypot(cx, cy)
    if ahead <= 0.0:
        return None
    if abs(aside) <= FLAT * chord:
        return Piece(end, None, 0.0, chord)
    radius = chord * chord / (2.0 * aside)
    sweep = 2.0 * math.atan2(aside, ahead)
    centre = start[0] - radius * out[1], start[1] + radius * out[0]
    return Piece(end, centre, sweep, abs(radius * sweep))


def _distance(curve: Spline, low: float, high: float, start: Pair, pieces: list[Piece]) -> float:
    """How far the curve is from pieces that follow each other, where it is measured."""
    starts = [start, *(piece.end for piece in pieces)]
    points = [curve.at(low + (high - low) * k / SAMPLES) for k in range(1, SAMPLES)]
    pairs = list(zip(starts, pieces, strict=False))
    return max(min(distance(point, *each) for each in pairs) for point in points)


def distance(point: Pair, start: Pair, piece: Piece) -> float:
    """The distance of a point from an arc or line that begins at `start`."""
    if start == piece.end:
        return math.dist(point, start)
    if piece.centre is None:
        cx, cy = piece.end[0] - start[0], piece.end[1] - start[1]
        share = ((point[0] - start[0]) * cx + (point[1] - start[1]) * cy) / (cx * cx + cy * cy)
        share = min(1.0, max(0.0, share))
        return math.dist(point, (start[0] + share * cx, start[1] + share * cy))
    angle = math.atan2(point[1] - piece.centre[1], point[0] - piece.centre[0])
    angle -= math.atan2(start[1] - piece.centre[1], start[0] - piece.centre[0])
    turned = math.copysign(1.0, piece.sweep_rad) * angle % math.tau
    if turned <= abs(piece.sweep_rad):
        return abs(math.dist(point, piece.centre) - math.dist(start, piece.centre))
    return min(math.dist(point, start), math.dist(point, piece.end))
