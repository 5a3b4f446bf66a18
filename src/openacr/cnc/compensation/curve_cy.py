"""One element of a chain as a row of numbers: the contour, and where the tool runs beside it.

A row begins at an index `i` of an array; its columns are the constants below. Everything
is in the plane. With the unit tangent t and its left normal n = (-ty, tx), a tool at the
signed distance d (left positive) from a point P of the contour stands at P + d n:

    line   the same line, shifted by d n
    arc    the same centre, radius R' = R - d (counter-clockwise) or R + d (clockwise)

so that the distance never changes the form of an element, only its ends.
"""

from openacr.cmath import atan2, fabs, rint, sqrt
from openacr.views import F64

__all__ = ["comp_fit", "comp_lay", "comp_place", "comp_range"]

X0 = 0  # the contour: start,
Y0 = 1
X1 = 2  # end,
Y1 = 3
CX = 4  # centre of an arc,
CY = 5
RADIUS = 6  # its radius, 0 for a line,
SWEEP = 7  # its sweep, + counter-clockwise, 0 for a line,
T0X = 8  # unit tangent at the start
T0Y = 9
T1X = 10  # and at the end
T1Y = 11
AWAY = 12  # the tool: its signed distance from the contour, left positive,
TOOL_RADIUS = 13  # the radius R' of its arc,
AX = 14  # start
AY = 15
BX = 16  # and end of its move,
BY = 17
TOOL_SWEEP = 18  # the sweep of its arc
ROLL = 19  # the sweep about the corner after it
START = 20  # the element: where it starts,
END = 28  # and where it ends, 8 axes

PI = 3.141592653589793
SHORTEST = 1.0e-6  # what moves less in the plane is no element
LEAST_SLACK = 1.0e-9

# what comp_lay found
NOTHING = 0
PLAIN = 1
UNEQUAL = 2  # start and end of an arc have different radii
SMALL = 4  # the tool does not fit into an arc; UNEQUAL may be added

# what comp_fit found
FITS = 0
EMPTY = 1
GOUGES = 2


def comp_lay(F: F64, i: int, away: float, epsilon: float, sweep_epsilon: float) -> int:
    """Lay out the line between two points, or with a sweep an arc, and the tool beside it.

    Returns what was found.
    """
    found: int = _comp_curve(F, i, epsilon, sweep_epsilon)
    if found != NOTHING and not comp_place(F, i, away):
        return SMALL + UNEQUAL if found == UNEQUAL else SMALL
    return found


def _comp_curve(F: F64, i: int, epsilon: float, sweep_epsilon: float) -> int:
    """The contour; an arc of less than the sweep epsilon is the line between its ends."""
    if F[i + SWEEP] != 0.0 and fabs(F[i + SWEEP]) >= sweep_epsilon:
        return _comp_arc(F, i, epsilon, sweep_epsilon)
    dx: float = F[i + X1] - F[i + X0]
    dy: float = F[i + Y1] - F[i + Y0]
    length: float = sqrt(dx * dx + dy * dy)
    if length < SHORTEST:
        return NOTHING
    F[i + RADIUS] = 0.0
    F[i + SWEEP] = 0.0
    F[i + T0X] = dx / length
    F[i + T0Y] = dy / length
    F[i + T1X] = F[i + T0X]
    F[i + T1Y] = F[i + T0Y]
    return PLAIN


def _comp_arc(F: F64, i: int, epsilon: float, sweep_epsilon: float) -> int:
    """Give an arc one radius, and tangents.

    Both radii belong to one centre only if that lies on the perpendicular bisector of the
    chord. The nearest point of it is the present centre, moved along the chord. For arcs
    that are nearly closed that may be far; their centre stays, and the mean radius is off
    by at most half the difference.
    """
    sweep: float = F[i + SWEEP]
    dx: float = F[i + X1] - F[i + X0]
    dy: float = F[i + Y1] - F[i + Y0]
    chord: float = sqrt(dx * dx + dy * dy)
    first: float = comp_length(F[i + X0] - F[i + CX], F[i + Y0] - F[i + CY])
    last: float = comp_length(F[i + X1] - F[i + CX], F[i + Y1] - F[i + CY])
    found: int = PLAIN
    if fabs(first - last) > epsilon:
        found = UNEQUAL
    if first < SHORTEST or last < SHORTEST:
        return NOTHING
    shift: float = 0.0
    if fabs(sweep) > 2.0 * PI - sweep_epsilon and chord <= epsilon:
        F[i + X1] = F[i + X0]
        F[i + Y1] = F[i + Y0]
        F[i + SWEEP] = 2.0 * PI if sweep > 0.0 else -2.0 * PI
        last = first
    elif chord < SHORTEST:
        return NOTHING
    else:
        shift = (F[i + CX] - F[i + X0]) * dx + (F[i + CY] - F[i + Y0]) * dy
        shift = shift / chord - 0.5 * chord
        if fabs(sweep) <= PI or fabs(shift) <= epsilon:
            F[i + CX] = F[i + CX] - shift * dx / chord
            F[i + CY] = F[i + CY] - shift * dy / chord
            first = comp_length(F[i + X0] - F[i + CX], F[i + Y0] - F[i + CY])
            last = first
    F[i + RADIUS] = 0.5 * (first + last)
    return _comp_turn(F, i, found)


