"""The planner: segments in, setpoints out.

    segments -> chains (chains.py) -> courses: path and time law -> overlaps -> setpoints
    (stream.py)

It plans what it may: a chain of one line once the chain is closed, a curved one window by
window. Nothing is given out that could not be brought to rest by what is known.
"""

import math
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import accumulate

from openacr.compiled import pick
from openacr.trajectory import overlap_cy
from openacr.trajectory.arrays import numbers, room
from openacr.trajectory.chains import Chain, corner_jerk
from openacr.trajectory.course import Course, Soft, straight_course
from openacr.trajectory.limits import Limits, TrajectoryError, most
from openacr.trajectory.segments import Piece, Point, Segment
from openacr.trajectory.setpoints import Setpoints
from openacr.trajectory.smooth_course import SmoothCourse, look_ahead
from openacr.trajectory.stream import Member, Stream

PERIOD_S = 0.003
NEARLY = 0.999  # of the jerk on straight lines: what rounding may take
MOST_POINTS = 1024  # of one take
APART = 4.0  # periods between the first and the last of three courses: no difference has both
NEAR = 30.0  # tolerances around a corner within which the deviation of an overlap is examined
_overlap_time = pick(overlap_cy.overlap_time)


class TrajectoryPlanner:
    """Plans a path that comes segment by segment."""

    def __init__(self, start: Point, limits: Limits, period_s: float = PERIOD_S) -> None:
        if len(start) != limits.axes:
            raise TrajectoryError(f"a start with {len(start)} axes and limits of {limits.axes}")
        self.limits, self.period_s = limits, period_s
        self._at = start
        self._chains: deque[Chain] = deque()
        self._stream = Stream(start, period_s)
        self._base_u = 0.0
        self._last: Chain | None = None  # that of the last complete course
        self._growing: SmoothCourse | None = None
        self._is_new = False  # not in the stream yet

    # --- input -------------------------------------------------------------------

    def add(self, segment: Segment) -> None:
        """Append a segment; one without length is passed over."""
        piece = Piece(self._at, segment)
        self._at = segment.end
        if piece.length_u <= 0.0:
            return
        chain = self._chains[-1] if self._chains else None
        if chain is None or chain.is_closed or not chain.takes(piece):
            if chain is not None and not chain.is_closed:
                chain.is_closed = True
                chain.stops = chain.is_rapid or segment.is_rapid
            chain = Chain()
            self._chains.append(chain)
        chain.add(piece)

    def stop(self) -> None:
        """The path known so far ends at rest."""
        if self._chains:
            self._chains[-1].is_closed = True

    # --- output ------------------------------------------------------------------

    def take(self) -> Setpoints | None:
        """Plan, and return the next setpoints; None where nothing is ready."""
        while self._stream.ready() < MOST_POINTS and self._plan_more():
            pass
        return self._stream.take(MOST_POINTS)

    def _plan_more(self) -> bool:
        """Plan one more section; False where more segments are needed."""
        if not self._chains:
            return False
        chain = self._chains[0]
        after = self._chains[1] if len(self._chains) > 1 else None
        if chain.is_closed and not chain.stops and after is None:
            return False
        if self._growing is None:
            if chain.is_straight and not chain.is_closed:
                return False
            if chain.is_straight:
                self._begin(chain, self._straight(chain, after))
                self._finish(chain, after)
                return True
            if not chain.is_closed and chain.length_u < self._look_u(chain.pieces[0]):
                return False
            before = self._before()
            soft = None if before is None else self._soft(before, chain)
            self._growing = SmoothCourse(self.limits, self.period_s, chain.pieces, soft)
            self._is_new = True
        return self._grow(chain, after, self._growing)

    def _grow(self, chain: Chain, after: Chain | None, course: SmoothCourse) -> bool:
        """Plan the next window of a smooth chain."""
        if not self._is_new:
            course.drop(self._stream.next_s - course.begin_s - 8.0 * self.period_s)
        for piece in chain.pieces:
            course.add(piece)
        chain.pieces.clear()
        if chain.is_closed and not course.is_closed:
            course.close(chain.tail[-1], None if chain.stops or after is None
                         else self._soft(chain, after))  # fmt: skip
        if not course.is_closed and chain.length_u < course.wants_u:
            return False
        course.plan()
        if self._is_new:
            self._begin(chain, course)
            self._is_new = False
        if course.is_complete:
            self._growing = None
            self._finish(chain, after)
        return True

    def _look_u(self, piece: Piece) -> float:
        """The length of path that is to be known when a smooth chain begins."""
        feed = piece.segment.feed_ups
        return look_ahead(self.limits.along(piece.tangent(0.0), feed, self.period_s))

    def _before(self) -> Chain | None:
        """The chain that the next one overlaps."""
        return self._last if self._last is not None and not self._last.stops else None

    def _begin(self, chain: Chain, course: Course) -> None:
        """Append a course to the stream."""
        last = self._stream.last
        before = self._before()
        if last is not None and before is not None:
            course.lead_s = self._overlap(before, last.course, chain, course)
            course.begin_s = last.course.end_s - course.lead_s
            last.held_s = 0.0
        else:
            course.begin_s = self._stream.after_rest_s()
        if isinstance(course, SmoothCourse):
            member = Member(course, self._base_u, course.sections.ends, course.sections.lines)
        else:
            offsets = list(accumulate(piece.length_u for piece in chain.pieces))
            member = Member(course, self._base_u, offsets,
                            [piece.segment.line for piece in chain.pieces])  # fmt: skip
        if not chain.stops:
            member.held_s = math.inf
        self._stream.add(member)

    def _finish(self, chain: Chain, after: Chain | None) -> None:
        """The whole course of a chain is in the stream."""
        self._chains.popleft()
        self._base_u += chain.length_u
        self._last = chain
        member = self._stream.last
        if member is not None:
            course = member.course
            member.held_s = 0.0
            if not chain.stops and after is not None:
                member.held_s = min(course.duration_s - course.lead_s, self._longest(chain, after))

    def _straight(self, chain: Chain, after: Chain | None) -> Course:
        """The course of a closed chain that is one straight line."""
        first, last = chain.pieces[0], chain.pieces[-1]
        feed = math.inf if chain.is_rapid else first.segment.feed_ups
        along = self.limits.along(first.tangent(0.0), feed, self.period_s)
        along = replace(along, jerk=NEARLY * along.jerk)
        before = self._before()
        softs = (
            Soft(along.jerk, 0.0) if before is None else self._soft(before, chain),
            Soft(along.jerk, 0.0) if chain.stops or after is None else self._soft(chain, after),
        )
        return straight_course(first.start, last.segment.end, chain.length_u, along, softs)

    def _soft(self, before: Chain, after: Chain) -> Soft:
        """The jerk of two overlapping ends, and for how long it rules."""
        end, start = before.tail[-1], after.head[0]
        u1, u2 = end.tangent(end.length_u), start.tangent(0.0)
        jerk = NEARLY * corner_jerk(self.limits.jerks(self.period_s), u1, u2)
        tolerance = min(end.segment.tolerance_u, start.segment.tolerance_u)
        return Soft(jerk, (48.0 * tolerance / (jerk * math.dist(u1, u2))) ** (1 / 3))

    def _longest(self, before: Chain, after: Chain) -> float:
        """The longest overlap of two chains that can keep the tolerance, about."""
        end, start = before.tail[-1], after.head[0]
        tolerance = min(end.segment.tolerance_u, start.segment.tolerance_u)
        u1, u2 = end.tangent(end.length_u), start.tangent(0.0)
        change = math.dist(u1, u2)
        slow = most(self.limits.acceleration_ups2, [q - p for p, q in zip(u1, u2, strict=True)])
        by_acceleration = math.sqrt(8.0 * tolerance / (slow * change * change))
        return 1.1 * (self._soft(before, after).time_s + by_acceleration)

    def _overlap(self, before: Chain, a: Course, after: Chain, b: Course) -> float:
        """The time by which course b may begin before course a has ended."""
        end, start = before.tail[-1], after.head[0]
        tolerance = min(end.segment.tolerance_u, start.segment.tolerance_u)
        alone_s = a.duration_s - a.lead_s - APART * self.period_s
        longest = max(0.0, min(alone_s, 0.5 * b.duration_s, b.committed_s,
                               self._longest(before, after)))  # fmt: skip
        speed = max(end.segment.feed_ups, start.segment.feed_ups)
        rules = numbers([self.period_s, a.begin_s, 0.999 * tolerance, speed, longest,
                                       *self.limits.checked()])  # fmt: skip
        near = near_corner(before, after, NEAR * tolerance)
        axes = self.limits.axes
        count = int(longest / self.period_s) + 3 * overlap_cy.AROUND
        return _overlap_time(
            a.H, a.C, a.Z, b.H, b.C, b.Z, numbers(near), len(near) // axes - 1,
            rules, room(count * axes), room(4 * axes),
        )  # fmt: skip


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
