"""Geometry of canonical moves: length, tangents, and the speeds that axis limits allow.

The feed counts along the linear axes X Y Z U V; rotary axes follow, and a move of rotary
axes alone has its length in degrees of the fastest one.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from openacr.cnc.canonical import AXES
from openacr.compiled import pick
from openacr.mill.config.curves import can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings
from openacr.mill.plan import arc_law_cy

Direction = tuple[float, ...]  # a unit tangent, a number for each linear axis
Point = Sequence[float]  # machine position, one value per axis 0..7
RADIUS_MM = 60.0  # a degree counts as much as it turns a point at about this radius
MM_PER_INCH = 25.4
_bend = pick(arc_law_cy.arc_bend)
_widening = pick(arc_law_cy.arc_widening)
_skew = pick(arc_law_cy.arc_skew)
_speed = pick(arc_law_cy.arc_speed)
_ramp = pick(arc_law_cy.arc_ramp)


@dataclass(frozen=True, slots=True)
class Bend:
    """The turn of an arc in the plane of two axes, in the terms of `arc_law_cy`."""

    plane: tuple[int, int]
    per_u: float
    widening: float
    skew: float


@dataclass(frozen=True, slots=True)
class MoveShape:
    """Shape of one move: `share` is the travel of each axis per unit of path length."""

    length_u: float
    start: Direction | None
    end: Direction | None
    share: tuple[float, ...]
    turns: Direction = ()  # of the rotary axes by path length, as lengths (`per_degree`)
    bend: Bend | None = None  # of an arc


def linear_axes(settings: Settings) -> list[int]:
    """The axes along which the feed counts; tangents have a component for each."""
    return [one.index for one in settings.axes if one.is_linear]


def per_degree(settings: Settings, axis: AxisSettings) -> float:
    """The length that a degree of a rotary axis counts as [units of the machine].

    It is the arc at the radius that the axis has in the store. Without one it is 1 mm or 1/32 inch:
    a power of two, so that scaling and scaling back are exact.
    """
    if axis.tolerance_radius_u > 0.0:
        return math.radians(axis.tolerance_radius_u)
    radius_u = RADIUS_MM if settings.is_metric else RADIUS_MM / MM_PER_INCH
    return 2.0 ** math.floor(math.log2(math.radians(radius_u)))


def weights(settings: Settings) -> tuple[float, ...]:
    """What a unit or degree of each axis 0..7 counts as, where all axes make up one distance."""
    turns = {one.index: per_degree(settings, one) for one in settings.axes if not one.is_linear}
    return tuple(turns.get(axis, 1.0) for axis in range(AXES))


class Geometry:
    """Computes lengths and limits for one set of axes."""

    def __init__(self, settings: Settings) -> None:
        self._axes = settings.axes
        self._speeds = settings.speeds
        self._linear = linear_axes(settings)
        self._rotary = [one.index for one in settings.axes if not one.is_linear]
        self._weights = weights(settings)
        self._plans = can_plan(settings)

    def line(self, start: Point, end: Point) -> MoveShape:
        """The shape of a straight move; its length is 0 when no axis moves."""
        delta = [b - a for a, b in zip(start, end, strict=True)]
        length = math.sqrt(sum(delta[axis] ** 2 for axis in self._linear))
        direction = None
        if length > 0.0:
            direction = tuple(delta[axis] / length for axis in self._linear)
        else:
            length = max((abs(delta[axis]) for axis in self._rotary), default=0.0)
        share = tuple(abs(d) / length for d in delta) if length > 0.0 else (0.0,) * len(delta)
        return MoveShape(length, direction, direction, share, self._turns(delta, length))

    def arc(
        self,
        start: Point,
        end: Point,
        plane: tuple[int, int],
        centre: tuple[float, float],
        sweep_rad: float,
    ) -> MoveShape:
        """The shape of an arc; positive sweeps turn from the first axis of the plane to the second.

        A radius that changes along the path (a spiral) counts as its mean; other linear
        axes are added as on a helix.
        """
        first, second = plane
        begin_u = math.dist((start[first], start[second]), centre)
        end_u = math.dist((end[first], end[second]), centre)
        arc_u = 0.5 * (begin_u + end_u) * abs(sweep_rad)
        rise = {axis: end[axis] - start[axis] for axis in self._linear if axis not in plane}
        length = math.sqrt(arc_u * arc_u + sum(d * d for d in rise.values()))
        if length == 0.0:
            return MoveShape(0.0, None, None, (0.0,) * len(start))
        delta = [b - a for a, b in zip(start, end, strict=True)]
        share = [abs(part) / length for part in delta]
        share[first] = share[second] = arc_u / length
        turn = math.copysign(1.0, sweep_rad) * arc_u / length
        tangents = [
            self._tangent(point, plane, centre, turn, rise, length) for point in (start, end)
        ]
        bend = None
        if arc_u > 0.0:
            radii = begin_u, end_u, sweep_rad
            bend = Bend(plane, _bend(*radii, arc_u / length), _widening(*radii), _skew(*radii))
        turns = self._turns(delta, length)
        return MoveShape(length, tangents[0], tangents[1], tuple(share), turns, bend)

    def _turns(self, delta: Sequence[float], length: float) -> Direction:
        """The part of the rotary axes in a path that has a length, as in `MoveShape`."""
        per = length or 1.0
        return tuple(self._weights[axis] * delta[axis] / per for axis in self._rotary)

    def _tangent(
        self,
        point: Point,
        plane: tuple[int, int],
        centre: tuple[float, float],
        turn: float,
        rise: dict[int, float],
        length: float,
    ) -> Direction:
        """The unit tangent: a quarter turn ahead of the radius, tilted by the rise."""
        first, second = plane
        x, y = point[first] - centre[0], point[second] - centre[1]
        radius = math.hypot(x, y) or 1.0
        parts = {first: -y / radius * turn, second: x / radius * turn}
        parts |= {axis: d / length for axis, d in rise.items()}
        return tuple(parts[axis] for axis in self._linear)

    def is_linear(self, shape: MoveShape) -> bool:
        """Whether only linear axes move."""
        return shape.start is not None and not any(shape.share[axis] for axis in self._rotary)

    def speed_limit(self, shape: MoveShape, *, is_planned: bool = False) -> float:
        """The highest vector speed within all axis limits, units/s.

        Of a planned path the planner finds what its turns leave; Arc Acceleration it does not know.
        """
        limits = [self._speeds.max_ups] if shape.start is not None else []
        limits += _per_axis(((one, one.max_speed_ups) for one in self._axes), shape)
        if self._speeds.rotary_max > 0.0:
            rotary = (one for one in self._axes if one.index in self._rotary)
            limits += _per_axis(((one, self._speeds.rotary_max) for one in rotary), shape)
        if shape.bend is not None and is_planned:
            limits.append(math.sqrt(self._speeds.arc_acc_ups2 / shape.bend.per_u))
        elif shape.bend is not None:
            limits.append(_speed(self._arc_limit(shape.bend), shape.bend.per_u))
        return min(limits, default=math.inf)

    def ramp_limit(
        self, shape: MoveShape, ramp_ups2: float, speed_ups: float, *, rounds: bool = False
    ) -> float:
        """The highest vector acceleration at up to a speed within all axis limits, units/s2.

        In a rounded corner it can have any direction, so it is within the limit of every axis.
        Of a machine that plans paths the ramp is one of each rotary axis, as in `curve_limits`.
        """
        if rounds:
            own = [one.max_acceleration_ups2 for one in self._axes if shape.share[one.index] > 0.0]
            return min([ramp_ups2, *(limit for limit in own if limit > 0.0)])
        own = _per_axis(((one, one.max_acceleration_ups2) for one in self._axes), shape)
        if self._plans:
            own.append(ramp_ups2 / self._fastest_turn(shape))
        if (bend := shape.bend) is not None:
            limit = self._arc_limit(bend)
            own.append(_ramp(limit, bend.per_u, bend.widening, bend.skew, speed_ups))
        return min([ramp_ups2, *own])

    def jerk_limit(self, shape: MoveShape) -> float:
        """The highest vector jerk within those of the path and of all axes, units/s3; 0 = any."""
        path = self._speeds.jerk_ups3
        own = ((one, one.jerk_ups3) for one in self._axes if limits_jerk(one, path))
        travel = [path] if shape.start is not None else []
        return min(travel + _per_axis(own, shape), default=path)

    def _fastest_turn(self, shape: MoveShape) -> float:
        """The largest share of a rotary axis where it is above that of the path, else 1."""
        return max((1.0, *(shape.share[axis] for axis in self._rotary)))

    def _arc_limit(self, bend: Bend) -> float:
        """The acceleration of an arc in any direction of its plane [units/s2]."""
        own = (one.max_acceleration_ups2 for one in self._axes if one.index in bend.plane)
        return min([self._speeds.arc_acc_ups2, *(limit for limit in own if limit > 0.0)])


def limits_jerk(axis: AxisSettings, path_ups3: float) -> bool:
    """Whether moves of an axis may need less jerk than that of the path."""
    return not axis.is_linear or axis.jerk_ups3 < path_ups3


def _per_axis(limits: Iterable[tuple[AxisSettings, float]], shape: MoveShape) -> list[float]:
    """Convert axis limits to limits of the vector; 0 is no limit."""
    return [
        limit / shape.share[axis.index]
        for axis, limit in limits
        if limit > 0.0 and shape.share[axis.index] > 0.0
    ]
