r"""Return to a path that was left: the rest of a move, and the moves that rejoin it.

After a stop the machine may have been moved by hand. A tool that was only raised goes
straight down where it left the path, at the point P. One that was moved off the path first
goes up to a clear level, across, and down at feed. Where cutter radius compensation gives the
side of the path that is free of the part (+1 left, -1 right), it goes down on that side and
joins the path on a quarter arc tangent at P:

    centre  C = P + s r n,  s = side, n = t turned by +90 degrees
    start   E = C - r t,    from E the arc turns through 90 degrees into P

Otherwise it goes down at P itself: no other place is known to be free.
"""

import math
from collections.abc import Iterator, Sequence
from typing import TypeVar

from msgspec import Struct
from msgspec.structs import replace

from openacr.cnc.canonical import (
    TOOL_AXIS,
    Arc,
    Line,
    Pace,
    PathMode,
    Plane,
    Point,
    Rapid,
    Source,
)
from openacr.mill.plan.moves.encoding import Job, Motion

RIGHT_ANGLE = 0.5 * math.pi
Path = TypeVar("Path", bound=Motion)


def first_of(entry: Path, begin: Point, here: Point) -> Path:
    """The part of a move before a point on it."""
    if not isinstance(entry, Arc):
        return replace(entry, end=here)
    first, second = entry.plane.first, entry.plane.second
    radius = math.dist((here[first], here[second]), entry.centre)
    return replace(entry, end=here, sweep_rad=_turned(entry, begin, here), end_radius=radius)


def rest_of(entry: Path, begin: Point, here: Point) -> Path:
    """The part of a move after a point on it."""
    if not isinstance(entry, Arc):
        return entry
    first, second = entry.plane.first, entry.plane.second
    turned = _turned(entry, begin, here)
    radius = math.dist((here[first], here[second]), entry.centre)
    return replace(entry, sweep_rad=entry.sweep_rad - turned, start_radius=radius)


def _turned(arc: Arc, begin: Point, here: Point) -> float:
    """The angle between two points of an arc, in its direction."""
    first, second = arc.plane.first, arc.plane.second
    angles = [
        math.atan2(point[second] - arc.centre[1], point[first] - arc.centre[0])
        for point in (begin, here)
    ]
    turn = math.copysign(1.0, arc.sweep_rad)
    turned = (turn * (angles[1] - angles[0])) % (2.0 * math.pi)
    if turned > abs(arc.sweep_rad):  # slightly before the beginning, by rounding
        turned = 0.0 if turned > math.pi + 0.5 * abs(arc.sweep_rad) else abs(arc.sweep_rad)
    return turn * turned


def apart_u(entry: Motion, begin: Point, here: Point, weights: Sequence[float]) -> float:
    """The distance of a point from a move; `weights` are lengths of a unit of each axis."""
    end = entry.end
    if isinstance(entry, Arc):
        share = _turned(entry, begin, here) / entry.sweep_rad
    else:
        along = _vector(begin, end, weights)
        square = sum(part * part for part in along)
        gone = sum(h * part for h, part in zip(_vector(begin, here, weights), along, strict=True))
        share = min(max(gone / square, 0.0), 1.0) if square > 0.0 else 0.0
    nearest = [a + (b - a) * share for a, b in zip(begin, end, strict=True)]
    if isinstance(entry, Arc):
        first, second = entry.plane.first, entry.plane.second
        start = math.atan2(begin[second] - entry.centre[1], begin[first] - entry.centre[0])
        radius = entry.start_radius + (entry.end_radius - entry.start_radius) * share
        angle = start + entry.sweep_rad * share
        nearest[first] = entry.centre[0] + radius * math.cos(angle)
        nearest[second] = entry.centre[1] + radius * math.sin(angle)
    return math.hypot(*_vector(nearest, here, weights))


def _vector(begin: Sequence[float], end: Sequence[float], weights: Sequence[float]) -> list[float]:
    """The vector from one point to another, as lengths."""
    return [(b - a) * weight for a, b, weight in zip(begin, end, weights, strict=True)]


class Place(Struct, frozen=True):
    """Where a path was left: the point, the direction in XY, and the move."""

    point: Point
    tangent: tuple[float, float] | None  # None where nothing moved in XY
    job: Job


def place(job: Job, here: Point) -> Place:
    """The place of a machine that is at `here` on a move."""
    return Place(here, _tangent(job, here), job)


def _tangent(job: Job, here: Point) -> tuple[float, float] | None:
    first, second = Plane.XY.first, Plane.XY.second
    if isinstance(job.entry, Arc) and job.entry.plane is Plane.XY:
        x, y = here[first] - job.entry.centre[0], here[second] - job.entry.centre[1]
        turn = math.copysign(1.0, job.entry.sweep_rad)
        x, y = -turn * y, turn * x
    else:
        x, y = job.finish[first] - job.begin[first], job.finish[second] - job.begin[second]
    length = math.hypot(x, y)
    return (x / length, y / length) if length > 0.0 else None


def lead_in(left: Place, here: Point, level_u: float, radius_u: float) -> Iterator[Motion]:
    """The moves from the present position to the place where the path was left.

    `level_u` is a clear level above both; a `radius_u` of 0 means no arc.
    """
    source, target, pace = left.job.entry.source, left.point, pace_of(left.job)
    if pace is None or pace.side == 0 or left.tangent is None or radius_u <= 0.0:
        yield from straight_back(source, here, target, level_u, pace)
        return
    (tx, ty), side = left.tangent, float(pace.side)
    first, second = Plane.XY.first, Plane.XY.second
    centre = (target[first] - side * radius_u * ty, target[second] + side * radius_u * tx)
    start = _with(target, first, centre[0] - radius_u * tx)
    start = _with(start, second, centre[1] - radius_u * ty)
    yield from straight_back(source, here, start, level_u, pace)
    yield Arc(
        source, target, Plane.XY, centre, side * RIGHT_ANGLE, radius_u, radius_u, pace,
        is_inserted=True,
    )  # fmt: skip


def straight_back(
    source: Source, here: Point, target: Point, level_u: float, pace: Pace | None
) -> Iterator[Rapid | Line]:
    """Moves up to a level, across, and down to a point: rapids, the last one at `pace` if given."""
    yield Rapid(source, _with(here, TOOL_AXIS, level_u), is_inserted=True)
    yield Rapid(source, _with(target, TOOL_AXIS, level_u), is_inserted=True)
    if pace is None:
        yield Rapid(source, target, is_inserted=True)
    else:
        yield Line(source, target, pace, is_inserted=True)


def pace_of(job: Job) -> Pace | None:
    """The pace for going down to a move: its feed, None for a rapid."""
    if isinstance(job.entry, Rapid):
        return None
    return replace(job.entry.pace, mode=PathMode.FREE, is_confirmed=False)


def _with(point: Point, axis: int, value: float) -> Point:
    return (*point[:axis], value, *point[axis + 1 :])
