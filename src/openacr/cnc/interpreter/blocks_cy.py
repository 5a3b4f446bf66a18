"""Blocks executed many at a time: modal codes, feeds, straight moves and arcs.

A step of a plan (`run_rows_cy`) sets a row of the modal state, takes F, computes (`values_cy`), or
moves as the motion in force does:

    position  p = word * times / per          + p in G91; rotary words as they are
    target    p + shift                       a row is written where the machine moves

A line that cannot be executed so - its values are wrong or doubtful, or nothing says how - is
left with the state from before it: the parser reads it again, and says what is wrong.
"""

from openacr.cmath import floor
from openacr.cnc.geometry.arc_cy import (
    A_CX,
    A_CY,
    A_R0,
    A_R1,
    A_SWEEP,
    A_X0,
    A_X1,
    A_Y0,
    A_Y1,
    ARC_DONE,
    arc_about,
    arc_centre,
    arc_is_near,
    plane_first,
    plane_second,
)
from openacr.cnc.interpreter.run_rows_cy import (
    A_END,
    A_TARGET,
    ARC,
    ARC_BITS,
    BIT_R,
    CENTRE_BITS,
    CURVE,
    INCH,
    INCREMENTAL,
    K_LETTER,
    LEFT,
    LETTER_F,
    LETTER_I,
    LETTER_R,
    M_AT,
    M_CENTRES,
    M_COMPENSATION,
    M_CYCLE,
    M_DISTANCE,
    M_HAS_FEED,
    M_HAS_TURNED,
    M_IDLE,
    M_IS_PLAIN,
    M_IS_SHIFTED,
    M_KEEP,
    M_KEPT,
    M_MOTION,
    M_PACE,
    M_PLANE,
    M_ROWS,
    NO_CYCLE,
    NOTE,
    OFF,
    P_AXES,
    P_WORDS,
    R_FLAGS,
    R_KIND,
    R_LINE,
    R_PACE,
    R_PLANE,
    R_START,
    R_STOP,
    R_TEXT,
    ROW,
    STEP_BAR,
    STEP_KEEP,
    STEP_NOTE,
    STEP_TURN,
    STEP_UNIT,
    TAKEN,
    W_EPSILON,
    W_FEED,
    W_KEPT,
    W_LIMITS,
    W_NEAR,
    W_PER,
    W_POSITION,
    W_SHIFT,
    W_TARGET,
    W_TIMES,
    W_UNITS,
)
from openacr.cnc.reading.scan_cy import AXES, K_ROTARY, W_WORDS
from openacr.views import F64, I32


def block_keep(W: F64, M: I32) -> None:
    """Keep the state from before a line."""
    for k in range(M_KEEP):
        M[M_KEPT + k] = M[k]
    W[W_KEPT] = W[W_TIMES]
    W[W_KEPT + 1] = W[W_PER]
    W[W_KEPT + 2] = W[W_FEED]


def block_restore(W: F64, M: I32, paces: F64) -> None:
    """Go back to the state from before a line."""
    for k in range(M_KEEP):
        M[k] = M[M_KEPT + k]
    W[W_TIMES] = W[W_KEPT]
    W[W_PER] = W[W_KEPT + 1]
    W[W_FEED] = W[W_KEPT + 2]
    paces[M[M_PACE]] = W[W_FEED]


def block_length(W: F64, value: float) -> float:
    """A length in active units, in default units."""
    return value * W[W_TIMES] / W[W_PER]


def block_row(M: I32, R: I32, kind: int) -> int:
    """Add a row; returns its number. There is room for it."""
    row: int = M[M_ROWS]
    at: int = row * ROW
    R[at + R_KIND] = kind
    R[at + R_LINE] = M[M_AT]
    R[at + R_PACE] = M[M_PACE]
    R[at + R_PLANE] = M[M_PLANE]
    R[at + R_START] = M[M_AT + 1]
    R[at + R_STOP] = M[M_AT + 2]
    R[at + R_TEXT] = M[M_AT + 3]
    R[at + R_FLAGS] = 0
    M[M_ROWS] = row + 1
    return row


def block_note(W: F64, P: I32, plan: int, at: int, M: I32, R: I32, ends: F64) -> int:
    """Note the words of a code whose handler is called in its place between the moves."""
    row: int = block_row(M, R, NOTE)
    R[row * ROW + R_PLANE] = P[at + 1]
    letters: int = plan + P[at + 2]
    for k in range(P[letters]):
        ends[row * AXES + k] = W[W_WORDS + P[letters + 1 + k]]
    if P[at] == STEP_NOTE:
        M[M_IDLE] = 0
    if P[at] == STEP_TURN:
        M[M_HAS_TURNED] = 1
    return TAKEN


def block_limit(W: F64, letter: int, limit: int) -> int:
    """Leave a block whose word is out of its limits, or has to be whole and is not."""
    value: float = W[W_WORDS + letter]
    at: int = W_LIMITS + 3 * limit
    if value < W[at] or value > W[at + 1]:
        return LEFT
    return LEFT if W[at + 2] != 0.0 and floor(value) != value else TAKEN


def block_set(W: F64, M: I32, step: int, row: int, value: int) -> int:
    """Set a row of the modal state."""
    if M[row] != value:
        if step == STEP_KEEP or (step == STEP_BAR and M[M_CYCLE] != NO_CYCLE):
            return LEFT
        if step == STEP_BAR and M[M_COMPENSATION] != OFF:
            return LEFT
    M[row] = value
    if step == STEP_UNIT:
        units: int = W_UNITS if value == INCH else W_UNITS + 2
        W[W_TIMES] = W[units]
        W[W_PER] = W[units + 1]
    return TAKEN


