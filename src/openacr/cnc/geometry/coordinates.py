"""From program to machine coordinates and back.

    1 program value p          active to default unit, increments added
    2 scale     p1 = c + k (p - c)                        per axis
    3 rotate    p2 = rotation about the centre            in its plane
    4 (cutter radius compensation works on p2)
    5 turn      p3 = rotation of the work system about Z, with floating zero and local shift
                added before it: its centre is where they put the origin of the system
    6-9 shift   p4 = p3 + common + work + local + floating zero + fixture + length

Steps 6 to 9 are one vector, computed again when a part of it changes. The machine position
does not change then: the program position is computed from it. In the machine system (G53)
only step 1 applies; the others apply again with the next work system.
"""

from __future__ import annotations

import math
from operator import add

from msgspec import Struct

from openacr.cnc.canonical import AXES, Plane, Point
from openacr.cnc.state.cells import COMMON, FIXTURES, FLOATING, LENGTH, LENGTH_WEAR, LOCAL
from openacr.cnc.state.hosts import Cells
from openacr.cnc.state.modal import Modal
from openacr.cnc.state.parameters import NINTH_SYSTEM

LAST_SYSTEM = 8
TURN = 8  # of the cells of a system: its rotation
HOLE = 10  # distance of the cells of one system from the next
LENGTH_SIGN = {43: 1.0, 44: -1.0, 49: 0.0}
ORIGIN: Point = (0.0,) * AXES


def system_base(n: int) -> int:
    """The first cell of work system n; the ninth (G59.3) has its own."""
    return COMMON + HOLE * n if n <= LAST_SYSTEM else NINTH_SYSTEM


def origin_that_reads(
    point: Point, before: Point, degrees: float, wanted: dict[int, float]
) -> Point:
    """The origin of a system, turned by degrees about Z, in which a point reads these values.

    Axes that are not named keep the reading they have with the origin `before`.
    """
    turn = Rotation(Plane.XY, (0.0, 0.0), degrees)
    reading = [x - o for x, o in zip(point, before, strict=True)]
    turn.turned(reading, -degrees)
    for axis, value in wanted.items():
        reading[axis] = value
    turn.turned(reading, degrees)
    return tuple(x - r for x, r in zip(point, reading, strict=True))


class Scale(Struct, frozen=True):
    """G51: factors about a centre."""

    centre: Point
    factors: Point


class Rotation(Struct, frozen=True):
    """A rotation in a plane: G68, and that of a work system."""

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
        self.turn: Rotation | None = None  # of the work system
        self.shift: Point = ORIGIN
        self.added: Point = ORIGIN  # G43.1, G43.2: lengths that come from no table

    @property
    def is_plain(self) -> bool:
        """Whether the program coordinates are only shifted."""
        return self.scale is None and self.rotation is None and self.turn is None

    @property
    def is_shifted(self) -> bool:
        """Whether machine and program positions differ by a shift."""
        return self.shift is not ORIGIN

    def clear(self) -> None:
        """Remove scaling, rotation and added lengths."""
        self.chosen_scale = self.chosen_rotation = None
        self.added = ORIGIN

    def refresh(self, modal: Modal) -> None:
        """Apply what was chosen, and compute steps 5 to 9 from the cells."""
        if modal.work == 0:
            self.scale = self.rotation = self.turn = None
            self.shift = ORIGIN
            return
        self.scale, self.rotation = self.chosen_scale, self.chosen_rotation
        read = self._cells.read
        base = system_base(modal.work)
        beside = [read(LOCAL + a) + read(FLOATING + a) for a in range(AXES)]
        shift = [read(COMMON + a) + read(base + a) + beside[a] for a in range(AXES)]
        degrees = read(base + TURN)
        self.turn = Rotation(Plane.XY, (-beside[0], -beside[1]), degrees) if degrees else None
        for axis, value in enumerate(self.offsets(modal)):
            shift[axis] += value
        self.shift = tuple(shift) if any(shift) else ORIGIN

    def offsets(self, modal: Modal) -> Point:
        """The offsets of steps 8 and 9: fixture and length."""
        read = self._cells.read
        vector = [0.0] * AXES
        if modal.fixture:
            base = FIXTURES + HOLE * modal.fixture
            vector = [read(base + a) for a in range(AXES)]
            vector[self._z] = 0.0
        vector[self._z] += LENGTH_SIGN[modal.length] * (read(LENGTH) + read(LENGTH_WEAR))
        return tuple(v + a for v, a in zip(vector, self.added, strict=True))

    def forward(self, program: Point) -> Point:
        """Scale, rotate and turn: steps 2, 3 and 5."""
        if self.turn is None:
            return self.scaled(program)
        p = list(self.scaled(program))
        self.turn.turned(p, self.turn.degrees)
        return tuple(p)

    def scaled(self, program: Point) -> Point:
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
        """Undo turn, rotation and scaling: steps 5, 3 and 2."""
        if self.is_plain:
            return placed
        p = list(self.unturned(placed))
        if self.rotation is not None:
            self.rotation.turned(p, -self.rotation.degrees)
        if self.scale is not None:
            factors, centre = self.scale.factors, self.scale.centre
            p = [c + (x - c) / k for x, c, k in zip(p, centre, factors, strict=True)]
        return tuple(p)

    def unturned(self, placed: Point) -> Point:
        """Undo the rotation of the work system: step 5."""
        if self.turn is None:
            return placed
        p = list(placed)
        self.turn.turned(p, -self.turn.degrees)
        return tuple(p)

    def origin_of(self, n: int, machine: Point, wanted: dict[int, float], modal: Modal) -> Point:
        """The offset of work system n with which a machine point reads these values by axis.

        Other axes keep their reading; in a rotated system X or Y alone moves both offsets.
        """
        read, base = self._cells.read, system_base(n)
        is_used = n == modal.work  # the local shift ends when another system is chosen
        beside = [read(FLOATING + a) + (read(LOCAL + a) if is_used else 0.0) for a in range(AXES)]
        other = self.offsets(modal)
        own = tuple(x - read(COMMON + a) - other[a] for a, x in enumerate(machine))
        before = tuple(read(base + a) for a in range(AXES))
        named = {axis: value + beside[axis] for axis, value in wanted.items()}
        return origin_that_reads(own, before, read(base + TURN), named)

    def to_machine(self, placed: Point) -> Point:
        """Add the shift of steps 6 to 9."""
        if self.shift is ORIGIN:
            return placed
        return tuple(map(add, placed, self.shift))

    def from_machine(self, machine: Point) -> Point:
        """Subtract the shift of steps 6 to 9."""
        return tuple(x - s for x, s in zip(machine, self.shift, strict=True))
