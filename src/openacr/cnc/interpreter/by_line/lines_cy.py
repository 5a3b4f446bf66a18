"""Lines executed many at a time: the steps of their plans, one line after another.

`data` is the text, `F` and `I` the memory of the interpreter (`cnc/rows`), `cells` the cells of the
store with their state in `states`.
"""

from openacr.cnc.interpreter.by_line.blocks_cy import (
    block_call,
    block_feed,
    block_keep,
    block_limit,
    block_move,
    block_note,
    block_restore,
    block_set,
)
from openacr.cnc.interpreter.by_line.cycles_cy import cycle_end, cycle_run
from openacr.cnc.interpreter.by_line.formulas_cy import formula_run
from openacr.cnc.interpreter.by_line.values_cy import (
    jump_is_plain,
    jump_place,
    value_step,
    value_undo,
)
from openacr.cnc.reading.rich_cy import scan_rich
from openacr.cnc.reading.scan_cy import scan_line, scan_shape
from openacr.cnc.rows import modes, plans, runs, scans, values
from openacr.views import F64, I32, U8

__all__ = ["run_lines"]


def block_jump(F: F64, I: I32, cells: F64, states: I32, plan: int, at: int, line: int) -> int:
    """Jump if the condition of the step at `at` is met; LEFT if the target is not known here."""
    how: int = I[at + 1]
    if I[at + 2]:
        if not formula_run(F, I, cells, states, plan + I[at + 2]):
            return runs.LEFT
        if (F[values.stack[0]] != 0.0) != (how & plans.JUMP_IF_TRUE != 0):
            return runs.TAKEN
    jump: int = jump_place(I, line)
    if jump < 0:
        return runs.LEFT
    if how & plans.JUMP_COUNTS and I[runs.most_passes]:
        if not jump_is_plain(F, I, jump):
            return runs.LEFT
    I[scans.next_at] = I[jump + values.JUMP_PLACE] - I[runs.first_at]
    I[scans.next_line] = I[jump + values.JUMP_TARGET]
    I[runs.jump_cnt] += 1
    return runs.JUMPED


def block_run(F: F64, I: I32, cells: F64, states: I32, plan: int, line: int) -> int:
    """Execute the steps of one block; LEFT or CALLED where it is left as it was."""
    if I[runs.is_plain] and not I[plan + plans.IS_PLAIN]:
        return runs.LEFT
    if I[modes.idle_cnt] >= runs.MOST_IDLE - plans.MOST_STROKE:
        return runs.LEFT
    block_keep(F, I)
    I[values.undo_cnt] = 0
    I[runs.call_cnt] = 0
    I[modes.idle_cnt] += 1
    done: int = runs.TAKEN
    at: int = plan + plans.STEPS
    for _ in range(I[plan + plans.STEP_CNT]):
        step: int = I[at]
        if step == plans.STEP_MOVE and I[modes.cycle] == modes.NO_CYCLE:
            done = block_move(F, I, plan)
        elif step == plans.STEP_FEED:
            done = block_feed(F, I)
        elif step == plans.STEP_JUMP:
            done = block_jump(F, I, cells, states, plan, at, line)
        elif step == plans.STEP_MOVE or step == plans.STEP_DRILL:
            done = cycle_run(F, I, cells, states, plan, I[at + 1])
        elif step == plans.STEP_LIMIT:
            done = block_limit(F, I[at + 1], I[at + 2])
        elif step == plans.STEP_NOTE or step == plans.STEP_SHOW or step == plans.STEP_TURN:
            done = block_note(F, I, plan, at)
        elif step == plans.STEP_END_CYCLE:
            cycle_end(I)
        elif step == plans.STEP_CALL:
            done = block_call(I, I[at + 1])
        elif step > plans.STEP_MOVE and step < plans.STEP_JUMP:
            done = value_step(F, I, cells, states, plan, at)
        else:
            done = block_set(F, I, step, I[at + 1], I[at + 2])
        if done == runs.LEFT or done == runs.CALLED:
            block_restore(F, I)
            value_undo(F, I, cells, states)
            return done
        at += 3
    return done


def run_lines(data: U8, pos: int, stop: int, F: F64, I: I32, cells: F64, states: I32) -> None:
    """Execute lines from `pos` on until one is left, or there is no room for more moves.

    `scans.next_at`, `scans.status` and the rows beside them have where it ended and why.
    """
    line: int = I[runs.first_line]
    last: int = pos
    last_line: int = line
    count: int = 0
    status: int = scans.AT_END
    has_words: int = 0
    while 0 <= pos < stop and I[modes.move_cnt] < runs.MOST_ROWS and status == scans.AT_END:
        after: int = scan_line(data, pos, stop, F, I)
        if after < 0 and I[runs.has_values]:
            after = scan_rich(data, pos, stop, F, I)
        if after < 0:
            status = scans.HARD
            break
        done: int = runs.TAKEN
        if I[scans.token_cnt]:
            plan: int = scan_shape(I)
            if plan < 0:
                status = scans.NEW if plan == scans.NO_SHAPE else scans.SLOW
                break
            I[runs.line] = line
            I[runs.line_start] = pos
            I[runs.line_stop] = after
            done = block_run(F, I, cells, states, plan, line)
            if done == runs.CALLED:
                status = scans.CALLED
                break
            I[runs.called_cnt] = 0
            if done == runs.LEFT:
                status = scans.LEFT
                break
            has_words = 1
        last = pos
        last_line = line
        count += 1
        line += 1
        pos = after
        if done == runs.JUMPED:
            line = I[scans.next_line]
            pos = I[scans.next_at]
    I[scans.next_line] = line
    I[scans.next_at] = pos
    I[scans.last_at] = last
    I[scans.last_line] = last_line
    I[scans.line_cnt] = count
    I[scans.status] = status
    I[scans.has_words] = has_words
