"""Planning data of moves, from arrays: lengths, tangents, limits, of straight moves and arcs.

The formulas are those of `geometry` and `encoding`, where they are explained:

    line   L = |d|                        tangent d / L           share of an axis |d_a| / L
    arc    L = sqrt((r sweep)^2 + |rise|^2)    tangent a quarter turn ahead of the radius, tilted
    feed   the lowest of F, the machine, limit_a / share_a, and what an arc allows
    ramp   the lowest of the machine, limit_a / share_a, and what the turn of an arc leaves

`Q` is the row of a move, `Y` has the axes of the machine, AXIS numbers each, `X` the speeds of the
machine, `J` integers. `U`: scratch, a displacement, shares, and the bend of an arc. A row whose
positions are to be looked at one by one is flagged: it may be beyond a soft limit or the pulses of
a packet.
"""

from openacr.cmath import fabs, floor, sqrt
from openacr.mill.plan.arc_law_cy import arc_bend, arc_ramp, arc_skew, arc_speed, arc_widening
from openacr.views import F64, I32

AXES = 8

# A move in the planner.
Q_LENGTH = 0
Q_FEED = 1
Q_RAMP = 2
Q_TOLERANCE = 3
Q_MODE = 4
Q_IS_RAPID = 5
Q_HAS_TANGENT = 6
Q_START = 7  # unit tangents, one number for each linear axis
Q_END = 12
Q_WANTED = 17  # F, units/s
Q_LINE = 18
Q_FILE = 19
Q_CORNER = 20  # highest speed at its end
Q_EXIT = 21  # planned speed at its end
Q_IS_ROUND = 22  # its end is a rounded corner: turn, reach, highest speed
Q_TURN = 23
Q_REACH = 24
Q_CAP = 25
Q_ROTATION = 26  # of rotary axes by length, a degree as a length
Q_ROUND_RAMP = 29  # of the weaker of the two moves at a rounded corner
Q_IS_JOINED = 30  # rounded into the next move by the card, or straight on
Q_SIZE = 31

# An axis of the machine.
Y_INDEX = 0
Y_IS_LINEAR = 1
Y_SCALE = 2  # pulses per unit
Y_SPEED = 3  # limits; 0: unlimited
Y_RAMP = 4
Y_HAS_LIMITS = 5
Y_HIGH = 6
Y_LOW = 7
Y_WEIGHT = 8  # the length that a unit or degree counts as
Y_SIZE = 9

# Speeds of the machine.
X_RAPID = 0
X_RAPID_RAMP = 1
X_FEED_RAMP = 2
X_ARC_RAMP = 3
X_MAX = 4
X_ROTARY = 5
X_MOVES = 6  # numbers before these

J_AXES = 0  # count
J_UNHOMED = 1  # mask of axes whose first move is to be flagged
J_MOVES = 2  # integers before these

RAPID = 0
LINE = 1
ARC = 2
ZX = 18
YZ = 19
LONG_MAX = 2147483647.0

U_DELTA = 0
U_SHARE = 8
U_BEND = 16  # of an arc, 0: of a line
U_WIDENING = 17
U_SKEW = 18
U_SIZE = 19

__all__ = ["move_row"]


def move_pulses(at: float, scale: float) -> float:
    """A position in whole pulses, halves away from zero."""
    exact: float = at * scale
    nearest: float = floor(fabs(exact) + 0.5)
    return nearest if exact >= 0.0 else -nearest


def move_line(J: I32, Y: F64, U: F64, Q: F64, q: int) -> None:
    """Length, tangent and shares of a straight move by the displacement in U."""
    along: float = 0.0
    turned: float = 0.0
    for k in range(J[J_AXES]):
        y: int = k * Y_SIZE
        delta: float = U[U_DELTA + int(Y[y + Y_INDEX])]
        if Y[y + Y_IS_LINEAR] > 0.0:
            along += delta * delta
        elif fabs(delta) > turned:
            turned = fabs(delta)
    length: float = sqrt(along)
    Q[q + Q_HAS_TANGENT] = 1.0 if length > 0.0 else 0.0
    place: int = 0
    for k in range(J[J_AXES]):
        y = k * Y_SIZE
        if Y[y + Y_IS_LINEAR] > 0.0:
            part: float = 0.0
            if length > 0.0:
                part = U[U_DELTA + int(Y[y + Y_INDEX])] / length
            Q[q + Q_START + place] = part
            Q[q + Q_END + place] = part
            place += 1
    if length <= 0.0:
        length = turned
    for axis in range(AXES):
        U[U_SHARE + axis] = fabs(U[U_DELTA + axis]) / length if length > 0.0 else 0.0
    Q[q + Q_LENGTH] = length


