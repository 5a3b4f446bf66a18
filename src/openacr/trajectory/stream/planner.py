"""The planner: segments in, setpoints out.

    segments -> chains (chains.py) -> courses: path and time law -> overlaps -> setpoints
    (stream.py)

It plans what it may: a chain of one line once the chain is closed, a curved one window by
window. Nothing is given out that could not be brought to rest by what is known.
"""

import math
from collections import deque
from dataclasses import replace

from openacr.compiled import pick
from openacr.trajectory.course import overlap_cy
from openacr.trajectory.course.course import Course, Soft, straight_course
from openacr.trajectory.course.faster_line import run_faster
from openacr.trajectory.path.arrays import numbers, room
from openacr.trajectory.path.grain import look_ahead
from openacr.trajectory.path.limits import Along, Limits, TrajectoryError
from openacr.trajectory.path.sections import Sections
from openacr.trajectory.path.segments import Piece, Point, Segment
from openacr.trajectory.path.setpoints import Setpoints
from openacr.trajectory.stream.chains import Chain, Corner
from openacr.trajectory.stream.corners import corner_between, near_corner
from openacr.trajectory.stream.smooth_course import SmoothCourse
from openacr.trajectory.stream.stream import APART, Member, Stream

PERIOD_S = 0.003
NEARLY = 0.999  # of the jerk on straight lines: what rounding may take
MOST_POINTS = 1024  # of one take
FIRST = 3.0  # look-ahead distances of a smooth chain that are known when it begins
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
        self._factor = 1.0  # of the feeds
        self._base_u = 0.0
        self._last: Chain | None = None  # that of the last complete course
        self._growing: SmoothCourse | None = None
        self._is_new = False  # not in the stream yet
        self._fault: TrajectoryError | None = None  # why nothing more is planned

    # --- input -------------------------------------------------------------------

    def add(self, segment: Segment) -> float:
        """Append a segment; one without length is passed over. Returns its length."""
        piece = Piece(self._at, segment)
        piece.factor = self._factor
        self._at = segment.end
        if piece.length_u <= 0.0:
            return 0.0
        chain = self._chains[-1] if self._chains else None
        if chain is None or chain.is_closed or not chain.takes(piece):
            if chain is not None and not chain.is_closed:
                chain.is_closed = True
                chain.stops = chain.is_rapid or segment.is_rapid
            chain = Chain()
            self._chains.append(chain)
        chain.add(piece)
        return piece.length_u

    def stop(self) -> None:
        """The path known so far ends at rest."""
        if self._chains:
            self._chains[-1].is_closed = True

    def override(self, factor: float) -> None:
        """Plan the path with another factor of its feeds, but for what has been taken.

        The course that is being taken is planned again where the factor rises: from there on what
        a higher speed leaves is known to keep the limits.
        """
        if factor == self._factor or self._fault is not None:
            return
        self._factor = factor
        self._drop_untaken()
        for chain in self._chains:
            for piece in chain.pieces:
                piece.factor = factor
        member = self._stream.last
        if member is not None:
            self._hasten(member)

    def _drop_untaken(self) -> None:
        """Drop the courses of which nothing was taken; their chains are planned again."""
        dropped = self._stream.drop_untaken()
        if self._growing is not None and (self._is_new or dropped):
            self._growing, self._is_new = None, False
            self._chains[0].take_back()
        for member in reversed(dropped):
            if not self._chains or member.chain is not self._chains[0]:
                member.chain.take_back()
                self._chains.appendleft(member.chain)
            self._base_u = member.base_u
        if dropped:
            last = self._stream.last
            self._last = None if last is None else last.chain
            self._await_next(last)

    def _hasten(self, member: Member) -> None:
        """Let the last course run faster from where it may change."""
        if min(member.sections.factors) >= self._factor:
            return
        course, since_s = member.course, self._stream.free_s - member.course.begin_s
        if isinstance(course, SmoothCourse):
            chain = member.chain
            ahead_u = sum(piece.length_u for piece in chain.pieces)
            if chain.is_closed and (chain.stops or course.is_closed or len(self._chains) > 1):
                ahead_u = math.inf
            if course.hasten(since_s, self._factor, ahead_u) and self._growing is None:
                self._growing, self._base_u = course, member.base_u
                self._chains.appendleft(chain)
                if not chain.stops:
                    member.held_s = math.inf
            return
        for piece in member.chain.pieces:
            piece.factor = max(piece.factor, self._factor)
        end = self._end_of(member.chain, self._chains[0] if self._chains else None)
        since_u = run_faster(course, since_s, self._along(member.chain), end)
        if since_u is not None:
            member.sections.hasten(since_u, self._factor)
            self._await_next(member)

    # --- output ------------------------------------------------------------------

    def take(self, most: int = MOST_POINTS) -> Setpoints | None:
        """Plan, and return the next setpoints, `most` at most; None where nothing is ready.

        No more is planned than is needed for them. TrajectoryError where the path cannot be
        planned, after all that was planned before.
        """
        try:
            while self._fault is None and self._stream.ready() < most and self._plan_more():
                pass
        except TrajectoryError as error:
            self._fault = error
        if self._fault is not None and not self._stream.ready():
            raise self._fault
        return self._stream.take(most)

    def prepare(self, count: int) -> bool:
        """Plan one more section where fewer than `count` setpoints are ready; whether it has.

        Until they are taken an override plans them again.
        """
        if self._fault is not None or self._stream.ready() >= count:
            return False
        try:
            return self._plan_more()
        except TrajectoryError as error:
            self._fault = error
            return False

    @property
    def ready(self) -> int:
        """The count of setpoints that are planned and not taken."""
        return self._stream.ready()

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
                self._finish(chain)
                return True
            first_u = FIRST * self._look_u(chain.pieces[0])
            if not chain.is_closed and chain.length_u < first_u:
                return False
            before = self._before()
            soft = None if before is None else self._corner(before, chain).start
            known = chain.pieces_within(first_u)
            self._growing = SmoothCourse(self.limits, self.period_s, known, soft)
            self._is_new = True
        return self._grow(chain, after, self._growing)

    def _grow(self, chain: Chain, after: Chain | None, course: SmoothCourse) -> bool:
        """Plan the next window of a smooth chain, of as much of the path as it needs.

        What is known beyond that makes no difference, so that the plan of a program is one and the
        same however its moves arrive.
        """
        if not self._is_new:
            course.drop(self._stream.next_s - course.begin_s - 8.0 * self.period_s)
            if self._stream.taken_s > course.begin_s:
                chain.given.clear()
        wants_u = course.wants_u
        while chain.pieces and course.known_u < wants_u:
            course.add(chain.give())
        if not chain.pieces and not (course.catches_up and course.known_u >= wants_u):
            if not chain.is_closed:  # whether this is its end makes a difference
                return False
            if not course.is_closed:
                course.close(chain.tail[-1], None if chain.stops or after is None
                             else self._corner(chain, after).end)  # fmt: skip
        course.plan()
        if self._is_new:
            self._begin(chain, course)
            self._is_new = False
        if course.is_complete:
            self._growing = None
            self._finish(chain)
        return True

    def _look_u(self, piece: Piece) -> float:
        """The look-ahead distance at the feed of a piece."""
        return look_ahead(self.limits.along(piece.tangent(0.0), piece.feed_ups, self.period_s))

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
            sections = course.sections
        else:
            sections, end_u = Sections(), 0.0
            for piece in chain.pieces:
                end_u += piece.length_u
                sections.add(piece, end_u)
        member = Member(course, self._base_u, chain, sections)
        if not chain.stops:
            member.held_s = math.inf
        self._stream.add(member)

    def _finish(self, chain: Chain) -> None:
        """The whole course of a chain is in the stream."""
        self._chains.popleft()
        self._base_u += chain.length_u
        self._last = chain
        member = self._stream.last
        if member is not None:
            member.held_s = 0.0
            member.rests = chain.stops
            self._await_next(member)

    def _await_next(self, member: Member | None) -> None:
        """Hold back the end of a course that will overlap the next one."""
        if member is None or member.chain.stops or not self._chains:
            return
        course, corner = member.course, self._corner(member.chain, self._chains[0])
        member.held_s = min(course.duration_s - course.lead_s, corner.longest_s)

    def _straight(self, chain: Chain, after: Chain | None) -> Course:
        """The course of a closed chain that is one straight line."""
        first, last = chain.pieces[0], chain.pieces[-1]
        along, before = self._along(chain), self._before()
        start = Soft(along.jerk, 0.0) if before is None else self._corner(before, chain).start
        return straight_course(first.start, last.segment.end, chain.length_u, along,
                               (start, self._end_of(chain, after)))  # fmt: skip

    def _along(self, chain: Chain) -> Along:
        """The limits along a chain that is one straight line."""
        first = chain.pieces[0]
        along = self.limits.along(first.tangent(0.0), first.feed_ups, self.period_s, first.tool_ups)
        return replace(along, jerk=NEARLY * along.jerk)

    def _end_of(self, chain: Chain, after: Chain | None) -> Soft:
        """How a chain that is one straight line ends."""
        if chain.stops or after is None:
            return Soft(self._along(chain).jerk, 0.0)
        return self._corner(chain, after).end

    def _corner(self, before: Chain, after: Chain) -> Corner:
        """The corner between two chains."""
        if after.corner is None:
            after.corner = corner_between(self.limits, self.period_s, before, after)
        return after.corner

    def _overlap(self, before: Chain, a: Course, after: Chain, b: Course) -> float:
        """The time by which course b may begin before course a has ended."""
        end, start, corner = before.tail[-1], after.head[0], self._corner(before, after)
        tolerance = min(end.segment.tolerance_u, start.segment.tolerance_u)
        alone_s = a.duration_s - a.lead_s - APART * self.period_s
        longest = max(0.0, min(alone_s, 0.5 * b.duration_s, b.committed_s, corner.longest_s,
                               a.end_s - self._stream.taken_s))  # fmt: skip
        speed = max(end.feed_ups, start.feed_ups)
        tool = max(end.tool_ups, start.tool_ups)
        near, axes = near_corner(before, after, corner.near_u), self.limits.axes
        rules = (self.period_s, a.begin_s, 0.999 * tolerance, speed, tool, longest,
                 len(near) // axes - 1, *self.limits.checked())  # fmt: skip
        points = overlap_cy.ROOM + int(longest / self.period_s) + 3 * overlap_cy.AROUND
        P = room(len(rules) + len(near) + points * axes)
        begin = overlap_cy.overlap_near(axes)
        P[: len(rules)], P[begin : begin + len(near)] = numbers(rules), numbers(near)
        return _overlap_time(a.H, a.C, a.Z, b.H, b.C, b.Z, P)
