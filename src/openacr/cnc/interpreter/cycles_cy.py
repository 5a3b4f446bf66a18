"""Canned cycles: the holes of a block, each with the text of its cycle as plans.

The text of a cycle is a stroke in `P`: the count of its lines, then for each line its plan, its
number, and where it begins and ends. What a hole needs to know stands in the cells from P249 on, as
the text finds them. A block is left where one of its holes cannot be executed so.
"""

from openacr.cnc.geometry.arc_cy import plane_first, plane_second
from openacr.cnc.interpreter.blocks_cy import (
    block_end,
    block_feed,
    block_length,
    block_limit,
    block_note,
    block_set,
    block_straight,
)
from openacr.cnc.interpreter.formulas_cy import formula_run
from openacr.cnc.interpreter.run_rows_cy import (
    A_END,
    A_WORDS,
    BIT_L,
    BIT_P,
    BIT_Q,
    BIT_R,
    CENTRE_BITS,
    CUT_SHORT,
    FIRST_CYCLE,
    HAS_PECK,
    HAS_REST,
    INCREMENTAL,
    INCREMENTS,
    K_LETTER,
    LEFT,
    LETTER_L,
    LETTER_P,
    LETTER_Q,
    LETTER_R,
    LETTER_X,
    LETTERS,
    M_AT,
    M_BOTTOM,
    M_COMPENSATION,
    M_CYCLE,
    M_DISTANCE,
    M_HAS_TURNED,
    M_IDLE,
    M_IS_DRILLING,
    M_LEVEL,
    M_MOTION,
    M_PLANE,
    M_RETURN,
    M_RISES,
    M_ROWS,
    M_STROKES,
    M_WORDS,
    MOST_REPEATS,
    MOST_ROWS,
    MOST_STROKE,
    NO_CYCLE,
    OFF,
    P_AXES,
    P_FIRST,
    P_STEPS,
    P_WORDS,
    PECK,
    PECK_BREAK,
    RAPID,
    RETURN_R,
    RETURNED,
    STEP_BAR,
    STEP_FEED,
    STEP_GO,
    STEP_LIMIT,
    STEP_MOVE,
    STEP_NOTE,
    STEP_RETURN,
    STEP_SET,
    STROKE,
    TAKEN,
    W_BEFORE,
    W_BOTTOM,
    W_CLEAR,
    W_FEED,
    W_INITIAL,
    W_LEVEL,
    W_PECK,
    W_PER,
    W_POSITION,
    W_REST,
    W_SIGNS,
    W_SPIN,
    W_TIMES,
    WRITTEN,
)
from openacr.cnc.interpreter.values_cy import value_cell, value_step
from openacr.cnc.reading.scan_cy import AXES, W_WORDS
from openacr.views import F64, I32

POINTS = 16  # position and target
DRILLING = 5  # numbers of the cycle
CELL_CODE = 249  # the first of the cells of a cycle
CELL_DIRECTION = 270  # the last one


def cycle_keep(W: F64) -> None:
    """Keep where the machine is, and the words of the cycle."""
    for k in range(POINTS):
        W[W_BEFORE + k] = W[W_POSITION + k]
    for k in range(DRILLING):
        W[W_BEFORE + POINTS + k] = W[W_INITIAL + k]


def cycle_restore(W: F64) -> int:
    """Go back to what was kept: the block is left."""
    for k in range(POINTS):
        W[W_POSITION + k] = W[W_BEFORE + k]
    for k in range(DRILLING):
        W[W_INITIAL + k] = W[W_BEFORE + POINTS + k]
    return LEFT


def cycle_drill_axis(plane: int) -> int:
    """The axis across a plane."""
    return 3 - plane_first(plane) - plane_second(plane)