def block_feed(W: F64, M: I32, R: I32, paces: F64) -> int:
    """Take F; rows before have a pace of their own."""
    rows: int = M[M_ROWS]
    if W[W_WORDS + LETTER_F] <= 0.0:
        return LEFT
    feed: float = block_length(W, W[W_WORDS + LETTER_F])
    M[M_HAS_FEED] = 1
    if feed != W[W_FEED]:
        if rows > 0 and M[M_IS_PLAIN]:
            return LEFT
        if rows > 0 and R[(rows - 1) * ROW + R_PACE] == M[M_PACE]:
            M[M_PACE] = M[M_PACE] + 1
        W[W_FEED] = feed
        paces[M[M_PACE]] = feed
    return TAKEN


def block_end(W: F64, K: I32, M: I32, A: F64, named: int) -> None:
    """Find the program point a block goes to."""
    for axis in range(AXES):
        at: float = W[W_POSITION + axis]
        if named & (1 << axis):
            value: float = W[W_WORDS + K[K_LETTER + axis]]
            if not K[K_ROTARY] & (1 << axis):
                value = block_length(W, value)
            at = at + value if M[M_DISTANCE] == INCREMENTAL else value
        A[A_END + axis] = at


def block_target(W: F64, M: I32, A: F64) -> bool:
    """Find the machine point of that point; returns whether the machine moves."""
    moves: bool = False
    for axis in range(AXES):
        at: float = A[A_END + axis]
        if M[M_IS_SHIFTED]:
            at = at + W[W_SHIFT + axis]
        A[A_TARGET + axis] = at
        if at != W[W_TARGET + axis]:
            moves = True
    return moves


def block_go(W: F64, M: I32, A: F64, ends: F64, R: I32, kind: int) -> int:
    """Add a move to the point that was found; returns its row."""
    row: int = block_row(M, R, kind)
    for axis in range(AXES):
        W[W_TARGET + axis] = A[A_TARGET + axis]
        ends[row * AXES + axis] = A[A_TARGET + axis]
    M[M_IDLE] = 0
    return row


def block_straight(W: F64, M: I32, A: F64, ends: F64, R: I32, kind: int) -> None:
    """Go straight to the program point in A; a row is written where the machine moves."""
    if block_target(W, M, A) or M[M_COMPENSATION] != OFF:
        block_go(W, M, A, ends, R, kind)
    for axis in range(AXES):
        W[W_POSITION + axis] = A[A_END + axis]


def block_centre(W: F64, M: I32, axis: int, words: int) -> float:
    """One coordinate of the centre by I, J or K."""
    start: float = W[W_POSITION + axis]
    if not words & (1 << axis):
        return start
    length: float = block_length(W, W[W_WORDS + LETTER_I + axis])
    if M[M_CENTRES] == 2:
        return length
    return start + length if M[M_CENTRES] == 1 else start - length


def block_arc(W: F64, M: I32, A: F64, arcs: F64, row: int, words: int) -> int:
    """Find the arc to the end of a block; LEFT if it is wrong or doubtful."""
    first: int = plane_first(M[M_PLANE])
    second: int = plane_second(M[M_PLANE])
    direction: int = -1 if M[M_MOTION] == 2 else 1
    A[A_X0] = W[W_POSITION + first]
    A[A_Y0] = W[W_POSITION + second]
    A[A_X1] = A[A_END + first]
    A[A_Y1] = A[A_END + second]
    if words & BIT_R:
        radius: float = block_length(W, W[W_WORDS + LETTER_R])
        if words & CENTRE_BITS or arc_centre(A, radius, direction, W[W_EPSILON]) != ARC_DONE:
            return LEFT
    else:
        if words == 0 or words & (1 << (3 - first - second)):
            return LEFT
        A[A_CX] = block_centre(W, M, first, words)
        A[A_CY] = block_centre(W, M, second, words)
    if arc_about(A, direction) != ARC_DONE or not arc_is_near(A[A_R0], A[A_R1], W[W_NEAR]):
        return LEFT
    at: int = row * CURVE
    arcs[at] = A[A_CX] + W[W_SHIFT + first]
    arcs[at + 1] = A[A_CY] + W[W_SHIFT + second]
    arcs[at + 2] = A[A_SWEEP]
    arcs[at + 3] = A[A_R0]
    arcs[at + 4] = A[A_R1]
    return TAKEN


def block_move(
    W: F64, K: I32, P: I32, plan: int, M: I32, A: F64, ends: F64, arcs: F64, R: I32
) -> int:  # fmt: skip
    """Move as the motion in force does; a row is written where the machine moves."""
    words: int = P[plan + P_WORDS]
    motion: int = M[M_MOTION]
    block_end(W, K, M, A, P[plan + P_AXES])
    if motion == 0 or motion == 1:
        if words:
            return LEFT
        block_straight(W, M, A, ends, R, motion)
        return TAKEN
    if (motion != 2 and motion != 3) or words > ARC_BITS:
        return LEFT
    if block_arc(W, M, A, arcs, M[M_ROWS], words) == LEFT:
        return LEFT
    block_target(W, M, A)
    block_go(W, M, A, ends, R, ARC)
    for axis in range(AXES):
        W[W_POSITION + axis] = A[A_END + axis]
    return TAKEN
