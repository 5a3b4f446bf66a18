"""What a straight move or an arc is to the planner: length, tangents, limits. The law of moves.

The feed counts along the linear axes; rotary ones follow. A move of rotary axes alone has its
length in degrees of the fastest one.

    line   L = |d|                        tangent d / L           share of an axis |d_a| / L
    arc    L = sqrt((r sweep)^2 + |rise|^2)    tangent a quarter turn ahead of the radius, tilted
    feed   the lowest of F, the machine, limit_a / share_a, and what an arc allows
    ramp   the lowest of the machine, limit_a / share_a, and what the turn of an arc leaves
    jerk   the lowest of that of paths and limit_a / share_a

The radius r of a spiral is its mean. In a corner that the card rounds the ramp can have any
direction, so that it is within the limit of every axis.

`X`: numbers of the machine, then of the move in hand; `J`: counts, masks and kinds; `Q`: rows of
moves, of which the present one begins at q.
"""

from openacr.cmath import fabs, floor, sqrt
from openacr.mill.plan.moves.arc_law_cy import arc_bend, arc_ramp, arc_skew, arc_speed, arc_widening
from openacr.views import F64, I32

AXES = 8
MOST_LINEAR = 5
MOST_ROTARY = 3

# A corner, as the card rounds it.
K_IS_ROUND = 0
K_TURN = 1  # length of the difference of the two unit tangents
K_REACH_U = 2  # along both moves
K_CAP_UPS = 3  # highest speed
K_RAMP_UPS2 = 4  # of the weaker of the two moves
K_SIZE = 5

# A move in the planner.
Q_LENGTH_U = 0
Q_FEED_UPS = 1
Q_RAMP_UPS2 = 2
Q_JERK_UPS3 = 3
Q_TOLERANCE_U = 4  # of the corner at its end, towards another move with one
Q_MODE = 5
Q_IS_RAPID = 6
Q_HAS_TANGENT = 7
Q_START = 8  # unit tangents, one number for each linear axis
Q_END = Q_START + MOST_LINEAR
Q_TURNS = Q_END + MOST_LINEAR  # of rotary axes by length, a degree as a length
Q_WANTED_UPS = Q_TURNS + MOST_ROTARY  # F
Q_LINE = Q_WANTED_UPS + 1
Q_FILE = Q_WANTED_UPS + 2
Q_CORNER_UPS = Q_WANTED_UPS + 3  # highest speed at its end
Q_EXIT_UPS = Q_WANTED_UPS + 4  # planned speed at its end
Q_IS_JOINED = Q_WANTED_UPS + 5  # rounded into the next move by the card, or straight on
Q_ROUND = Q_WANTED_UPS + 6  # the corner at its end
Q_SIZE = Q_ROUND + K_SIZE

# An axis of the machine.
Y_INDEX = 0
Y_IS_LINEAR = 1
Y_SCALE = 2  # pulses per unit
Y_SPEED_UPS = 3  # limits; 0: unlimited
Y_RAMP_UPS2 = 4
Y_JERK_UPS3 = 5
Y_HAS_LIMITS = 6
Y_HIGH_U = 7
Y_LOW_U = 8
Y_WEIGHT = 9  # the length that a unit or degree counts as
Y_SIZE = 10

# The machine.
X_RAPID_UPS = 0
X_RAPID_UPS2 = 1  # ramps
X_FEED_UPS2 = 2
X_ARC_UPS2 = 3
X_MAX_UPS = 4
X_ROTARY_UPS = 5
X_JERK_UPS3 = 6
X_AXES = 7  # Y_SIZE numbers for each axis of the machine

# The move in hand: what it is,
X_BEGIN_U = X_AXES + AXES * Y_SIZE  # machine positions of all axes
X_END_U = X_BEGIN_U + AXES
X_WANTED_UPS = X_END_U + AXES
X_CORNER_U = X_WANTED_UPS + 1  # tolerance of its corners
X_CENTRE_U = X_CORNER_U + 1  # of an arc, on the two axes of its plane
X_SWEEP_RAD = X_CENTRE_U + 2
X_RADII_U = X_SWEEP_RAD + 1  # the distances of its begin and end from the centre
# and what follows.
X_DELTA_U = X_RADII_U + 2
X_SHARE = X_DELTA_U + AXES
X_BEND_PER_U = X_SHARE + AXES  # of an arc, 0: of a line
X_WIDENING = X_BEND_PER_U + 1
X_SKEW = X_BEND_PER_U + 2
X_MOVES = X_BEND_PER_U + 3  # numbers before these

