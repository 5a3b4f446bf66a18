"""A straight course at a higher speed from a moment on, in closed form.

From the distance s, speed v and acceleration a of that moment, three phases of the jerks J, 0, -J
lead to the speed w at an acceleration of 0. With the peak acceleration p,

    w = v + (p^2 - a^2)/(2J) + p^2/(2J)     p = (J (w - v) + a^2/2)^(1/2)

or, where that is above the limit A, p = A for a while. The end is that of the course before, from
the speed w (scurve_cy.py). The length of all this rises with w.
"""

import math

import numpy as np

from openacr.compiled import pick
from openacr.trajectory.course import scurve_cy
from openacr.trajectory.course.course import Course, Soft
from openacr.trajectory.course.course_cy import H_ROWS
from openacr.trajectory.course.end_law import turn_s
from openacr.trajectory.course.law_cy import ROW
from openacr.trajectory.path.arrays import flat, numbers, room
from openacr.trajectory.path.limits import Along
from openacr.trajectory.path.setpoints import Reals

HALVINGS = 50
RAMP = 3  # phases from the present speed to the highest
FAR = 1e9  # units: room for both ramps to any speed
LESS_S = 1e-6  # gained at least

Phases = list[tuple[float, float]]  # durations and jerks
_rest_to_rest = pick(scurve_cy.rest_to_rest)


def run_faster(course: Course, since_s: float, along: Along, end: Soft) -> float | None:
    """Let a straight course run at the limits `along` from a time on; the distance there.

    None where it would not end earlier: then it stays as it is.
    """
    rows = np.array(course.Z).reshape(-1, ROW)[: int(course.H[H_ROWS])]
    done = int(np.searchsorted(rows[:, 0], since_s, side="right"))
    if done == 0 or done == len(rows):
        return None
    now = _at(rows[done - 1], rows[done], since_s)
    phases = _fastest(now, course.planned_u - now[1], along, end)
    if phases is None:
        return None
    law = [*rows[:done], now]
    for time_s, jerk in phases:
        law.append(_after(law[-1], time_s, jerk))
    law[-1][1:] = course.planned_u, 0.0, 0.0
    if law[-1][0] > course.duration_s - LESS_S:
        return None
    course.set_law(flat(np.array(law)), len(law))
    course.committed_s = course.duration_s
    return float(now[1])


def _at(row: Reals, after: Reals, time_s: float) -> Reals:
    """The row of a law at a time between two others, with a constant jerk between them."""
    jerk = (after[3] - row[3]) / (after[0] - row[0]) if after[0] > row[0] else 0.0
    return _after(row, time_s - row[0], jerk)


def _after(row: Reals, time_s: float, jerk: float) -> Reals:
    """The row after some time of a constant jerk."""
    t, s, v, a = row
    s = s + time_s * (v + time_s * (0.5 * a + time_s * jerk / 6.0))
    return np.array([t + time_s, s, v + time_s * (a + 0.5 * jerk * time_s), a + jerk * time_s])


def _fastest(now: Reals, left_u: float, along: Along, end: Soft) -> Phases | None:
    """The quickest phases from a row to rest; None where the length left is too short."""
    _, _, v, a = now
    low, high = v + 0.5 * a * abs(a) / along.jerk, along.speed
    if not 0.0 < low <= high or _length_u(now, _phases(now, low, along, end)) > left_u:
        return None
    if _length_u(now, _phases(now, high, along, end)) > left_u:
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if _length_u(now, _phases(now, middle, along, end)) > left_u:
                high = middle
            else:
                low = middle
        high = low
    phases = _phases(now, high, along, end)
    cruise_s = (left_u - _length_u(now, phases)) / high
    return [*phases[:RAMP], (cruise_s, 0.0), *phases[RAMP:]]


def _phases(now: Reals, w: float, along: Along, end: Soft) -> Phases:
    """The ramp from a row to the speed w, and the one from there to rest."""
    _, _, v, a = now
    peak, hold_s = math.sqrt(max(along.jerk * (w - v) + 0.5 * a * a, 0.0)), 0.0
    if peak > along.acceleration:
        peak = along.acceleration
        hold_s = (w - v - (peak * peak - 0.5 * a * a) / along.jerk) / peak
    times = max(peak - a, 0.0) / along.jerk, max(hold_s, 0.0), peak / along.jerk
    slow = end.at_most(along.jerk)
    rests = along.jerk, 0.0, 0.0, slow.jerk, slow.time_s, turn_s(slow.swing_u, slow.jerk)
    ramps = room(2 * scurve_cy.R_SIZE)
    _rest_to_rest(FAR, w, along.acceleration, along.jerk, numbers(rests), ramps,
                  room(ROW * scurve_cy.MOST_ROWS))  # fmt: skip
    braking = [
        (ramps[scurve_cy.R_SIZE + k], ramps[scurve_cy.R_SIZE + scurve_cy.R_JERKS + k])
        for k in reversed(range(scurve_cy.PHASES))
    ]
    return [*zip(times, (along.jerk, 0.0, -along.jerk), strict=True), *braking]


def _length_u(now: Reals, phases: Phases) -> float:
    """The distance of some phases."""
    row = now
    for time_s, jerk in phases:
        row = _after(row, time_s, jerk)
    return float(row[1] - now[1])
