"""Run time of moves from their planned speeds, many moves in one call.

Moves wait in a queue until those that follow them are known as far as braking to rest takes; then
their end speeds are final, and their times are added up (`planning_cy`, where the arrays are
explained; `X` and `J` are continued here).
"""

from openacr.mill.plan.move_rows_cy import (
    AXES,
    Q_EXIT,
    Q_FILE,
    Q_IS_RAPID,
    Q_LENGTH,
    Q_LINE,
    Q_MODE,
    Q_SIZE,
    Q_WANTED,
    X_RAPID,
    move_row,
)
from openacr.mill.plan.planning_cy import (
    EXACT,
    J_COUNT,
    J_HEAD,
    J_PLAN,
    P_BEGIN,
    P_END,
    P_LENGTH,
    PHASE,
    X_PLAN,
    queue_add,
    queue_ahead,
    queue_drop,
    queue_speeds,
    queue_travel,
)
from openacr.views import F64, I32

__all__ = ["forecast_add", "forecast_close", "forecast_moves", "forecast_release"]

X_RAPID_S = X_PLAN  # results
X_FEED_S = X_PLAN + 1
X_CHAIN_FEED = X_PLAN + 2  # the chain of feed moves up to rest or another feed
X_CHAIN_TOP = X_PLAN + 3
X_CHAIN_LINE = X_PLAN + 4
X_CHAIN_FILE = X_PLAN + 5
X_FIRST_LINE = X_PLAN + 6  # chains that do not reach their feed: the first, and the slowest
X_FIRST_FILE = X_PLAN + 7
X_WORST_LINE = X_PLAN + 8
X_WORST_FILE = X_PLAN + 9
X_WORST_SHARE = X_PLAN + 10
X_SIZE = X_PLAN + 11

J_RELEASED = J_PLAN  # count of moves
J_CHAIN_CNT = J_PLAN + 1
J_SLOW_CNT = J_PLAN + 2  # moves of chains that do not reach their feed
J_FILES = J_PLAN + 3  # of the texts that moves come from, and of elements that waited
MOST_FILES = 16
J_SIZE = J_FILES + MOST_FILES

TOGETHER = 512  # moves planned at once
QUEUE = 10_000  # rows there is room for: MOST_AHEAD and TOGETHER, twice
REACHED = 0.999999  # of the feed; speeds of the plan are results of square roots
PACE = 4  # numbers of a pace: speed, mode, tolerance, F in units/s
ROW = 8  # of a move in `rows`
CURVE = 5


def forecast_add(J: I32, X: F64, Q: F64, B: F64, P: F64) -> None:
    """Add the move in the row after the last one to the queue, which plans when it is due."""
    queue_add(J, X, Q, B)
    if J[J_COUNT] >= TOGETHER and J[J_COUNT] - queue_ahead(J, Q, B) >= TOGETHER:
        forecast_release(J, X, Q, B, P, False)


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


def forecast_travel(J: I32, X: F64, Q: F64, i: int, P: F64) -> None:
    """Add up the time of one planned move."""
    seconds: float = 0.0
    top: float = 0.0
    for n in range(queue_travel(X, Q, i, P)):
        begin: float = P[n * PHASE + P_BEGIN]
        end: float = P[n * PHASE + P_END]
        top = begin if begin > top else top
        top = end if end > top else top
        if P[n * PHASE + P_LENGTH] > 0.0:
            seconds += 2.0 * P[n * PHASE + P_LENGTH] / (begin + end)
    J[J_RELEASED] = J[J_RELEASED] + 1
    if Q[i + Q_IS_RAPID] > 0.0:
        X[X_RAPID_S] = X[X_RAPID_S] + seconds
    else:
        X[X_FEED_S] = X[X_FEED_S] + seconds
        forecast_chain(J, X, Q, i, top)


def forecast_release(J: I32, X: F64, Q: F64, B: F64, P: F64, is_complete: bool) -> None:
    """Add up the times of the moves whose end speeds are final; all, where none follow."""
    if J[J_COUNT] == 0:
        return
    queue_speeds(J, X, Q)
    count: int = J[J_COUNT]
    if not is_complete:
        count -= queue_ahead(J, Q, B)
    for k in range(count):
        forecast_travel(J, X, Q, (J[J_HEAD] + k) * Q_SIZE, P)
    queue_drop(J, Q, B, count)


def forecast_moves(
    J: I32, X: F64, Y: F64, U: F64, Q: F64, B: F64, P: F64, begin: F64, rows: I32, ends: F64,
    arcs: F64, paces: F64, count: int, flags: I32
) -> int:  # fmt: skip
    """Plan moves from `begin` on, which moves along; returns the count of rows flagged."""
    flagged: int = 0
    for k in range(count):
        kind: int = rows[k * ROW]
        pace: int = rows[k * ROW + 2] * PACE
        q: int = (J[J_HEAD] + J[J_COUNT]) * Q_SIZE
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
            forecast_add(J, X, Q, B, P)
    return flagged
