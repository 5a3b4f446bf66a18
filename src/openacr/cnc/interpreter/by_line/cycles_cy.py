"""Canned cycles: the holes of a block, each with the text of its cycle as plans.

What a hole needs to know is in the cells from P249 on, as the text finds them. A block is left
where one of its holes cannot be executed so.
"""

from openacr.cnc.geometry.arc_cy import plane_first, plane_second
from openacr.cnc.interpreter.by_line.blocks_cy import (
    block_end,
    block_feed,
    block_length,
    block_limit,
    block_note,
    block_set,
    block_straight,
)
from openacr.cnc.interpreter.by_line.formulas_cy import formula_run
from openacr.cnc.interpreter.by_line.values_cy import value_cell, value_step
from openacr.cnc.rows import holes, modes, moves, plans, points, runs, scans, values
from openacr.views import F64, I32

CELL_CODE = 249  # the first of the cells of a cycle
CELL_DIRECTION = 270  # the last one


def cycle_keep(F: F64) -> None:
    """Keep where the machine is, and the words of the cycle."""
    for axis in range(moves.AXES):
        F[holes.kept_position_u[axis]] = F[points.position_u[axis]]
        F[holes.kept_target_u[axis]] = F[points.target_u[axis]]
    for k in range(holes.DRILLING):
        F[holes.kept_drilling[k]] = F[holes.drilling[k]]


def cycle_restore(F: F64) -> int:
    """Go back to what was kept: the block is left."""
    for axis in range(moves.AXES):
        F[points.position_u[axis]] = F[holes.kept_position_u[axis]]
        F[points.target_u[axis]] = F[holes.kept_target_u[axis]]
    for k in range(holes.DRILLING):
        F[holes.drilling[k]] = F[holes.kept_drilling[k]]
    return runs.LEFT


def cycle_drill_axis(plane: int) -> int:
    """The axis across a plane."""
    return 3 - plane_first(plane) - plane_second(plane)


def cycle_begin(F: F64, I: I32, code: int) -> None:
    """A code of a cycle: without one that is active its words are new."""
    is_first: bool = I[modes.cycle] == modes.NO_CYCLE
    if is_first:
        I[modes.is_drilling] = 1
        I[modes.level_form] = 0
        I[modes.bottom_form] = 0
        I[modes.cycle_words] = 0
    if is_first or not I[holes.rises]:
        F[holes.initial_u] = F[points.position_u[cycle_drill_axis(I[modes.plane])]]
    I[modes.cycle] = code


def cycle_end(I: I32) -> None:
    """G80."""
    I[modes.cycle] = modes.NO_CYCLE
    I[modes.is_drilling] = 0


def cycle_take(F: F64, I: I32, axes: int, words: int, drill: int) -> None:
    """Take the words of a block, which are kept for the blocks after it."""
    how: int = modes.INCREMENTS if I[modes.distance] == modes.INCREMENTAL else modes.WRITTEN
    if axes & (1 << drill):
        F[holes.bottom_u] = block_length(F, F[scans.word[I[runs.letter_of[drill]]]])
        I[modes.bottom_form] = how
    if words & plans.BIT_R:
        F[holes.level_u] = block_length(F, F[scans.word[plans.LETTER_R]])
        I[modes.level_form] = how
    if words & plans.BIT_Q:
        F[holes.peck] = F[scans.word[plans.LETTER_Q]]
        I[modes.cycle_words] |= modes.HAS_PECK
    if words & plans.BIT_P:
        F[holes.rest_s] = F[scans.word[plans.LETTER_P]]
        I[modes.cycle_words] |= modes.HAS_REST


def cycle_level(F: F64, I: I32) -> float:
    """The R level."""
    if I[modes.level_form] == modes.INCREMENTS:
        return F[holes.level_u] + F[holes.initial_u]
    return F[holes.level_u]


def cycle_bottom(F: F64, I: I32, level: float) -> float:
    """The bottom of the holes."""
    if I[modes.bottom_form] == modes.INCREMENTS:
        return F[holes.bottom_u] + level
    return F[holes.bottom_u]


def cycle_peck(F: F64, I: I32) -> float:
    """Q, 0 where there is none."""
    return F[holes.peck] if I[modes.cycle_words] & modes.HAS_PECK else 0.0


