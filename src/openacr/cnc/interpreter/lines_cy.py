"""Lines executed many at a time: the steps of their plans (`blocks_cy`), one line after another.

`data` is the text, `T` what is known of shapes (`scan_cy`), `J` and `H` jumps (`values_cy`).
"""

from openacr.cnc.interpreter.blocks_cy import (
    INCH,
    JUMP_COUNTS,
    JUMP_IF_TRUE,
    JUMPED,
    K_FIRST,
    K_JUMPS,
    K_LAST_LINE,
    K_READ,
    LEFT,
    M_HAS_VALUES,
    M_IDLE,
    M_IS_PLAIN,
    M_LINE,
    M_MOST_PASSES,
    MOST_IDLE,
    MOVED,
    P_FIRST,
    P_IS_ALONE,
    P_IS_PLAIN,
    P_STEPS,
    R_LINE,
    R_START,
    R_STOP,
    ROW,
    STEP_FEED,
    STEP_JUMP,
    STEP_MOVE,
    STEP_STORE,
    STEP_UNIT,
    STEP_VALUE,
    TAKEN,
    W_PER,
    W_TARGET,
    W_TIMES,
    W_UNITS,
    block_feed,
    block_keep,
    block_move,
    block_restore,
)
from openacr.cnc.interpreter.formulas_cy import (
    formula_run,
)
from openacr.cnc.interpreter.values_cy import (
    J_PLACE,
    J_TARGET,
    X_UNDO_CNT,
    jump_is_plain,
    jump_place,
    value_keep,
    value_store,
    value_undo,
)
from openacr.cnc.reading.rich_cy import (
    scan_rich,
)
from openacr.cnc.reading.scan_cy import (
    K_HAS_WORDS,
    K_LAST,
    K_LINES,
    K_NEXT,
    K_STATUS,
    K_TOKENS,
    SCAN_END,
    SCAN_HARD,
    SCAN_LEFT,
    SCAN_NEW,
    SCAN_SLOW,
    SHAPE_NONE,
    W_WORDS,
    scan_line,
    scan_shape,
)
from openacr.views import F64, I32, U8

__all__ = ["run_lines"]


def block_jump(
    W: F64, K: I32, P: I32, plan: int, at: int, M: I32, line: int, N: F64, X: F64, V: F64, U: F64,
    C: F64, Z: I32, B: I32, J: I32, H: F64
) -> int:  # fmt: skip
    """Jump if the condition of the step at `at` is met; LEFT if the target is not known here."""
    how: int = P[at + 1]
    if P[at + 2]:
        if not formula_run(P, plan + P[at + 2], N, X, V, U, C, Z, B):
            return LEFT
        if (X[0] != 0.0) != (how & JUMP_IF_TRUE != 0):
            return TAKEN
    jump: int = jump_place(J, line)
    if jump < 0:
        return LEFT
    if how & JUMP_COUNTS and M[M_MOST_PASSES]:
        if not jump_is_plain(J, H, jump, W, W_TARGET, M[M_MOST_PASSES]):
            return LEFT
    K[K_NEXT] = J[jump + J_PLACE] - K[K_FIRST]
    K[K_LINES] = J[jump + J_TARGET]
    K[K_JUMPS] = K[K_JUMPS] + 1
    return JUMPED


def block_value(
    W: F64, P: I32, plan: int, at: int, N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32
) -> int:  # fmt: skip
    """Compute a word or a value, or assign one."""
    step: int = P[at]
    if step == STEP_STORE:
        return TAKEN if value_store(P[at + 1], P[at + 2], X, V, U, C, Z, B) else LEFT
    if step == STEP_VALUE:
        return TAKEN if value_keep(P, plan + P[at + 2], N, X, V, U, C, Z, B, P[at + 1]) else LEFT
    if not formula_run(P, plan + P[at + 2], N, X, V, U, C, Z, B):
        return LEFT
    W[W_WORDS + P[at + 1]] = X[0]
    return TAKEN


