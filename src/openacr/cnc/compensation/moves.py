"""Elements from the rows of a chain: the moves of a piece, and those between pieces."""

from collections.abc import Sequence
from typing import TypeVar

from openacr.cnc.canonical import PLANES, Moves, Pace, Plane, Point, Source
from openacr.cnc.compensation.curve_cy import SHORTEST
from openacr.cnc.compensation.rows import Piece, Table
from openacr.cnc.geometry.elements import Element
from openacr.cnc.rows.chains import EXTRA
from openacr.cnc.rows.moves import ARC, CURVE, INSERTED, POINT, ROW

Held = TypeVar("Held")


def moved(point: Point, plane: Plane, x: float, y: float) -> Point:
    """A point with other coordinates in the plane."""
    if plane is Plane.XY:
        return (x, y, *point[2:])
    values = list(point)
    values[plane.first] = x
    values[plane.second] = y
    return tuple(values)


def element_of(table: Table, k: int, pieces: Sequence[Piece[Held] | None]) -> Element:
    """A move of the tool from the rows that were issued, one piece for each slot."""
    row = table.rows[ROW * k : ROW * (k + 1)]
    piece, paced = pieces[row[4]], pieces[row[2]]
    if piece is None or paced is None:
        raise LookupError(k)
    element, pace = piece.element, paced.element.pace
    is_inserted = row[7] & INSERTED != 0
    end = tuple(table.ends[POINT * k : POINT * (k + 1)].tolist())
    ax, ay, _, cx, cy = table.extra[EXTRA * k : EXTRA * (k + 1)].tolist()
    start = moved(end if is_inserted else element.start, element.plane, ax, ay)
    if row[0] != ARC:
        return tool_element(element.source, element.plane, start, end, pace, None, 0.0, is_inserted)
    sweep = table.arcs[CURVE * k + 2]
    return tool_element(
        element.source, element.plane, start, end, pace, (cx, cy), sweep, is_inserted
    )


def tool_element_at(moves: Moves, k: int, extra: Sequence[float]) -> Element:
    """A move of the tool by itself; axes outside the plane are where it ends."""
    kind, plane = moves.rows[ROW * k], PLANES[moves.rows[ROW * k + 3]]
    x, y, _, cx, cy = extra[EXTRA * k : EXTRA * (k + 1)]
    end = moves.end_of(k)
    start = moved(end, plane, x, y)
    if kind != ARC:
        return tool_element(moves.source_of(k), plane, start, end, None)
    sweep = moves.arcs[CURVE * k + 2]
    return tool_element(moves.source_of(k), plane, start, end, None, (cx, cy), sweep)


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


def tool_element(
    source: Source,
    plane: Plane,
    start: Point,
    end: Point,
    pace: Pace | None,
    centre: tuple[float, float] | None = None,
    sweep_rad: float = 0.0,
    is_inserted: bool = False,
) -> Element:
    """A move of the tool's centre."""
    return Element(source, plane, start, end, pace, centre, sweep_rad, is_inserted, True)
