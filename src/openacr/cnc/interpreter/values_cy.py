"""Steps of blocks that compute: words and assignments with formulas, conditions of jumps.

What a block assigns is taken back where the block is left: `X` has, after the stack of formulas,
the values of the block and what was in their places before.

    J  jumps by their line: line, target in the text and its line, passes, 1 if a place is kept
    H  the place that is kept, 8 numbers for each jump
"""

from openacr.cnc.interpreter.formulas_cy import (
    CELLS,
    IS_KNOWN,
    IS_WRITTEN,
    LAST_OWN,
    LOCALS,
    MAY_WRITE,
    MOST_OPERANDS,
    OWN_LOCALS,
    formula_run,
    formula_whole,
)
from openacr.cnc.interpreter.run_rows_cy import LEFT, STEP_STORE, STEP_VALUE, TAKEN
from openacr.cnc.reading.scan_cy import AXES, W_WORDS
from openacr.views import F64, I32

STORE_CELL = 0
STORE_HASH = 1  # the local, or outside calls the cell
STORE_OWN = 2

X_VALUES = MOST_OPERANDS
MOST_VALUES = 16
MOST_UNDO = 4096
X_UNDO = X_VALUES + MOST_VALUES  # place, value and state from before, of each assignment
X_UNDO_CNT = X_UNDO + 3 * MOST_UNDO
X_SIZE = X_UNDO_CNT + 1
PLACE_OWN = 100
PLACE_CELL = 10000

J_LINE = 0
J_PLACE = 1
J_TARGET = 2
J_PASSES = 3
J_IS_KEPT = 4
JUMP = 5
JUMPS = 64
JUMP_MASK = 63


def value_note(X: F64, place: int, value: float, state: int) -> bool:
    """Note what an assignment replaces; False where there is no room."""
    if X[X_UNDO_CNT] >= MOST_UNDO:
        return False
    at: int = X_UNDO + 3 * int(X[X_UNDO_CNT])
    X[at] = float(place)
    X[at + 1] = value
    X[at + 2] = float(state)
    X[X_UNDO_CNT] = X[X_UNDO_CNT] + 1.0
    return True


def value_cell(n: int, value: float, X: F64, C: F64, Z: I32) -> bool:
    """Write a cell of the store."""
    if not value_note(X, PLACE_CELL + n, C[n], Z[n]):
        return False
    C[n] = value
    Z[n] = IS_KNOWN | IS_WRITTEN
    return True


def value_store(kind: int, slot: int, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32) -> bool:
    """Assign the value after a slot to the parameter in it; False where only the tree can."""
    n: int = formula_whole(X[X_VALUES + slot])
    value: float = X[X_VALUES + slot + 1]
    most: int = OWN_LOCALS if kind == STORE_OWN else LOCALS
    if (kind == STORE_OWN or (kind == STORE_HASH and V[0] != 0.0)) and 1 <= n <= most:
        if not value_note(X, n, V[n], 0):
            return False
        V[n] = value
        return True
    if kind == STORE_OWN:
        if n < 1 or n > LAST_OWN or not value_note(X, PLACE_OWN + n, U[n], 0):
            return False
        U[n] = value
        return True
    if n < 0 or n >= CELLS or not B[n] & MAY_WRITE:
        return False
    return value_cell(n, value, X, C, Z)


def value_undo(X: F64, V: F64, U: F64, C: F64, Z: I32) -> None:
    """Take back what the block has assigned."""
    count: int = int(X[X_UNDO_CNT])
    while count > 0:
        count -= 1
        at: int = X_UNDO + 3 * count
        place: int = int(X[at])
        if place < PLACE_OWN:
            V[place] = X[at + 1]
        elif place < PLACE_CELL:
            U[place - PLACE_OWN] = X[at + 1]
        else:
            C[place - PLACE_CELL] = X[at + 1]
            Z[place - PLACE_CELL] = int(X[at + 2])
    X[X_UNDO_CNT] = 0.0


def value_keep(
    P: I32, at: int, N: F64, X: F64, V: F64, U: F64, C: F64, Z: I32, B: I32, slot: int
) -> bool:
    """Compute a formula to a value of the block."""
    if not formula_run(P, at, N, X, V, U, C, Z, B):
        return False
    X[X_VALUES + slot] = X[0]
    return True


def value_step(
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


def jump_place(J: I32, line: int) -> int:
    """The place of a jump in J, -1 if it is not known."""
    at: int = (line & JUMP_MASK) * JUMP
    return at if J[at + J_LINE] == line else -1


def jump_is_same(J: I32, H: F64, at: int, W: F64, target: int) -> bool:
    """Whether the machine is where it was in the pass that is kept; `target` is its row in W."""
    if not J[at + J_IS_KEPT]:
        return False
    for axis in range(AXES):
        if H[(J[at + J_LINE] & JUMP_MASK) * AXES + axis] != W[target + axis]:
            return False
    return True


def jump_is_plain(J: I32, H: F64, at: int, W: F64, target: int, most: int) -> bool:
    """Count a pass, unless its state has to be compared or kept (`loops.py`)."""
    passes: int = J[at + J_PASSES] + 1
    if passes > most or passes & (passes - 1) == 0 or jump_is_same(J, H, at, W, target):
        return False
    J[at + J_PASSES] = passes
    return True
