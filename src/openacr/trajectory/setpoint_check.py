"""Whether the setpoints of a course are within the limits of its axes."""

import math

import numpy as np

from openacr.compiled import pick
from openacr.trajectory import course_cy
from openacr.trajectory.arrays import flat
from openacr.trajectory.course import Course
from openacr.trajectory.limits import Limits

PHASES = 4
_fill = pick(course_cy.course_fill)


def setpoints_keep_limits(
    course: Course, limits: Limits, period_s: float, since_s: float | None
) -> bool:
    """Whether setpoints from a time of the course on keep the limits of acceleration and jerk.

    Where the course begins in the stream is not known before its first window is planned; then
    (`since_s` is None) several phases of the grid are examined.
    """
    if since_s is None:
        starts = [period_s * (phase / PHASES - 4.0) for phase in range(PHASES)]
    else:
        begin = max(since_s - 4.0 * period_s, 0.0)
        grid = math.ceil((course.begin_s + begin) / period_s) * period_s - course.begin_s
        starts = [grid - 4.0 * period_s * (grid < 4.0 * period_s)]
    return all(_keeps_limits(course, limits, period_s, start) for start in starts)


def _keeps_limits(course: Course, limits: Limits, period_s: float, begin_s: float) -> bool:
    axes = limits.axes
    count = int((course.duration_s - begin_s) / period_s) + 4
    points, gone = np.empty((count, axes)), np.empty(count)
    _fill(course.H, course.C, course.Z, begin_s, period_s, count, flat(points), flat(gone))
    push = np.abs(np.diff(points, n=2, axis=0)).max(axis=0) / period_s**2
    jerk = np.abs(np.diff(points, n=3, axis=0)).max(axis=0) / period_s**3
    most = np.array(limits.checked())
    return bool((push <= most[axes : 2 * axes]).all() and (jerk <= most[2 * axes : 3 * axes]).all())