J_AXES = 0  # count
J_SHARES_RAMP = 1  # each rotary axis has the ramp of feed moves: of machines that plan paths
J_UNHOMED = 2  # mask of axes whose first move is to be flagged
J_KIND = 3  # of the move in hand
J_FIRST = 4  # the axes of the plane of an arc
J_SECOND = 5
J_IS_PLANNED = 6  # its path is planned, which leaves its turns to the planner of the path
J_IN_POLYLINE = 7  # its length and limits are those of its programmed ends
J_MOVES = 8  # integers before these

RAPID = 0
LINE = 1
ARC = 2
UNLIMITED = 1.0e300
LONG_MAX = 2147483647.0

__all__ = ["move_pulses", "move_row"]


def move_pulses(at: float, scale: float) -> float:
    """A position in whole pulses, halves away from zero."""
    exact: float = at * scale
    nearest: float = floor(fabs(exact) + 0.5)
    return nearest if exact >= 0.0 else 0.0 - nearest


def move_radii(J: I32, X: F64) -> None:
    """The distances of both ends of an arc from its centre."""
    for end in range(2):
        at: int = X_BEGIN_U if end == 0 else X_END_U
        x: float = X[at + J[J_FIRST]] - X[X_CENTRE_U]
        y: float = X[at + J[J_SECOND]] - X[X_CENTRE_U + 1]
        X[X_RADII_U + end] = sqrt(x * x + y * y)


def move_line(J: I32, X: F64, Q: F64, q: int) -> None:
    """Length, tangent and shares of a straight move by its displacement."""
    along: float = 0.0
    turned: float = 0.0
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        delta: float = X[X_DELTA_U + int(X[y + Y_INDEX])]
        if X[y + Y_IS_LINEAR] > 0.0:
            along += delta * delta
        elif fabs(delta) > turned:
            turned = fabs(delta)
    length: float = sqrt(along)
    Q[q + Q_HAS_TANGENT] = 1.0 if length > 0.0 else 0.0
    place: int = 0
    for k in range(J[J_AXES]):
        y = X_AXES + k * Y_SIZE
        if X[y + Y_IS_LINEAR] > 0.0:
            part: float = 0.0
            if length > 0.0:
                part = X[X_DELTA_U + int(X[y + Y_INDEX])] / length
            Q[q + Q_START + place] = part
            Q[q + Q_END + place] = part
            place += 1
    if length <= 0.0:
        length = turned
    for axis in range(AXES):
        X[X_SHARE + axis] = fabs(X[X_DELTA_U + axis]) / length if length > 0.0 else 0.0
    Q[q + Q_LENGTH_U] = length


def move_arc(J: I32, X: F64, Q: F64, q: int) -> None:
    """Length, tangents and shares of an arc, and how it bends."""
    first: int = J[J_FIRST]
    second: int = J[J_SECOND]
    sweep: float = X[X_SWEEP_RAD]
    r0: float = X[X_RADII_U]
    r1: float = X[X_RADII_U + 1]
    arc_u: float = 0.5 * (r0 + r1) * fabs(sweep)
    rise: float = 0.0
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        axis: int = int(X[y + Y_INDEX])
        if X[y + Y_IS_LINEAR] > 0.0 and axis != first and axis != second:
            rise += X[X_DELTA_U + axis] * X[X_DELTA_U + axis]
    length: float = sqrt(arc_u * arc_u + rise)
    Q[q + Q_LENGTH_U] = length
    Q[q + Q_HAS_TANGENT] = 1.0 if length > 0.0 else 0.0
    for each in range(AXES):
        X[X_SHARE + each] = fabs(X[X_DELTA_U + each]) / length if length > 0.0 else 0.0
    if length <= 0.0:
        return
    X[X_SHARE + first] = arc_u / length
    X[X_SHARE + second] = arc_u / length
    if arc_u > 0.0:
        X[X_BEND_PER_U] = arc_bend(r0, r1, sweep, arc_u / length)
        X[X_WIDENING] = arc_widening(r0, r1, sweep)
        X[X_SKEW] = arc_skew(r0, r1, sweep)
    turn: float = arc_u / length if sweep > 0.0 else -arc_u / length
    move_tangent(J, X, X_BEGIN_U, r0, turn, length, Q, q + Q_START)
    move_tangent(J, X, X_END_U, r1, turn, length, Q, q + Q_END)