def move_arc(
    J: I32, Y: F64, U: F64, Q: F64, q: int, begin: F64, ends: F64, at: int, arcs: F64, a: int,
    first: int, second: int
) -> None:  # fmt: skip
    """Length, tangents and shares of an arc."""
    x0: float = begin[first] - arcs[a]
    y0: float = begin[second] - arcs[a + 1]
    x1: float = ends[at + first] - arcs[a]
    y1: float = ends[at + second] - arcs[a + 1]
    r0: float = sqrt(x0 * x0 + y0 * y0)
    r1: float = sqrt(x1 * x1 + y1 * y1)
    arc_u: float = 0.5 * (r0 + r1) * fabs(arcs[a + 2])
    rise: float = 0.0
    for k in range(J[J_AXES]):
        axis: int = int(Y[k * Y_SIZE + Y_INDEX])
        if Y[k * Y_SIZE + Y_IS_LINEAR] > 0.0 and axis != first and axis != second:
            rise += U[U_DELTA + axis] * U[U_DELTA + axis]
    length: float = sqrt(arc_u * arc_u + rise)
    Q[q + Q_LENGTH] = length
    Q[q + Q_HAS_TANGENT] = 1.0 if length > 0.0 else 0.0
    for each in range(AXES):
        U[U_SHARE + each] = fabs(U[U_DELTA + each]) / length if length > 0.0 else 0.0
    if length <= 0.0:
        return
    U[U_SHARE + first] = arc_u / length
    U[U_SHARE + second] = arc_u / length
    if arc_u > 0.0:
        U[U_BEND] = arc_bend(r0, r1, arcs[a + 2], arc_u / length)
        U[U_WIDENING] = arc_widening(r0, r1, arcs[a + 2])
        U[U_SKEW] = arc_skew(r0, r1, arcs[a + 2])
    turn: float = arc_u / length if arcs[a + 2] > 0.0 else -arc_u / length
    n0: float = r0 if r0 > 0.0 else 1.0
    n1: float = r1 if r1 > 0.0 else 1.0
    place: int = 0
    for k in range(J[J_AXES]):
        axis = int(Y[k * Y_SIZE + Y_INDEX])
        if Y[k * Y_SIZE + Y_IS_LINEAR] > 0.0:
            start: float = U[U_DELTA + axis] / length
            end: float = start
            if axis == first:
                start = -y0 / n0 * turn
                end = -y1 / n1 * turn
            elif axis == second:
                start = x0 / n0 * turn
                end = x1 / n1 * turn
            Q[q + Q_START + place] = start
            Q[q + Q_END + place] = end
            place += 1


def move_rotation(J: I32, Y: F64, U: F64, Q: F64, q: int) -> None:
    """What the rotary axes turn by the length of the move."""
    place: int = 0
    for k in range(J[J_AXES]):
        y: int = k * Y_SIZE
        if Y[y + Y_IS_LINEAR] <= 0.0:
            turned: float = Y[y + Y_WEIGHT] * U[U_DELTA + int(Y[y + Y_INDEX])]
            Q[q + Q_ROTATION + place] = turned / Q[q + Q_LENGTH] if Q[q + Q_LENGTH] > 0.0 else 0.0
            place += 1


def move_limits(J: I32, X: F64, Y: F64, U: F64, Q: F64, q: int, rounds: bool) -> None:
    """Lower feed and ramp of a move to the limits of the machine and of its axes."""
    feed: float = Q[q + Q_FEED]
    ramp: float = Q[q + Q_RAMP]
    if Q[q + Q_HAS_TANGENT] > 0.0 and X[X_MAX] < feed:
        feed = X[X_MAX]
    for k in range(J[J_AXES]):
        y: int = k * Y_SIZE
        share: float = U[U_SHARE + int(Y[y + Y_INDEX])]
        if share > 0.0:
            if Y[y + Y_SPEED] > 0.0 and Y[y + Y_SPEED] / share < feed:
                feed = Y[y + Y_SPEED] / share
            is_turned: bool = Y[y + Y_IS_LINEAR] <= 0.0 and X[X_ROTARY] > 0.0
            if is_turned and X[X_ROTARY] / share < feed:
                feed = X[X_ROTARY] / share
            limit: float = Y[y + Y_RAMP] if rounds else Y[y + Y_RAMP] / share
            if Y[y + Y_RAMP] > 0.0 and limit < ramp:
                ramp = limit
    Q[q + Q_FEED] = feed
    Q[q + Q_RAMP] = ramp


