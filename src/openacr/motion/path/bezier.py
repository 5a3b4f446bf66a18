"""Geometry of SPLINE and NURB: every span of them as a rational Bezier curve.

The poles of a span of a B-spline are values of its blossom, the symmetric function of p
arguments that is affine in each and gives the curve where all are equal: pole i of the span
from a to b is the blossom of p - i times a and i times b. With weights all this happens to
the homogeneous points (w p, w).
"""

from collections.abc import Sequence
from itertools import pairwise
from math import inf, sqrt
from typing import TypeAlias

from msgspec import Struct

Vector: TypeAlias = Sequence[float]
SAMPLES = 16


class Bezier(Struct, frozen=True):
    """A rational Bezier curve: its poles and their weights."""

    poles: tuple[tuple[float, ...], ...]
    weights: tuple[float, ...]

    @property
    def degree(self) -> int:
        """Highest power of the parameter."""
        return len(self.poles) - 1

    @property
    def is_point(self) -> bool:
        """Whether the curve never leaves its first pole."""
        return all(pole == self.poles[0] for pole in self.poles)


def _mix(a: Vector, b: Vector, part: float) -> list[float]:
    return [x + (y - x) * part for x, y in zip(a, b, strict=True)]


def _homogeneous(point: Vector, weight: float) -> list[float]:
    return [*(weight * value for value in point), weight]


def _from_homogeneous(points: Sequence[Vector]) -> Bezier:
    weights = tuple(point[-1] for point in points)
    return Bezier(tuple(tuple(v / point[-1] for v in point[:-1]) for point in points), weights)


def span(points: Sequence[Vector], weights: Vector, knots: Vector) -> Bezier:
    """The span of a B-spline of degree p over knots[p] to knots[p + 1], of p + 1 points."""
    degree = len(points) - 1
    given = [_homogeneous(p, w) for p, w in zip(points, weights, strict=True)]
    begin, end = knots[degree], knots[degree + 1]
    return _from_homogeneous(
        [_blossom(given, knots, [begin] * (degree - i) + [end] * i) for i in range(degree + 1)]
    )


def _blossom(points: Sequence[Vector], knots: Vector, at: Vector) -> Vector:
    """De Boor's algorithm with an argument of its own in each step."""
    degree = len(points) - 1
    row = list(points)
    for step in range(degree):
        for i in range(degree, step, -1):
            low, high = knots[i], knots[i + degree - step]
            row[i] = _mix(row[i - 1], row[i], (at[step] - low) / (high - low))
    return row[degree]


def hermite(start: Vector, end: Vector, leave: Vector, arrive: Vector, time: float) -> Bezier:
    """The cubic from start to end in a time, with given velocities there."""
    third = time / 3.0
    second = [p + v * third for p, v in zip(start, leave, strict=True)]
    next_to_last = [p - v * third for p, v in zip(end, arrive, strict=True)]
    return Bezier((tuple(start), tuple(second), tuple(next_to_last), tuple(end)), (1.0,) * 4)


def step(start: Vector, end: Vector) -> tuple[Bezier, ...]:
    """From rest to rest: the spans of a uniform cubic B-spline whose control points step once."""
    points, knots = [start] * 3 + [end] * 3, [float(knot) for knot in range(7)]
    return tuple(span(points[n : n + 4], (1.0,) * 4, knots) for n in range(3))


def line(start: Vector, end: Vector) -> Bezier:
    """A straight line as a curve."""
    return Bezier((tuple(start), tuple(end)), (1.0, 1.0))


def halves(curve: Bezier) -> tuple[Bezier, Bezier]:
    """Both halves, by de Casteljau's construction."""
    row: list[Vector] = [
        _homogeneous(p, w) for p, w in zip(curve.poles, curve.weights, strict=True)
    ]
    first, second = [row[0]], [row[-1]]
    while len(row) > 1:
        row = [_mix(a, b, 0.5) for a, b in pairwise(row)]
        first.append(row[0])
        second.append(row[-1])
    return _from_homogeneous(first), _from_homogeneous(second[::-1])


def tightest_radius(curve: Bezier, units: Vector) -> float:
    """The smallest radius of curvature (sampled), each coordinate measured in its unit.

    With velocity v and acceleration a of the parametrisation it is
    |v|^3 / sqrt(|v|^2 |a|^2 - (v.a)^2).
    """
    scaled = [
        _homogeneous([v / unit for v, unit in zip(pole, units, strict=True)], weight)
        for pole, weight in zip(curve.poles, curve.weights, strict=True)
    ]
    return min(_radius(scaled, n / SAMPLES) for n in range(SAMPLES + 1))


def _radius(poles: list[list[float]], u: float) -> float:
    velocity, accel = _derivatives(poles, u)
    vv = sum(v * v for v in velocity)
    aa = sum(a * a for a in accel)
    va = sum(v * a for v, a in zip(velocity, accel, strict=True))
    bent = vv * aa - va * va
    return vv * sqrt(vv) / sqrt(bent) if bent > 0.0 else inf


def _derivatives(poles: list[list[float]], u: float) -> tuple[list[float], list[float]]:
    """First and second derivative of N/D by the quotient rule."""
    value, first, second = _at(poles, u), _at(_rise(poles), u), _at(_rise(_rise(poles)), u)
    d, d1, d2 = value[-1], first[-1], second[-1]
    place = [n / d for n in value[:-1]]
    velocity = [(n1 - p * d1) / d for n1, p in zip(first[:-1], place, strict=True)]
    accel = [
        (n2 - 2.0 * v * d1 - p * d2) / d
        for n2, v, p in zip(second[:-1], velocity, place, strict=True)
    ]
    return velocity, accel


def _rise(poles: list[list[float]]) -> list[list[float]]:
    """Poles of the derivative."""
    degree = len(poles) - 1
    if degree == 0:
        return [[0.0] * len(poles[0])]
    return [[(y - x) * degree for x, y in zip(a, b, strict=True)] for a, b in pairwise(poles)]


def _at(poles: list[list[float]], u: float) -> list[float]:
    row = poles
    while len(row) > 1:
        row = [_mix(a, b, u) for a, b in pairwise(row)]
    return row[0]