def cycle_begin(W: F64, M: I32, code: int) -> None:
    """A code of a cycle: without one that is active its words are new."""
    is_first: bool = M[M_CYCLE] == NO_CYCLE
    if is_first:
        M[M_IS_DRILLING] = 1
        M[M_LEVEL] = 0
        M[M_BOTTOM] = 0
        M[M_WORDS] = 0
    if is_first or not M[M_RISES]:
        W[W_INITIAL] = W[W_POSITION + cycle_drill_axis(M[M_PLANE])]
    M[M_CYCLE] = code


def cycle_end(M: I32) -> None:
    """G80."""
    M[M_CYCLE] = NO_CYCLE
    M[M_IS_DRILLING] = 0


def cycle_take(W: F64, K: I32, M: I32, axes: int, words: int, drill: int) -> None:
    """Take the words of a block, which are kept for the blocks after it."""
    how: int = INCREMENTS if M[M_DISTANCE] == INCREMENTAL else WRITTEN
    if axes & (1 << drill):
        W[W_BOTTOM] = block_length(W, W[W_WORDS + K[K_LETTER + drill]])
        M[M_BOTTOM] = how
    if words & BIT_R:
        W[W_LEVEL] = block_length(W, W[W_WORDS + LETTER_R])
        M[M_LEVEL] = how
    if words & BIT_Q:
        W[W_PECK] = W[W_WORDS + LETTER_Q]
        M[M_WORDS] = M[M_WORDS] | HAS_PECK
    if words & BIT_P:
        W[W_REST] = W[W_WORDS + LETTER_P]
        M[M_WORDS] = M[M_WORDS] | HAS_REST


def cycle_level(W: F64, M: I32) -> float:
    """The R level."""
    return W[W_LEVEL] + W[W_INITIAL] if M[M_LEVEL] == INCREMENTS else W[W_LEVEL]


def cycle_bottom(W: F64, M: I32, level: float) -> float:
    """The bottom of the holes."""
    return W[W_BOTTOM] + level if M[M_BOTTOM] == INCREMENTS else W[W_BOTTOM]


def cycle_peck(W: F64, M: I32) -> float:
    """Q, 0 where there is none."""
    return W[W_PECK] if M[M_WORDS] & HAS_PECK else 0.0


def cycle_is_plain(W: F64, M: I32) -> bool:
    """Whether the words of a cycle are there, and nothing is doubtful."""
    code: int = M[M_CYCLE]
    if not M[M_IS_DRILLING] or not M[M_LEVEL] or not M[M_BOTTOM]:
        return False
    if (code == PECK or code == PECK_BREAK) and cycle_peck(W, M) <= 0.0:
        return False
    level: float = cycle_level(W, M)
    if cycle_bottom(W, M, level) > level:
        return False
    return M[M_RISES] != 0 or M[M_RETURN] == RETURN_R or W[W_INITIAL] >= level


def cycle_shown(W: F64, value: float) -> float:
    """A length in default units, in active units."""
    return value * W[W_PER] / W[W_TIMES]


def cycle_value(W: F64, M: I32, n: int, left: int) -> float:
    """What the text of a cycle finds in cell `n`."""
    level: float = cycle_level(W, M)
    initial: float = W[W_INITIAL]
    if M[M_RISES] and level > initial:
        initial = level
    if n == 249:
        return float(M[M_CYCLE])
    if n == 250:
        return cycle_shown(W, W[W_POSITION + plane_first(M[M_PLANE])])
    if n == 251:
        return cycle_shown(W, W[W_POSITION + plane_second(M[M_PLANE])])
    if n == 252:
        return cycle_shown(W, cycle_bottom(W, M, level))
    if n == 253:
        return cycle_shown(W, level)
    if n == 254:
        return cycle_shown(W, initial)
    if n == 255:
        return cycle_shown(W, level if M[M_RETURN] == RETURN_R else initial)
    if n == 256:
        return cycle_peck(W, M)
    if n == 257:
        return W[W_REST] if M[M_WORDS] & HAS_REST else 0.0
    if n == 258:
        return cycle_shown(W, W[W_FEED])
    if n == 259:
        return float(left)
    if n == 260 or n == 261:
        return cycle_shown(W, W[W_CLEAR + n - 260])
    if n == 262 or n == 263:
        return W[W_SIGNS + n - 262] * cycle_peck(W, M)
    if n == 264:
        return W[W_SPIN]
    if n == 265:
        return float(M[M_RETURN])
    if n == 266:
        return float(M[M_PLANE])
    if n == 267:
        return float(M[M_DISTANCE])
    return 1.0 if n == CELL_DIRECTION else 0.0