def move_turns(
    J: I32, X: F64, Y: F64, U: F64, Q: F64, q: int, first: int, second: int
) -> None:  # fmt: skip
    """Lower feed and ramp of an arc to what the limits of the two axes of its plane leave."""
    limit: float = X[X_ARC_RAMP]
    for k in range(J[J_AXES]):
        axis: int = int(Y[k * Y_SIZE + Y_INDEX])
        own: float = Y[k * Y_SIZE + Y_RAMP]
        if (axis == first or axis == second) and 0.0 < own < limit:
            limit = own
    speed: float = arc_speed(limit, U[U_BEND])
    if speed < Q[q + Q_FEED]:
        Q[q + Q_FEED] = speed
    ramp: float = arc_ramp(limit, U[U_BEND], U[U_WIDENING], U[U_SKEW], Q[q + Q_FEED])
    if ramp < Q[q + Q_RAMP]:
        Q[q + Q_RAMP] = ramp


def move_is_linear(J: I32, Y: F64, U: F64) -> bool:
    """Whether no rotary axis moves."""
    for k in range(J[J_AXES]):
        if Y[k * Y_SIZE + Y_IS_LINEAR] <= 0.0 and U[U_SHARE + int(Y[k * Y_SIZE + Y_INDEX])] > 0.0:
            return False
    return True


def move_as_sent(J: I32, Y: F64, U: F64, Q: F64, q: int, begin: F64, ends: F64, at: int) -> None:
    """The same move between whole pulses, where it has a length then."""
    for axis in range(AXES):
        U[U_DELTA + axis] = 0.0
    moves: bool = False
    for k in range(J[J_AXES]):
        axis = int(Y[k * Y_SIZE + Y_INDEX])
        scale: float = Y[k * Y_SIZE + Y_SCALE]
        end: float = move_pulses(ends[at + axis], scale) / scale
        U[U_DELTA + axis] = end - move_pulses(begin[axis], scale) / scale
        moves = moves or U[U_DELTA + axis] != 0.0
    if moves:
        move_line(J, Y, U, Q, q)


def move_is_flagged(
    J: I32, Y: F64, begin: F64, ends: F64, at: int, arcs: F64, a: int, first: int, second: int
) -> bool:
    """Whether the positions of a move are to be looked at; `first` is -1 for straight moves."""
    found: bool = False
    for k in range(J[J_AXES]):
        y: int = k * Y_SIZE
        axis: int = int(Y[y + Y_INDEX])
        end: float = ends[at + axis]
        if fabs(move_pulses(end, Y[y + Y_SCALE])) > LONG_MAX:
            found = True
        high: float = end
        low: float = end
        if first >= 0 and (axis == first or axis == second):
            reach: float = arcs[a + 3] if arcs[a + 3] > arcs[a + 4] else arcs[a + 4]
            centre: float = arcs[a] if axis == first else arcs[a + 1]
            high = centre + 1.001 * reach
            low = centre - 1.001 * reach
        if Y[y + Y_HAS_LIMITS] > 0.0 and (high > Y[y + Y_HIGH] or low < Y[y + Y_LOW]):
            found = True
        if end != begin[axis] and J[J_UNHOMED] & (1 << axis):
            J[J_UNHOMED] = J[J_UNHOMED] - (1 << axis)
            found = True
    return found


def move_row(
    J: I32, X: F64, Y: F64, U: F64, Q: F64, q: int, begin: F64, kind: int, plane: int, ends: F64,
    at: int, arcs: F64, a: int, wanted: float, tolerance: float
) -> bool:  # fmt: skip
    """Fill in the row of a move to the point at `at`; returns whether it is flagged."""
    first: int = -1
    second: int = -1
    U[U_BEND] = 0.0
    for axis in range(AXES):
        U[U_DELTA + axis] = ends[at + axis] - begin[axis]
    Q[q + Q_IS_RAPID] = 1.0 if kind == RAPID else 0.0
    Q[q + Q_FEED] = wanted
    Q[q + Q_RAMP] = X[X_RAPID_RAMP] if kind == RAPID else X[X_FEED_RAMP]
    Q[q + Q_TOLERANCE] = 0.0
    if kind == ARC:
        first = 2 if plane == ZX else (1 if plane == YZ else 0)
        second = 0 if plane == ZX else (2 if plane == YZ else 1)
        move_arc(J, Y, U, Q, q, begin, ends, at, arcs, a, first, second)
    else:
        move_line(J, Y, U, Q, q)
        if kind == LINE and tolerance > 0.0 and Q[q + Q_HAS_TANGENT] > 0.0:
            if move_is_linear(J, Y, U):
                Q[q + Q_TOLERANCE] = tolerance
                move_as_sent(J, Y, U, Q, q, begin, ends, at)
    move_rotation(J, Y, U, Q, q)
    move_limits(J, X, Y, U, Q, q, Q[q + Q_TOLERANCE] > 0.0)
    if U[U_BEND] > 0.0:
        move_turns(J, X, Y, U, Q, q, first, second)
    return move_is_flagged(J, Y, begin, ends, at, arcs, a, first, second)
