"""What a coordinated move is to do, in units and absolute angles, before it is a record."""

from collections.abc import Sequence
from enum import IntEnum
from typing import TypeAlias

from msgspec import Struct

from openacr.kernel.path import curve_cy


class Direction(IntEnum):
    """Rotation of a circle; counter-clockwise leads from the first axis to the second."""

    CLOCKWISE = curve_cy.CURVE_CW
    COUNTER_CLOCKWISE = curve_cy.CURVE_CCW


class Target(Struct, frozen=True):
    """Where one axis of a move goes: to `value_u`, or by `value_u` if incremental."""

    axis: int
    value_u: float
    incremental: bool = False


class Sine(Struct, frozen=True):
    """One axis on a part of a sine wave, to `target_u`."""

    axis: int
    target_u: float
    phase_deg: float
    sweep_deg: float
    amplitude_u: float


class Circle(Struct, frozen=True):
    """Two axes round a centre; the same place again is a full turn."""

    axes: tuple[int, int]
    target_u: tuple[float, float]
    center_u: tuple[float, float]
    direction: Direction
    radius_scale: tuple[float, float] = (1.0, 1.0)


class SpaceArc(Struct, frozen=True):
    """Three axes on the circle through where they are, a mid point and a target."""

    axes: tuple[int, int, int]
    target_u: tuple[float, float, float]
    mid_u: tuple[float, float, float]


class Piece(Struct, frozen=True):
    """Slaves on a piece of SPLINE or NURB, in pulses; it takes `span` or, if 0, its length."""

    slaves: tuple[int, ...]
    axes: tuple[int, ...]
    poles_cnt: tuple[tuple[float, ...], ...]
    weights: tuple[float, ...]
    span: float = 0.0


class FlagState(Struct, frozen=True):
    """A flag in the state that is waited for."""

    number: int
    clear: bool = False

    @property
    def signed(self) -> int:
        """As the kernel keeps it: the number + 1, negative for the clear state."""
        return -(self.number + 1) if self.clear else self.number + 1


Part: TypeAlias = Target | Sine | Circle | SpaceArc
Shape: TypeAlias = Part | Piece


def end_points(parts: Sequence[Part]) -> list[Target]:
    """The target of every axis of a move, whatever curve leads there; the last one counts."""
    found: dict[int, Target] = {}
    for part in parts:
        match part:
            case Target(axis):
                found[axis] = part
            case Sine(axis, target):
                found[axis] = Target(axis, target)
            case Circle(axes, targets) | SpaceArc(axes, targets):
                found |= {a: Target(a, t) for a, t in zip(axes, targets, strict=True)}
    return list(found.values())
