"""G5, G5.1, G5.2 and G5.3: splines in the XY plane, cut as arcs within a tolerance."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from openacr.cnc.canonical import Plane
from openacr.cnc.codes.gcodes.motion import MOTIONS, NO_CYCLE, NO_MOTION, check_words, pace_over
from openacr.cnc.codes.table import Axes, Group, Limit, Step, check_limit
from openacr.cnc.codes.tables import RS274NGC
from openacr.cnc.geometry.arcs import ArcGeometry, placed
from openacr.cnc.geometry.splines import (
    MOST_ARCS,
    TOLERANCE_INCH,
    Pair,
    Spline,
    TooManyArcsError,
    biarcs,
)

if TYPE_CHECKING:
    from openacr.cnc.canonical import Point
    from openacr.cnc.codes.run import Motions, Run
    from openacr.cnc.program.block_context import BlockContext

gcode = RS274NGC.gcode
POINTS = 5.2
FIRST_ORDER = 3
OPEN = "a curve of G5.2 is open: G5.3 ends it"
_PLANE_LETTERS = "XY"
_ORDER = Limit("L", FIRST_ORDER, 20, "E235", is_whole=True)
_WEIGHT = Limit("P", 1e-6, 1e6, "E235")
Vector = tuple[float, float]


@gcode(5, step=Step.MOTION, group=Group.MOTION, takes="IJPQ", axes=Axes.MOVE)
def cubic(run: Run, b: BlockContext) -> None:
    """A cubic spline; I J from the start, P Q from the end to its control points."""
    _check(run, b)
    if "P" not in b.words or "Q" not in b.words:
        raise b.fault("E235", hint="P and Q are needed")
    start, end = run.path.program, run.path.end(b)
    out, back = _out(run, b), _vector(run, b, "PQ")
    points = (_pair(start), _sum(_pair(start), out), _sum(_pair(end), back), _pair(end))
    _cut(run, b, Spline(points, (1.0,) * 4, 4), end)
    run.curve.end, run.curve.onward = end, (-back[0], -back[1])


def _out(run: Run, b: BlockContext) -> Vector:
    """I and J of G5; without them the curve goes on as the G5 before it ended."""
    if ("I" in b.words) != ("J" in b.words):
        raise b.fault("E235", "I" if "I" in b.words else "J", hint="I and J, or neither")
    if "I" in b.words:
        return _vector(run, b, "IJ")
    if run.curve.end != run.path.program:
        raise b.fault("E235", hint="the first G5 needs I and J")
    return run.curve.onward


@gcode(5.1, step=Step.MOTION, group=Group.MOTION, takes="IJ", axes=Axes.MOVE)
def quadratic(run: Run, b: BlockContext) -> None:
    """A quadratic spline; I J lead from the start to its control point."""
    _check(run, b)
    if not ("I" in b.words or "J" in b.words):
        raise b.fault("E235", hint="I, J or both are needed")
    start, end = run.path.program, run.path.end(b)
    middle = _sum(_pair(start), _vector(run, b, "IJ"))
    _cut(run, b, Spline((_pair(start), middle, _pair(end)), (1.0,) * 3, 3), end)


@gcode(POINTS, step=Step.MOTION, group=Group.MOTION, takes="PL", axes=Axes.MOVE)
def begin_curve(run: Run, b: BlockContext) -> None:
    """Control points X Y of weight P of a NURBS of order L, up to G5.3."""
    _check(run, b, may_be_open=True)
    control_point(run, b)
    run.modal.motion, run.motions = POINTS, IN_CURVE


def control_point(run: Run, b: BlockContext) -> None:
    """One control point, in a block with G5.2 or after it."""
    check_words(run, b, "PL")
    curve, letters = run.curve, {letter for _, letter in b.plan.axes}
    _check_axes(b)
    if "P" not in b.words:
        raise b.fault("E235", hint="each control point has a weight P")
    check_limit(_WEIGHT, b.words["P"], b.plan.column("P"))
    if "L" in b.words:
        check_limit(_ORDER, b.words["L"], b.plan.column("L"))
        curve.order = b.whole("L")
    if letters not in ({"X", "Y"}, set()) or (curve.points and not letters):
        raise b.fault("E235", hint="a control point has X and Y")
    if not curve.points:
        curve.points.append(_pair(run.path.program))
        curve.weights.append(1.0 if letters else b.words["P"])
    if letters:
        curve.points.append(_pair(run.path.end(b)))
        curve.weights.append(b.words["P"])


@gcode(5.3, step=Step.MOTION, group=Group.MOTION, axes=Axes.BARRED)
def end_curve(run: Run, b: BlockContext) -> None:
    """The end of a NURBS: it is cut through its control points."""
    curve = run.curve
    if not curve.points:
        raise b.fault("E235", hint="G5.2 begins a curve")
    if len(curve.points) < curve.order:
        need = f"{len(curve.points)} control points, and L{curve.order} needs {curve.order}"
        raise b.fault("E235", detail=need, hint="where the curve begins is one of them")
    _check(run, b, may_be_open=True)
    if curve.points[0] != _pair(run.path.program):
        raise b.fault("E235", hint="offsets have changed since G5.2")
    spline = Spline(tuple(curve.points), tuple(curve.weights), curve.order)
    curve.points, curve.weights, curve.order = [], [], FIRST_ORDER
    run.motions = MOTIONS
    _cut(run, b, spline, _at(run.path.program, spline.points[-1]))


def no_open_curve(run: Run, b: BlockContext) -> None:
    """Refuse another motion between G5.2 and G5.3."""
    if run.curve.points:
        raise b.fault("E235", hint=OPEN)


IN_CURVE: Motions = {**dict.fromkeys(MOTIONS, no_open_curve), POINTS: control_point}


def _check(run: Run, b: BlockContext, *, may_be_open: bool = False) -> None:
    run.offset_path.refuse(b, "E314")
    if not may_be_open:
        no_open_curve(run, b)
    if run.modal.plane_axes is not Plane.XY:
        raise b.fault("E235", hint="splines lie in the XY plane: G17")
    _check_axes(b)


def _check_axes(b: BlockContext) -> None:
    for _, letter in b.plan.axes:
        if letter not in _PLANE_LETTERS:
            raise b.fault("E235", letter, letter, "splines move X and Y alone")


def _vector(run: Run, b: BlockContext, letters: str) -> Vector:
    """Two words as lengths in default units."""
    x, y = (run.path.length(b.get(letter)) for letter in letters)
    return x, y


def _pair(point: Point) -> Pair:
    return point[Plane.XY.first], point[Plane.XY.second]


def _sum(point: Pair, vector: Vector) -> Pair:
    return point[0] + vector[0], point[1] + vector[1]


def _at(point: Point, place: Pair) -> Point:
    """A program point at another place of the plane."""
    return (*place, *point[2:])


def _cut(run: Run, b: BlockContext, spline: Spline, end: Point) -> None:
    """Move along a spline to the program point where it ends; no motion is active then."""
    path = run.path
    try:
        pieces = biarcs(spline, path.inches(TOLERANCE_INCH))
    except TooManyArcsError:
        raise b.fault("E235", detail=f"more than {MOST_ARCS} arcs") from None
    pace = pace_over(run, b, lambda: sum(piece.length for piece in pieces))
    for k, piece in enumerate(pieces):
        begin = path.program
        finish = end if k == len(pieces) - 1 else _at(begin, piece.end)
        if piece.centre is None:
            path.line(b, finish, pace)
            continue
        radii = math.dist(_pair(begin), piece.centre), math.dist(_pair(finish), piece.centre)
        arc = ArcGeometry(piece.centre, piece.sweep_rad, *radii)
        path.arc(b, finish, placed(b, arc, Plane.XY, path.coordinates, begin), pace)
    run.modal.motion, run.modal.cycle = NO_MOTION, NO_CYCLE
    run.curve.end = None
