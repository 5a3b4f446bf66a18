"""Blocks executed many at a time: modal codes, feeds, straight moves and arcs.

Each line has a shape (`scan_cy`), and each shape a plan in `P`, made once by Python:

    axes named (mask), I J K R (mask 1 2 4 8), PLAIN, ALONE, count of steps, steps of 3 numbers

A step sets a row of the modal state `M`, takes F, computes (`values_cy`), or moves as the motion
in force does:

    position  p = word * times / per          + p in G91; rotary words as they are
    target    p + shift                       a row is written where the machine moves

A line that cannot be executed so - its values are wrong or doubtful, or nothing says how - is
left with the state from before it: the parser reads it again, and says what is wrong.

`R`: ROW numbers of each move, `ends`: its target, `arcs`: centre, sweep, radii. `A`: one arc
(`arc_cy`), then the point a block goes to. `W` and `K` as in `scan_cy`, continued here.
"""

from openacr.cnc.geometry.arc_cy import (
    A_CX,
    A_CY,
    A_R0,
    A_R1,
    A_SIZE,
    A_SWEEP,
    A_X0,
    A_X1,
    A_Y0,
    A_Y1,
    ARC_DONE,
    arc_about,
    arc_centre,
    arc_is_near,
)
from openacr.cnc.reading.rich_cy import K_RICH_SIZE
from openacr.cnc.reading.scan_cy import (
    AXES,
    K_ROTARY,
    W_SCAN_SIZE,
    W_WORDS,
)
from openacr.views import F64, I32

K_LETTER = K_RICH_SIZE  # the letter of each axis
K_LAST_LINE = K_LETTER + AXES  # number of the last line that was read
K_READ = K_LETTER + AXES + 1  # count of lines read
K_FIRST = K_LETTER + AXES + 2  # place of the data in the text
K_JUMPS = K_LETTER + AXES + 3  # count of jumps
K_RUN_SIZE = K_LETTER + AXES + 4

W_POSITION = W_SCAN_SIZE  # program position, default units
W_TARGET = W_POSITION + 8  # machine position
W_SHIFT = W_POSITION + 16  # from one to the other
W_TIMES = W_POSITION + 24  # active unit to default unit
W_PER = W_POSITION + 25
W_UNITS = W_POSITION + 26  # times and per of G20, then of G21
W_FEED = W_POSITION + 30  # in force, default units
W_NEAR = W_POSITION + 31  # radii are equal within it
W_EPSILON = W_POSITION + 32  # a chord may be longer than two radii by it
W_KEPT = W_POSITION + 33  # times, per and feed from before the line
W_RUN_SIZE = W_POSITION + 36

# Rows of the modal state, and what belongs to the run.
M_MOTION = 0
M_PLANE = 1
M_DISTANCE = 2
M_CENTRES = 3
M_UNIT = 4
M_RETURN = 5
M_PATH = 6
M_FIELDS = 7
M_PACE = 7  # of the next move
M_HAS_FEED = 8
M_IDLE = 9  # blocks since the last move
M_KEEP = 10  # rows that are restored where a line is left
M_KEPT = 10  # the same from before the line
M_IS_SHIFTED = 20
M_IS_PLAIN = 21  # only straight feed moves of one pace are taken
M_LINE = 22  # of the first line
M_HAS_VALUES = 23  # cells can be read and written here
M_MOST_PASSES = 24  # of a jump; 0: jumps are not counted
M_SIZE = 25

P_AXES = 0
P_WORDS = 1
P_IS_PLAIN = 2
P_IS_ALONE = 3
P_STEPS = 4
P_FIRST = 5

STEP_SET = 0  # row, value
STEP_UNIT = 1  # the same, and the factors of the unit
STEP_FEED = 2
STEP_MOVE = 3
STEP_WORD = 4  # letter, formula
STEP_VALUE = 5  # slot, formula
STEP_STORE = 6  # kind, slot
STEP_JUMP = 7  # JUMP_..., formula or 0
JUMP_COUNTS = 1
JUMP_IF_TRUE = 2  # else where it is false

R_KIND = 0
R_LINE = 1
R_PACE = 2
R_PLANE = 3
R_START = 4  # of its line
R_STOP = 5
ROW = 6
CURVE = 5  # numbers of an arc

RAPID = 0
LINE = 1
ARC = 2

TAKEN = 0
MOVED = 1
LEFT = 2
JUMPED = 3

