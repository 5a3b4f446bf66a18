r"""Look-ahead planning of the speed from one move to the next, and the motion of planned moves.

The card plans inside a move; what it cannot see is the corner after the last move it was
sent. So every move is sent with the speed it has to end with (FVEL), and that speed is
planned here over the moves that are known:

    corner     the lower feed, slowed by the angle between the tangents (G62), by the
               velocity step an axis would make there (Corner Step), 0 for exact stops
    backward   v_end(i)^2 <= v_end(i+1)^2 + 2 A L(i+1), the last known move ends at rest

The backward pass limits each speed to one that the following moves can brake from. It only
rises when more moves become known, so a move that was sent stays valid.

Moves with a path tolerance are joined: the card rounds the corner between them and computes its
speeds itself (kernel/path/round_law_cy.py). Here the same speeds are predicted, for the moves
around them and the run time: such a corner is entered and left within its reach of the programmed
one, and its two halves are passed at a constant acceleration each.

The card runs each move from the speed the move before it ended with, up to its feed and
down to the speed it was sent with, at constant acceleration a. Over a length L

    end      v1 = min(planned, sqrt(v0^2 + 2 a L))    what can be reached at all
    peak     vp = min(feed, sqrt((2 a L + v0^2 + v1^2) / 2))
    time     (vp - v0)/a + (vp - v1)/a + (L - ramps)/vp

`Q`: the rows of the queue (`move_rows_cy`), `B` the longest braking distances of the queue, each
from one move on, in falling order; `X` and `J`: numbers and counts, continued from `move_rows_cy`.
`P`: the phases of a move, PHASE numbers each.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.kernel.path.round_law_cy import STRAIGHT, round_brake, round_cap, round_ramp2
from openacr.mill.plan.move_rows_cy import (
    J_MOVES,
    Q_CAP,
    Q_CORNER,
    Q_END,
    Q_EXIT,
    Q_FEED,
    Q_HAS_TANGENT,
    Q_IS_JOINED,
    Q_IS_RAPID,
    Q_IS_ROUND,
    Q_LENGTH,
    Q_MODE,
    Q_RAMP,
    Q_REACH,
    Q_ROTATION,
    Q_ROUND_RAMP,
    Q_SIZE,
    Q_START,
    Q_TOLERANCE,
    Q_TURN,
    X_MOVES,
)
from openacr.views import F64, I32

__all__ = ["queue_add", "queue_ahead", "queue_drop", "queue_speeds", "queue_travel"]

X_ANGLE1 = X_MOVES  # corner rules
X_ANGLE2 = X_MOVES + 1
X_SLOWEST = X_MOVES + 2
X_STEP = X_MOVES + 3
X_SPEED = X_MOVES + 4  # at the end of the move before, and the rounded corner there
X_IS_ROUND = X_MOVES + 5
X_TURN = X_MOVES + 6
X_REACH = X_MOVES + 7
X_CAP = X_MOVES + 8
X_ROUND_RAMP = X_MOVES + 9
X_LINE2 = X_MOVES + 10  # squared speeds of a move: between its corners, and before the last of them
X_AHEAD2 = X_MOVES + 11
X_PLAN = X_MOVES + 12  # numbers before these

J_HEAD = J_MOVES  # the first row of the queue
J_COUNT = J_MOVES + 1  # moves in it
J_BRAKE_HEAD = J_MOVES + 2  # of B
J_BRAKE_END = J_MOVES + 3
J_LEAST = J_MOVES + 4  # moves kept at least
J_PLAN = J_MOVES + 5

EXACT = 1.0  # modes; others pass corners at their feed
CORNER = 2.0
MOST_AHEAD = 4000  # moves held back at most, however short they are
REACH = 4.0  # of a rounded corner, per tolerance and change of direction
DEGREES = 57.29577951308232
NO_JERK = 0.0
LINEAR = 5
ROTARY = 3

P_LENGTH = 0
P_BEGIN = 1  # speeds
P_END = 2
PHASE = 3
MOST_PHASES = 5


def queue_angle(X: F64, Q: F64, i: int, j: int, feed: float) -> float:
    """The corner speed of G62: feed up to angle 1, then linearly to the slowest, 0 from angle 2.

    atan2 of the half-angle chords keeps full accuracy near 0 and 180 degrees, where acos of the
    dot product loses half the digits.
    """
    apart: float = 0.0
    along: float = 0.0
    for k in range(LINEAR):
        a: float = Q[i + Q_END + k]
        b: float = Q[j + Q_START + k]
        apart += (a - b) * (a - b)
        along += (a + b) * (a + b)
    turn: float = 2.0 * atan2(sqrt(apart), sqrt(along)) * DEGREES
    first: float = X[X_ANGLE1]
    second: float = X[X_ANGLE2]
    if (first == 0.0 and second == 0.0) or turn <= first:
        return feed
    if second > 0.0 and turn >= second:
        return 0.0
    slowest: float = X[X_SLOWEST] if X[X_SLOWEST] < feed else feed
    last: float = second if second > 0.0 else 180.0
    return feed - (feed - slowest) * (turn - first) / (last - first)


def queue_step(X: F64, Q: F64, i: int, j: int, feed: float) -> float:
    """The speed at which the velocity step of every axis is within Corner Step."""
    jump: float = 0.0
    for k in range(LINEAR):
        each: float = fabs(Q[i + Q_END + k] - Q[j + Q_START + k])
        jump = each if each > jump else jump
    for k in range(ROTARY):
        turned: float = fabs(Q[i + Q_ROTATION + k] - Q[j + Q_ROTATION + k])
        jump = turned if turned > jump else jump
    if jump > 0.0 and X[X_STEP] / jump < feed:
        feed = X[X_STEP] / jump
    return feed


def queue_corner(X: F64, Q: F64, i: int, j: int) -> float:
    """The highest speed at which the move in row i may pass into the one in row j."""
    if Q[i + Q_IS_RAPID] > 0.0 or Q[j + Q_IS_RAPID] > 0.0 or Q[i + Q_MODE] == EXACT:
        return 0.0
    if Q[i + Q_HAS_TANGENT] <= 0.0 or Q[j + Q_HAS_TANGENT] <= 0.0:
        return 0.0
    feed: float = Q[i + Q_FEED] if Q[i + Q_FEED] < Q[j + Q_FEED] else Q[j + Q_FEED]
    if Q[i + Q_MODE] == CORNER:
        feed = queue_angle(X, Q, i, j, feed)
    return queue_step(X, Q, i, j, feed) if X[X_STEP] > 0.0 else feed


def queue_join(X: F64, Q: F64, i: int, j: int) -> None:
    """Set the corner between two moves: its speed limit, and whether it is rounded."""
    has_tangents: bool = Q[i + Q_HAS_TANGENT] > 0.0 and Q[j + Q_HAS_TANGENT] > 0.0
    if not has_tangents or Q[i + Q_TOLERANCE] == 0.0 or Q[j + Q_TOLERANCE] == 0.0:
        Q[i + Q_CORNER] = queue_corner(X, Q, i, j)
        return
    Q[i + Q_IS_JOINED] = 1.0
    Q[i + Q_CORNER] = Q[i + Q_FEED] if Q[i + Q_FEED] < Q[j + Q_FEED] else Q[j + Q_FEED]
    square: float = 0.0
    for k in range(LINEAR):
        each: float = Q[j + Q_START + k] - Q[i + Q_END + k]
        square += each * each
    turn: float = sqrt(square)
    if turn <= STRAIGHT:
        return
    shorter: float = Q[i + Q_LENGTH] if Q[i + Q_LENGTH] < Q[j + Q_LENGTH] else Q[j + Q_LENGTH]
    reach: float = REACH * Q[i + Q_TOLERANCE] / turn
    Q[i + Q_IS_ROUND] = 1.0
    Q[i + Q_TURN] = turn
    Q[i + Q_REACH] = reach if reach < 0.5 * shorter else 0.5 * shorter
    Q[i + Q_ROUND_RAMP] = Q[i + Q_RAMP] if Q[i + Q_RAMP] < Q[j + Q_RAMP] else Q[j + Q_RAMP]
    Q[i + Q_CAP] = round_cap(turn, Q[i + Q_REACH], Q[i + Q_ROUND_RAMP], NO_JERK)
    if Q[i + Q_CAP] < Q[i + Q_CORNER]:
        Q[i + Q_CORNER] = Q[i + Q_CAP]


def queue_before2(turn: float, reach: float, cap: float, ramp: float, w: float) -> float:
    """The highest squared speed at one end of half a corner whose other end has `w`."""
    reached: float = round_ramp2(turn, reach, ramp, NO_JERK, w)
    return reached if reached < cap * cap else cap * cap


def queue_pass2(turn: float, reach: float, ramp: float, w: float, goal: float) -> float:
    """The squared speed after half a corner entered with `w` that may end with `goal`."""
    if goal <= w:
        return goal
    top: float = round_ramp2(turn, reach, ramp, NO_JERK, w)
    top = goal if goal < top else top
    end: float = w + 2.0 * round_brake(turn, reach, ramp, top) * reach
    return end if end < top else top


def queue_back(
    X: F64, Q: F64, i: int, is_round: bool, turn: float, reach: float, cap: float, round_ramp: float
) -> float:
    """Squared speed at the start of a move after this corner; X gets those inside it."""
    top: float = Q[i + Q_FEED] * Q[i + Q_FEED]
    ramp: float = Q[i + Q_RAMP]
    ahead: float = Q[i + Q_EXIT] * Q[i + Q_EXIT]
    ahead = ahead if ahead < top else top
    length: float = Q[i + Q_LENGTH]
    if Q[i + Q_IS_ROUND] > 0.0:
        ahead = queue_before2(
            Q[i + Q_TURN], Q[i + Q_REACH], Q[i + Q_CAP], Q[i + Q_ROUND_RAMP], ahead
        )
        ahead = ahead if ahead < top else top
        length = length - Q[i + Q_REACH]
    X[X_AHEAD2] = ahead
    if not is_round:
        X[X_LINE2] = ahead + 2.0 * ramp * length
        return X[X_LINE2]
    line: float = ahead + 2.0 * ramp * (length - reach)
    line = line if line < top else top
    line = line if line < cap * cap else cap * cap
    X[X_LINE2] = line
    return queue_before2(turn, reach, cap, round_ramp, line)


def queue_brake(Q: F64, i: int) -> float:
    """The distance to brake from the feed of a move to rest; longer through rounded corners."""
    double: float = 1.0 if Q[i + Q_TOLERANCE] > 0.0 else 2.0
    return Q[i + Q_FEED] * Q[i + Q_FEED] / (double * Q[i + Q_RAMP])


def queue_ahead(J: I32, Q: F64, B: F64) -> int:
    """The count of last moves that have to wait for the moves that follow.

    As many as needed to brake to rest, so that the speeds of released moves do not depend
    on unknown moves; never fewer than J_LEAST.
    """
    distance: float = 0.0
    last: int = J[J_HEAD] + J[J_COUNT] - 1
    for count in range(J[J_COUNT]):
        distance += Q[(last - count) * Q_SIZE + Q_LENGTH]
        if count + 1 >= MOST_AHEAD:
            return MOST_AHEAD
        if distance >= B[J[J_BRAKE_HEAD]] and count + 1 >= J[J_LEAST]:
            return count + 1
    return J[J_COUNT]


def queue_add(J: I32, X: F64, Q: F64, B: F64) -> None:
    """Add the move in the row after the last one to the queue."""
    new: int = (J[J_HEAD] + J[J_COUNT]) * Q_SIZE
    if J[J_COUNT]:
        queue_join(X, Q, new - Q_SIZE, new)
    Q[new + Q_CORNER] = 0.0
    Q[new + Q_IS_JOINED] = 0.0
    Q[new + Q_IS_ROUND] = 0.0
    J[J_COUNT] = J[J_COUNT] + 1
    brake: float = queue_brake(Q, new)
    while J[J_BRAKE_END] > J[J_BRAKE_HEAD] and B[J[J_BRAKE_END] - 1] < brake:
        J[J_BRAKE_END] = J[J_BRAKE_END] - 1
    B[J[J_BRAKE_END]] = brake
    J[J_BRAKE_END] = J[J_BRAKE_END] + 1


def queue_speeds(J: I32, X: F64, Q: F64) -> None:
    """Set the end speed of every move in the queue: the backward pass."""
    first: int = J[J_HEAD] * Q_SIZE
    i: int = first + (J[J_COUNT] - 1) * Q_SIZE
    Q[i + Q_EXIT] = 0.0
    while i > first:
        after: int = i
        i -= Q_SIZE
        is_round: bool = Q[i + Q_IS_ROUND] > 0.0
        start2: float = 0.0
        if is_round or Q[after + Q_IS_ROUND] > 0.0:
            start2 = queue_back(
                X, Q, after, is_round, Q[i + Q_TURN], Q[i + Q_REACH], Q[i + Q_CAP],
                Q[i + Q_ROUND_RAMP],
            )  # fmt: skip
        else:
            start2 = Q[after + Q_EXIT] * Q[after + Q_EXIT]
            start2 += 2.0 * Q[after + Q_RAMP] * Q[after + Q_LENGTH]
        reach: float = sqrt(start2)
        Q[i + Q_EXIT] = Q[i + Q_CORNER] if Q[i + Q_CORNER] < reach else reach


def queue_drop(J: I32, Q: F64, B: F64, count: int) -> None:
    """Remove the first moves; rows and distances begin anew when most of their room is used up."""
    for _ in range(count):
        if B[J[J_BRAKE_HEAD]] == queue_brake(Q, J[J_HEAD] * Q_SIZE):
            J[J_BRAKE_HEAD] = J[J_BRAKE_HEAD] + 1
        J[J_HEAD] = J[J_HEAD] + 1
    J[J_COUNT] = J[J_COUNT] - count
    if J[J_HEAD] > J[J_COUNT]:
        for n in range(J[J_COUNT] * Q_SIZE):
            Q[n] = Q[J[J_HEAD] * Q_SIZE + n]
        for n in range(J[J_BRAKE_END] - J[J_BRAKE_HEAD]):
            B[n] = B[J[J_BRAKE_HEAD] + n]
        J[J_BRAKE_END] = J[J_BRAKE_END] - J[J_BRAKE_HEAD]
        J[J_HEAD] = 0
        J[J_BRAKE_HEAD] = 0


def queue_phase(P: F64, n: int, length: float, begin: float, end: float) -> int:
    """Note a phase at constant acceleration; returns the number of the next."""
    P[n * PHASE + P_LENGTH] = length
    P[n * PHASE + P_BEGIN] = begin
    P[n * PHASE + P_END] = end
    return n + 1


def queue_travel(X: F64, Q: F64, i: int, P: F64) -> int:
    """The phases of a planned move, after the moves before it; returns their count.

    Up to its peak speed, constant, down to its end; before and after that halves of corners.
    """
    a: float = Q[i + Q_RAMP]
    left: float = Q[i + Q_LENGTH]
    feed: float = Q[i + Q_FEED]
    begin: float = X[X_SPEED] if X[X_SPEED] < feed else feed
    enters: bool = X[X_IS_ROUND] > 0.0
    queue_back(X, Q, i, enters, X[X_TURN], X[X_REACH], X[X_CAP], X[X_ROUND_RAMP])
    count: int = 0
    if enters:
        line: float = sqrt(
            queue_pass2(X[X_TURN], X[X_REACH], X[X_ROUND_RAMP], begin * begin, X[X_LINE2])
        )
        count = queue_phase(P, count, X[X_REACH], begin, line)
        begin = line
        left -= X[X_REACH]
    end: float = Q[i + Q_EXIT]
    leaves: bool = Q[i + Q_IS_ROUND] > 0.0
    if leaves:
        left -= Q[i + Q_REACH]
        end = sqrt(X[X_AHEAD2])
    reached: float = sqrt(begin * begin + 2.0 * a * left)
    end = end if end < reached else reached
    peak: float = sqrt(0.5 * (2.0 * a * left + begin * begin + end * end))
    peak = feed if feed < peak else peak
    up: float = (peak * peak - begin * begin) / (2.0 * a)
    down: float = (peak * peak - end * end) / (2.0 * a)
    rest: float = left - up - down
    count = queue_phase(P, count, up, begin, peak)
    count = queue_phase(P, count, rest if rest > 0.0 else 0.0, peak, peak)
    count = queue_phase(P, count, down, peak, end)
    if leaves:
        goal: float = Q[i + Q_EXIT] * Q[i + Q_EXIT]
        after: float = sqrt(
            queue_pass2(Q[i + Q_TURN], Q[i + Q_REACH], Q[i + Q_ROUND_RAMP], end * end, goal)
        )
        count = queue_phase(P, count, Q[i + Q_REACH], end, after)
        end = after
    X[X_SPEED] = end
    X[X_IS_ROUND] = Q[i + Q_IS_ROUND]
    X[X_TURN] = Q[i + Q_TURN]
    X[X_REACH] = Q[i + Q_REACH]
    X[X_CAP] = Q[i + Q_CAP]
    X[X_ROUND_RAMP] = Q[i + Q_ROUND_RAMP]
    return count