def move_tangent(
    J: I32, X: F64, at: int, radius: float, turn: float, length: float, Q: F64, tangent: int
) -> None:
    """The unit tangent of an arc at X[at]: a quarter turn ahead of the radius, tilted."""
    n: float = radius if radius > 0.0 else 1.0
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        if X[y + Y_IS_LINEAR] > 0.0:
            axis: int = int(X[y + Y_INDEX])
            part: float = X[X_DELTA_U + axis] / length
            if axis == J[J_FIRST]:
                part = -(X[at + J[J_SECOND]] - X[X_CENTRE_U + 1]) / n * turn
            elif axis == J[J_SECOND]:
                part = (X[at + J[J_FIRST]] - X[X_CENTRE_U]) / n * turn
            Q[tangent] = part
            tangent += 1


def move_turns(J: I32, X: F64, Q: F64, q: int) -> None:
    """What the rotary axes turn by the length of the move."""
    place: int = 0
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        if X[y + Y_IS_LINEAR] <= 0.0:
            turned: float = X[y + Y_WEIGHT] * X[X_DELTA_U + int(X[y + Y_INDEX])]
            length: float = Q[q + Q_LENGTH_U] if Q[q + Q_LENGTH_U] > 0.0 else 1.0
            Q[q + Q_TURNS + place] = turned / length
            place += 1


def move_limits(J: I32, X: F64, Q: F64, q: int) -> None:
    """Lower feed, ramp and jerk of a move to the limits of the machine and of its axes."""
    feed: float = Q[q + Q_FEED_UPS]
    ramp: float = Q[q + Q_RAMP_UPS2]
    jerk: float = UNLIMITED
    rounds: bool = Q[q + Q_TOLERANCE_U] > 0.0
    fastest_turn: float = 1.0
    if Q[q + Q_HAS_TANGENT] > 0.0:
        feed = X[X_MAX_UPS] if X[X_MAX_UPS] < feed else feed
        jerk = X[X_JERK_UPS3]
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        share: float = X[X_SHARE + int(X[y + Y_INDEX])]
        if share > 0.0:
            if X[y + Y_SPEED_UPS] > 0.0 and X[y + Y_SPEED_UPS] / share < feed:
                feed = X[y + Y_SPEED_UPS] / share
            is_turned: bool = X[y + Y_IS_LINEAR] <= 0.0
            if is_turned and X[X_ROTARY_UPS] > 0.0 and X[X_ROTARY_UPS] / share < feed:
                feed = X[X_ROTARY_UPS] / share
            if is_turned and share > fastest_turn:
                fastest_turn = share
            limit: float = X[y + Y_RAMP_UPS2] if rounds else X[y + Y_RAMP_UPS2] / share
            if X[y + Y_RAMP_UPS2] > 0.0 and limit < ramp:
                ramp = limit
            if X[y + Y_JERK_UPS3] > 0.0 and X[y + Y_JERK_UPS3] / share < jerk:
                jerk = X[y + Y_JERK_UPS3] / share
    if J[J_SHARES_RAMP] and Q[q + Q_RAMP_UPS2] / fastest_turn < ramp:
        ramp = Q[q + Q_RAMP_UPS2] / fastest_turn
    Q[q + Q_FEED_UPS] = feed
    Q[q + Q_RAMP_UPS2] = ramp
    Q[q + Q_JERK_UPS3] = jerk if jerk < UNLIMITED else X[X_JERK_UPS3]


def move_bend(J: I32, X: F64, Q: F64, q: int) -> None:
    """Lower feed and ramp of an arc to what the limits of the two axes of its plane leave."""
    limit: float = X[X_ARC_UPS2]
    for k in range(J[J_AXES]):
        axis: int = int(X[X_AXES + k * Y_SIZE + Y_INDEX])
        own: float = X[X_AXES + k * Y_SIZE + Y_RAMP_UPS2]
        if (axis == J[J_FIRST] or axis == J[J_SECOND]) and 0.0 < own < limit:
            limit = own
    speed: float = arc_speed(limit, X[X_BEND_PER_U])
    if J[J_IS_PLANNED]:  # by axis; Arc Acceleration is not known to it
        speed = sqrt(X[X_ARC_UPS2] / X[X_BEND_PER_U])
    if speed < Q[q + Q_FEED_UPS]:
        Q[q + Q_FEED_UPS] = speed
    ramp: float = arc_ramp(limit, X[X_BEND_PER_U], X[X_WIDENING], X[X_SKEW], Q[q + Q_FEED_UPS])
    if ramp < Q[q + Q_RAMP_UPS2]:
        Q[q + Q_RAMP_UPS2] = ramp


