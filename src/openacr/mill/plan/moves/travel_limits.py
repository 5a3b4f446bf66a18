"""Soft-limit check of moves before they are sent: end points and extremes of arcs."""

import math
from collections.abc import Iterator, Sequence

from msgspec import Struct

from openacr.cnc.canonical import Arc, Point
from openacr.mill.config.settings import Settings
from openacr.mill.config.tabs import AxisSettings
from openacr.mill.plan.moves.arcs import along
from openacr.mill.plan.moves.encoding import Job, Motion

QUARTER = 0.5 * math.pi


class Excess(Struct, frozen=True):
    """A point beyond a limit: the axis, the point, and the limit it is beyond."""

    axis: AxisSettings
    at_u: float
    limit_u: float

    @property
    def beyond_u(self) -> float:
        """The distance beyond the limit."""
        return abs(self.at_u - self.limit_u)

    def __str__(self) -> str:
        return (
            f"axis {self.axis.name} would go to {self.at_u:.6g},"
            f" {self.beyond_u:.6g} beyond its limit {self.limit_u:g}"
        )


def first_excess(job: Job, settings: Settings) -> Excess | None:
    """The first point of a move beyond a soft limit; limits of un-homed axes do not count."""
    acting = [axis for axis in limited(settings) if settings.is_homed(axis.index)]
    return next(excesses(job, acting), None)


def limited(settings: Settings) -> list[AxisSettings]:
    """The axes whose soft limits are not disabled."""
    return [axis for axis in settings.axes if axis.soft_limits is not None]


def excesses(job: Job, axes: Sequence[AxisSettings]) -> Iterator[Excess]:
    """Every end or extreme point of a move where one of these axes is beyond a soft limit."""
    for point in outermost(job.entry, job.begin):
        for axis in axes:
            if axis.soft_limits is None:
                continue
            excess = _excess(axis, point[axis.index], *axis.soft_limits)
            if excess is not None and point[axis.index] != job.begin[axis.index]:
                yield excess


def _excess(axis: AxisSettings, at_u: float, high_u: float, low_u: float) -> Excess | None:
    if at_u > high_u:
        return Excess(axis, at_u, high_u)
    return Excess(axis, at_u, low_u) if at_u < low_u else None


def unhomed(job: Job, settings: Settings) -> AxisSettings | None:
    """The first axis that moves although it must be homed first; None if there is none."""
    for axis in settings.axes:
        moves = job.begin[axis.index] != job.finish[axis.index]
        if moves and axis.is_home_required and not settings.is_homed(axis.index):
            return axis
    return None


def outermost(entry: Motion, begin: Point) -> Iterator[Point]:
    """The end of a move and, on arcs, every point where an axis of the plane reverses.

    Those are the quarter points of the circle, at whole multiples of 90 degrees.
    """
    yield entry.end
    if not isinstance(entry, Arc):
        return
    first, second = entry.plane.first, entry.plane.second
    start = math.atan2(begin[second] - entry.centre[1], begin[first] - entry.centre[0])
    low, high = sorted((start, start + entry.sweep_rad))
    for quarter in range(math.ceil(low / QUARTER), math.floor(high / QUARTER) + 1):
        yield along(entry, begin, (quarter * QUARTER - start) / entry.sweep_rad)
