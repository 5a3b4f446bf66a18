"""Points of arcs, and the chords that take their place where the card has no arc."""

import math
from collections.abc import Iterator

from msgspec.structs import replace

from openacr.cnc.canonical import Arc, Line, Point


def along(arc: Arc, begin: Point, share: float) -> Point:
    """The point of an arc at a share 0..1 of its sweep."""
    first, second = arc.plane.first, arc.plane.second
    start = math.atan2(begin[second] - arc.centre[1], begin[first] - arc.centre[0])
    angle = start + share * arc.sweep_rad
    radius = arc.start_radius + share * (arc.end_radius - arc.start_radius)
    point = [a + share * (b - a) for a, b in zip(begin, arc.end, strict=True)]
    point[first] = arc.centre[0] + radius * math.cos(angle)
    point[second] = arc.centre[1] + radius * math.sin(angle)
    return tuple(point)


def chords(arc: Arc, begin: Point, chord_u: float) -> Iterator[Line]:
    """Straight pieces whose height over the arc stays within the chord tolerance."""
    radius = max(arc.start_radius, arc.end_radius)
    height = min(chord_u, radius)
    pace = replace(arc.pace, tolerance_u=max(arc.pace.tolerance_u - height, 0.0))
    half = math.acos(max(1.0 - height / radius, -1.0))
    count = max(1, math.ceil(abs(arc.sweep_rad) / (2.0 * half)))
    for number in range(1, count + 1):
        end = arc.end if number == count else along(arc, begin, number / count)
        yield Line(arc.source, end, pace, arc.is_inserted, arc.is_compensated)
