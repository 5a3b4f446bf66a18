"""Lengths, counts and extents of moves, added up over arrays.

    line   sqrt(sum of d^2) of the linear axes
    arc    sqrt((r sweep)^2 + rise^2), r the mean radius; it reaches farthest at its end and where
           an axis of the plane reverses: at whole multiples of a quarter turn

An axis has extents from its first move on; its place before belongs to them if that move cuts.

`V` (doubles): results, and the present point. `N`: counts and masks of axes.
"""

from openacr.cmath import atan2, ceil, cos, fabs, floor, sin, sqrt
from openacr.cnc.geometry.arc_cy import plane_first, plane_second
from openacr.views import F64, I32

__all__ = ["survey_moves"]

AXES = 8
V_LOW = 0
V_HIGH = 8
V_AT = 16
V_RAPID = 24  # lengths
V_FEED = 25
V_SIZE = 26

N_RAPID = 0  # counts
N_FEED = 1
N_ARC = 2
N_AXES = 3  # masks: of the machine
N_LINEAR = 4
N_UNPLACED = 5  # did not move yet
N_SIZE = 6

RAPID = 0
ARC = 2
ROW = 8
CURVE = 5
QUARTER = 1.5707963267948966


def survey_reach(V: F64, N: I32, axis: int, at: float) -> None:
    """An axis goes to a position."""
    if N[N_UNPLACED] & (1 << axis):
        return
    if at < V[V_LOW + axis]:
        V[V_LOW + axis] = at
    if at > V[V_HIGH + axis]:
        V[V_HIGH + axis] = at


def survey_place(V: F64, N: I32, ends: F64, at: int, cuts: bool) -> None:
    """Axes that move for the first time have extents from now on."""
    for axis in range(AXES):
        if N[N_UNPLACED] & (1 << axis) and ends[at + axis] != V[V_AT + axis]:
            N[N_UNPLACED] = N[N_UNPLACED] - (1 << axis)
            if cuts:
                survey_reach(V, N, axis, V[V_AT + axis])


def survey_line(V: F64, N: I32, ends: F64, at: int, is_rapid: bool) -> None:
    """Add a straight move; its end is reached later."""
    square: float = 0.0
    for axis in range(AXES):
        if N[N_LINEAR] & (1 << axis):
            part: float = ends[at + axis] - V[V_AT + axis]
            square += part * part
    if is_rapid:
        N[N_RAPID] = N[N_RAPID] + 1
        V[V_RAPID] = V[V_RAPID] + sqrt(square)
    else:
        N[N_FEED] = N[N_FEED] + 1
        V[V_FEED] = V[V_FEED] + sqrt(square)
    survey_place(V, N, ends, at, not is_rapid)


def survey_quarters(
    V: F64, N: I32, ends: F64, at: int, arcs: F64, a: int, first: int, second: int
) -> None:
    """Reach the points of an arc where an axis of its plane reverses."""
    begin: float = atan2(V[V_AT + second] - arcs[a + 1], V[V_AT + first] - arcs[a])
    end: float = begin + arcs[a + 2]
    low: float = begin if begin < end else end
    high: float = end if begin < end else begin
    quarter: int = int(ceil(low / QUARTER))
    last: int = int(floor(high / QUARTER))
    while quarter <= last:
        angle: float = quarter * QUARTER
        share: float = (angle - begin) / arcs[a + 2]
        radius: float = arcs[a + 3] + (arcs[a + 4] - arcs[a + 3]) * share
        for axis in range(AXES):
            if N[N_AXES] & (1 << axis):
                to: float = V[V_AT + axis] + (ends[at + axis] - V[V_AT + axis]) * share
                if axis == first:
                    to = arcs[a] + radius * cos(angle)
                elif axis == second:
                    to = arcs[a + 1] + radius * sin(angle)
                survey_reach(V, N, axis, to)
        quarter += 1


def survey_arc(V: F64, N: I32, plane: int, ends: F64, at: int, arcs: F64, a: int) -> None:
    """Add an arc; its end is reached later."""
    first: int = plane_first(plane)
    second: int = plane_second(plane)
    length: float = 0.5 * (arcs[a + 3] + arcs[a + 4]) * fabs(arcs[a + 2])
    rise: float = 0.0
    for axis in range(AXES):
        if N[N_LINEAR] & (1 << axis) and axis != first and axis != second:
            part: float = ends[at + axis] - V[V_AT + axis]
            rise += part * part
    N[N_ARC] = N[N_ARC] + 1
    V[V_FEED] = V[V_FEED] + sqrt(length * length + rise)
    N[N_UNPLACED] = N[N_UNPLACED] & ~((1 << first) | (1 << second))
    survey_reach(V, N, first, V[V_AT + first])
    survey_reach(V, N, second, V[V_AT + second])
    survey_place(V, N, ends, at, True)
    survey_quarters(V, N, ends, at, arcs, a, first, second)


def survey_moves(V: F64, N: I32, rows: I32, ends: F64, arcs: F64, count: int) -> None:
    """Add moves from the present point on."""
    for k in range(count):
        kind: int = rows[k * ROW]
        at: int = k * AXES
        if kind == ARC:
            survey_arc(V, N, rows[k * ROW + 3], ends, at, arcs, k * CURVE)
        else:
            survey_line(V, N, ends, at, kind == RAPID)
        for axis in range(AXES):
            if N[N_AXES] & (1 << axis):
                survey_reach(V, N, axis, ends[at + axis])
            V[V_AT + axis] = ends[at + axis]
