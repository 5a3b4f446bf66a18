"""Courses: a chain with its path and time law, ready to be evaluated (course_cy.py)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from openacr.compiled import pick
from openacr.trajectory.course import course_cy, scurve_cy
from openacr.trajectory.course.end_law import rest_u, turn_s
from openacr.trajectory.path.arrays import flat, numbers, room
from openacr.trajectory.path.limits import Along
from openacr.trajectory.path.segments import Point
from openacr.trajectory.path.setpoints import Reals
from openacr.views import F64

_rest_to_rest = pick(scurve_cy.rest_to_rest)


@dataclass(frozen=True, slots=True)
class Soft:
    """The start or end of a chain that overlaps another: its jerk for the first seconds.

    It swings out by `swing_u` first (end_law.py).
    """

    jerk: float
    time_s: float
    swing_u: float = 0.0
    share: float = 1.0  # of the jerk that its axes allow along the path

    def reach_u(self) -> float:
        """The distance from rest up to which the jerk rules."""
        return rest_u(self.time_s, self.swing_u, self.jerk)

    def at_most(self, jerk: float) -> "Soft":
        """The same with no more than a jerk."""
        return self if self.jerk <= jerk else replace(self, jerk=jerk)


class Course:
    """Tables of one course; `H`, `C` and `Z` are what the compiled functions take."""

    __slots__ = ("C", "H", "Z", "begin_s", "committed_s", "is_complete", "lead_s")

    def __init__(self, start: Point, end: Point, length_u: float) -> None:
        axes = len(start)
        self.H = room(course_cy.H_START + 2 * axes)
        self.H[course_cy.H_AXES] = axes
        self.H[course_cy.H_LENGTH] = length_u
        for k in range(axes):
            self.H[course_cy.H_START + k] = start[k]
            self.H[course_cy.H_START + axes + k] = end[k]
        self.Z = room(4)
        self.begin_s = 0.0  # of the stream
        self.lead_s = 0.0  # overlap with the course before
        self.committed_s = 0.0  # the law up to here is final
        self.is_complete = False

    def set_path(self, points: Reals, step: float, origin: float) -> None:
        """Take control points of the path."""
        self.C = flat(np.ascontiguousarray(points).reshape(-1))
        self.H[course_cy.H_POINTS] = len(points)
        self.H[course_cy.H_STEP] = step
        self.H[course_cy.H_ORIGIN] = origin

    def set_law(self, rows: F64, count: int) -> None:
        """Take `count` rows of a time law."""
        self.Z = rows
        self.H[course_cy.H_ROWS] = count

    @property
    def duration_s(self) -> float:
        """The time of the last row of the law."""
        return self.Z[4 * (int(self.H[course_cy.H_ROWS]) - 1)]

    @property
    def planned_u(self) -> float:
        """The distance of the last row of the law."""
        return self.Z[4 * (int(self.H[course_cy.H_ROWS]) - 1) + 1]

    @property
    def end_s(self) -> float:
        """When the course ends in the stream, as planned now."""
        return self.begin_s + self.duration_s


def straight_course(
    start: Point, end: Point, length_u: float, along: Along, softs: Sequence[Soft]
) -> Course:
    """The course of a straight line from rest to rest."""
    course = Course(start, end, length_u)
    one, other = np.array(start), np.array(end)
    step = other - one
    course.set_path(np.stack([one - step, one, other, other + step]), length_u, 0.0)
    rows = room(4 * scurve_cy.MOST_ROWS)
    ends: list[float] = []
    for soft in softs:
        slow = soft.at_most(along.jerk)
        ends += [slow.jerk, slow.time_s, turn_s(slow.swing_u, slow.jerk)]
    count = _rest_to_rest(length_u, along.speed, along.acceleration, along.jerk,
                          numbers(ends), room(2 * scurve_cy.R_SIZE), rows)  # fmt: skip
    course.set_law(rows, count)
    course.committed_s = course.duration_s
    course.is_complete = True
    return course
