"""From the rows of a chain back to elements: what is issued for a piece and between pieces."""

from collections.abc import Iterator
from dataclasses import replace
from math import atan2, ceil, cos, pi, sin, tau

from openacr.cnc.canonical import Pace, Plane, Point, Source
from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    EMPTY,
    FITS,
    SHORTEST,
    SWEEP,
    TOOL_SWEEP,
    X1,
    Y1,
)
from openacr.cnc.compensation.join_cy import BRIDGE, GAP, ROUND
from openacr.cnc.compensation.rows import Piece
from openacr.cnc.elements import Element
from openacr.views import F64

RAPID_STEP_RAD = pi / 3.0  # of a corner that is rounded at rapid speed


def moved(point: Point, plane: Plane, x: float, y: float) -> Point:
    """A point with other coordinates in the plane."""
    if plane is Plane.XY:
        return (x, y, *point[2:])
    values = list(point)
    values[plane.first] = x
    values[plane.second] = y
    return tuple(values)


def tool_way(F: F64, piece: Piece[object]) -> Element | None:
    """The move of the tool beside an element; None where nothing is left of it."""
    element, row = piece.element, piece.row
    plane = element.plane
    start = moved(element.start, plane, F[row + AX], F[row + AY])
    end = moved(element.end, plane, F[row + BX], F[row + BY])
    if piece.fits == FITS and F[row + SWEEP] != 0.0:
        centre = (F[row + CX], F[row + CY])
        sweep = F[row + TOOL_SWEEP]
        return Element(element.source, plane, start, end, element.pace, centre, sweep, False, True)
    if piece.fits == EMPTY and start == moved(end, plane, F[row + AX], F[row + AY]):
        return None
    return Element(element.source, plane, start, end, element.pace, None, 0.0, False, True)


def inserted(
    F: F64, piece: Piece[object], following: Piece[object], meets: int
) -> Iterator[Element]:
    """The moves between the end of a piece and the start of the one behind it."""
    if meets not in (ROUND, BRIDGE, GAP):
        return
    element = following.element
    pace = element.pace or piece.element.pace
    start = (F[piece.row + BX], F[piece.row + BY])
    end = (F[following.row + AX], F[following.row + AY])
    make = _Maker(element.source, element.plane, element.start, pace)
    if meets != ROUND:
        yield make.element(start, end)
        return
    corner = (F[piece.row + X1], F[piece.row + Y1])
    sweep = rolled(start, end, corner, F[piece.row + AWAY])
    if pace is not None:
        yield make.element(start, end, corner, sweep)
    else:
        yield from make.around(start, end, corner, sweep)


def rolled(
    start: tuple[float, float], end: tuple[float, float], corner: tuple[float, float], away: float
) -> float:
    """The sweep of a tool that rolls about a corner: clockwise where it is on the left."""
    first = atan2(start[1] - corner[1], start[0] - corner[0])
    last = atan2(end[1] - corner[1], end[0] - corner[0])
    turn = -1.0 if away > 0.0 else 1.0
    return turn * ((turn * (last - first)) % tau)


class _Maker:
    """Makes inserted elements of one place; axes outside the plane rest."""

    def __init__(self, source: Source, plane: Plane, point: Point, pace: Pace | None) -> None:
        self._source = source
        self._plane = plane
        self._point = point
        self._pace = pace

    def element(
        self,
        start: tuple[float, float],
        end: tuple[float, float],
        centre: tuple[float, float] | None = None,
        sweep_rad: float = 0.0,
    ) -> Element:
        return Element(
            self._source,
            self._plane,
            moved(self._point, self._plane, *start),
            moved(self._point, self._plane, *end),
            self._pace,
            centre,
            sweep_rad,
            is_inserted=True,
            is_compensated=True,
        )

    def around(
        self,
        start: tuple[float, float],
        end: tuple[float, float],
        corner: tuple[float, float],
        sweep: float,
    ) -> Iterator[Element]:
        """Straight rapid moves around the arc: tangents of it, that never come nearer."""
        steps = max(1, ceil(abs(sweep) / RAPID_STEP_RAD))
        step = sweep / steps
        x, y = start[0] - corner[0], start[1] - corner[1]
        at = start
        for k in range(steps):
            angle, stretch = (k + 0.5) * step, 1.0 / cos(0.5 * step)
            c, s = cos(angle) * stretch, sin(angle) * stretch
            to = (corner[0] + c * x - s * y, corner[1] + s * x + c * y)
            yield self.element(at, to)
            at = to
        yield self.element(at, end)


def at_place(element: Element, place: tuple[float, float]) -> Element:
    """An element without motion in the plane, where the tool stands."""
    return replace(
        element,
        start=moved(element.start, element.plane, *place),
        end=moved(element.end, element.plane, *place),
        is_compensated=True,
    )


def is_motion(element: Element) -> bool:
    """Whether anything moves in the plane, full circles included."""
    first, second = element.plane.first, element.plane.second
    dx = element.end[first] - element.start[first]
    dy = element.end[second] - element.start[second]
    return element.centre is not None or dx * dx + dy * dy >= SHORTEST * SHORTEST