def _comp_turn(F: F64, i: int, found: int) -> int:
    """Put down sweep and tangents as they follow from centre and ends."""
    turn: float = 1.0 if F[i + SWEEP] > 0.0 else -1.0
    sx: float = F[i + X0] - F[i + CX]
    sy: float = F[i + Y0] - F[i + CY]
    ex: float = F[i + X1] - F[i + CX]
    ey: float = F[i + Y1] - F[i + CY]
    first: float = comp_length(sx, sy)
    last: float = comp_length(ex, ey)
    if first < SHORTEST or last < SHORTEST:
        return NOTHING
    # The angle between the ends, with as many turns as were programmed.
    angle: float = atan2(sx * ey - sy * ex, sx * ex + sy * ey)
    angle = angle + 2.0 * PI * rint((F[i + SWEEP] - angle) / (2.0 * PI))
    F[i + SWEEP] = angle
    F[i + T0X] = -turn * sy / first
    F[i + T0Y] = turn * sx / first
    F[i + T1X] = -turn * ey / last
    F[i + T1Y] = turn * ex / last
    return found


def comp_length(x: float, y: float) -> float:
    return sqrt(x * x + y * y)


def comp_place(F: F64, i: int, away: float) -> bool:
    """Put the tool beside the whole element; False where an arc leaves it no room."""
    F[i + AWAY] = away
    F[i + AX] = F[i + X0] - away * F[i + T0Y]
    F[i + AY] = F[i + Y0] + away * F[i + T0X]
    F[i + BX] = F[i + X1] - away * F[i + T1Y]
    F[i + BY] = F[i + Y1] + away * F[i + T1X]
    F[i + TOOL_SWEEP] = F[i + SWEEP]
    F[i + TOOL_RADIUS] = F[i + RADIUS] - away if F[i + SWEEP] > 0.0 else F[i + RADIUS] + away
    return F[i + SWEEP] == 0.0 or F[i + TOOL_RADIUS] > 0.0


def comp_beyond(F: F64, i: int, is_end: bool, x: float, y: float) -> float:
    """How far a point lies beyond the end, or start, of the tool's path, along its direction.

    In units of length for lines, in radians (-pi..pi) for arcs.
    """
    turn: float = 1.0
    fx: float = F[i + X0]
    fy: float = F[i + Y0]
    if is_end:
        fx = F[i + X1]
        fy = F[i + Y1]
    if F[i + SWEEP] == 0.0:
        return (x - fx) * F[i + T0X] + (y - fy) * F[i + T0Y]
    if F[i + SWEEP] < 0.0:
        turn = -1.0
    fx = fx - F[i + CX]
    fy = fy - F[i + CY]
    x = x - F[i + CX]
    y = y - F[i + CY]
    return turn * atan2(fx * y - fy * x, fx * x + fy * y)


def comp_fit(F: F64, i: int, epsilon: float, sweep_epsilon: float) -> int:
    """Say whether the tool still runs forward between its ends: FITS, EMPTY or GOUGES.

    The sweep of an arc is what was programmed, less what was cut off at both ends. Where
    elements were joined within epsilon its ends may be that much off along the path.
    """
    slack: float = 1.0e-3 * epsilon
    if slack < LEAST_SLACK:
        slack = LEAST_SLACK
    if F[i + SWEEP] == 0.0:
        length: float = (F[i + BX] - F[i + AX]) * F[i + T0X]
        length = length + (F[i + BY] - F[i + AY]) * F[i + T0Y]
        return _comp_verdict(length, slack)
    radius: float = F[i + TOOL_RADIUS]
    if radius <= 0.0:
        return GOUGES
    start: float = comp_beyond(F, i, False, F[i + AX], F[i + AY])
    end: float = comp_beyond(F, i, True, F[i + BX], F[i + BY])
    sweep: float = fabs(F[i + SWEEP])
    swept: float = sweep - start + end
    if swept > sweep + sweep_epsilon + 2.0 * epsilon / radius:
        return GOUGES
    if swept > 2.0 * PI + LEAST_SLACK:
        swept = swept - 2.0 * PI
    F[i + TOOL_SWEEP] = swept if F[i + SWEEP] > 0.0 else -swept
    return _comp_verdict(swept * radius, slack)


def _comp_verdict(length: float, slack: float) -> int:
    if length < -slack:
        return GOUGES
    if length < SHORTEST:
        return EMPTY
    return FITS


def comp_range(F: F64, i: int, x: float, y: float) -> float:
    """The distance of a point from the contour of the element."""
    start: float = comp_length(x - F[i + X0], y - F[i + Y0])
    end: float = comp_length(x - F[i + X1], y - F[i + Y1])
    nearest: float = start if start < end else end
    beyond: float = comp_beyond(F, i, False, x, y)
    before: float = comp_beyond(F, i, True, x, y)
    if F[i + SWEEP] == 0.0:
        if beyond > 0.0 and before < 0.0:
            return fabs((x - F[i + X0]) * F[i + T0Y] - (y - F[i + Y0]) * F[i + T0X])
        return nearest
    if beyond < 0.0:
        beyond = beyond + 2.0 * PI
    if beyond <= fabs(F[i + SWEEP]):
        return fabs(comp_length(x - F[i + CX], y - F[i + CY]) - F[i + RADIUS])
    return nearest
