"""Run time of moves from their planned speeds, many moves in one call.

Moves wait in a queue until those that follow them are known as far as braking to rest takes; then
their end speeds are final, and their times are added up (`planning_cy`, where the arrays are
explained; `X` and `J` are continued here).
"""

from openacr.mill.plan.moves.move_rows_cy import (
    ARC,
    AXES,
    J_FIRST,
    J_KIND,
    J_SECOND,
    Q_EXIT_UPS,
    Q_FILE,
    Q_IS_RAPID,
    Q_LENGTH_U,
    Q_LINE,
    Q_MODE,
    Q_SIZE,
    Q_WANTED_UPS,
    RAPID,
    X_BEGIN_U,
    X_CENTRE_U,
    X_CORNER_U,
    X_END_U,
    X_SWEEP_RAD,
    X_WANTED_UPS,
    move_is_flagged,
    move_radii,
    move_row,
)
from openacr.mill.plan.moves.planning_cy import (
    EXACT,
    J_COUNT,
    J_HEAD,
    J_PLAN,
    P_BEGIN_UPS,
    P_END_UPS,
    P_LENGTH_U,
    PHASE,
    X_PHASES,
    X_PLAN,
    queue_add,
    queue_ahead,
    queue_drop,
    queue_speeds,
    queue_travel,
)
from openacr.views import F64, I32

__all__ = ["forecast_add", "forecast_close", "forecast_moves", "forecast_release"]

# Results.
X_RAPID_S = X_PLAN
X_FEED_S = X_PLAN + 1
# The chain of feed moves up to rest or another feed.
X_CHAIN_FEED_UPS = X_PLAN + 2
X_CHAIN_TOP_UPS = X_PLAN + 3
X_CHAIN_LINE = X_PLAN + 4
X_CHAIN_FILE = X_PLAN + 5
# Chains that do not reach their feed: the first, and the slowest.
X_FIRST_LINE = X_PLAN + 6
X_FIRST_FILE = X_PLAN + 7
X_WORST_LINE = X_PLAN + 8
X_WORST_FILE = X_PLAN + 9
X_WORST_SHARE = X_PLAN + 10
X_SIZE = X_PLAN + 11

J_RELEASED = J_PLAN  # count of moves
J_CHAIN_CNT = J_PLAN + 1
J_SLOW_CNT = J_PLAN + 2  # moves of chains that do not reach their feed
J_ROWS = J_PLAN + 3  # count of moves that are to be planned
J_FILES = J_PLAN + 4  # of the texts that moves come from, and of elements that waited
MOST_FILES = 16
J_FLAGS = J_FILES + MOST_FILES  # the moves that are flagged

TOGETHER = 512  # moves planned at once
QUEUE = 10_000  # rows there is room for: MOST_AHEAD and TOGETHER, twice
REACHED = 0.999999  # of the feed; speeds of the plan are results of square roots
# A pace.
PACE_UPS = 0
PACE_MODE = 1
PACE_CORNER_U = 2
PACE_WANTED_UPS = 3  # F
PACE = 4
# A move in `rows`.
ROW_KIND = 0
ROW_LINE = 1
ROW_PACE = 2
ROW_PLANE = 3
ROW_FILE = 6
ROW = 8
# An arc: centre, sweep, radii of begin and end.
ARC_SWEEP_RAD = 2
ARC_RADII_U = 3
CURVE = 5
ZX = 18  # planes
YZ = 19


def forecast_add(J: I32, X: F64, Q: F64, B: F64) -> None:
    """Add the move in the row after the last one to the queue, which plans when it is due."""
    queue_add(J, X, Q, B)
    if J[J_COUNT] >= TOGETHER and J[J_COUNT] - queue_ahead(J, Q, B) >= TOGETHER:
        forecast_release(J, X, Q, B, False)


def forecast_close(J: I32, X: F64) -> None:
    """End a chain of feed moves; it is noted if it did not reach its feed."""
    count: int = J[J_CHAIN_CNT]
    J[J_CHAIN_CNT] = 0
    if count == 0 or X[X_CHAIN_TOP_UPS] >= REACHED * X[X_CHAIN_FEED_UPS]:
        return
    if J[J_SLOW_CNT] == 0:
        X[X_FIRST_LINE] = X[X_CHAIN_LINE]
        X[X_FIRST_FILE] = X[X_CHAIN_FILE]
    share: float = X[X_CHAIN_TOP_UPS] / X[X_CHAIN_FEED_UPS]
    if J[J_SLOW_CNT] == 0 or share < X[X_WORST_SHARE]:
        X[X_WORST_SHARE] = share
        X[X_WORST_LINE] = X[X_CHAIN_LINE]
        X[X_WORST_FILE] = X[X_CHAIN_FILE]
    J[J_SLOW_CNT] = J[J_SLOW_CNT] + count


