"""Run time of moves from their planned speeds, many moves in one call.

The same as `planning` and `predicting`, where the formulas are explained: moves wait in a queue
until those that follow them are known as far as braking to rest takes; then their end speeds are
final, and their times are added up.

`Q`: the rows of the queue (`move_rows_cy`), `B` the longest braking distances of the queue, each
from one move on, in falling order; `X` and `J`: numbers and counts, continued from `move_rows_cy`.
"""

from openacr.cmath import atan2, fabs, sqrt
from openacr.kernel.path.round_law_cy import (
    STRAIGHT,
    round_brake,
    round_cap,
    round_limit,
    round_ramp2,
)
from openacr.mill.plan.move_rows_cy import (
    AXES,
    Q_CAP,
    Q_CORNER,
    Q_END,
    Q_EXIT,
    Q_FEED,
    Q_FILE,
    Q_HAS_TANGENT,
    Q_IS_RAPID,
    Q_IS_ROUND,
    Q_LENGTH,
    Q_LINE,
    Q_MODE,
    Q_RAMP,
    Q_REACH,
    Q_ROTATION,
    Q_SIZE,
    Q_START,
    Q_TOLERANCE,
    Q_TURN,
    Q_WANTED,
    X_MOVES,
    X_RAPID,
    move_row,
)
from openacr.views import F64, I32

__all__ = ["forecast_add", "forecast_close", "forecast_moves", "forecast_release"]

X_ANGLE1 = X_MOVES  # corner rules
X_ANGLE2 = X_MOVES + 1
X_SLOWEST = X_MOVES + 2
X_STEP = X_MOVES + 3
X_SPEED = X_MOVES + 4  # at the end of the moves released
X_IS_ROUND = X_MOVES + 5  # the corner there
X_TURN = X_MOVES + 6
X_REACH = X_MOVES + 7
X_CAP = X_MOVES + 8
X_RAPID_S = X_MOVES + 9  # results
X_FEED_S = X_MOVES + 10
X_CHAIN_FEED = X_MOVES + 11  # the chain of feed moves up to rest or another feed
X_CHAIN_TOP = X_MOVES + 12
X_CHAIN_LINE = X_MOVES + 13
X_CHAIN_FILE = X_MOVES + 14
X_FIRST_LINE = X_MOVES + 15  # chains that do not reach their feed: the first, and the slowest
X_FIRST_FILE = X_MOVES + 16
X_WORST_LINE = X_MOVES + 17
X_WORST_FILE = X_MOVES + 18
X_WORST_SHARE = X_MOVES + 19
X_LINE2 = X_MOVES + 20  # scratch: squared speeds of a move
X_AHEAD2 = X_MOVES + 21
X_SIZE = X_MOVES + 22

J_COUNT = 2  # moves in the queue
J_BRAKE_HEAD = 3  # of B
J_BRAKE_END = 4
J_LEAST = 5  # moves kept at least
J_MOVES = 6  # moves released
J_CHAIN_CNT = 7
J_SLOW_CNT = 8  # moves of chains that do not reach their feed
J_FILES = 9  # of the texts that moves come from, and of elements that waited
MOST_FILES = 16
J_SIZE = J_FILES + MOST_FILES

EXACT = 1.0  # modes; others pass corners at their feed
CORNER = 2.0
MOST_AHEAD = 4000
TOGETHER = 512  # moves planned at once
QUEUE = 5000  # rows there is room for
REACH = 4.0  # of a rounded corner, per tolerance and change of direction
REACHED = 0.999999  # of the feed; speeds of the plan are results of square roots
DEGREES = 57.29577951308232
LINEAR = 5
ROTARY = 3
PACE = 4  # numbers of a pace: speed, mode, tolerance, F in units/s
ROW = 8  # of a move in `rows`
CURVE = 5
ENDLESS = 1.0e300


def forecast_angle(X: F64, Q: F64, i: int, j: int, feed: float) -> float:
    """The corner speed of G62."""
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


def forecast_corner(X: F64, Q: F64, i: int, j: int) -> float:
    """The highest speed from the move in row i to the one in row j."""
    if Q[i + Q_IS_RAPID] > 0.0 or Q[j + Q_IS_RAPID] > 0.0 or Q[i + Q_MODE] == EXACT:
        return 0.0
    if Q[i + Q_HAS_TANGENT] <= 0.0 or Q[j + Q_HAS_TANGENT] <= 0.0:
        return 0.0
    feed: float = Q[i + Q_FEED] if Q[i + Q_FEED] < Q[j + Q_FEED] else Q[j + Q_FEED]
    if Q[i + Q_MODE] == CORNER:
        feed = forecast_angle(X, Q, i, j, feed)
    if X[X_STEP] <= 0.0:
        return feed
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


