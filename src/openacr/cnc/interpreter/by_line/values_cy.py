"""Steps of blocks that compute: words and assignments with formulas, conditions of jumps.

What a block assigns is taken back where the block is left.
"""

from openacr.cnc.interpreter.by_line.formulas_cy import formula_run, formula_whole
from openacr.cnc.rows import moves, plans, points, runs, scans, values
from openacr.views import F64, I32


def value_note(F: F64, I: I32, place: int, value: float, state: int) -> bool:
    """Note what an assignment replaces; False where there is no room."""
    if I[values.undo_cnt] >= values.MOST_UNDO:
        return False
    at: int = values.undo[values.UNDO * I[values.undo_cnt]]
    F[at] = float(place)
    F[at + 1] = value
    F[at + 2] = float(state)
    I[values.undo_cnt] += 1
    return True


def value_cell(F: F64, I: I32, cells: F64, states: I32, n: int, value: float) -> bool:
    """Write a cell of the store."""
    if not value_note(F, I, values.PLACE_CELL + n, cells[n], states[n]):
        return False
    cells[n] = value
    states[n] = values.IS_KNOWN | values.IS_WRITTEN
    return True


def value_store(F: F64, I: I32, cells: F64, states: I32, kind: int, slot: int) -> bool:
    """Assign the value after a slot to the parameter in it; False where only the tree can."""
    n: int = formula_whole(F[values.slot[slot]])
    value: float = F[values.slot[slot + 1]]
    most: int = values.OWN_LOCALS if kind == values.STORE_OWN else values.LOCALS
    has_locals: bool = kind == values.STORE_OWN
    if kind == values.STORE_HASH:
        has_locals = F[values.local[0]] != 0.0
    if has_locals and 1 <= n <= most:
        if not value_note(F, I, n, F[values.local[n]], 0):
            return False
        F[values.local[n]] = value
        return True
    if kind == values.STORE_OWN:
        if n < 1 or n > values.LAST_OWN:
            return False
        if not value_note(F, I, values.PLACE_OWN + n, F[values.own[n]], 0):
            return False
        F[values.own[n]] = value
        return True
    if n < 0 or n >= values.CELLS or not I[values.access[n]] & values.MAY_WRITE:
        return False
    return value_cell(F, I, cells, states, n, value)


def value_undo(F: F64, I: I32, cells: F64, states: I32) -> None:
    """Take back what the block has assigned."""
    count: int = I[values.undo_cnt]
    while count > 0:
        count -= 1
        at: int = values.undo[values.UNDO * count]
        place: int = int(F[at])
        if place < values.PLACE_OWN:
            F[values.local[place]] = F[at + 1]
        elif place < values.PLACE_CELL:
            F[values.own[place - values.PLACE_OWN]] = F[at + 1]
        else:
            cells[place - values.PLACE_CELL] = F[at + 1]
            states[place - values.PLACE_CELL] = int(F[at + 2])
    I[values.undo_cnt] = 0


def value_step(F: F64, I: I32, cells: F64, states: I32, plan: int, at: int) -> int:
    """Compute a word or a value, or assign one."""
    step: int = I[at]
    if step == plans.STEP_STORE:
        return runs.TAKEN if value_store(F, I, cells, states, I[at + 1], I[at + 2]) else runs.LEFT
    if not formula_run(F, I, cells, states, plan + I[at + 2]):
        return runs.LEFT
    if step == plans.STEP_VALUE:
        F[values.slot[I[at + 1]]] = F[values.stack[0]]
    else:
        F[scans.word[I[at + 1]]] = F[values.stack[0]]
    return runs.TAKEN


def jump_place(I: I32, line: int) -> int:
    """The row of a jump, -1 if it is not known."""
    at: int = values.jump[(line & values.JUMP_MASK) * values.JUMP]
    return at if I[at + values.JUMP_LINE] == line else -1


def jump_is_same(F: F64, I: I32, at: int) -> bool:
    """Whether the machine is where it was in the pass that is kept."""
    if not I[at + values.JUMP_IS_KEPT]:
        return False
    kept: int = values.kept_u[(I[at + values.JUMP_LINE] & values.JUMP_MASK) * moves.AXES]
    for axis in range(moves.AXES):
        if F[kept + axis] != F[points.target_u[axis]]:
            return False
    return True


def jump_is_plain(F: F64, I: I32, at: int) -> bool:
    """Count a pass, unless its state has to be compared or kept (`loops.py`)."""
    passes: int = I[at + values.JUMP_PASSES] + 1
    if passes > I[runs.most_passes] or passes & (passes - 1) == 0 or jump_is_same(F, I, at):
        return False
    I[at + values.JUMP_PASSES] = passes
    return True