def cycle_cells(W: F64, M: I32, left: int, X: F64, C: F64, Z: I32) -> int:
    """Fill the cells of a cycle."""
    for n in range(CELL_CODE, CELL_DIRECTION + 1):
        if not value_cell(n, cycle_value(W, M, n, left), X, C, Z):
            return LEFT
    return TAKEN


def cycle_move(W: F64, M: I32, A: F64, ends: F64, R: I32, letters: int) -> int:
    """A straight move of the text: X, Y, Z are the axes of the plane and the one across it."""
    if M[M_MOTION] != 0 and M[M_MOTION] != 1:
        return LEFT
    for axis in range(AXES):
        A[A_END + axis] = W[W_POSITION + axis]
    for k in range(3):
        if letters & (1 << k):
            place: int = cycle_drill_axis(M[M_PLANE])
            if k < 2:
                place = plane_second(M[M_PLANE]) if k else plane_first(M[M_PLANE])
            A[A_END + place] = block_length(W, W[W_WORDS + LETTER_X + k])
    block_straight(W, M, A, ends, R, M[M_MOTION])
    return TAKEN


def cycle_line(
    W: F64, P: I32, plan: int, following: int, M: I32, A: F64, ends: F64, R: I32, paces: F64,
    N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32
) -> int:  # fmt: skip
    """Execute a line of the text; the line after it, or RETURNED, or CUT_SHORT."""
    done: int = TAKEN
    at: int = plan + P_FIRST
    for _ in range(P[plan + P_STEPS]):
        step: int = P[at]
        if step == STEP_MOVE:
            done = cycle_move(W, M, A, ends, R, P[plan + P_AXES])
        elif step == STEP_FEED:
            done = block_feed(W, M, R, paces)
        elif step == STEP_NOTE:
            done = block_note(W, P, plan, at, M, R, ends)
        elif step == STEP_LIMIT:
            done = block_limit(W, P[at + 1], P[at + 2])
        elif step == STEP_SET or step == STEP_BAR:
            done = block_set(W, M, step, P[at + 1], P[at + 2])
        elif step == STEP_GO or step == STEP_RETURN:
            if P[at + 2] and not formula_run(P, plan + P[at + 2], N, X, V, U, C, Z, B):
                return CUT_SHORT
            if not P[at + 2] or X[0] != 0.0:
                return P[at + 1] if step == STEP_GO else RETURNED
        else:
            done = value_step(W, P, plan, at, N, X, V, U, C, Z, B)
        if done == LEFT:
            return CUT_SHORT
        at += 3
    return following


def cycle_stroke(
    W: F64, P: I32, M: I32, A: F64, ends: F64, R: I32, paces: F64, N: F64, X: F64, V: F64, U: F64,
    C: F64, Z: I32, B: I32
) -> int:  # fmt: skip
    """Execute the text of the cycle at a hole."""
    cycle: int = M[M_CYCLE]
    motion: int = M[M_MOTION]
    stroke: int = M[M_STROKES + cycle - FIRST_CYCLE]
    line: int = 0
    lines: int = 0
    M[M_CYCLE] = NO_CYCLE
    while 0 <= line < P[stroke]:
        at: int = stroke + 1 + STROKE * line
        lines += 1
        if lines > MOST_STROKE or M[M_ROWS] + P[P[at] + P_STEPS] > MOST_ROWS:
            return LEFT
        for k in range(3):
            M[M_AT + k] = P[at + 1 + k]
        M[M_IDLE] = M[M_IDLE] + 1
        line = cycle_line(
            W, P, P[at], line + 1, M, A, ends, R, paces, N, X, V, U, C, Z, B
        )  # fmt: skip
    M[M_CYCLE] = cycle
    M[M_MOTION] = motion
    return TAKEN if line == RETURNED else LEFT