def forecast_join(X: F64, Q: F64, i: int, j: int) -> None:
    """Set the corner between two moves."""
    Q[i + Q_IS_ROUND] = 0.0
    has_tangents: bool = Q[i + Q_HAS_TANGENT] > 0.0 and Q[j + Q_HAS_TANGENT] > 0.0
    if not has_tangents or Q[i + Q_TOLERANCE] == 0.0 or Q[j + Q_TOLERANCE] == 0.0:
        Q[i + Q_CORNER] = forecast_corner(X, Q, i, j)
        return
    Q[i + Q_CORNER] = Q[i + Q_FEED] if Q[i + Q_FEED] < Q[j + Q_FEED] else Q[j + Q_FEED]
    square: float = 0.0
    for k in range(LINEAR):
        each: float = Q[j + Q_START + k] - Q[i + Q_END + k]
        square += each * each
    turn: float = sqrt(square)
    if turn <= STRAIGHT:
        return
    shorter: float = Q[i + Q_LENGTH] if Q[i + Q_LENGTH] < Q[j + Q_LENGTH] else Q[j + Q_LENGTH]
    ramp: float = Q[i + Q_RAMP] if Q[i + Q_RAMP] < Q[j + Q_RAMP] else Q[j + Q_RAMP]
    reach: float = REACH * Q[i + Q_TOLERANCE] / turn
    reach = 0.5 * shorter if 0.5 * shorter < reach else reach
    Q[i + Q_IS_ROUND] = 1.0
    Q[i + Q_TURN] = turn
    Q[i + Q_REACH] = reach
    Q[i + Q_CAP] = round_cap(turn, reach, ramp, 0.0)
    if Q[i + Q_CAP] < Q[i + Q_CORNER]:
        Q[i + Q_CORNER] = Q[i + Q_CAP]


def forecast_before2(turn: float, reach: float, cap: float, w: float) -> float:
    """The highest squared speed at one end of half a corner whose other end has `w`."""
    ramp: float = round_limit(turn, reach, cap, 0.0, 0.0)
    reached: float = round_ramp2(turn, reach, ramp, 0.0, w)
    return reached if reached < cap * cap else cap * cap


def forecast_pass2(turn: float, reach: float, cap: float, w: float, goal: float) -> float:
    """The squared speed after half a corner entered with `w` that may end with `goal`."""
    if goal <= w:
        return goal
    ramp: float = round_limit(turn, reach, cap, 0.0, 0.0)
    top: float = round_ramp2(turn, reach, ramp, 0.0, w)
    top = goal if goal < top else top
    rate: float = round_brake(turn, reach, ramp, top)
    end: float = w + 2.0 * rate * reach
    return end if end < top else top


def forecast_back(
    X: F64, Q: F64, i: int, is_round: bool, turn: float, reach: float, cap: float
) -> float:
    """Squared speed at the start of a move after this corner; X gets those inside it."""
    top: float = Q[i + Q_FEED] * Q[i + Q_FEED]
    ramp: float = Q[i + Q_RAMP]
    ahead: float = Q[i + Q_EXIT] * Q[i + Q_EXIT]
    ahead = ahead if ahead < top else top
    length: float = Q[i + Q_LENGTH]
    if Q[i + Q_IS_ROUND] > 0.0:
        ahead = forecast_before2(Q[i + Q_TURN], Q[i + Q_REACH], Q[i + Q_CAP], ahead)
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
    return forecast_before2(turn, reach, cap, line)


def forecast_brake(Q: F64, i: int) -> float:
    """The distance to brake from the feed of a move to rest."""
    double: float = 1.0 if Q[i + Q_TOLERANCE] > 0.0 else 2.0
    return Q[i + Q_FEED] * Q[i + Q_FEED] / (double * Q[i + Q_RAMP])


def forecast_ahead(J: I32, Q: F64, B: F64) -> int:
    """The count of last moves that have to wait for the moves that follow."""
    brake: float = B[J[J_BRAKE_HEAD]]
    distance: float = 0.0
    count: int = 0
    while count < J[J_COUNT]:
        distance += Q[(J[J_COUNT] - 1 - count) * Q_SIZE + Q_LENGTH]
        count += 1
        if (distance >= brake and count >= J[J_LEAST]) or count >= MOST_AHEAD:
            return count
    return count