def cycle_is_plain(F: F64, I: I32) -> bool:
    """Whether the words of a cycle are there, and nothing is doubtful."""
    code: int = I[modes.cycle]
    if not I[modes.is_drilling] or not I[modes.level_form] or not I[modes.bottom_form]:
        return False
    if (code == modes.PECK or code == modes.PECK_BREAK) and cycle_peck(F, I) <= 0.0:
        return False
    level: float = cycle_level(F, I)
    if cycle_bottom(F, I, level) > level:
        return False
    if I[holes.rises] or I[modes.return_level] == modes.RETURN_R:
        return True
    return F[holes.initial_u] >= level


def cycle_shown(F: F64, value: float) -> float:
    """A length in default units, in active units."""
    return value * F[points.per] / F[points.times]


def cycle_value(F: F64, I: I32, n: int, left: int) -> float:
    """What the text of a cycle finds in cell `n`."""
    level: float = cycle_level(F, I)
    initial: float = F[holes.initial_u]
    if I[holes.rises] and level > initial:
        initial = level
    if n == 249:
        return float(I[modes.cycle])
    if n == 250:
        return cycle_shown(F, F[points.position_u[plane_first(I[modes.plane])]])
    if n == 251:
        return cycle_shown(F, F[points.position_u[plane_second(I[modes.plane])]])
    if n == 252:
        return cycle_shown(F, cycle_bottom(F, I, level))
    if n == 253:
        return cycle_shown(F, level)
    if n == 254:
        return cycle_shown(F, initial)
    if n == 255:
        return cycle_shown(F, level if I[modes.return_level] == modes.RETURN_R else initial)
    if n == 256:
        return cycle_peck(F, I)
    if n == 257:
        return F[holes.rest_s] if I[modes.cycle_words] & modes.HAS_REST else 0.0
    if n == 258:
        return cycle_shown(F, F[points.feed_upm])
    if n == 259:
        return float(left)
    if n == 260 or n == 261:
        return cycle_shown(F, F[holes.clear_u[n - 260]])
    if n == 262 or n == 263:
        return F[holes.sign[n - 262]] * cycle_peck(F, I)
    if n == 264:
        return F[holes.spin]
    if n == 265:
        return float(I[modes.return_level])
    if n == 266:
        return float(I[modes.plane])
    if n == 267:
        return float(I[modes.distance])
    return 1.0 if n == CELL_DIRECTION else 0.0


def cycle_cells(F: F64, I: I32, cells: F64, states: I32, left: int) -> int:
    """Fill the cells of a cycle."""
    for n in range(CELL_CODE, CELL_DIRECTION + 1):
        if not value_cell(F, I, cells, states, n, cycle_value(F, I, n, left)):
            return runs.LEFT
    return runs.TAKEN


def cycle_move(F: F64, I: I32, letters: int) -> int:
    """A straight move of the text: X, Y, Z are the axes of the plane and the one across it."""
    if I[modes.motion] != 0 and I[modes.motion] != 1:
        return runs.LEFT
    for axis in range(moves.AXES):
        F[points.end_u[axis]] = F[points.position_u[axis]]
    for k in range(3):
        if letters & (1 << k):
            place: int = cycle_drill_axis(I[modes.plane])
            if k < 2:
                place = plane_second(I[modes.plane]) if k else plane_first(I[modes.plane])
            F[points.end_u[place]] = block_length(F, F[scans.word[plans.LETTER_X + k]])
    block_straight(F, I, I[modes.motion])
    return runs.TAKEN


def cycle_line(F: F64, I: I32, cells: F64, states: I32, plan: int, following: int) -> int:
    """Execute a line of the text; the line after it, or RETURNED, or CUT_SHORT."""
    done: int = runs.TAKEN
    at: int = plan + plans.STEPS
    for _ in range(I[plan + plans.STEP_CNT]):
        step: int = I[at]
        if step == plans.STEP_MOVE:
            done = cycle_move(F, I, I[plan + plans.AXES])
        elif step == plans.STEP_FEED:
            done = block_feed(F, I)
        elif step == plans.STEP_NOTE:
            done = block_note(F, I, plan, at)
        elif step == plans.STEP_LIMIT:
            done = block_limit(F, I[at + 1], I[at + 2])
        elif step == plans.STEP_SET or step == plans.STEP_BAR:
            done = block_set(F, I, step, I[at + 1], I[at + 2])
        elif step == plans.STEP_GO or step == plans.STEP_RETURN:
            if I[at + 2] and not formula_run(F, I, cells, states, plan + I[at + 2]):
                return plans.CUT_SHORT
            if not I[at + 2] or F[values.stack[0]] != 0.0:
                return I[at + 1] if step == plans.STEP_GO else plans.RETURNED
        else:
            done = value_step(F, I, cells, states, plan, at)
        if done == runs.LEFT:
            return plans.CUT_SHORT
        at += 3
    return following


