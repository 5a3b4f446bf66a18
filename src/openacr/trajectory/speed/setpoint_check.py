"""How far the setpoints of a course use the limits of its axes."""

import math

import numpy as np

from openacr.compiled import pick
from openacr.trajectory.course import course_cy
from openacr.trajectory.course.course import Course
from openacr.trajectory.path.arrays import flat
from openacr.trajectory.path.limits import Limits
from openacr.trajectory.path.setpoints import Reals

PHASES = 4
_fill = pick(course_cy.course_fill)


def setpoints_by_limits(
    course: Course, limits: Limits, period_s: float, since_s: float | None
) -> Reals:
    """The largest speed, acceleration and jerk of setpoints from a time on, by their limits.

    Where the course begins in the stream is not known before its first window is planned; then
    (`since_s` is None) several phases of the grid are examined.
    """
    if since_s is None:
        starts = [period_s * (phase / PHASES - 4.0) for phase in range(PHASES)]
    else:
        begin = max(since_s - 4.0 * period_s, 0.0)
        grid = math.ceil((course.begin_s + begin) / period_s) * period_s - course.begin_s
        starts = [grid - 4.0 * period_s * (grid < 4.0 * period_s)]
    found: Reals = np.max([_by_limits(course, limits, period_s, at) for at in starts], axis=0)
    return found


def _by_limits(course: Course, limits: Limits, period_s: float, begin_s: float) -> Reals:
    axes = limits.axes
    count = int((course.duration_s - begin_s) / period_s) + 4
    points, gone = np.empty((count, axes)), np.empty(count)
    _fill(course.H, course.C, course.Z, begin_s, period_s, count, flat(points), flat(gone))
    most = np.reshape(limits.checked()[: 3 * axes], (3, axes))
    found, change = np.empty(3), points
    for order, limit in enumerate(most):
        change = np.diff(change, axis=0) / period_s
        found[order] = (np.abs(change).max(axis=0) / limit).max()
    return found
