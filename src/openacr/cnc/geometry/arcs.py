"""Arcs: centre, sweep and radii from the words of a block."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator

from msgspec import Struct
from msgspec.structs import replace

from openacr.cnc.canonical import Plane, Point
from openacr.cnc.geometry import arc_cy
from openacr.cnc.geometry.coordinates import Coordinates
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.rows import arcs as rows
from openacr.compiled import pick

NO_TURN = arc_cy.ARC_NO_TURN  # radians
TURN = arc_cy.ARC_TURN
CENTRE_WORDS = "IJK"  # of axes 0, 1, 2
Pair = tuple[float, float]
_FAULTS = {arc_cy.ARC_SAME: "E231", arc_cy.ARC_APART: "E233", arc_cy.ARC_SMALL: "E232"}
_centre = pick(arc_cy.arc_centre)
_sweep = pick(arc_cy.arc_about)


class ArcGeometry(Struct, frozen=True):
    """An arc in its plane: the radius changes linearly over the sweep (+ counter-clockwise)."""

    centre: Pair
    sweep_rad: float
    start_radius: float
    end_radius: float

    def with_turns(self, turns: int) -> ArcGeometry:
        """The same arc with full turns before it: `turns` in all."""
        more = math.copysign(TURN * (turns - 1), self.sweep_rad)
        return replace(self, sweep_rad=self.sweep_rad + more)

    def turns(self, plane: Plane, start: Point, end: Point) -> Iterator[tuple[Point, ArcGeometry]]:
        """Arcs of at most one turn that follow each other, each with its end.

        Axes outside the plane move in proportion to the angle.
        """
        whole = math.ceil(abs(self.sweep_rad) / TURN - NO_TURN) - 1
        radius = self.start_radius
        for k in range(1, whole + 1):
            share = TURN * k / abs(self.sweep_rad)
            point = [a + (b - a) * share for a, b in zip(start, end, strict=True)]
            grown = self.start_radius + (self.end_radius - self.start_radius) * share
            for axis, middle in zip((plane.first, plane.second), self.centre, strict=True):
                is_same = grown == self.start_radius
                reach = start[axis] - middle
                point[axis] = start[axis] if is_same else middle + reach * grown / self.start_radius
            sweep = math.copysign(TURN, self.sweep_rad)
            yield tuple(point), ArcGeometry(self.centre, sweep, radius, grown)
            radius = grown
        left = self.sweep_rad - math.copysign(TURN * whole, self.sweep_rad)
        yield end, ArcGeometry(self.centre, left, radius, self.end_radius)


def arc_geometry(
    b: BlockContext,
    plane: Plane,
    start: Point,
    end: Point,
    direction: int,
    reading: int,
    epsilon: float,
    lengths: dict[str, float],
) -> ArcGeometry:
    """Compute the arc of a block; `lengths` are its words I J K R in default units."""
    first, second = plane.first, plane.second
    for letter in CENTRE_WORDS:
        if letter in lengths and CENTRE_WORDS.index(letter) not in (first, second):
            raise b.fault("E234", letter, letter)
    a, z = (start[first], start[second]), (end[first], end[second])
    if "R" in lengths:
        if len(lengths) > 1:
            raise b.fault("E231", "R")
        centre = _centre_by_radius(b, a, z, lengths["R"], direction, epsilon)
    else:
        centre = centre_by_words(b, plane, a, reading, lengths)
    return _arc_about(b, a, z, centre, direction)


def centre_by_words(
    b: BlockContext, plane: Plane, start: Pair, reading: int, lengths: dict[str, float]
) -> Pair:
    """The centre by I, J, K: start minus words (0), start plus words (1), a position (2)."""
    letters = CENTRE_WORDS[plane.first], CENTRE_WORDS[plane.second]
    if not any(letter in lengths for letter in letters):
        raise b.fault("E231", hint="I, J, K or R")
    if reading == 2:
        x, y = (lengths.get(letter, s) for letter, s in zip(letters, start, strict=True))
        return x, y
    sign = 1.0 if reading == 1 else -1.0
    x, y = (s + sign * lengths.get(letter, 0.0) for letter, s in zip(letters, start, strict=True))
    return x, y


def _arc_of(start: Pair, end: Pair, centre: Pair) -> array[float]:
    return array("d", (*start, *end, *centre, 0.0, 0.0, 0.0))


def _centre_by_radius(
    b: BlockContext, start: Pair, end: Pair, radius: float, direction: int, epsilon: float
) -> Pair:
    arc = _arc_of(start, end, start)
    found = _centre(memoryview(arc), 0, radius, direction, epsilon)
    if found != arc_cy.ARC_DONE:
        raise b.fault(_FAULTS[found], "R")
    return arc[rows.CX], arc[rows.CY]


def _arc_about(
    b: BlockContext, start: Pair, end: Pair, centre: Pair, direction: int
) -> ArcGeometry:
    arc = _arc_of(start, end, centre)
    found = _sweep(memoryview(arc), 0, direction)
    if found != arc_cy.ARC_DONE:
        raise b.fault(_FAULTS[found])
    return ArcGeometry(centre, arc[rows.SWEEP_RAD], arc[rows.R0], arc[rows.R1])


def placed(
    b: BlockContext, arc: ArcGeometry, plane: Plane, coordinates: Coordinates, start: Point
) -> ArcGeometry:
    """The arc after scaling and rotation."""
    if coordinates.is_plain:
        return arc
    first, second = plane.first, plane.second
    sweep, factor = arc.sweep_rad, 1.0
    if coordinates.scale is not None:
        k1, k2 = coordinates.scale.factors[first], coordinates.scale.factors[second]
        if abs(abs(k1) - abs(k2)) > arc_cy.ARC_NEAREST:
            raise b.fault("E244", detail=f"{k1:g} and {k2:g}")
        factor = abs(k1)
        sweep = -sweep if k1 * k2 < 0.0 else sweep
    for turn in (coordinates.rotation, coordinates.turn):
        if turn is not None and turn.plane is not plane:
            raise b.fault("E244", detail="the plane is turned out of itself")
    point = list(start)
    point[first], point[second] = arc.centre
    moved = coordinates.forward(tuple(point))
    return ArcGeometry(
        (moved[first], moved[second]), sweep, arc.start_radius * factor, arc.end_radius * factor
    )
