"""Blocks executed many at a time: modal codes, feeds, straight moves and arcs.

A step of a plan (`rows/plans.py`) sets a row of the modal state, takes F, computes (`values_cy`),
or moves as the motion in force does:

    position  p = word * times / per          + p in G91; rotary words as they are
    target    p + shift                       a row is written where the machine moves

A line that cannot be executed so - its values are wrong or doubtful, or nothing says how - is
left with the state from before it: the parser reads it again, and says what is wrong.
"""

from openacr.cmath import floor
from openacr.cnc.geometry.arc_cy import (
    ARC_DONE,
    arc_about,
    arc_centre,
    arc_is_near,
    plane_first,
    plane_second,
)
from openacr.cnc.rows import arcs, modes, moves, plans, points, results, runs, scans
from openacr.views import F64, I32


def block_keep(F: F64, I: I32) -> None:
    """Keep the state from before a line."""
    for k in range(modes.STATE):
        I[modes.kept[k]] = I[modes.state[k]]
    F[points.kept_times] = F[points.times]
    F[points.kept_per] = F[points.per]
    F[points.kept_feed_upm] = F[points.feed_upm]


def block_restore(F: F64, I: I32) -> None:
    """Go back to the state from before a line."""
    for k in range(modes.STATE):
        I[modes.state[k]] = I[modes.kept[k]]
    F[points.times] = F[points.kept_times]
    F[points.per] = F[points.kept_per]
    F[points.feed_upm] = F[points.kept_feed_upm]
    F[results.feed_upm[I[modes.pace]]] = F[points.feed_upm]


def block_length(F: F64, value: float) -> float:
    """A length in active units, in default units."""
    return value * F[points.times] / F[points.per]


def block_row(I: I32, kind: int) -> int:
    """Add a row; returns its number. There is room for it."""
    row: int = I[modes.move_cnt]
    at: int = results.row[row * moves.ROW]
    I[at + moves.KIND] = kind
    I[at + moves.LINE_NUMBER] = I[runs.line]
    I[at + moves.PACE] = I[modes.pace]
    I[at + moves.PLANE] = I[modes.plane]
    I[at + moves.START] = I[runs.line_start]
    I[at + moves.STOP] = I[runs.line_stop]
    I[at + moves.TEXT] = I[runs.line_text]
    I[at + moves.FLAGS] = 0
    I[modes.move_cnt] = row + 1
    return row


def block_note(F: F64, I: I32, plan: int, at: int) -> int:
    """Note the words of a code whose handler is called in its place between the moves."""
    row: int = block_row(I, moves.NOTE)
    I[results.row[row * moves.ROW + moves.PLANE]] = I[at + 1]
    letters: int = plan + I[at + 2]
    for k in range(I[letters]):
        F[results.end_u[row * moves.AXES + k]] = F[scans.word[I[letters + 1 + k]]]
    if I[at] == plans.STEP_NOTE:
        I[modes.idle_cnt] = 0
    if I[at] == plans.STEP_TURN:
        I[runs.has_turned] = 1
    return runs.TAKEN


def block_limit(F: F64, letter: int, limit: int) -> int:
    """Leave a block whose word is out of its limits, or has to be whole and is not."""
    value: float = F[scans.word[letter]]
    at: int = plans.limit[plans.LIMIT * limit]
    if value < F[at] or value > F[at + 1]:
        return runs.LEFT
    return runs.LEFT if F[at + 2] != 0.0 and floor(value) != value else runs.TAKEN


def block_set(F: F64, I: I32, step: int, row: int, value: int) -> int:
    """Set a row of the modal state."""
    if I[modes.state[row]] != value:
        if step == plans.STEP_KEEP or (step == plans.STEP_BAR and I[modes.cycle] != modes.NO_CYCLE):
            return runs.LEFT
        if step == plans.STEP_BAR and I[modes.compensation] != modes.OFF:
            return runs.LEFT
        if (step == plans.STEP_UNIT or step == plans.STEP_ALONE) and I[modes.move_cnt] > 0:
            return runs.LEFT
    I[modes.state[row]] = value
    if step == plans.STEP_UNIT:
        unit: int = 0 if value == modes.INCH else 2
        F[points.times] = F[points.factor[unit]]
        F[points.per] = F[points.factor[unit + 1]]
    return runs.TAKEN


def block_call(I: I32, note: int) -> int:
    """Have the handler of a note called, unless it has been for this line."""
    if I[modes.compensation] != modes.OFF:
        return runs.LEFT
    I[runs.call_cnt] += 1
    if I[runs.call_cnt] <= I[runs.called_cnt]:
        return runs.TAKEN
    I[runs.call] = note
    return runs.CALLED


def block_feed(F: F64, I: I32) -> int:
    """Take F; rows before have a pace of their own."""
    rows: int = I[modes.move_cnt]
    if F[scans.word[plans.LETTER_F]] <= 0.0:
        return runs.LEFT
    feed: float = block_length(F, F[scans.word[plans.LETTER_F]])
    I[modes.has_feed] = 1
    if feed != F[points.feed_upm]:
        if rows > 0 and I[runs.is_plain]:
            return runs.LEFT
        if rows > 0 and I[results.row[(rows - 1) * moves.ROW + moves.PACE]] == I[modes.pace]:
            I[modes.pace] += 1
        F[points.feed_upm] = feed
        F[results.feed_upm[I[modes.pace]]] = feed
    return runs.TAKEN


