"""The stream of setpoints: courses one after the other, added where they overlap.

Of a course that is going to overlap the next one the last `held_s` seconds wait for that. At
most two courses overlap at any time.
"""

import math
from collections import deque
from typing import Any

import numpy as np

from openacr.compiled import pick
from openacr.trajectory.course import course_cy
from openacr.trajectory.course.course import Course
from openacr.trajectory.path.arrays import flat
from openacr.trajectory.path.sections import Sections
from openacr.trajectory.path.segments import Point
from openacr.trajectory.path.setpoints import Reals, Setpoints, Whole
from openacr.trajectory.stream.chains import Chain

_fill = pick(course_cy.course_fill)
_add = pick(course_cy.course_add)
APART = 4.0  # periods between the first and the last of three courses: no difference has both
SAME = 1e-12  # of a period: rounding of a grid time

Sums = tuple[Reals, Whole, Reals, Reals]


class Member:
    """A course in the stream: where its path begins, and what its sections are."""

    __slots__ = ("base_u", "chain", "course", "held_s", "rests", "sections")

    def __init__(self, course: Course, base_u: float, chain: Chain, sections: Sections) -> None:
        self.course, self.base_u, self.chain, self.sections = course, base_u, chain, sections
        self.held_s = 0.0
        self.rests = True  # at its end, before the next course begins


class Stream:
    """Control points at whole multiples of the period, from the courses that are known."""

    def __init__(self, start: Point, period_s: float) -> None:
        self.period_s = period_s
        self._start = np.array(start)
        self._axes = len(start)
        self._members: deque[Member] = deque()
        self._next = 0
        self._gone_s = -math.inf  # when the last course has ended that is not kept any more
        self._line, self._path_u = 0, 0.0

    @property
    def last(self) -> Member | None:
        """The last course that was added."""
        return self._members[-1] if self._members else None

    @property
    def taken_s(self) -> float:
        """The time of the last control point that was taken; before the first one, below 0."""
        return (self._next - 1) * self.period_s

    @property
    def free_s(self) -> float:
        """The time from which the last course may change.

        No difference of control points there has one that was taken, or one of the course before.
        """
        ends = [self._gone_s, *(member.course.end_s for member in list(self._members)[:-1])]
        return max(self.taken_s, max(ends) + APART * self.period_s)

    @property
    def next_s(self) -> float:
        """The time of the next control point."""
        return self._next * self.period_s

    def add(self, member: Member) -> None:
        """Append a course whose beginning in the stream is known."""
        self._members.append(member)

    def drop_untaken(self) -> list[Member]:
        """Remove and return the courses of which nothing was taken."""
        dropped: list[Member] = []
        while self._members and self._members[-1].course.begin_s >= self.taken_s:
            dropped.insert(0, self._members.pop())
        return dropped

    def ready_s(self) -> float:
        """The time up to which control points are final."""
        if not self._members:
            return 0.0
        last = self._members[-1]
        course = last.course
        if course.is_complete:
            return course.end_s - last.held_s
        return course.begin_s + course.committed_s

    def ready(self) -> int:
        """The count of control points that are final and not taken."""
        if not self._members:
            return 0
        last = self._members[-1]
        if last.course.is_complete and last.rests:
            final = self._rest_knot(last.course.end_s) + 1
        else:
            final = math.floor(self.ready_s() / self.period_s) + 1
        return max(0, final - self._next)

    def take(self, most: int) -> Setpoints | None:
        """Remove and return at most `most` final control points."""
        count = min(most, self.ready())
        if count <= 0:
            return None
        points, lines, path_u, factors = self._sums(self._next, count)
        first = self._next
        self._next += count
        while len(self._members) > 1 and self._is_over(*list(self._members)[:2]):
            self._gone_s = self._members.popleft().course.end_s
        rest, _, rest_path, _ = self._rest()
        return Setpoints(
            first, self.period_s, points, lines, path_u, rest, float(rest_path[-1]), factors
        )

    def _is_over(self, member: Member, after: Member) -> bool:
        """Whether all of a course was taken, and some of the next one."""
        return member.course.end_s <= self.next_s and after.course.begin_s < self.taken_s

    def _rest_knot(self, end_s: float) -> int:
        """The third knot at which a course that ends at a time is at rest."""
        return math.ceil(end_s / self.period_s - SAME) + 2

    def after_rest_s(self) -> float:
        """When a course may begin after the last one has come to rest."""
        if not self._members:
            return 0.0
        return self._rest_knot(self._members[-1].course.end_s) * self.period_s

    def _rest(self) -> Sums:
        """The points from the next one on to rest, where no other course follows."""
        end_s = self._members[-1].course.end_s
        count = self._rest_knot(end_s) + 1 - self._next
        return self._sums(self._next, max(count, 3))

    def _sums(self, first: int, count: int) -> Sums:
        """Control points, lines, distances and factors of `count` grid times from `first` on."""
        times: Reals = np.arange(first, first + count, dtype=np.float64) * self.period_s
        points = np.empty((count + 1, self._axes))  # the last row is room
        path_u = np.zeros(count)
        lines, factors = np.zeros(count, dtype=np.int64), np.ones(count)
        writing = -1  # rows from here on are those of the course before
        for member, after in zip(self._members, [*list(self._members)[1:], None], strict=True):
            course = member.course
            begun = int(np.searchsorted(times, course.begin_s))
            stop = count
            if after is not None:
                stop = int(np.searchsorted(times, course.end_s))
            row = max(writing, 0)
            if writing > begun:
                self._call(_add, course, times, begun, writing, points, path_u)
            if stop > row:
                self._call(_fill, course, times, row, stop, points, path_u)
                lines[row:stop], factors[row:stop] = member.sections.marks(path_u[row:stop])
                path_u[row:stop] += member.base_u
            writing = stop
        return points[:-1], lines, path_u, factors

    def _call(
        self, function: Any, course: Course, times: Reals, row: int, stop: int,
        points: Reals, path_u: Reals,
    ) -> None:  # fmt: skip
        """Evaluate a course at the grid times of some rows."""
        function(
            course.H, course.C, course.Z, float(times[row]) - course.begin_s, self.period_s,
            stop - row, flat(points[row : stop + 1].reshape(-1)), flat(path_u[row:stop]),
        )  # fmt: skip
