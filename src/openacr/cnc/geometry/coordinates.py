"""From program to machine coordinates and back.

    1 program value p          active to default unit, increments added
    2 scale     p1 = c + k (p - c)                        per axis
    3 rotate    p2 = rotation about the centre            in its plane
    4 (cutter radius compensation works on p2)
    5-8 shift   p3 = p2 + common + work + local + floating zero + fixture + length

Steps 5 to 8 are one vector, computed again when a part of it changes. The machine position
does not change then: the program position is computed from it. In the machine system (G53)
only step 1 applies; the others apply again with the next work system.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import add

from openacr.cnc.canonical import AXES, Plane, Point
from openacr.cnc.state.cells import COMMON, FIXTURES, FLOATING, LENGTH, LENGTH_WEAR, LOCAL
from openacr.cnc.state.hosts import Cells
from openacr.cnc.state.modal import Modal

LAST_SYSTEM, NINTH_SYSTEM = 8, 840
HOLE = 10  # distance of the cells of one system from the next
LENGTH_SIGN = {43: 1.0, 44: -1.0, 49: 0.0}
ORIGIN: Point = (0.0,) * AXES


def system_base(n: int) -> int:
    """The first cell of work system n; the ninth (G59.3) has its own."""
    return COMMON + HOLE * n if n <= LAST_SYSTEM else NINTH_SYSTEM


@dataclass(frozen=True, slots=True)
class Scale:
    """G51: factors about a centre."""

    centre: Point
    factors: Point


@dataclass(frozen=True, slots=True)
class Rotation:
    """G68: a rotation in a plane."""

    plane: Plane
    centre: tuple[float, float]
    degrees: float

    def turned(self, p: list[float], degrees: float) -> None:
        """Rotate a point in place."""
        first, second = self.plane.first, self.plane.second
        sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        if degrees % 90.0 == 0.0:  # without rounding errors
            sine, cosine = round(sine), round(cosine)
        x, y = p[first] - self.centre[0], p[second] - self.centre[1]
        p[first] = self.centre[0] + x * cosine - y * sine
        p[second] = self.centre[1] + x * sine + y * cosine


class Coordinates:
    """The transformation between program and machine coordinates."""

    def __init__(self, cells: Cells, letters: dict[str, int]) -> None:
        self._cells = cells
        self._z = letters.get("Z", 2)
        self.chosen_scale: Scale | None = None  # by G51
        self.chosen_rotation: Rotation | None = None  # by G68
        self.scale: Scale | None = None  # in force: G53 sets both aside
        self.rotation: Rotation | None = None
        self.shift: Point = ORIGIN
        self.added: Point = ORIGIN  # G43.1, G43.2: lengths that come from no table

    @property
    def is_plain(self) -> bool:
        """Whether neither scaling nor rotation is on."""
        return self.scale is None and self.rotation is None

    def clear(self) -> None:
        """Remove scaling, rotation and added lengths."""
        self.chosen_scale = self.chosen_rotation = None
        self.added = ORIGIN

    def refresh(self, modal: Modal) -> None:
        """Apply what was chosen, and compute the shift of steps 5 to 8 from the cells."""
        if modal.work == 0:
            self.scale = self.rotation = None
            self.shift = ORIGIN
            return
        self.scale, self.rotation = self.chosen_scale, self.chosen_rotation
        read = self._cells.read
        base = system_base(modal.work)
        shift = [
            read(COMMON + a) + read(base + a) + read(LOCAL + a) + read(FLOATING + a)
            for a in range(AXES)
        ]
        for axis, value in enumerate(self.offsets(modal)):
            shift[axis] += value
        self.shift = tuple(shift) if any(shift) else ORIGIN

    def offsets(self, modal: Modal) -> Point:
        """The offsets of steps 7 and 8: fixture and length."""
        read = self._cells.read
        vector = [0.0] * AXES
        if modal.fixture:
            base = FIXTURES + HOLE * modal.fixture
            vector = [read(base + a) for a in range(AXES)]
            vector[self._z] = 0.0
        vector[self._z] += LENGTH_SIGN[modal.length] * (read(LENGTH) + read(LENGTH_WEAR))
        return tuple(v + a for v, a in zip(vector, self.added, strict=True))

    def add_length(self, length: float) -> None:
        """Add a length to Z."""
        z = self._z
        self.added = (*self.added[:z], self.added[z] + length, *self.added[z + 1 :])

    def forward(self, program: Point) -> Point:
        """Scale and rotate: steps 2 and 3."""
        if self.scale is None and self.rotation is None:
            return program
        p = list(program)
        if self.scale is not None:
            factors, centre = self.scale.factors, self.scale.centre
            p = [c + k * (x - c) for x, c, k in zip(p, centre, factors, strict=True)]
        if self.rotation is not None:
            self.rotation.turned(p, self.rotation.degrees)
        return tuple(p)

    def backward(self, placed: Point) -> Point:
        """Undo rotation and scaling: steps 3 and 2."""
        if self.scale is None and self.rotation is None:
            return placed
        p = list(placed)
        if self.rotation is not None:
            self.rotation.turned(p, -self.rotation.degrees)
        if self.scale is not None:
            factors, centre = self.scale.factors, self.scale.centre
            p = [c + (x - c) / k for x, c, k in zip(p, centre, factors, strict=True)]
        return tuple(p)

    def to_machine(self, placed: Point) -> Point:
        """Add the shift of steps 5 to 8."""
        if self.shift is ORIGIN:
            return placed
        return tuple(map(add, placed, self.shift))

    def from_machine(self, machine: Point) -> Point:
        """Subtract the shift of steps 5 to 8."""
        return tuple(x - s for x, s in zip(machine, self.shift, strict=True))