def block_end(F: F64, I: I32, named: int) -> None:
    """Find the program point a block goes to."""
    for axis in range(moves.AXES):
        at: float = F[points.position_u[axis]]
        if named & (1 << axis):
            value: float = F[scans.word[I[runs.letter_of[axis]]]]
            if not I[scans.rotary_axes] & (1 << axis):
                value = block_length(F, value)
            at = at + value if I[modes.distance] == modes.INCREMENTAL else value
        F[points.end_u[axis]] = at


def block_target(F: F64, I: I32) -> bool:
    """Find the machine point of that point; returns whether the machine moves."""
    is_moving: bool = False
    for axis in range(moves.AXES):
        at: float = F[points.end_u[axis]]
        if I[runs.is_shifted]:
            at = at + F[points.shift_u[axis]]
        F[points.goal_u[axis]] = at
        if at != F[points.target_u[axis]]:
            is_moving = True
    return is_moving


def block_go(F: F64, I: I32, kind: int) -> int:
    """Add a move to the point that was found; returns its row."""
    row: int = block_row(I, kind)
    for axis in range(moves.AXES):
        F[points.target_u[axis]] = F[points.goal_u[axis]]
        F[results.end_u[row * moves.AXES + axis]] = F[points.goal_u[axis]]
    I[modes.idle_cnt] = 0
    return row


def block_straight(F: F64, I: I32, kind: int) -> None:
    """Go straight to the point that was found; a row is written where the machine moves."""
    if block_target(F, I) or I[modes.compensation] != modes.OFF:
        block_go(F, I, kind)
    for axis in range(moves.AXES):
        F[points.position_u[axis]] = F[points.end_u[axis]]


def block_centre(F: F64, I: I32, axis: int, words: int) -> float:
    """One coordinate of the centre by I, J or K."""
    start: float = F[points.position_u[axis]]
    if not words & (1 << axis):
        return start
    length: float = block_length(F, F[scans.word[plans.LETTER_I + axis]])
    if I[modes.centres] == 2:
        return length
    return start + length if I[modes.centres] == 1 else start - length


def block_arc(F: F64, I: I32, row: int, words: int) -> int:
    """Find the arc to the end of a block; LEFT if it is wrong or doubtful."""
    first: int = plane_first(I[modes.plane])
    second: int = plane_second(I[modes.plane])
    arc: int = points.arc[0]
    direction: int = -1 if I[modes.motion] == 2 else 1
    F[arc + arcs.X0] = F[points.position_u[first]]
    F[arc + arcs.Y0] = F[points.position_u[second]]
    F[arc + arcs.X1] = F[points.end_u[first]]
    F[arc + arcs.Y1] = F[points.end_u[second]]
    if words & plans.BIT_R:
        radius: float = block_length(F, F[scans.word[plans.LETTER_R]])
        if words & plans.CENTRE_BITS:
            return runs.LEFT
        if arc_centre(F, arc, radius, direction, F[points.epsilon_u]) != ARC_DONE:
            return runs.LEFT
    else:
        if words == 0 or words & (1 << (3 - first - second)):
            return runs.LEFT
        F[arc + arcs.CX] = block_centre(F, I, first, words)
        F[arc + arcs.CY] = block_centre(F, I, second, words)
    if arc_about(F, arc, direction) != ARC_DONE:
        return runs.LEFT
    if not arc_is_near(F[arc + arcs.R0], F[arc + arcs.R1], F[points.near_u]):
        return runs.LEFT
    at: int = results.arc[row * moves.CURVE]
    F[at + moves.CENTRE_FIRST] = F[arc + arcs.CX] + F[points.shift_u[first]]
    F[at + moves.CENTRE_SECOND] = F[arc + arcs.CY] + F[points.shift_u[second]]
    F[at + moves.SWEEP_RAD] = F[arc + arcs.SWEEP_RAD]
    F[at + moves.START_RADIUS] = F[arc + arcs.R0]
    F[at + moves.END_RADIUS] = F[arc + arcs.R1]
    return runs.TAKEN


def block_move(F: F64, I: I32, plan: int) -> int:
    """Move as the motion in force does; a row is written where the machine moves."""
    words: int = I[plan + plans.WORDS]
    motion: int = I[modes.motion]
    block_end(F, I, I[plan + plans.AXES])
    if motion == 0 or motion == 1:
        if words:
            return runs.LEFT
        block_straight(F, I, motion)
        return runs.TAKEN
    if (motion != 2 and motion != 3) or words > plans.ARC_BITS:
        return runs.LEFT
    if block_arc(F, I, I[modes.move_cnt], words) == runs.LEFT:
        return runs.LEFT
    block_target(F, I)
    block_go(F, I, moves.ARC)
    for axis in range(moves.AXES):
        F[points.position_u[axis]] = F[points.end_u[axis]]
    return runs.TAKEN