def forecast_chain(J: I32, X: F64, Q: F64, i: int, top: float) -> None:
    """Add a feed move with its highest speed to its chain."""
    if J[J_CHAIN_CNT] == 0 or X[X_CHAIN_FEED_UPS] != Q[i + Q_WANTED_UPS]:
        forecast_close(J, X)
        X[X_CHAIN_FEED_UPS] = Q[i + Q_WANTED_UPS]
        X[X_CHAIN_TOP_UPS] = 0.0
        X[X_CHAIN_LINE] = Q[i + Q_LINE]
        X[X_CHAIN_FILE] = Q[i + Q_FILE]
    J[J_CHAIN_CNT] = J[J_CHAIN_CNT] + 1
    if top > X[X_CHAIN_TOP_UPS]:
        X[X_CHAIN_TOP_UPS] = top
    if Q[i + Q_EXIT_UPS] == 0.0:
        forecast_close(J, X)


def forecast_travel(J: I32, X: F64, Q: F64, i: int) -> None:
    """Add up the time of one planned move."""
    seconds: float = 0.0
    top: float = 0.0
    for n in range(queue_travel(X, Q, i)):
        p: int = X_PHASES + n * PHASE
        begin: float = X[p + P_BEGIN_UPS]
        end: float = X[p + P_END_UPS]
        top = begin if begin > top else top
        top = end if end > top else top
        if X[p + P_LENGTH_U] > 0.0:
            seconds += 2.0 * X[p + P_LENGTH_U] / (begin + end)
    J[J_RELEASED] = J[J_RELEASED] + 1
    if Q[i + Q_IS_RAPID] > 0.0:
        X[X_RAPID_S] = X[X_RAPID_S] + seconds
    else:
        X[X_FEED_S] = X[X_FEED_S] + seconds
        forecast_chain(J, X, Q, i, top)


def forecast_release(J: I32, X: F64, Q: F64, B: F64, is_complete: bool) -> None:
    """Add up the times of the moves whose end speeds are final; all, where none follow."""
    if J[J_COUNT] == 0:
        return
    queue_speeds(J, X, Q)
    count: int = J[J_COUNT]
    if not is_complete:
        count -= queue_ahead(J, Q, B)
    for k in range(count):
        forecast_travel(J, X, Q, (J[J_HEAD] + k) * Q_SIZE)
    queue_drop(J, Q, B, count)


def forecast_arc(J: I32, X: F64, plane: int, arcs: F64, a: int) -> float:
    """Take an arc in hand, whose end is there already; returns its larger radius."""
    J[J_FIRST] = 2 if plane == ZX else (1 if plane == YZ else 0)
    J[J_SECOND] = 0 if plane == ZX else (2 if plane == YZ else 1)
    X[X_CENTRE_U] = arcs[a]
    X[X_CENTRE_U + 1] = arcs[a + 1]
    X[X_SWEEP_RAD] = arcs[a + ARC_SWEEP_RAD]
    move_radii(J, X)
    begin: float = arcs[a + ARC_RADII_U]
    end: float = arcs[a + ARC_RADII_U + 1]
    return begin if begin > end else end


def forecast_moves(
    J: I32, X: F64, Q: F64, B: F64, rows: I32, ends: F64, arcs: F64, paces: F64
) -> int:
    """Plan J[J_ROWS] moves from the begin in X on; returns the count of those that are flagged."""
    flagged: int = 0
    for k in range(J[J_ROWS]):
        row: int = k * ROW
        kind: int = rows[row + ROW_KIND]
        pace: int = rows[row + ROW_PACE] * PACE
        q: int = (J[J_HEAD] + J[J_COUNT]) * Q_SIZE
        J[J_KIND] = kind
        X[X_WANTED_UPS] = paces[pace + PACE_UPS]
        X[X_CORNER_U] = paces[pace + PACE_CORNER_U]
        for axis in range(AXES):
            X[X_END_U + axis] = ends[k * AXES + axis]
        reach_u: float = 0.0
        if kind == ARC:
            reach_u = forecast_arc(J, X, rows[row + ROW_PLANE], arcs, k * CURVE)
        move_row(J, X, Q, q)
        if move_is_flagged(J, X, reach_u):
            J[J_FLAGS + flagged] = k
            flagged += 1
        for axis in range(AXES):
            X[X_BEGIN_U + axis] = X[X_END_U + axis]
        if Q[q + Q_LENGTH_U] > 0.0:
            Q[q + Q_MODE] = EXACT if kind == RAPID else paces[pace + PACE_MODE]
            Q[q + Q_WANTED_UPS] = 0.0 if kind == RAPID else paces[pace + PACE_WANTED_UPS]
            Q[q + Q_LINE] = float(rows[row + ROW_LINE])
            Q[q + Q_FILE] = float(J[J_FILES + rows[row + ROW_FILE]])
            forecast_add(J, X, Q, B)
    return flagged
