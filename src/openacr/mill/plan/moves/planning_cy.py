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
`C`: `Q` or `X`, where the numbers of a corner begin at c.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.kernel.path.round_law_cy import STRAIGHT, round_brake, round_cap, round_ramp2
from openacr.mill.plan.moves.move_rows_cy import (
    J_MOVES,
    K_CAP_UPS,
    K_IS_ROUND,
    K_RAMP_UPS2,
    K_REACH_U,
    K_SIZE,
    K_TURN,
    MOST_LINEAR,
    MOST_ROTARY,
    Q_CORNER_UPS,
    Q_END,
    Q_EXIT_UPS,
    Q_FEED_UPS,
    Q_HAS_TANGENT,
    Q_IS_JOINED,
    Q_IS_RAPID,
    Q_LENGTH_U,
    Q_MODE,
    Q_RAMP_UPS2,
    Q_ROUND,
    Q_SIZE,
    Q_START,
    Q_TOLERANCE_U,
    Q_TURNS,
    X_MOVES,
)
from openacr.views import F64, I32

__all__ = ["queue_add", "queue_ahead", "queue_drop", "queue_speeds", "queue_travel"]

# Corner rules.
X_ANGLE1_DEG = X_MOVES
X_ANGLE2_DEG = X_MOVES + 1
X_SLOWEST_UPS = X_MOVES + 2
X_STEP_UPS = X_MOVES + 3  # largest velocity step of one axis, 0 = any
# At the end of the move before.
X_SPEED_UPS = X_MOVES + 4
X_ROUND = X_MOVES + 5
# Squared speeds of a move: between its corners, and before the last of them.
X_LINE2 = X_ROUND + K_SIZE
X_AHEAD2 = X_LINE2 + 1
# Phases of a move: length, and speeds at both ends.
X_PHASES = X_LINE2 + 2
P_LENGTH_U = 0
P_BEGIN_UPS = 1
P_END_UPS = 2
PHASE = 3
MOST_PHASES = 5
X_PLAN = X_PHASES + MOST_PHASES * PHASE  # numbers before these

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


def queue_angle(X: F64, Q: F64, i: int, j: int, feed: float) -> float:
    """The corner speed of G62: feed up to angle 1, then linearly to the slowest, 0 from angle 2.

    atan2 of the half-angle chords keeps full accuracy near 0 and 180 degrees, where acos of the
    dot product loses half the digits.
    """
    apart: float = 0.0
    along: float = 0.0
    for k in range(MOST_LINEAR):
        a: float = Q[i + Q_END + k]
        b: float = Q[j + Q_START + k]
        apart += (a - b) * (a - b)
        along += (a + b) * (a + b)
    turn: float = 2.0 * atan2(sqrt(apart), sqrt(along)) * DEGREES
    first: float = X[X_ANGLE1_DEG]
    second: float = X[X_ANGLE2_DEG]
    if (first == 0.0 and second == 0.0) or turn <= first:
        return feed
    if second > 0.0 and turn >= second:
        return 0.0
    slowest: float = X[X_SLOWEST_UPS] if X[X_SLOWEST_UPS] < feed else feed
    last: float = second if second > 0.0 else 180.0
    return feed - (feed - slowest) * (turn - first) / (last - first)


def queue_step(X: F64, Q: F64, i: int, j: int, feed: float) -> float:
    """The speed at which the velocity step of every axis is within Corner Step."""
    jump: float = 0.0
    for k in range(MOST_LINEAR):
        each: float = fabs(Q[i + Q_END + k] - Q[j + Q_START + k])
        jump = each if each > jump else jump
    for k in range(MOST_ROTARY):
        turned: float = fabs(Q[i + Q_TURNS + k] - Q[j + Q_TURNS + k])
        jump = turned if turned > jump else jump
    if jump > 0.0 and X[X_STEP_UPS] / jump < feed:
        feed = X[X_STEP_UPS] / jump
    return feed


def queue_corner(X: F64, Q: F64, i: int, j: int) -> float:
    """The highest speed at which the move in row i may pass into the one in row j."""
    if Q[i + Q_IS_RAPID] > 0.0 or Q[j + Q_IS_RAPID] > 0.0 or Q[i + Q_MODE] == EXACT:
        return 0.0
    if Q[i + Q_HAS_TANGENT] <= 0.0 or Q[j + Q_HAS_TANGENT] <= 0.0:
        return 0.0
    feed: float = Q[i + Q_FEED_UPS] if Q[i + Q_FEED_UPS] < Q[j + Q_FEED_UPS] else Q[j + Q_FEED_UPS]
    if Q[i + Q_MODE] == CORNER:
        feed = queue_angle(X, Q, i, j, feed)
    return queue_step(X, Q, i, j, feed) if X[X_STEP_UPS] > 0.0 else feed


