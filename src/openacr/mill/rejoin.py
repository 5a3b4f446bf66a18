r"""The way back to a path that was left: what is left of a move, and how it is joined.

After a stop the machine may have been moved by hand. It comes back on a quarter arc that
touches the path at the point P where it was left:

    side    s = sign(t x (position - P)), the side of the path the tool is on now
    centre  C = P + s r n,  n = t turned by +90 degrees
    start   E = C - r t,    from E the arc turns through 90 degrees into P
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

from openacr.cnc.canonical import Arc, Line, Pace, PathMode, Plane, Point, Rapid, Source
from openacr.mill.encoding import Job, Motion

RIGHT_ANGLE = 0.5 * math.pi
Path = TypeVar("Path", bound=Motion)


def first_of(entry: Path, begin: Point, here: Point) -> Path:
    """A move up to a point on it."""
    if not isinstance(entry, Arc):
        return replace(entry, end=here)
    first, second = entry.plane.first, entry.plane.second
    radius = math.dist((here[first], here[second]), entry.centre)
    return replace(entry, end=here, sweep_rad=_turned(entry, begin, here), end_radius=radius)


def rest_of(entry: Path, begin: Point, here: Point) -> Path:
    """A move from a point on it on."""
    if not isinstance(entry, Arc):
        return entry
    first, second = entry.plane.first, entry.plane.second
    gone = _turned(entry, begin, here)
    radius = math.dist((here[first], here[second]), entry.centre)
    return replace(entry, sweep_rad=entry.sweep_rad - gone, start_radius=radius)


def _turned(arc: Arc, begin: Point, here: Point) -> float:
    """How far an arc has got: the angle between two points, in its direction."""
    first, second = arc.plane.first, arc.plane.second
    angles = [
        math.atan2(point[second] - arc.centre[1], point[first] - arc.centre[0])
        for point in (begin, here)
    ]
    turn = math.copysign(1.0, arc.sweep_rad)
    gone = (turn * (angles[1] - angles[0])) % (2.0 * math.pi)
    if gone > abs(arc.sweep_rad):  # a little in front of the beginning, by rounding
        gone = 0.0 if gone > math.pi + 0.5 * abs(arc.sweep_rad) else abs(arc.sweep_rad)
    return turn * gone


@dataclass(frozen=True, slots=True)
class Place:
    """Where a path was left: the point, the direction there, and the move."""

    point: Point
    tangent: tuple[float, float] | None  # in the plane; None where nothing moved in it
    plane: Plane
    job: Job


def place(job: Job, here: Point) -> Place:
    """The place of a machine that stands at `here` on a move."""
    plane = job.entry.plane if isinstance(job.entry, Arc) else Plane.XY
    return Place(here, _tangent(job, here, plane), plane, job)


def _tangent(job: Job, here: Point, plane: Plane) -> tuple[float, float] | None:
    first, second = plane.first, plane.second
    if isinstance(job.entry, Arc):
        x, y = here[first] - job.entry.centre[0], here[second] - job.entry.centre[1]
        turn = math.copysign(1.0, job.entry.sweep_rad)
        x, y = -turn * y, turn * x
    else:
        x, y = job.finish[first] - job.begin[first], job.finish[second] - job.begin[second]
    length = math.hypot(x, y)
    return (x / length, y / length) if length > 0.0 else None


def lead_in(left: Place, here: Point, radius_u: float) -> Iterator[Motion]:
    """The moves from where the machine stands now to the place where it left the path."""
    plane, source, target = left.plane, left.job.entry.source, left.point
    if left.tangent is None or radius_u <= 0.0 or isinstance(left.job.entry, Rapid):
        yield from straight_back(source, here, target, plane.drill)
        return
    drill = plane.drill
    up = _with(here, drill, max(here[drill], target[drill]))
    yield Rapid(source, up, is_inserted=True)
    (tx, ty), pace = left.tangent, _pace(left.job)
    dx, dy = here[plane.first] - target[plane.first], here[plane.second] - target[plane.second]
    side = -1.0 if tx * dy - ty * dx < 0.0 else 1.0
    centre = (
        target[plane.first] - side * radius_u * ty,
        target[plane.second] + side * radius_u * tx,
    )
    start = _with(target, plane.first, centre[0] - radius_u * tx)
    start = _with(start, plane.second, centre[1] - radius_u * ty)
    yield Rapid(source, _with(start, drill, up[drill]), is_inserted=True)
    yield Line(source, start, pace, is_inserted=True)
    yield Arc(
        source, target, plane, centre, side * RIGHT_ANGLE, radius_u, radius_u, pace,
        is_inserted=True,
    )  # fmt: skip


def straight_back(source: Source, here: Point, target: Point, drill: int) -> Iterator[Rapid]:
    """To a point in rapids: the drill axis up first if it has to, and down last."""
    level = max(here[drill], target[drill])
    yield Rapid(source, _with(here, drill, level), is_inserted=True)
    yield Rapid(source, _with(target, drill, level), is_inserted=True)
    yield Rapid(source, target, is_inserted=True)


def _pace(job: Job) -> Pace:
    if isinstance(job.entry, Rapid):
        return Pace(job.feed_ups * 60.0)
    return replace(job.entry.pace, mode=PathMode.FREE, is_confirmed=False)


def _with(point: Point, axis: int, value: float) -> Point:
    return (*point[:axis], value, *point[axis + 1 :])
