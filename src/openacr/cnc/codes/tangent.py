"""The tangential axis: turned to the direction of the path at every move.

Where the direction changes by more than an epsilon the axis is turned at the corner, by a
rapid move of its own; a smaller change is spread over the move. On arcs it turns by the
sweep while the arc is cut. Moves across the plane keep it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Pace, Plane, Point, Rapid, Source
from openacr.sysvar.tabs import CONTROL

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.cnc.geometry.arcs import ArcGeometry

NO_MOVE = 1e-9


class Tangent:
    """Turns one axis along the path."""

    def __init__(self, run: Run, offset_deg: float) -> None:
        self._run = run
        self._offset_deg = offset_deg
        self._axis = int(run.cells.read(CONTROL.tangential_axis))
        self._epsilon_deg = run.cells.read(CONTROL.perpen_tangent_epsilon)

    def shape(
        self, source: Source, start: Point, end: Point, arc: ArcGeometry | None, pace: Pace | None
    ) -> Point:
        """The end of a move with the axis turned; a turn at the corner is issued here."""
        if self._axis < 0:
            return end
        direction = self._start_deg(start, end, arc)
        if direction is None:
            return self._kept(start, end)
        now = start[self._axis]
        turn = _shortest(direction + self._offset_deg - now)
        if abs(turn) > self._epsilon_deg:
            now += turn
            self._run.move(Rapid(source, self._turned(start, now), is_inserted=True))
            turn = 0.0
        sweep = math.degrees(arc.sweep_rad) if arc is not None else 0.0
        return self._turned(end, now + turn + sweep)

    def _kept(self, start: Point, end: Point) -> Point:
        return self._turned(end, start[self._axis])

    def _turned(self, point: Point, angle: float) -> Point:
        return (*point[: self._axis], angle, *point[self._axis + 1 :])

    def _start_deg(self, start: Point, end: Point, arc: ArcGeometry | None) -> float | None:
        """The direction in which a move starts, in its plane; None across the plane."""
        plane: Plane = self._run.modal.plane_axes
        first, second = plane.first, plane.second
        if arc is None:
            dx, dy = end[first] - start[first], end[second] - start[second]
        else:
            shift = self._run.path.coordinates.shift
            side = math.copysign(1.0, arc.sweep_rad)
            dx = -side * (start[second] - shift[second] - arc.centre[1])
            dy = side * (start[first] - shift[first] - arc.centre[0])
        if math.hypot(dx, dy) < NO_MOVE:
            return None
        return math.degrees(math.atan2(dy, dx))


def _shortest(turn: float) -> float:
    """The same turn in (-180, 180]."""
    rest = math.fmod(turn, 360.0)
    if rest > 180.0:
        return rest - 360.0
    return rest + 360.0 if rest <= -180.0 else rest