def queue_join(X: F64, Q: F64, i: int, j: int) -> None:
    """Set the corner between two moves: its speed limit, and whether it is rounded."""
    has_tangents: bool = Q[i + Q_HAS_TANGENT] > 0.0 and Q[j + Q_HAS_TANGENT] > 0.0
    if not has_tangents or Q[i + Q_TOLERANCE_U] == 0.0 or Q[j + Q_TOLERANCE_U] == 0.0:
        Q[i + Q_CORNER_UPS] = queue_corner(X, Q, i, j)
        return
    Q[i + Q_IS_JOINED] = 1.0
    Q[i + Q_CORNER_UPS] = (
        Q[i + Q_FEED_UPS] if Q[i + Q_FEED_UPS] < Q[j + Q_FEED_UPS] else Q[j + Q_FEED_UPS]
    )
    square: float = 0.0
    for k in range(MOST_LINEAR):
        each: float = Q[j + Q_START + k] - Q[i + Q_END + k]
        square += each * each
    turn: float = sqrt(square)
    if turn <= STRAIGHT:
        return
    shorter: float = Q[i + Q_LENGTH_U]
    shorter = shorter if shorter < Q[j + Q_LENGTH_U] else Q[j + Q_LENGTH_U]
    reach: float = REACH * Q[i + Q_TOLERANCE_U] / turn
    reach = reach if reach < 0.5 * shorter else 0.5 * shorter
    ramp: float = Q[i + Q_RAMP_UPS2]
    ramp = ramp if ramp < Q[j + Q_RAMP_UPS2] else Q[j + Q_RAMP_UPS2]
    c: int = i + Q_ROUND
    Q[c + K_IS_ROUND] = 1.0
    Q[c + K_TURN] = turn
    Q[c + K_REACH_U] = reach
    Q[c + K_RAMP_UPS2] = ramp
    Q[c + K_CAP_UPS] = round_cap(turn, reach, ramp, NO_JERK)
    if Q[c + K_CAP_UPS] < Q[i + Q_CORNER_UPS]:
        Q[i + Q_CORNER_UPS] = Q[c + K_CAP_UPS]


def queue_before2(C: F64, c: int, w: float) -> float:
    """The highest squared speed at one end of half a corner whose other end has `w`."""
    cap2: float = C[c + K_CAP_UPS] * C[c + K_CAP_UPS]
    reached: float = round_ramp2(C[c + K_TURN], C[c + K_REACH_U], C[c + K_RAMP_UPS2], NO_JERK, w)
    return reached if reached < cap2 else cap2


def queue_pass2(C: F64, c: int, w: float, goal: float) -> float:
    """The squared speed after half a corner entered with `w` that may end with `goal`."""
    if goal <= w:
        return goal
    turn: float = C[c + K_TURN]
    reach: float = C[c + K_REACH_U]
    ramp: float = C[c + K_RAMP_UPS2]
    top: float = round_ramp2(turn, reach, ramp, NO_JERK, w)
    top = goal if goal < top else top
    end: float = w + 2.0 * round_brake(turn, reach, ramp, top) * reach
    return end if end < top else top


def queue_back(X: F64, Q: F64, i: int, C: F64, c: int) -> float:
    """Squared speed at the start of a move after the corner at C[c]; X gets those inside it."""
    top: float = Q[i + Q_FEED_UPS] * Q[i + Q_FEED_UPS]
    ramp: float = Q[i + Q_RAMP_UPS2]
    ahead: float = Q[i + Q_EXIT_UPS] * Q[i + Q_EXIT_UPS]
    ahead = ahead if ahead < top else top
    length: float = Q[i + Q_LENGTH_U]
    if Q[i + Q_ROUND + K_IS_ROUND] > 0.0:
        ahead = queue_before2(Q, i + Q_ROUND, ahead)
        ahead = ahead if ahead < top else top
        length = length - Q[i + Q_ROUND + K_REACH_U]
    X[X_AHEAD2] = ahead
    if C[c + K_IS_ROUND] <= 0.0:
        X[X_LINE2] = ahead + 2.0 * ramp * length
        return X[X_LINE2]
    cap2: float = C[c + K_CAP_UPS] * C[c + K_CAP_UPS]
    line: float = ahead + 2.0 * ramp * (length - C[c + K_REACH_U])
    line = line if line < top else top
    line = line if line < cap2 else cap2
    X[X_LINE2] = line
    return queue_before2(C, c, line)


