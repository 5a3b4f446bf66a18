r"""SCALE, ROTATE, OFFSET and FLZ: from the programmed path to the one of the machine.

    scaled   = c + f (p - c)               each axis
    rotated  = m + R(angle) (scaled - m)   the two axes of the plane, counter-clockwise
    machine  = rotated + OFFSET + FLZ      each axis

Distances (incremental values) are scaled and turned, not shifted. Where a turned path names
only one axis of the plane, the other one stays at its last programmed value, which is found
by the inverse transformation of the machine target: no second record of the path has to be kept.

The values act on moves that are issued later; jogs, followers and binary moves know nothing
of them.
"""

from collections.abc import Callable, Sequence
from functools import partial
from math import cos, radians, sin

from msgspec.structs import replace

from openacr.errors import CardError
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters
from openacr.messages import INVALID_ARC, INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.interlocks import master_moving, scale_of
from openacr.motion.path import moves
from openacr.motion.path.curves import slave_of
from openacr.motion.path.move_request import Circle, Direction, Part, Sine, SpaceArc, Target


def apply(card: Card, program: int, parts: Sequence[Part]) -> list[Part]:
    """The parts of a move in machine coordinates; `Invalid arc` if it is not an arc there."""
    turned = _Rotation(card, program).turn([_scaled(card, part) for part in parts])
    return [_shifted(card, part) for part in turned]


def rotate(card: Card, program: int, angle_deg: float) -> None:
    """Turn later paths by an angle about the centre that is set."""
    card.memory.F[masters.rotate_deg[moves.needed_master(card, program)]] = angle_deg


def rotate_about(
    card: Card, program: int, axes: tuple[int, int], center_u: tuple[float, float]
) -> None:
    """Choose the plane of ROTATE, by two axes, and its centre."""
    if axes[0] == axes[1]:
        raise CardError(INVALID_ARGUMENT)
    master = moves.needed_master(card, program)
    for place, (axis, center) in enumerate(zip(axes, center_u, strict=True)):
        card.memory.I[masters.rotate_slave[master] + place] = slave_of(card, program, axis)
        card.memory.F[masters.rotate_center_u[master] + place] = center


def angle_deg(card: Card, program: int) -> float:
    """The angle of ROTATE."""
    return card.memory.F[masters.rotate_deg[moves.needed_master(card, program)]]


def float_zero(card: Card, program: int, axis: int, value_u: float) -> None:
    """FLZ: let the present target position of an axis have a programmed value."""
    end_u = _machine_end(card, program, axis)
    card.memory.F[axis_rows.flz_u[axis]] = end_u - card.memory.F[axis_rows.offset_u[axis]] - value_u


def clear_float_zero(card: Card, axis: int) -> None:
    """FLZ OFF for one axis."""
    card.memory.F[axis_rows.flz_u[axis]] = 0.0


def _machine_end(card: Card, program: int, axis: int) -> float:
    """Where an axis is, or where its last move will end, in units."""
    master = moves.needed_master(card, program)
    slave = slave_of(card, program, axis)
    here = not master_moving(card, master)
    end_cnt = moves.start_cnt(card, master, slave, axis, here=here)
    return end_cnt / scale_of(card, axis)


# --- scale --------------------------------------------------------------------------------


def _factor(card: Card, axis: int) -> float:
    return card.memory.F[axis_rows.scale[axis]]


def _scale(card: Card, axis: int, value_u: float) -> float:
    center = card.memory.F[axis_rows.scale_center_u[axis]]
    return center + _factor(card, axis) * (value_u - center)


def _scaled(card: Card, part: Part) -> Part:
    match part:
        case Target(axis, value, incremental=True):
            return replace(part, value_u=_factor(card, axis) * value)
        case Target(axis, value):
            return replace(part, value_u=_scale(card, axis, value))
        case Sine(axis, target):
            amplitude = part.amplitude_u * _factor(card, axis)
            return replace(part, target_u=_scale(card, axis, target), amplitude_u=amplitude)
        case Circle():
            return _scaled_circle(card, part)
        case SpaceArc(axes):
            _needs_equal_factors(card, axes)
            return replace(
                part,
                target_u=_each(axes, part.target_u, partial(_scale, card)),
                mid_u=_each(axes, part.mid_u, partial(_scale, card)),
            )


def _each(
    axes: Sequence[int], values: Sequence[float], change: Callable[[int, float], float]
) -> tuple[float, float, float]:
    """Three values, each changed for its axis."""
    return (
        change(axes[0], values[0]),
        change(axes[1], values[1]),
        change(axes[2], values[2]),
    )


def _scaled_circle(card: Card, circle: Circle) -> Circle:
    """A circle stays one when both factors have one size; one mirrored axis turns it round."""
    _needs_equal_factors(card, circle.axes)
    first, second = circle.axes
    is_mirrored = _factor(card, first) * _factor(card, second) < 0.0
    target, center = circle.target_u, circle.center_u
    return Circle(
        circle.axes,
        (_scale(card, first, target[0]), _scale(card, second, target[1])),
        (_scale(card, first, center[0]), _scale(card, second, center[1])),
        _opposite(circle.direction) if is_mirrored else circle.direction,
        circle.radius_scale,
    )


def _opposite(direction: Direction) -> Direction:
    if direction is Direction.CLOCKWISE:
        return Direction.COUNTER_CLOCKWISE
    return Direction.CLOCKWISE


def _needs_equal_factors(card: Card, axes: Sequence[int]) -> None:
    if len({abs(_factor(card, axis)) for axis in axes}) > 1:
        raise CardError(INVALID_ARC)


