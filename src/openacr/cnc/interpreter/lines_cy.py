"""Lines executed many at a time: the steps of their plans, one line after another.

`data` is the text, `T` what is known of shapes (`scan_cy`), `J` and `H` jumps (`values_cy`).
"""

from openacr.cnc.interpreter.blocks_cy import (
    block_feed,
    block_keep,
    block_limit,
    block_move,
    block_note,
    block_restore,
    block_set,
)
from openacr.cnc.interpreter.cycles_cy import cycle_end, cycle_run
from openacr.cnc.interpreter.formulas_cy import formula_run
from openacr.cnc.interpreter.run_rows_cy import (
    JUMP_COUNTS,
    JUMP_IF_TRUE,
    JUMPED,
    K_FIRST,
    K_JUMPS,
    K_LAST_LINE,
    K_READ,
    LEFT,
    M_AT,
    M_CYCLE,
    M_HAS_VALUES,
    M_IDLE,
    M_IS_PLAIN,
    M_LINE,
    M_MOST_PASSES,
    M_ROWS,
    MOST_IDLE,
    MOST_ROWS,
    MOST_STROKE,
    NO_CYCLE,
    P_FIRST,
    P_IS_ALONE,
    P_IS_PLAIN,
    P_STEPS,
    STEP_DRILL,
    STEP_END_CYCLE,
    STEP_FEED,
    STEP_JUMP,
    STEP_LIMIT,
    STEP_MOVE,
    STEP_NOTE,
    STEP_SHOW,
    STEP_TURN,
    TAKEN,
    W_TARGET,
)
from openacr.cnc.interpreter.values_cy import (
    J_PLACE,
    J_TARGET,
    X_UNDO_CNT,
    jump_is_plain,
    jump_place,
    value_step,
    value_undo,
)
from openacr.cnc.reading.rich_cy import scan_rich
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


def block_run(
    W: F64, K: I32, P: I32, plan: int, M: I32, A: F64, ends: F64, arcs: F64, R: I32, paces: F64,
    line: int, N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32, J: I32, H: F64
) -> int:  # fmt: skip
    """Execute the steps of one block; LEFT where it is left as it was."""
    if M[M_IS_PLAIN] and not P[plan + P_IS_PLAIN]:
        return LEFT
    if (P[plan + P_IS_ALONE] and M[M_ROWS] > 0) or M[M_IDLE] >= MOST_IDLE - MOST_STROKE:
        return LEFT
    block_keep(W, M)
    X[X_UNDO_CNT] = 0.0
    M[M_IDLE] = M[M_IDLE] + 1
    done: int = TAKEN
    at: int = plan + P_FIRST
    for _ in range(P[plan + P_STEPS]):
        step: int = P[at]
        if step == STEP_MOVE and M[M_CYCLE] == NO_CYCLE:
            done = block_move(W, K, P, plan, M, A, ends, arcs, R)
        elif step == STEP_FEED:
            done = block_feed(W, M, R, paces)
        elif step == STEP_JUMP:
            done = block_jump(W, K, P, plan, at, M, line, N, X, V, U, C, Z, B, J, H)
        elif step == STEP_MOVE or step == STEP_DRILL:
            done = cycle_run(
                W, K, P, plan, P[at + 1], M, A, ends, R, paces, N, X, V, U, C, Z, B
            )  # fmt: skip
        elif step == STEP_LIMIT:
            done = block_limit(W, P[at + 1], P[at + 2])
        elif step == STEP_NOTE or step == STEP_SHOW or step == STEP_TURN:
            done = block_note(W, P, plan, at, M, R, ends)
        elif step == STEP_END_CYCLE:
            cycle_end(M)
        elif step > STEP_MOVE and step < STEP_JUMP:
            done = value_step(W, P, plan, at, N, X, V, U, C, Z, B)
        else:
            done = block_set(W, M, step, P[at + 1], P[at + 2])
        if done == LEFT:
            block_restore(W, M, paces)
            value_undo(X, V, U, C, Z)
            return LEFT
        at += 3
    return done


def run_lines(
    data: U8, pos: int, stop: int, W: F64, K: I32, L: I32, T: I32, P: I32, M: I32, A: F64,
    ends: F64, arcs: F64, R: I32, paces: F64, N: F64, Q: I32, X: F64, V: F64, U: F64, C: F64,
    Z: I32, B: I32, J: I32, H: F64
) -> None:  # fmt: skip
    """Execute lines from `pos` on until one is left, or there is no room for more moves.

    K says where it ended and why.
    """
    most: int = MOST_ROWS
    line: int = M[M_LINE]
    last: int = pos
    last_line: int = line
    count: int = 0
    status: int = SCAN_END
    has_words: int = 0
    K[K_JUMPS] = 0
    while 0 <= pos < stop and M[M_ROWS] < most and status == SCAN_END:
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
            M[M_AT] = line
            M[M_AT + 1] = pos
            M[M_AT + 2] = after
            done = block_run(
                W, K, P, plan, M, A, ends, arcs, R, paces, line, N, X, V, U, C, Z, B, J, H
            )
            if done == LEFT:
                status = SCAN_LEFT
                break
            has_words = 1
            if P[plan + P_IS_ALONE]:
                most = M[M_ROWS]
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
