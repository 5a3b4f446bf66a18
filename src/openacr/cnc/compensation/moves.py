"""Elements from the rows of a chain: the moves of a piece, and those between pieces."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil, cos, pi, sin

from openacr.cnc.canonical import Pace, Plane, Point
from openacr.cnc.compensation.curve_cy import (
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    FITS,
    ROLL,
    SHORTEST,
    X1,
    Y1,
)
from openacr.cnc.compensation.drafts import tool_element
from openacr.cnc.compensation.join_cy import CROSSING, FORCED, JOINED, ROUND
from openacr.cnc.compensation.rows import Piece
from openacr.cnc.geometry.elements import Element
from openacr.views import F64

Place = tuple[float, float]

RAPID_STEP_RAD = pi / 3.0  # of a corner that is rounded at rapid speed


def moved(point: Point, plane: Plane, x: float, y: float) -> Point:
    """A point with other coordinates in the plane."""
    if plane is Plane.XY:
        return (x, y, *point[2:])
    values = list(point)
    values[plane.first] = x
    values[plane.second] = y
    return tuple(values)


def tool_move(F: F64, piece: Piece[object]) -> Element | None:
    """The move of the tool beside an element; None if nothing is left of it."""
    element, row = piece.element, piece.row
    plane = element.plane
    ax, ay, bx, by, sweep = F[row + AX : row + ROLL].tolist()
    if plane is Plane.XY:
        start, end = (ax, ay, *element.start[2:]), (bx, by, *element.end[2:])
    else:
        start, end = moved(element.start, plane, ax, ay), moved(element.end, plane, bx, by)
    pace, source = element.pace, element.source
    if sweep != 0.0 and piece.fits == FITS:
        centre = (F[row + CX], F[row + CY])
        return tool_element(source, plane, start, end, pace, centre, sweep)
    if piece.fits != FITS or piece.is_lead_in:
        is_short = abs(bx - ax) < SHORTEST and abs(by - ay) < SHORTEST
        if is_short and start == moved(end, plane, ax, ay):
            return None
    return tool_element(source, plane, start, end, pace)


def inserted(
    F: F64, piece: Piece[object], following: Piece[object], meets: int
) -> Sequence[Element]:
    """The moves between the end of a piece and the start of the next one."""
    if meets in (JOINED, CROSSING, FORCED):
        return ()
    i, j = piece.row, following.row
    start, end = (F[i + BX], F[i + BY]), (F[j + AX], F[j + AY])
    pace = following.element.pace or piece.element.pace
    if meets != ROUND:
        return (_between(following.element, pace, start, end),)
    corner, sweep = (F[i + X1], F[i + Y1]), F[i + ROLL]
    if pace is None:
        places = [*_around(start, corner, sweep), end]
        return [_between(following.element, None, a, b) for a, b in pairwise([start, *places])]
    return (_between(following.element, pace, start, end, corner, sweep),)


def _between(
    element: Element,
    pace: Pace | None,
    start: Place,
    end: Place,
    centre: Place | None = None,
    sweep: float = 0.0,
) -> Element:
    """An inserted move; axes outside the plane stay where the next element starts."""
    plane, point = element.plane, element.start
    first, last = moved(point, plane, *start), moved(point, plane, *end)
    return tool_element(element.source, plane, first, last, pace, centre, sweep, True)


def _around(start: Place, corner: Place, sweep: float) -> Iterator[Place]:
    """Corners of tangents around an arc, for rapid moves: they never come nearer."""
    steps = max(1, ceil(abs(sweep) / RAPID_STEP_RAD))
    step = sweep / steps
    x, y = start[0] - corner[0], start[1] - corner[1]
    factor = 1.0 / cos(0.5 * step)
    for k in range(steps):
        c, s = cos((k + 0.5) * step) * factor, sin((k + 0.5) * step) * factor
        yield corner[0] + c * x - s * y, corner[1] + s * x + c * y


def at_place(element: Element, place: tuple[float, float]) -> Element | None:
    """An element without motion in the plane, at the tool's position; None if nothing moves."""
    start, end = (
        moved(element.start, element.plane, *place),
        moved(element.end, element.plane, *place),
    )
    if start == end:
        return None
    return tool_element(element.source, element.plane, start, end, element.pace)


def is_motion(element: Element) -> bool:
    """Whether anything moves in the plane, full circles included."""
    first, second = element.plane.first, element.plane.second
    dx = element.end[first] - element.start[first]
    dy = element.end[second] - element.start[second]
    return element.centre is not None or dx * dx + dy * dy >= SHORTEST * SHORTEST