def block_run(
    W: F64, K: I32, P: I32, plan: int, M: I32, A: F64, ends: F64, arcs: F64, R: I32, paces: F64,
    row: int, line: int, N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32, J: I32, H: F64
) -> int:  # fmt: skip
    """Execute the steps of one block; LEFT where it is left as it was."""
    if M[M_IS_PLAIN] and not P[plan + P_IS_PLAIN]:
        return LEFT
    if (P[plan + P_IS_ALONE] and row > 0) or M[M_IDLE] >= MOST_IDLE:
        return LEFT
    block_keep(W, M)
    X[X_UNDO_CNT] = 0.0
    M[M_IDLE] = M[M_IDLE] + 1
    done: int = TAKEN
    at: int = plan + P_FIRST
    for _ in range(P[plan + P_STEPS]):
        step: int = P[at]
        if step == STEP_MOVE:
            done = block_move(W, K, P, plan, M, A, ends, arcs, R, row)
        elif step == STEP_FEED:
            done = block_feed(W, M, R, paces, row)
        elif step == STEP_JUMP:
            done = block_jump(W, K, P, plan, at, M, line, N, X, V, U, C, Z, B, J, H)
        elif step > STEP_MOVE:
            done = block_value(W, P, plan, at, N, X, V, U, C, Z, B)
        else:
            M[P[at + 1]] = P[at + 2]
            if step == STEP_UNIT:
                units: int = W_UNITS if P[at + 2] == INCH else W_UNITS + 2
                W[W_TIMES] = W[units]
                W[W_PER] = W[units + 1]
        if done == LEFT:
            block_restore(W, M, paces)
            value_undo(X, V, U, C, Z)
            return LEFT
        at += 3
    return done


def run_lines(
    data: U8, pos: int, stop: int, W: F64, K: I32, L: I32, T: I32, P: I32, M: I32, A: F64,
    ends: F64, arcs: F64, R: I32, paces: F64, row: int, most: int, N: F64, Q: I32, X: F64, V: F64,
    U: F64, C: F64, Z: I32, B: I32, J: I32, H: F64
) -> int:  # fmt: skip
    """Execute lines from `pos` on until one is left, or there are `most` moves.

    There are `row` moves already. Returns the count of all; K says where it ended and why.
    """
    line: int = M[M_LINE]
    last: int = pos
    last_line: int = line
    count: int = 0
    status: int = SCAN_END
    has_words: int = 0
    K[K_JUMPS] = 0
    while 0 <= pos < stop and row < most and status == SCAN_END:
        after: int = scan_line(data, pos, stop, W, K, L)
        if after < 0 and M[M_HAS_VALUES]:
            after = scan_rich(data, pos, stop, W, K, L, N, Q)
        if after < 0:
            status = SCAN_HARD
            break
        done: int = TAKEN
        if K[K_TOKENS]:
            plan: int = scan_shape(K, L, T)
            if plan < 0:
                status = SCAN_NEW if plan == SHAPE_NONE else SCAN_SLOW
                break
            done = block_run(
                W, K, P, plan, M, A, ends, arcs, R, paces, row, line, N, X, V, U, C, Z, B, J, H
            )
            if done == LEFT:
                status = SCAN_LEFT
                break
            has_words = 1
            if done == MOVED:
                R[row * ROW + R_LINE] = line
                R[row * ROW + R_START] = pos
                R[row * ROW + R_STOP] = after
                row += 1
            if P[plan + P_IS_ALONE]:
                most = row
        last = pos
        last_line = line
        count += 1
        line += 1
        pos = after
        if done == JUMPED:
            line = K[K_LINES]
            pos = K[K_NEXT]
    K[K_LINES] = line
    K[K_NEXT] = pos
    K[K_LAST] = last
    K[K_LAST_LINE] = last_line
    K[K_READ] = count
    K[K_STATUS] = status
    K[K_HAS_WORDS] = has_words
    return row