def cycle_stroke(F: F64, I: I32, cells: F64, states: I32) -> int:
    """Execute the text of the cycle at a hole."""
    cycle: int = I[modes.cycle]
    motion: int = I[modes.motion]
    stroke: int = I[holes.stroke[cycle - modes.FIRST_CYCLE]]
    line: int = 0
    lines: int = 0
    I[modes.cycle] = modes.NO_CYCLE
    while 0 <= line < I[stroke]:
        at: int = stroke + 1 + plans.STROKE * line
        lines += 1
        if lines > plans.MOST_STROKE:
            return runs.LEFT
        if I[modes.move_cnt] + I[I[at] + plans.STEP_CNT] > runs.MOST_ROWS:
            return runs.LEFT
        I[runs.line] = I[at + 1]
        I[runs.line_start] = I[at + 2]
        I[runs.line_stop] = I[at + 3]
        I[modes.idle_cnt] += 1
        line = cycle_line(F, I, cells, states, I[at], line + 1)
    I[modes.cycle] = cycle
    I[modes.motion] = motion
    return runs.TAKEN if line == plans.RETURNED else runs.LEFT


def cycle_hole(F: F64, I: I32, cells: F64, states: I32, axes: int, left: int) -> int:
    """Go to the next hole and execute the text of the cycle."""
    if I[modes.move_cnt] >= runs.MOST_ROWS:
        return runs.LEFT
    block_end(F, I, axes & ~(1 << cycle_drill_axis(I[modes.plane])))
    block_straight(F, I, moves.RAPID)
    if cycle_cells(F, I, cells, states, left) == runs.LEFT:
        return runs.LEFT
    for k in range(scans.LETTERS):
        F[holes.kept_word[k]] = F[scans.word[k]]
    line: int = I[runs.line]
    begin: int = I[runs.line_start]
    end: int = I[runs.line_stop]
    I[runs.line_text] = 1
    done: int = cycle_stroke(F, I, cells, states)
    for k in range(scans.LETTERS):
        F[scans.word[k]] = F[holes.kept_word[k]]
    I[runs.line] = line
    I[runs.line_start] = begin
    I[runs.line_stop] = end
    I[runs.line_text] = 0
    return done


def cycle_holes(F: F64, I: I32, cells: F64, states: I32, plan: int) -> int:
    """The holes of a block; LEFT where they need more than is known here."""
    words: int = I[plan + plans.WORDS]
    drill: int = cycle_drill_axis(I[modes.plane])
    repeats: float = F[scans.word[plans.LETTER_L]] if words & plans.BIT_L else 1.0
    if words & plans.CENTRE_BITS or not I[holes.stroke[I[modes.cycle] - modes.FIRST_CYCLE]]:
        return runs.LEFT
    if repeats > plans.MOST_REPEATS or float(int(repeats)) != repeats:
        return runs.LEFT
    cycle_take(F, I, I[plan + plans.AXES], words, drill)
    if not cycle_is_plain(F, I) or I[modes.move_cnt] >= runs.MOST_ROWS:
        return runs.LEFT
    level: float = cycle_level(F, I)
    if I[holes.rises] and F[points.position_u[drill]] < level:
        for axis in range(moves.AXES):
            F[points.end_u[axis]] = F[points.position_u[axis]]
        F[points.end_u[drill]] = level
        block_straight(F, I, moves.RAPID)
    left: int = int(repeats)
    done: int = runs.TAKEN
    while left > 0 and done == runs.TAKEN:
        done = cycle_hole(F, I, cells, states, I[plan + plans.AXES], left)
        left -= 1
    return done


def cycle_run(F: F64, I: I32, cells: F64, states: I32, plan: int, code: int) -> int:
    """The holes of a block, with the code of a cycle or 0; a block that is left changes nothing."""
    if I[modes.compensation] != modes.OFF or I[runs.has_turned]:
        return runs.LEFT
    cycle_keep(F)
    if code:
        cycle_begin(F, I, code)
    done: int = cycle_holes(F, I, cells, states, plan)
    return cycle_restore(F) if done == runs.LEFT else runs.TAKEN
