"""Lengths, counts and extents of moves, added up over arrays.

    line   sqrt(sum of d^2) of the linear axes
    arc    sqrt((r sweep)^2 + rise^2), r the mean radius; it reaches farthest at its end and where
           an axis of the plane reverses: at whole multiples of a quarter turn

An axis has extents from its first move on; its place before belongs to them if that move cuts.

`F` and `I` are the memory of what is added up (`rows/surveys.py`).
"""

from openacr.cmath import atan2, ceil, cos, fabs, floor, sin, sqrt
from openacr.cnc.geometry.arc_cy import plane_first, plane_second
from openacr.cnc.rows import moves, surveys
from openacr.views import F64, I32

__all__ = ["survey_moves"]

QUARTER = 1.5707963267948966


def survey_reach(F: F64, I: I32, axis: int, at: float) -> None:
    """An axis goes to a position."""
    if I[surveys.unplaced_axes] & (1 << axis):
        return
    if at < F[surveys.low_u[axis]]:
        F[surveys.low_u[axis]] = at
    if at > F[surveys.high_u[axis]]:
        F[surveys.high_u[axis]] = at


def survey_place(F: F64, I: I32, ends: F64, at: int, cuts: bool) -> None:
    """Axes that move for the first time have extents from now on."""
    for axis in range(moves.AXES):
        if I[surveys.unplaced_axes] & (1 << axis) and ends[at + axis] != F[surveys.at_u[axis]]:
            I[surveys.unplaced_axes] = I[surveys.unplaced_axes] - (1 << axis)
            if cuts:
                survey_reach(F, I, axis, F[surveys.at_u[axis]])


def survey_line(F: F64, I: I32, ends: F64, at: int, is_rapid: bool) -> None:
    """Add a straight move; its end is reached later."""
    square: float = 0.0
    for axis in range(moves.AXES):
        if I[surveys.linear_axes] & (1 << axis):
            part: float = ends[at + axis] - F[surveys.at_u[axis]]
            square += part * part
    if is_rapid:
        I[surveys.rapid_cnt] += 1
        F[surveys.rapid_u] = F[surveys.rapid_u] + sqrt(square)
    else:
        I[surveys.feed_cnt] += 1
        F[surveys.feed_u] = F[surveys.feed_u] + sqrt(square)
    survey_place(F, I, ends, at, not is_rapid)


def survey_quarters(
    F: F64, I: I32, ends: F64, at: int, arcs: F64, a: int, first: int, second: int
) -> None:
    """Reach the points of an arc where an axis of its plane reverses."""
    begin: float = atan2(F[surveys.at_u[second]] - arcs[a + 1], F[surveys.at_u[first]] - arcs[a])
    end: float = begin + arcs[a + 2]
    low: float = begin if begin < end else end
    high: float = end if begin < end else begin
    quarter: int = int(ceil(low / QUARTER))
    last: int = int(floor(high / QUARTER))
    while quarter <= last:
        angle: float = quarter * QUARTER
        share: float = (angle - begin) / arcs[a + 2]
        radius: float = arcs[a + 3] + (arcs[a + 4] - arcs[a + 3]) * share
        for axis in range(moves.AXES):
            if I[surveys.axes] & (1 << axis):
                start: float = F[surveys.at_u[axis]]
                to: float = start + (ends[at + axis] - start) * share
                if axis == first:
                    to = arcs[a] + radius * cos(angle)
                elif axis == second:
                    to = arcs[a + 1] + radius * sin(angle)
                survey_reach(F, I, axis, to)
        quarter += 1


def survey_arc(F: F64, I: I32, plane: int, ends: F64, at: int, arcs: F64, a: int) -> None:
    """Add an arc; its end is reached later."""
    first: int = plane_first(plane)
    second: int = plane_second(plane)
    length: float = 0.5 * (arcs[a + 3] + arcs[a + 4]) * fabs(arcs[a + 2])
    rise: float = 0.0
    for axis in range(moves.AXES):
        if I[surveys.linear_axes] & (1 << axis) and axis != first and axis != second:
            part: float = ends[at + axis] - F[surveys.at_u[axis]]
            rise += part * part
    I[surveys.arc_cnt] += 1
    F[surveys.feed_u] = F[surveys.feed_u] + sqrt(length * length + rise)
    I[surveys.unplaced_axes] = I[surveys.unplaced_axes] & ~((1 << first) | (1 << second))
    survey_reach(F, I, first, F[surveys.at_u[first]])
    survey_reach(F, I, second, F[surveys.at_u[second]])
    survey_place(F, I, ends, at, True)
    survey_quarters(F, I, ends, at, arcs, a, first, second)


def survey_moves(F: F64, I: I32, rows: I32, ends: F64, arcs: F64, count: int) -> None:
    """Add moves from the present point on."""
    for k in range(count):
        kind: int = rows[k * moves.ROW]
        at: int = k * moves.AXES
        if kind == moves.ARC:
            survey_arc(F, I, rows[k * moves.ROW + 3], ends, at, arcs, k * moves.CURVE)
        else:
            survey_line(F, I, ends, at, kind == moves.RAPID)
        for axis in range(moves.AXES):
            if I[surveys.axes] & (1 << axis):
                survey_reach(F, I, axis, ends[at + axis])
            F[surveys.at_u[axis]] = ends[at + axis]
