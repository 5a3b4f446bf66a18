"""Which chains of a drawing lie inside which, and how much room there is between them."""

import math
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from openacr.cnc.dxf.chains import NO_PARENT, Chain
from openacr.cnc.dxf.segments import Point, Segment

CHORD_RAD = math.radians(5.0)
Array = npt.NDArray[np.float64]


def outline(chain: Chain) -> Array:
    """The chain as points; arcs as chords of a few degrees."""
    points = [chain.start]
    for segment in chain.segments:
        points += _points(segment)
    return np.array(points)


def _points(segment: Segment) -> Iterator[Point]:
    if segment.centre is not None:
        (x, y), radius = segment.centre, segment.radius
        begin = math.atan2(segment.start[1] - y, segment.start[0] - x)
        count = math.ceil(abs(segment.sweep_rad) / CHORD_RAD)
        for k in range(1, count):
            angle = begin + segment.sweep_rad * k / count
            yield (x + radius * math.cos(angle), y + radius * math.sin(angle))
    yield segment.end


def parents(chains: Sequence[Chain], outlines: Sequence[Array]) -> list[int]:
    """For every chain the smallest closed one around it, `NO_PARENT` for those outside."""
    areas = np.array([abs(chain.area) if chain.is_closed else 0.0 for chain in chains])
    low = np.array([points.min(axis=0) for points in outlines])
    high = np.array([points.max(axis=0) for points in outlines])
    found = []
    for number, points in enumerate(outlines):
        is_around = (low <= low[number]).all(axis=1) & (high >= high[number]).all(axis=1)
        is_around &= areas > areas[number]
        around = np.flatnonzero(is_around)
        inner = sorted(around.tolist(), key=areas.__getitem__)
        middle = 0.5 * (points[0] + points[1])  # corners may touch the chain around
        found.append(next((k for k in inner if _is_inside(middle, outlines[k])), NO_PARENT))
    return found


def depths(parent: Sequence[int]) -> list[int]:
    """How many chains lie around each: even ones are outlines, odd ones holes."""
    return [sum(1 for _ in _ancestors(number, parent)) for number in range(len(parent))]


def _ancestors(number: int, parent: Sequence[int]) -> Iterator[int]:
    while (number := parent[number]) != NO_PARENT:
        yield number


def _is_inside(point: Array, polygon: Array) -> bool:
    """Whether a ray to the right of the point crosses the polygon an odd number of times."""
    x, y = point
    a, b = polygon[:-1], polygon[1:]
    crosses = (a[:, 1] > y) != (b[:, 1] > y)
    a, b = a[crosses], b[crosses]
    where = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return bool(np.count_nonzero(where > x) % 2)


class Edges:
    """All edges of a drawing, to find the free radius about a place."""

    def __init__(self, outlines: Sequence[Array]) -> None:
        self._outlines = outlines
        self._low = np.array([points.min(axis=0) for points in outlines])
        self._high = np.array([points.max(axis=0) for points in outlines])

    def has_room(self, place: Point, radius: float) -> bool:
        """Whether no edge is nearer to a place than a radius."""
        here = np.array(place)
        off = np.maximum(np.maximum(self._low - here, here - self._high), 0.0)
        near = np.flatnonzero((off * off).sum(axis=1) < radius * radius)
        return all(_distance(here, self._outlines[k]) >= radius for k in near.tolist())


def _distance(here: Array, points: Array) -> float:
    """The distance to the nearest point of an outline."""
    a, along = points[:-1], np.diff(points, axis=0)
    share = ((here - a) * along).sum(axis=1) / np.maximum((along * along).sum(axis=1), 1e-300)
    off = a + np.clip(share, 0.0, 1.0)[:, None] * along - here
    return float(np.sqrt((off * off).sum(axis=1).min()))