def queue_brake(Q: F64, i: int) -> float:
    """The distance to brake from the feed of a move to rest; longer through rounded corners."""
    double: float = 1.0 if Q[i + Q_TOLERANCE_U] > 0.0 else 2.0
    return Q[i + Q_FEED_UPS] * Q[i + Q_FEED_UPS] / (double * Q[i + Q_RAMP_UPS2])


def queue_ahead(J: I32, Q: F64, B: F64) -> int:
    """The count of last moves that have to wait for the moves that follow.

    As many as needed to brake to rest, so that the speeds of released moves do not depend
    on unknown moves; never fewer than J_LEAST.
    """
    distance: float = 0.0
    last: int = J[J_HEAD] + J[J_COUNT] - 1
    for count in range(J[J_COUNT]):
        distance += Q[(last - count) * Q_SIZE + Q_LENGTH_U]
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
    Q[new + Q_CORNER_UPS] = 0.0
    Q[new + Q_IS_JOINED] = 0.0
    Q[new + Q_ROUND + K_IS_ROUND] = 0.0
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
    Q[i + Q_EXIT_UPS] = 0.0
    while i > first:
        after: int = i
        i -= Q_SIZE
        start2: float = 0.0
        if Q[i + Q_ROUND + K_IS_ROUND] > 0.0 or Q[after + Q_ROUND + K_IS_ROUND] > 0.0:
            start2 = queue_back(X, Q, after, Q, i + Q_ROUND)
        else:
            start2 = Q[after + Q_EXIT_UPS] * Q[after + Q_EXIT_UPS]
            start2 += 2.0 * Q[after + Q_RAMP_UPS2] * Q[after + Q_LENGTH_U]
        reach: float = sqrt(start2)
        Q[i + Q_EXIT_UPS] = Q[i + Q_CORNER_UPS] if Q[i + Q_CORNER_UPS] < reach else reach


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


def queue_phase(X: F64, n: int, length: float, begin: float, end: float) -> int:
    """Note a phase at constant acceleration; returns the number of the next."""
    p: int = X_PHASES + n * PHASE
    X[p + P_LENGTH_U] = length
    X[p + P_BEGIN_UPS] = begin
    X[p + P_END_UPS] = end
    return n + 1


def queue_travel(X: F64, Q: F64, i: int) -> int:
    """The phases of a planned move, after the moves before it; returns their count.

    Up to its peak speed, constant, down to its end; before and after that halves of corners.
    """
    a: float = Q[i + Q_RAMP_UPS2]
    left: float = Q[i + Q_LENGTH_U]
    feed: float = Q[i + Q_FEED_UPS]
    begin: float = X[X_SPEED_UPS] if X[X_SPEED_UPS] < feed else feed
    queue_back(X, Q, i, X, X_ROUND)
    count: int = 0
    if X[X_ROUND + K_IS_ROUND] > 0.0:
        line: float = sqrt(queue_pass2(X, X_ROUND, begin * begin, X[X_LINE2]))
        count = queue_phase(X, count, X[X_ROUND + K_REACH_U], begin, line)
        begin = line
        left -= X[X_ROUND + K_REACH_U]
    corner: int = i + Q_ROUND
    end: float = Q[i + Q_EXIT_UPS]
    leaves: bool = Q[corner + K_IS_ROUND] > 0.0
    if leaves:
        left -= Q[corner + K_REACH_U]
        end = sqrt(X[X_AHEAD2])
    reached: float = sqrt(begin * begin + 2.0 * a * left)
    end = end if end < reached else reached
    peak: float = sqrt(0.5 * (2.0 * a * left + begin * begin + end * end))
    peak = feed if feed < peak else peak
    up: float = (peak * peak - begin * begin) / (2.0 * a)
    down: float = (peak * peak - end * end) / (2.0 * a)
    rest: float = left - up - down
    count = queue_phase(X, count, up, begin, peak)
    count = queue_phase(X, count, rest if rest > 0.0 else 0.0, peak, peak)
    count = queue_phase(X, count, down, peak, end)
    if leaves:
        goal: float = Q[i + Q_EXIT_UPS] * Q[i + Q_EXIT_UPS]
        after: float = sqrt(queue_pass2(Q, corner, end * end, goal))
        count = queue_phase(X, count, Q[corner + K_REACH_U], end, after)
        end = after
    X[X_SPEED_UPS] = end
    for k in range(K_SIZE):
        X[X_ROUND + k] = Q[corner + k]
    return count
