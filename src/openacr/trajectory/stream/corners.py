"""Sharp corners: how the chains on both sides of one end and begin (overlap_cy.py).

With the jerks Je of both ends, which add, a corner from u1 to u2 is passed at a distance from its
vertex of s |u2 - u1|, where both are s from it. Ends that swing out (end_law.py) come there with a
higher acceleration. Their jerks have both signs, so that Je is lower,

    Je max_k |u1 + u2|_k <= J     without       Je max_k (|u1| + |u2|)_k <= J     with a swing
"""

import math
from collections.abc import Iterable, Iterator, Sequence

from openacr.trajectory.course.course import Soft
from openacr.trajectory.course.end_law import DEPTH, rest_time, rest_u, turn_s
from openacr.trajectory.path.limits import Along, Limits, most
from openacr.trajectory.path.segments import Piece, Point
from openacr.trajectory.stream.chains import Chain, Corner

NEARLY = 0.999  # of the jerk: what rounding may take
SWING = 0.97  # of the tolerance
TURNED = 0.3  # of the time in which acceleration builds up, for the turn of a swing
PART = 0.45
SPARE = 3.0  # periods
LONGER = 1.1  # than computed: overlaps that are tried
NEAR = 30.0  # tolerances around a corner within which the deviation of an overlap is examined
LEAST_SHARED = 0.5  # of the jerk; else a shorter overlap is quicker
CHORD = 1e-4  # of an arc, for its curvature
AROUND = 5.0  # periods of the overlap that are examined


def corner_between(limits: Limits, period_s: float, before: Chain, after: Chain) -> Corner:
    """The corner between two chains."""
    end, start = before.tail[-1], after.head[0]
    u1, u2 = end.tangent(end.length_u), start.tangent(0.0)
    tolerance = min(end.segment.tolerance_u, start.segment.tolerance_u)
    change = math.dist(u1, u2)
    alongs = [
        limits.along(u, each.feed_ups, period_s, each.tool_ups)
        for u, each in ((u1, end), (u2, start))
    ]
    plain = _softs(_plain_jerk(limits.jerks(period_s), end, start), 0.0, tolerance / change, alongs)
    jerk = NEARLY * most_of(limits.jerks(period_s), _sum(u1, u2), _sum(u1, u2, -1.0))
    most_turn = TURNED * min(limits.acceleration_ups2) / max(limits.jerks(period_s))
    swing = min(SWING * tolerance, DEPTH * jerk * most_turn**3)
    swung = _softs(jerk, swing, tolerance / change, alongs)
    is_swung = (
        most_turn > period_s
        and _has_room(period_s, swung[0], alongs[0], end, before.length_u)
        and _has_room(period_s, swung[1], alongs[1], start, start.length_u)
        and all(
            _is_quicker(one, other, tolerance / change, along)
            for one, other, along in zip(swung, plain, alongs, strict=True)
        )
    )
    softs = swung if is_swung else plain
    slow = most(limits.acceleration_ups2, _sum(u2, u1, -1.0))
    by_acceleration = math.sqrt(8.0 * tolerance / (slow * change * change))
    longest = LONGER * (softs[0].time_s + by_acceleration)
    reach = rest_u(longest + AROUND * period_s, softs[0].swing_u, softs[0].jerk)
    return Corner(*softs, longest, max(LONGER * reach, NEAR * tolerance))


def _plain_jerk(jerks: Sequence[float], end: Piece, start: Piece) -> float:
    """The jerk Je of ends that do not swing out.

    On an arc with the curvature c, s = J t^3/6 has a jerk across the path of 1.5 J^2 t^3 c; that
    is 72 J e c / |u2 - u1| where the overlap begins, and adds to the jerk of the other end.
    """
    u1, u2 = end.tangent(end.length_u), start.tangent(0.0)
    tolerance = min(end.segment.tolerance_u, start.segment.tolerance_u)
    across, both = 72.0 * tolerance / math.dist(u1, u2), _sum(u1, u2)
    leaving = _sum(both, _curvature(end, end.length_u), -across)
    entering = _sum(both, _curvature(start, 0.0), across)
    without = most_of(jerks, u1, u2, both)
    shared = most_of(jerks, u1, u2, both, leaving, entering)
    return NEARLY * (shared if shared > LEAST_SHARED * without else without)


def most_of(limits: Sequence[float], *vectors: Sequence[float]) -> float:
    """The largest multiple of which all vectors are within the limits of all axes."""
    return min(most(limits, vector) for vector in vectors)


def _sum(one: Sequence[float], other: Sequence[float], factor: float = 1.0) -> list[float]:
    return [a + factor * b for a, b in zip(one, other, strict=True)]


def _curvature(piece: Piece, s: float) -> list[float]:
    """The curvature of a piece at one of its ends, as a vector."""
    part = CHORD * piece.length_u
    first, last = piece.tangent(max(0.0, s - part)), piece.tangent(min(piece.length_u, s + part))
    return [bend / part for bend in _sum(last, first, -1.0)]


def _softs(jerk: float, swing_u: float, s: float, alongs: Sequence[Along]) -> tuple[Soft, Soft]:
    """Both ends; they overlap while both are within a distance."""
    time = 2.0 * (float(rest_time(s, swing_u, jerk)) + 2.0 * turn_s(swing_u, jerk))
    end, start = (Soft(jerk, time, swing_u, min(1.0, jerk / along.jerk)) for along in alongs)
    return end, start


def _has_room(period_s: float, swung: Soft, along: Along, piece: Piece, length: float) -> bool:
    """Whether the overlap of a swing takes place on one line, far from the other end."""
    shortest = max(4.0 * math.cbrt(0.5 * length / along.jerk), length / along.speed)
    return (
        piece.is_line
        and swung.reach_u() <= piece.length_u
        and swung.time_s <= PART * shortest - SPARE * period_s
    )


def _is_quicker(swung: Soft, plain: Soft, s: float, along: Along) -> bool:
    """Whether a swing has gained speed at the end of its overlap, which ends before the feed."""
    t1 = turn_s(swung.swing_u, swung.jerk)
    r = float(rest_time(s, swung.swing_u, swung.jerk)) + 0.5 * swung.time_s
    push = min(swung.jerk * r, along.acceleration)
    speed = push * r - 0.5 * push * push / swung.jerk - swung.jerk * t1 * t1
    if speed + 0.5 * push * push / along.jerk > along.speed:
        return False
    t = float(rest_time(s, 0.0, plain.jerk)) + 0.5 * plain.time_s
    later = 0.5 * (swung.time_s - plain.time_s)
    gained = 0.5 * plain.jerk * t * t + (plain.jerk * t + 0.5 * along.jerk * later) * later
    return swung.jerk * (0.5 * r * r - t1 * t1) > gained


def near_corner(before: Chain, after: Chain, reach: float) -> list[float]:
    """The programmed path around a corner as a polyline, point after point."""
    vertex = after.head[0].start
    points = [*_walked(reversed(before.tail), vertex, reach, -1)][::-1]
    points += [vertex, *_walked(after.head, vertex, reach, 1)]
    return [part for point in points for part in point]


def _walked(pieces: Iterable[Piece], start: Point, reach: float, side: int) -> Iterator[Point]:
    """Points of the path from a vertex on, along pieces (`side` 1) or against them (-1)."""
    gone, last = 0.0, start
    for piece in pieces:
        for point in piece.chords(reach / 40.0, side):
            yield point
            gone += math.dist(last, point)
            last = point
            if gone > reach:
                return