def move_is_linear(J: I32, X: F64) -> bool:
    """Whether no rotary axis moves."""
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        if X[y + Y_IS_LINEAR] <= 0.0 and X[X_SHARE + int(X[y + Y_INDEX])] > 0.0:
            return False
    return True


def move_as_sent(J: I32, X: F64, Q: F64, q: int) -> None:
    """The same move between whole pulses, where it has a length then.

    In short moves rounding creates corners that the program does not have.
    """
    for axis in range(AXES):
        X[X_DELTA_U + axis] = 0.0
    moves: bool = False
    for k in range(J[J_AXES]):
        axis = int(X[X_AXES + k * Y_SIZE + Y_INDEX])
        scale: float = X[X_AXES + k * Y_SIZE + Y_SCALE]
        end: float = move_pulses(X[X_END_U + axis], scale) / scale
        X[X_DELTA_U + axis] = end - move_pulses(X[X_BEGIN_U + axis], scale) / scale
        moves = moves or X[X_DELTA_U + axis] != 0.0
    if moves:
        move_line(J, X, Q, q)


def move_straight(J: I32, X: F64, Q: F64, q: int) -> None:
    """Shape and limits of a straight move."""
    move_line(J, X, Q, q)
    rounds: bool = J[J_KIND] == LINE and X[X_CORNER_U] > 0.0 and Q[q + Q_HAS_TANGENT] > 0.0
    rounds = rounds and move_is_linear(J, X)
    if rounds:
        Q[q + Q_TOLERANCE_U] = X[X_CORNER_U]
    if rounds and not J[J_IN_POLYLINE]:
        move_as_sent(J, X, Q, q)
    move_turns(J, X, Q, q)
    move_limits(J, X, Q, q)
    if rounds and J[J_IN_POLYLINE]:
        length: float = Q[q + Q_LENGTH_U]
        move_as_sent(J, X, Q, q)
        Q[q + Q_LENGTH_U] = length


def move_row(J: I32, X: F64, Q: F64, q: int) -> None:
    """Fill in the row of the move in hand."""
    is_rapid: bool = J[J_KIND] == RAPID
    X[X_BEND_PER_U] = 0.0
    for axis in range(AXES):
        X[X_DELTA_U + axis] = X[X_END_U + axis] - X[X_BEGIN_U + axis]
    Q[q + Q_IS_RAPID] = 1.0 if is_rapid else 0.0
    Q[q + Q_FEED_UPS] = X[X_RAPID_UPS] if is_rapid else X[X_WANTED_UPS]
    Q[q + Q_RAMP_UPS2] = X[X_RAPID_UPS2] if is_rapid else X[X_FEED_UPS2]
    Q[q + Q_TOLERANCE_U] = 0.0
    if J[J_KIND] != ARC:
        move_straight(J, X, Q, q)
        return
    move_arc(J, X, Q, q)
    move_turns(J, X, Q, q)
    move_limits(J, X, Q, q)
    if X[X_BEND_PER_U] > 0.0:
        move_bend(J, X, Q, q)


def move_is_flagged(J: I32, X: F64, reach_u: float) -> bool:
    """Whether the positions of a move are to be looked at one by one.

    It may be beyond a soft limit or the pulses of a packet, or be the first of an axis whose
    limits are not in force. `reach_u`: the larger radius of an arc.
    """
    found: bool = False
    for k in range(J[J_AXES]):
        y: int = X_AXES + k * Y_SIZE
        axis: int = int(X[y + Y_INDEX])
        end: float = X[X_END_U + axis]
        if fabs(move_pulses(end, X[y + Y_SCALE])) > LONG_MAX:
            found = True
        high: float = end
        low: float = end
        if J[J_KIND] == ARC and (axis == J[J_FIRST] or axis == J[J_SECOND]):
            centre: float = X[X_CENTRE_U] if axis == J[J_FIRST] else X[X_CENTRE_U + 1]
            high = centre + 1.001 * reach_u
            low = centre - 1.001 * reach_u
        if X[y + Y_HAS_LIMITS] > 0.0 and (high > X[y + Y_HIGH_U] or low < X[y + Y_LOW_U]):
            found = True
        if end != X[X_BEGIN_U + axis] and J[J_UNHOMED] & (1 << axis):
            J[J_UNHOMED] = J[J_UNHOMED] - (1 << axis)
            found = True
    return found