INCREMENTAL = 91
INCH = 20
ZX = 18
YZ = 19
MOST_IDLE = 100_000
LETTER_F = 5
LETTER_I = 8
LETTER_R = 17
BIT_R = 8
CENTRE_BITS = 7

A_END = A_SIZE  # the program point a block goes to
A_TARGET = A_SIZE + 8
A_RUN_SIZE = A_SIZE + 16


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


def block_feed(W: F64, M: I32, R: I32, paces: F64, rows: int) -> int:
    """Take F; rows before have a pace of their own."""
    if W[W_WORDS + LETTER_F] <= 0.0:
        return LEFT
    feed: float = W[W_WORDS + LETTER_F] * W[W_TIMES] / W[W_PER]
    M[M_HAS_FEED] = 1
    if feed != W[W_FEED]:
        if rows > 0 and M[M_IS_PLAIN]:
            return LEFT
        if rows > 0 and R[(rows - 1) * ROW + R_PACE] == M[M_PACE]:
            M[M_PACE] = M[M_PACE] + 1
        W[W_FEED] = feed
        paces[M[M_PACE]] = feed
    return TAKEN


def block_end(W: F64, K: I32, M: I32, A: F64, named: int) -> bool:
    """Find where a block goes; returns whether the machine moves."""
    moves: bool = False
    for axis in range(AXES):
        at: float = W[W_POSITION + axis]
        if named & (1 << axis):
            value: float = W[W_WORDS + K[K_LETTER + axis]]
            if not K[K_ROTARY] & (1 << axis):
                value = value * W[W_TIMES] / W[W_PER]
            at = at + value if M[M_DISTANCE] == INCREMENTAL else value
        A[A_END + axis] = at
        if M[M_IS_SHIFTED]:
            at = at + W[W_SHIFT + axis]
        A[A_TARGET + axis] = at
        if at != W[W_TARGET + axis]:
            moves = True
    return moves


def block_first(plane: int) -> int:
    """The first axis of a plane."""
    if plane == ZX:
        return 2
    return 1 if plane == YZ else 0


def block_second(plane: int) -> int:
    """The second axis of a plane."""
    if plane == ZX:
        return 0
    return 2 if plane == YZ else 1


def block_centre(W: F64, M: I32, axis: int, words: int) -> float:
    """One coordinate of the centre by I, J or K."""
    start: float = W[W_POSITION + axis]
    if not words & (1 << axis):
        return start
    length: float = W[W_WORDS + LETTER_I + axis] * W[W_TIMES] / W[W_PER]
    if M[M_CENTRES] == 2:
        return length
    return start + length if M[M_CENTRES] == 1 else start - length


def block_arc(W: F64, M: I32, A: F64, arcs: F64, row: int, words: int) -> int:
    """Find the arc to the end of a block; LEFT if it is wrong or doubtful."""
    first: int = block_first(M[M_PLANE])
    second: int = block_second(M[M_PLANE])
    direction: int = -1 if M[M_MOTION] == 2 else 1
    A[A_X0] = W[W_POSITION + first]
    A[A_Y0] = W[W_POSITION + second]
    A[A_X1] = A[A_END + first]
    A[A_Y1] = A[A_END + second]
    if words & BIT_R:
        radius: float = W[W_WORDS + LETTER_R] * W[W_TIMES] / W[W_PER]
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
    return MOVED


def block_move(
    W: F64, K: I32, P: I32, plan: int, M: I32, A: F64, ends: F64, arcs: F64, R: I32, row: int
) -> int:
    """Move as the motion in force does; a row is written where the machine moves."""
    words: int = P[plan + P_WORDS]
    motion: int = M[M_MOTION]
    moves: bool = block_end(W, K, M, A, P[plan + P_AXES])
    if motion == 2 or motion == 3:
        if block_arc(W, M, A, arcs, row, words) == LEFT:
            return LEFT
        moves = True
    elif words or (motion != 0 and motion != 1):
        return LEFT
    for axis in range(AXES):
        W[W_POSITION + axis] = A[A_END + axis]
        if moves:
            W[W_TARGET + axis] = A[A_TARGET + axis]
            ends[row * AXES + axis] = A[A_TARGET + axis]
    if not moves:
        return TAKEN
    R[row * ROW + R_KIND] = motion if motion < 2 else ARC
    R[row * ROW + R_PACE] = M[M_PACE]
    R[row * ROW + R_PLANE] = M[M_PLANE]
    M[M_IDLE] = 0
    return MOVED