# --- shift --------------------------------------------------------------------------------


def _shift(card: Card, axis: int) -> float:
    return card.memory.F[axis_rows.offset_u[axis]] + card.memory.F[axis_rows.flz_u[axis]]


def _moved(card: Card, axis: int, value_u: float) -> float:
    return value_u + _shift(card, axis)


def _shifted(card: Card, part: Part) -> Part:
    match part:
        case Target(incremental=True):
            return part
        case Target(axis, value):
            return replace(part, value_u=_moved(card, axis, value))
        case Sine(axis, target):
            return replace(part, target_u=_moved(card, axis, target))
        case Circle(axes, target, center):
            return replace(
                part,
                target_u=(target[0] + _shift(card, axes[0]), target[1] + _shift(card, axes[1])),
                center_u=(center[0] + _shift(card, axes[0]), center[1] + _shift(card, axes[1])),
            )
        case SpaceArc(axes):
            return replace(
                part,
                target_u=_each(axes, part.target_u, partial(_moved, card)),
                mid_u=_each(axes, part.mid_u, partial(_moved, card)),
            )


# --- rotation -----------------------------------------------------------------------------


class _Rotation:
    """The rotation of one program at the moment a move is issued."""

    def __init__(self, card: Card, program: int) -> None:
        self._card = card
        self._program = program
        master = moves.needed_master(card, program)
        self._angle = radians(card.memory.F[masters.rotate_deg[master]])
        self._center = tuple(card.memory.F[masters.rotate_center_u[master] + n] for n in (0, 1))
        slaves = {s.number: s.axis for s in card.attachments.slaves(program)}
        self._plane = [
            slaves.get(card.memory.I[masters.rotate_slave[master] + n], -1) for n in (0, 1)
        ]

    def turn(self, parts: list[Part]) -> list[Part]:
        """All parts turned; those without an axis of the plane stay."""
        if self._angle == 0.0:
            return parts
        straight: dict[int, Target] = {}
        others: list[Part] = []
        for part in parts:
            if isinstance(part, Target) and part.axis in self._plane:
                straight[part.axis] = part
            else:
                others.append(self._turned_curve(part))
        return [*others, *self._turned_line(straight)]

    def _turned_line(self, named: dict[int, Target]) -> list[Part]:
        """Both axes of the plane, when one of them is named."""
        if not named:
            return []
        if -1 in self._plane:
            raise CardError(INVALID_ARGUMENT)
        first, second = self._plane
        if all(target.incremental for target in named.values()):
            delta_u = [named[a].value_u if a in named else 0.0 for a in self._plane]
            x, y = self._turned(delta_u[0], delta_u[1])
            return [Target(first, x, incremental=True), Target(second, y, incremental=True)]
        last = self._last()
        point = [
            self._absolute(named.get(a), value) for a, value in zip(self._plane, last, strict=True)
        ]
        x, y = self._turned_point(point[0], point[1])
        return [Target(first, x), Target(second, y)]

    def _absolute(self, target: Target | None, last: float) -> float:
        if target is None:
            return last
        return last + target.value_u if target.incremental else target.value_u

    def _last(self) -> tuple[float, float]:
        """The last programmed point of the plane, scaled: the inverse from the machine."""
        ends = [
            _machine_end(self._card, self._program, axis) - _shift(self._card, axis)
            for axis in self._plane
        ]
        x, y = ends[0] - self._center[0], ends[1] - self._center[1]
        c, s = cos(self._angle), sin(self._angle)
        return self._center[0] + c * x + s * y, self._center[1] - s * x + c * y

    def _turned_curve(self, part: Part) -> Part:
        """A curve in the plane of rotation keeps its shape; half in it, it has none."""
        match part:
            case Target():
                return part
            case Sine(axis):
                if axis in self._plane:
                    raise CardError(INVALID_ARGUMENT)
                return part
            case Circle(axes, target, center):
                if not self._lies_in_plane(axes):
                    return part
                return replace(
                    part,
                    target_u=self._turned_pair(axes, target),
                    center_u=self._turned_pair(axes, center),
                )
            case SpaceArc(axes):
                if not self._lies_in_plane(axes):
                    return part
                return replace(
                    part,
                    target_u=self._turned_three(axes, part.target_u),
                    mid_u=self._turned_three(axes, part.mid_u),
                )

    def _lies_in_plane(self, axes: Sequence[int]) -> bool:
        shared = len(set(axes) & set(self._plane))
        if shared == 1:
            raise CardError(INVALID_ARC)
        return shared == 2

    def _turned_pair(
        self, axes: tuple[int, int], point: tuple[float, float]
    ) -> tuple[float, float]:
        if axes[0] == self._plane[0]:
            return self._turned_point(*point)
        x, y = self._turned_point(point[1], point[0])
        return y, x

    def _turned_three(
        self, axes: tuple[int, int, int], point: tuple[float, float, float]
    ) -> tuple[float, float, float]:
        first, second = (axes.index(axis) for axis in self._plane)
        values = list(point)
        values[first], values[second] = self._turned_point(point[first], point[second])
        return values[0], values[1], values[2]

    def _turned(self, x: float, y: float) -> tuple[float, float]:
        c, s = cos(self._angle), sin(self._angle)
        return c * x - s * y, s * x + c * y

    def _turned_point(self, x: float, y: float) -> tuple[float, float]:
        turned = self._turned(x - self._center[0], y - self._center[1])
        return self._center[0] + turned[0], self._center[1] + turned[1]
