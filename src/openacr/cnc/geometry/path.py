"""The point a program has reached, and its moves from there.

Three forms of one point: `program` as given by the words, `placed` after scaling and
rotation, `target` in machine coordinates. The last two differ by a shift only, so cutter
radius compensation can work on machine points: elements that wait in it keep their
positions when an offset changes.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from msgspec.structs import replace

from openacr.cnc.canonical import (
    ROTARY,
    Arc,
    Entry,
    Line,
    Pace,
    PathMode,
    Plane,
    Point,
    Rapid,
    Source,
)
from openacr.cnc.geometry.arc_cy import arc_distance
from openacr.cnc.geometry.arcs import TURN, ArcGeometry
from openacr.cnc.geometry.coordinates import ORIGIN, Coordinates
from openacr.cnc.geometry.elements import Element
from openacr.cnc.program.block_context import BlockContext
from openacr.cnc.reading.functions import cosine, sine
from openacr.cnc.state.cells import DEFAULT_UNIT, RADIUS, RADIUS_WEAR
from openacr.cnc.state.hosts import Cells
from openacr.cnc.state.modal import COMPATIBILITY, METRIC, Modal
from openacr.units import MM_PER_INCH

FREE_SIDES = {41: 1, 42: -1}


class Path:
    """The point the program has reached, in its three forms."""

    def __init__(
        self, cells: Cells, modal: Modal, letters: dict[str, int], emit: Callable[[Entry], None]
    ) -> None:
        self._cells = cells
        self._rotary = {axis for letter, axis in letters.items() if letter in ROTARY}
        self._modal = modal
        self._emit = emit
        self.coordinates = Coordinates(cells, letters)
        self.program: Point = ORIGIN
        self.placed: Point = ORIGIN
        self.target: Point = ORIGIN
        self.issued: Point = ORIGIN  # the end of the last move that was made
        self.times, self.per = 1.0, 1.0  # active unit to default unit
        self._pace: Pace | None = None
        self.elements: Callable[[Element], None] | None = None  # into the compensation
        self.shape: (
            Callable[[Source, Point, Point, ArcGeometry | None, Pace | None], Point] | None
        ) = None

    # --- units and feed ----------------------------------------------------------------

    def set_unit(self) -> None:
        """Take over the active unit and the default unit."""
        self.times, self.per = self.factors(self._modal.unit)

    def factors(self, unit: int) -> tuple[float, float]:
        """What lengths in a unit (20, 21) are multiplied with and divided by."""
        is_metric, is_stored_metric = unit == METRIC, self._cells.read(DEFAULT_UNIT) != 0.0
        times = MM_PER_INCH if is_stored_metric and not is_metric else 1.0
        return times, MM_PER_INCH if is_metric and not is_stored_metric else 1.0

    def length(self, value: float) -> float:
        """A length in active units, in default units."""
        return value * self.times / self.per

    def shown(self, value: float) -> float:
        """A length in default units, in active units."""
        return value * self.per / self.times

    def inches(self, value: float) -> float:
        """A length in inches, in default units."""
        return value * MM_PER_INCH if self._cells.read(DEFAULT_UNIT) else value

    def change_pace(self) -> None:
        """Feed, path mode or a lock has changed."""
        self._pace = None

    def pace(self, b: BlockContext) -> Pace:
        """The pace of a feed move of this block."""
        pace = self._pace or self.plain_pace()
        return replace(pace, is_confirmed=True) if b.is_confirmed else pace

    def plain_pace(self) -> Pace:
        """The present pace of feed moves."""
        pace = self._pace
        if pace is None:
            modal = self._modal
            mode = modal.mode(is_compatible=self._cells.read(COMPATIBILITY) != 0.0)
            is_locked = modal.is_feed_locked or mode is PathMode.LOCKED
            pace = self._pace = Pace(
                modal.feed, mode, is_locked, modal.path == 61, modal.tolerance, self._side()
            )
        return pace

    def _side(self) -> int:
        """The side of the path away from the part, 0 if unknown (negative radius)."""
        modal = self._modal
        radius = self._cells.read(RADIUS) + self._cells.read(RADIUS_WEAR)
        is_known = modal.plane_axes is Plane.XY and radius >= 0.0
        return FREE_SIDES.get(modal.compensation, 0) if is_known else 0

    # --- places ------------------------------------------------------------------------

    def end(self, b: BlockContext) -> Point:
        """The program point given by the axis words of a block."""
        p = list(self.program)
        times, per = self.times, self.per
        words = b.words
        is_incremental = self._modal.distance == 91
        for axis, letter in b.plan.axes:
            value = words[letter]
            if letter not in ROTARY:
                value = value * times / per
            p[axis] = p[axis] + value if is_incremental else value
        if b.plan.is_polar:
            p[0], p[1] = self._polar(b, is_incremental=is_incremental)
        return tuple(p)

    def _polar(self, b: BlockContext, *, is_incremental: bool) -> tuple[float, float]:
        """X and Y of the words @ (distance from the origin) and ^ (degrees from X)."""
        column = "@" if "@" in b.words else "^"
        if self._modal.plane_axes is not Plane.XY:
            raise b.fault("E236", column, hint="polar coordinates lie in the XY plane: G17")
        x, y = self.program[0], self.program[1]
        radius, degrees = math.hypot(x, y), math.degrees(math.atan2(y, x))
        if radius == 0.0 and (is_incremental or "^" not in b.words):
            raise b.fault("E236", column, hint="at the origin the angle is needed, with G90")
        if is_incremental:
            radius, degrees = radius + self.length(b.get("@")), degrees + b.get("^")
        else:
            radius = self.length(b.words["@"]) if "@" in b.words else radius
            degrees = b.get("^", degrees)
        return radius * cosine(degrees), radius * sine(degrees)

    def distance(self, end: Point, arc: ArcGeometry | None, plane: Plane) -> float:
        """The length of a move from here; of rotary axes alone the largest turn."""
        delta = [b - a for a, b in zip(self.program, end, strict=True)]
        linear = [d for axis, d in enumerate(delta) if axis not in self._rotary]
        if arc is not None:
            beside = [d for axis, d in enumerate(delta) if axis in (plane.drill, 6, 7)]
            mean = 0.5 * (arc.start_radius + arc.end_radius)
            return math.hypot(mean * arc.sweep_rad, *beside)
        return math.hypot(*linear) or max(map(abs, delta))

    def begin(self, machine: Point) -> None:
        """Start at this machine point."""
        self.coordinates.refresh(self._modal)
        self.stand(machine)

    def refresh(self) -> None:
        """Recompute the program point after a change of offsets."""
        self.coordinates.refresh(self._modal)
        self.stand(self.target)

    # --- moves -------------------------------------------------------------------------

    def rapid(self, b: BlockContext, end: Point) -> None:
        """Move to a program point at rapid speed."""
        self._straight(b, end, self.coordinates.forward(end), None)

    def line(self, b: BlockContext, end: Point, pace: Pace) -> None:
        """Move to a program point at feed."""
        self._straight(b, end, self.coordinates.forward(end), pace)

    def place(self, b: BlockContext, placed: Point, pace: Pace | None) -> None:
        """Move straight to a point given after scaling and rotation."""
        self._straight(b, self.coordinates.backward(placed), placed, pace)

    def go_machine(self, b: BlockContext, target: Point, pace: Pace | None = None) -> None:
        """Move straight to a machine point."""
        if target != self.target:
            self._issue_straight(b.source, target, pace, is_confirmed=b.is_confirmed)
        self.stand(target)

    def stand(self, target: Point) -> None:
        """Take over a machine point without a move."""
        self.target = self.issued = target
        self.placed = self.coordinates.from_machine(target)
        self.program = self.coordinates.backward(self.placed)

    def jump(self, program: Point, target: Point) -> None:
        """Take over the end of many lines, without scaling and rotation."""
        self.program = self.placed = program
        self.target = target
        if self.elements is None:
            self.issued = target

    def _straight(self, b: BlockContext, end: Point, placed: Point, pace: Pace | None) -> None:
        b.has_moved = True
        self.program, self.placed = end, placed
        start, target = self.target, self.coordinates.to_machine(placed)
        if self.elements is not None:
            self._check_turn(b)
            self.target = target
            self.elements(Element(b.source, self._modal.plane_axes, start, target, pace))
            return
        if target != self.target:
            self._issue_straight(b.source, target, pace, is_confirmed=b.is_confirmed)
            self.target = target

    def _check_turn(self, b: BlockContext) -> None:
        """Compensation works in the plane of the machine: a turned system keeps XY alone."""
        turn = self.coordinates.turn
        if turn is not None and turn.plane is not self._modal.plane_axes:
            raise b.fault("E311", detail="the plane is turned out of itself")

    def _issue_straight(
        self,
        source: Source,
        target: Point,
        pace: Pace | None,
        is_inserted: bool = False,
        is_compensated: bool = False,
        is_confirmed: bool = False,
    ) -> None:
        if self.shape is not None:
            target = self.shape(source, self.issued, target, None, pace)
        self.issued = target
        if pace is None:
            is_confirmed |= self.plain_pace().is_confirmed
            self._emit(Rapid(source, target, is_inserted, is_confirmed))
        else:
            self._emit(Line(source, target, pace, is_inserted, is_compensated))

    def arc(self, b: BlockContext, end: Point, arc: ArcGeometry, pace: Pace) -> None:
        """Move along an arc given after scaling and rotation; `end` is the program point."""
        b.has_moved = True
        begin = self.placed
        self.program = end
        self.placed = self.coordinates.forward(end)
        if abs(arc.sweep_rad) <= TURN:
            self._arc_to(b, self.placed, arc, pace)
            return
        for placed, turn in arc.turns(self._modal.plane_axes, begin, self.placed):
            self._arc_to(b, placed, turn, pace)

    def _arc_to(self, b: BlockContext, placed: Point, arc: ArcGeometry, pace: Pace) -> None:
        """Move along an arc of at most one turn."""
        start, target = self.target, self.coordinates.to_machine(placed)
        if self.elements is not None:
            self._check_turn(b)
            self.target = target
            plane, shift = self._modal.plane_axes, self.coordinates.shift
            centre = arc.centre[0] + shift[plane.first], arc.centre[1] + shift[plane.second]
            self.elements(Element(b.source, plane, start, target, pace, centre, arc.sweep_rad))
            return
        self._issue_arc(b.source, target, arc, pace)
        self.target = target

    def _issue_arc(
        self,
        source: Source,
        target: Point,
        arc: ArcGeometry,
        pace: Pace,
        is_inserted: bool = False,
        is_compensated: bool = False,
    ) -> None:
        plane = self._modal.plane_axes
        if self.shape is not None:
            target = self.shape(source, self.issued, target, arc, pace)
        self.issued = target
        shift = self.coordinates.shift
        centre = arc.centre[0] + shift[plane.first], arc.centre[1] + shift[plane.second]
        self._emit(
            Arc(
                source,
                target,
                plane,
                centre,
                arc.sweep_rad,
                arc.start_radius,
                arc.end_radius,
                pace,
                is_inserted,
                is_compensated,
            )
        )

    def issue(self, element: Element) -> None:
        """Issue a compensated element as a canonical move."""
        flags = element.is_inserted, element.is_compensated
        if element.centre is None or element.pace is None:
            self._issue_straight(element.source, element.end, element.pace, *flags)
            return
        first, second = element.plane.first, element.plane.second
        shift = self.coordinates.shift
        arc = ArcGeometry(
            (element.centre[0] - shift[first], element.centre[1] - shift[second]),
            element.sweep_rad,
            arc_distance(element.start[first], element.start[second], *element.centre),
            arc_distance(element.end[first], element.end[second], *element.centre),
        )
        self._issue_arc(element.source, element.end, arc, element.pace, *flags)