def forecast_add(J: I32, X: F64, Q: F64, B: F64) -> None:
    """Add the move in the row after the last one to the queue, which plans when it is due."""
    new: int = J[J_COUNT] * Q_SIZE
    if J[J_COUNT]:
        forecast_join(X, Q, new - Q_SIZE, new)
    Q[new + Q_IS_ROUND] = 0.0
    Q[new + Q_CORNER] = 0.0
    J[J_COUNT] = J[J_COUNT] + 1
    brake: float = forecast_brake(Q, new)
    while J[J_BRAKE_END] > J[J_BRAKE_HEAD] and B[J[J_BRAKE_END] - 1] < brake:
        J[J_BRAKE_END] = J[J_BRAKE_END] - 1
    B[J[J_BRAKE_END]] = brake
    J[J_BRAKE_END] = J[J_BRAKE_END] + 1
    if J[J_COUNT] >= TOGETHER and J[J_COUNT] - forecast_ahead(J, Q, B) >= TOGETHER:
        forecast_release(J, X, Q, B, False)


def forecast_plan(J: I32, X: F64, Q: F64) -> None:
    """Set the end speed of every move in the queue."""
    i: int = (J[J_COUNT] - 1) * Q_SIZE
    Q[i + Q_EXIT] = 0.0
    while i > 0:
        after: int = i
        i -= Q_SIZE
        is_round: bool = Q[i + Q_IS_ROUND] > 0.0
        start2: float = forecast_back(
            X, Q, after, is_round, Q[i + Q_TURN], Q[i + Q_REACH], Q[i + Q_CAP]
        )
        if not is_round and Q[after + Q_IS_ROUND] <= 0.0:
            start2 = Q[after + Q_EXIT] * Q[after + Q_EXIT]
            start2 += 2.0 * Q[after + Q_RAMP] * Q[after + Q_LENGTH]
        reach: float = sqrt(start2)
        Q[i + Q_EXIT] = Q[i + Q_CORNER] if Q[i + Q_CORNER] < reach else reach


def forecast_close(J: I32, X: F64) -> None:
    """End a chain of feed moves; it is noted if it did not reach its feed."""
    count: int = J[J_CHAIN_CNT]
    J[J_CHAIN_CNT] = 0
    if count == 0 or X[X_CHAIN_TOP] >= REACHED * X[X_CHAIN_FEED]:
        return
    if J[J_SLOW_CNT] == 0:
        X[X_FIRST_LINE] = X[X_CHAIN_LINE]
        X[X_FIRST_FILE] = X[X_CHAIN_FILE]
    share: float = X[X_CHAIN_TOP] / X[X_CHAIN_FEED]
    if J[J_SLOW_CNT] == 0 or share < X[X_WORST_SHARE]:
        X[X_WORST_SHARE] = share
        X[X_WORST_LINE] = X[X_CHAIN_LINE]
        X[X_WORST_FILE] = X[X_CHAIN_FILE]
    J[J_SLOW_CNT] = J[J_SLOW_CNT] + count


def forecast_chain(J: I32, X: F64, Q: F64, i: int, top: float) -> None:
    """Add a feed move with its highest speed to its chain."""
    if J[J_CHAIN_CNT] == 0 or X[X_CHAIN_FEED] != Q[i + Q_WANTED]:
        forecast_close(J, X)
        X[X_CHAIN_FEED] = Q[i + Q_WANTED]
        X[X_CHAIN_TOP] = 0.0
        X[X_CHAIN_LINE] = Q[i + Q_LINE]
        X[X_CHAIN_FILE] = Q[i + Q_FILE]
    J[J_CHAIN_CNT] = J[J_CHAIN_CNT] + 1
    if top > X[X_CHAIN_TOP]:
        X[X_CHAIN_TOP] = top
    if Q[i + Q_EXIT] == 0.0:
        forecast_close(J, X)


def forecast_phase(length: float, begin: float, end: float) -> float:
    """The time of one phase at constant acceleration."""
    return 2.0 * length / (begin + end) if length > 0.0 else 0.0