def cycle_hole(
    W: F64, K: I32, P: I32, axes: int, left: int, M: I32, A: F64, ends: F64, R: I32, paces: F64,
    N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32
) -> int:  # fmt: skip
    """Go to the next hole and execute the text of the cycle."""
    if M[M_ROWS] >= MOST_ROWS:
        return LEFT
    block_end(W, K, M, A, axes & ~(1 << cycle_drill_axis(M[M_PLANE])))
    block_straight(W, M, A, ends, R, RAPID)
    if cycle_cells(W, M, left, X, C, Z) == LEFT:
        return LEFT
    for k in range(LETTERS):
        A[A_WORDS + k] = W[W_WORDS + k]
    line: int = M[M_AT]
    begin: int = M[M_AT + 1]
    end: int = M[M_AT + 2]
    M[M_AT + 3] = 1
    done: int = cycle_stroke(W, P, M, A, ends, R, paces, N, X, V, U, C, Z, B)
    for k in range(LETTERS):
        W[W_WORDS + k] = A[A_WORDS + k]
    M[M_AT] = line
    M[M_AT + 1] = begin
    M[M_AT + 2] = end
    M[M_AT + 3] = 0
    return done


def cycle_holes(
    W: F64, K: I32, P: I32, plan: int, M: I32, A: F64, ends: F64, R: I32, paces: F64, N: F64,
    X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32
) -> int:  # fmt: skip
    """The holes of a block; LEFT where they need more than is known here."""
    words: int = P[plan + P_WORDS]
    drill: int = cycle_drill_axis(M[M_PLANE])
    repeats: float = W[W_WORDS + LETTER_L] if words & BIT_L else 1.0
    if words & CENTRE_BITS or not M[M_STROKES + M[M_CYCLE] - FIRST_CYCLE]:
        return LEFT
    if repeats > MOST_REPEATS or float(int(repeats)) != repeats:
        return LEFT
    cycle_take(W, K, M, P[plan + P_AXES], words, drill)
    if not cycle_is_plain(W, M) or M[M_ROWS] >= MOST_ROWS:
        return LEFT
    level: float = cycle_level(W, M)
    if M[M_RISES] and W[W_POSITION + drill] < level:
        for axis in range(AXES):
            A[A_END + axis] = W[W_POSITION + axis]
        A[A_END + drill] = level
        block_straight(W, M, A, ends, R, RAPID)
    left: int = int(repeats)
    done: int = TAKEN
    while left > 0 and done == TAKEN:
        done = cycle_hole(
            W, K, P, P[plan + P_AXES], left, M, A, ends, R, paces, N, X, V, U, C, Z, B
        )  # fmt: skip
        left -= 1
    return done


def cycle_run(
    W: F64, K: I32, P: I32, plan: int, code: int, M: I32, A: F64, ends: F64, R: I32, paces: F64,
    N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32
) -> int:  # fmt: skip
    """The holes of a block, with the code of a cycle or 0; a block that is left changes nothing."""
    if M[M_COMPENSATION] != OFF or M[M_HAS_TURNED]:
        return LEFT
    cycle_keep(W)
    if code:
        cycle_begin(W, M, code)
    done: int = cycle_holes(W, K, P, plan, M, A, ends, R, paces, N, X, V, U, C, Z, B)
    return cycle_restore(W) if done == LEFT else TAKEN