def forecast_travel(J: I32, X: F64, Q: F64, i: int) -> None:
    """Add up the time of one planned move."""
    a: float = Q[i + Q_RAMP]
    left: float = Q[i + Q_LENGTH]
    feed: float = Q[i + Q_FEED]
    begin: float = X[X_SPEED] if X[X_SPEED] < feed else feed
    enters: bool = X[X_IS_ROUND] > 0.0
    forecast_back(X, Q, i, enters, X[X_TURN], X[X_REACH], X[X_CAP])
    seconds: float = 0.0
    top: float = begin
    if enters:
        line: float = sqrt(
            forecast_pass2(X[X_TURN], X[X_REACH], X[X_CAP], begin * begin, X[X_LINE2])
        )
        seconds = forecast_phase(X[X_REACH], begin, line)
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
    seconds += forecast_phase(up, begin, peak)
    seconds += forecast_phase(rest if rest > 0.0 else 0.0, peak, peak)
    seconds += forecast_phase(down, peak, end)
    top = begin if begin > top else top
    top = peak if peak > top else top
    top = end if end > top else top
    if leaves:
        goal: float = Q[i + Q_EXIT] * Q[i + Q_EXIT]
        after: float = sqrt(
            forecast_pass2(Q[i + Q_TURN], Q[i + Q_REACH], Q[i + Q_CAP], end * end, goal)
        )
        seconds += forecast_phase(Q[i + Q_REACH], end, after)
        end = after
        top = end if end > top else top
    X[X_SPEED] = end
    X[X_IS_ROUND] = Q[i + Q_IS_ROUND]
    X[X_TURN] = Q[i + Q_TURN]
    X[X_REACH] = Q[i + Q_REACH]
    X[X_CAP] = Q[i + Q_CAP]
    J[J_MOVES] = J[J_MOVES] + 1
    if Q[i + Q_IS_RAPID] > 0.0:
        X[X_RAPID_S] = X[X_RAPID_S] + seconds
    else:
        X[X_FEED_S] = X[X_FEED_S] + seconds
        forecast_chain(J, X, Q, i, top)


def forecast_release(J: I32, X: F64, Q: F64, B: F64, is_complete: bool) -> None:
    """Add up the times of the moves whose end speeds are final; all, where none follow."""
    if J[J_COUNT] == 0:
        return
    forecast_plan(J, X, Q)
    count: int = J[J_COUNT]
    if not is_complete:
        count -= forecast_ahead(J, Q, B)
    for k in range(count):
        if B[J[J_BRAKE_HEAD]] == forecast_brake(Q, k * Q_SIZE):
            J[J_BRAKE_HEAD] = J[J_BRAKE_HEAD] + 1
        forecast_travel(J, X, Q, k * Q_SIZE)
    left: int = J[J_COUNT] - count
    for n in range(left * Q_SIZE):
        Q[n] = Q[count * Q_SIZE + n]
    J[J_COUNT] = left
    brakes: int = J[J_BRAKE_END] - J[J_BRAKE_HEAD]
    for n in range(brakes):
        B[n] = B[J[J_BRAKE_HEAD] + n]
    J[J_BRAKE_HEAD] = 0
    J[J_BRAKE_END] = brakes


def forecast_moves(
    J: I32, X: F64, Y: F64, U: F64, Q: F64, B: F64, begin: F64, rows: I32, ends: F64, arcs: F64,
    paces: F64, count: int, flags: I32
) -> int:  # fmt: skip
    """Plan moves from `begin` on, which moves along; returns the count of rows flagged."""
    flagged: int = 0
    for k in range(count):
        kind: int = rows[k * ROW]
        pace: int = rows[k * ROW + 2] * PACE
        q: int = J[J_COUNT] * Q_SIZE
        wanted: float = paces[pace] if kind > 0 else X[X_RAPID]
        at: int = k * AXES
        if move_row(
            J, X, Y, U, Q, q, begin, kind, rows[k * ROW + 3], ends, at, arcs, k * CURVE, wanted,
            paces[pace + 2],
        ):  # fmt: skip
            flags[flagged] = k
            flagged += 1
        for axis in range(AXES):
            begin[axis] = ends[at + axis]
        if Q[q + Q_LENGTH] > 0.0:
            Q[q + Q_MODE] = paces[pace + 1] if kind > 0 else EXACT
            Q[q + Q_WANTED] = paces[pace + 3] if kind > 0 else 0.0
            Q[q + Q_LINE] = float(rows[k * ROW + 1])
            Q[q + Q_FILE] = float(J[J_FILES + rows[k * ROW + 6]])
            forecast_add(J, X, Q, B)
    return flagged
