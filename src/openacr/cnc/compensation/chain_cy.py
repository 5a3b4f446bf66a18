"""The loop of a chain: elements laid out, joined to the one before and issued, one after another.

`F` and `I` are the memory of the chain (`rows/chains.py`). Elements come as rows of moves, and
what is issued leaves as such rows (`rows/moves.py`). The loop ends where an element is more than a
part of a contour that the tool can follow: the status says what is to be done about it.
"""

from openacr.cmath import ceil, cos, fabs, sin
from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    CX,
    CY,
    END,
    FITS,
    GOUGES,
    NOTHING,
    PLAIN,
    ROLL,
    SHORTEST,
    START,
    SWEEP,
    TOOL_SWEEP,
    X0,
    X1,
    Y0,
    Y1,
    comp_lay,
)
from openacr.cnc.compensation.join_cy import (
    APART,
    BRIDGE,
    FIT_STEP,
    FORCED,
    JOINED,
    ROUND,
    comp_meet,
)
from openacr.cnc.geometry.arc_cy import arc_distance, plane_first, plane_second
from openacr.cnc.rows import chains, moves
from openacr.views import F64, I32

__all__ = [
    "chain_between",
    "chain_connect",
    "chain_drop",
    "chain_follow",
    "chain_lay",
    "chain_meet",
    "chain_move",
    "chain_push",
]

# What ends the loop.
DONE = 0
FULL = 1  # no room for what is issued
STILL = 2  # nothing moves in the plane
FOUND = 3  # there is something to report about the element, or of before
BROKEN = 4  # there is no piece before
LEADS = 5  # the piece before leads in
GOUGED = 6  # the tool cannot get from the piece before to this one
HOLDS = 7  # entries wait for the oldest piece, or there is something to report about its corner

RAPID_STEP_RAD = 1.0471975511965976  # of a corner that is rounded at rapid speed


def chain_lay(F: F64, I: I32, R: I32, ends: F64, arcs: F64, k: int) -> int:
    """Lay out element `k` of rows of moves in the next slot; returns what was found."""
    slot: int = I[chains.next_slot]
    i: int = slot * chains.COLUMNS
    p: int = chains.piece[slot * chains.PIECE]
    for n in range(moves.ROW):
        I[p + n] = R[k * moves.ROW + n]
    I[p + chains.FITS] = FITS
    I[p + chains.MEETS] = JOINED
    I[p + chains.IS_LEAD_IN] = 0
    I[p + chains.LEFT_OUT] = 0
    I[p + chains.HOLDS] = 0
    I[p + chains.TAG] = I[chains.tag] + k
    for axis in range(moves.AXES):
        F[i + START + axis] = F[chains.at_u[axis]]
        F[i + END + axis] = ends[k * moves.AXES + axis]
        F[chains.at_u[axis]] = ends[k * moves.AXES + axis]
    first: int = plane_first(I[p + moves.PLANE])
    second: int = plane_second(I[p + moves.PLANE])
    F[i + X0] = F[i + START + first]
    F[i + Y0] = F[i + START + second]
    F[i + X1] = F[i + END + first]
    F[i + Y1] = F[i + END + second]
    F[i + SWEEP] = 0.0
    if I[p + moves.KIND] == moves.ARC:
        F[i + CX] = arcs[k * moves.CURVE + moves.CENTRE_FIRST]
        F[i + CY] = arcs[k * moves.CURVE + moves.CENTRE_SECOND]
        F[i + SWEEP] = arcs[k * moves.CURVE + moves.SWEEP_RAD]
    return comp_lay(F, i, F[chains.away_u], F[chains.epsilon_u], F[chains.sweep_epsilon_rad])


def chain_line(F: F64, ax: float, ay: float, bx: float, by: float) -> None:
    """The move that is issued next goes straight from a to b."""
    F[chains.start_x] = ax
    F[chains.start_y] = ay
    F[chains.end_x] = bx
    F[chains.end_y] = by
    chain_bend(F, 0.0, 0.0, 0.0)


def chain_bend(F: F64, cx: float, cy: float, sweep: float) -> None:
    """With a sweep, that move is an arc about c."""
    F[chains.centre_x] = cx
    F[chains.centre_y] = cy
    F[chains.sweep_rad] = sweep


def chain_row(F: F64, I: I32, slot: int, axes: int, kind: int, pace: int, flags: int) -> None:
    """Issue the move; axes outside the plane go as in the columns `axes` of the slot."""
    row: int = I[chains.out_cnt]
    p: int = chains.piece[slot * chains.PIECE]
    at: int = chains.out_row[row * moves.ROW]
    end: int = chains.out_end_u[row * moves.AXES]
    for n in range(moves.ROW):
        I[at + n] = I[p + n]
    I[at + moves.KIND] = kind
    I[at + moves.PACE] = pace
    I[at + moves.FLAGS] = flags
    for axis in range(moves.AXES):
        F[end + axis] = F[slot * chains.COLUMNS + axes + axis]
    F[end + plane_first(I[p + moves.PLANE])] = F[chains.end_x]
    F[end + plane_second(I[p + moves.PLANE])] = F[chains.end_y]
    chain_curve(F, I, slot, row)
    I[chains.out_cnt] = row + 1


def chain_curve(F: F64, I: I32, slot: int, row: int) -> None:
    """Put down start, radius and, with a sweep, the arc of the move."""
    p: int = chains.piece[slot * chains.PIECE]
    extra: int = chains.out_extra[row * chains.EXTRA]
    cx: float = F[chains.centre_x]
    cy: float = F[chains.centre_y]
    F[extra] = F[chains.start_x]
    F[extra + 1] = F[chains.start_y]
    F[extra + 2] = fabs(F[slot * chains.COLUMNS + AWAY])
    F[extra + 3] = cx
    F[extra + 4] = cy
    if F[chains.sweep_rad] != 0.0:
        arc: int = chains.out_arc[row * moves.CURVE]
        first: float = F[chains.shift_u[plane_first(I[p + moves.PLANE])]]
        second: float = F[chains.shift_u[plane_second(I[p + moves.PLANE])]]
        # As if the centre came from the program: to it and back to the machine, with the rounding.
        F[arc + moves.CENTRE_FIRST] = cx - first + first
        F[arc + moves.CENTRE_SECOND] = cy - second + second
        F[arc + moves.SWEEP_RAD] = F[chains.sweep_rad]
        F[arc + moves.START_RADIUS] = arc_distance(F[chains.start_x], F[chains.start_y], cx, cy)
        F[arc + moves.END_RADIUS] = arc_distance(F[chains.end_x], F[chains.end_y], cx, cy)


def chain_is_still(F: F64, I: I32, slot: int) -> bool:
    """Whether nothing is left of a piece."""
    i: int = slot * chains.COLUMNS
    if fabs(F[i + BX] - F[i + AX]) >= SHORTEST or fabs(F[i + BY] - F[i + AY]) >= SHORTEST:
        return False
    plane: int = I[chains.piece[slot * chains.PIECE] + moves.PLANE]
    for axis in range(moves.AXES):
        if axis != plane_first(plane) and axis != plane_second(plane):
            if F[i + START + axis] != F[i + END + axis]:
                return False
    return True


def chain_move(F: F64, I: I32, slot: int) -> None:
    """Issue the move of the tool beside an element, if anything is left of it."""
    i: int = slot * chains.COLUMNS
    p: int = chains.piece[slot * chains.PIECE]
    kind: int = I[p + moves.KIND]
    sweep: float = 0.0
    I[chains.last_slot] = slot
    if kind == moves.ARC:
        kind = moves.LINE
    if F[i + TOOL_SWEEP] != 0.0 and I[p + chains.FITS] == FITS:
        sweep = F[i + TOOL_SWEEP]
        kind = moves.ARC
    elif I[p + chains.FITS] != FITS or I[p + chains.IS_LEAD_IN]:
        if chain_is_still(F, I, slot):
            return
    chain_line(F, F[i + AX], F[i + AY], F[i + BX], F[i + BY])
    chain_bend(F, F[i + CX], F[i + CY], sweep)
    chain_row(F, I, slot, END, kind, I[p + moves.PACE], moves.COMPENSATED)


def chain_insert(F: F64, I: I32, slot: int, kind: int, pace: int) -> None:
    """Issue an inserted move; axes outside the plane stay where the next element starts."""
    chain_row(F, I, slot, START, kind, pace, moves.INSERTED + moves.COMPENSATED)


def chain_around(F: F64, I: I32, slot: int, j: int) -> None:
    """Issue tangents around an arc, for rapid moves: they never come nearer to the corner."""
    i: int = slot * chains.COLUMNS
    pace: int = I[chains.piece[j * chains.PIECE] + moves.PACE]
    steps: float = ceil(fabs(F[i + ROLL]) / RAPID_STEP_RAD)
    if steps < 1.0:
        steps = 1.0
    step: float = F[i + ROLL] / steps
    x: float = F[i + BX] - F[i + X1]
    y: float = F[i + BY] - F[i + Y1]
    factor: float = 1.0 / cos(0.5 * step)
    ax: float = F[i + BX]
    ay: float = F[i + BY]
    k: float = 0.0
    while k < steps:
        c: float = cos((k + 0.5) * step) * factor
        s: float = sin((k + 0.5) * step) * factor
        bx: float = F[i + X1] + c * x - s * y
        by: float = F[i + Y1] + s * x + c * y
        chain_line(F, ax, ay, bx, by)
        chain_insert(F, I, j, moves.RAPID, pace)
        ax = bx
        ay = by
        k = k + 1.0
    chain_line(F, ax, ay, F[j * chains.COLUMNS + AX], F[j * chains.COLUMNS + AY])
    chain_insert(F, I, j, moves.RAPID, pace)


def chain_between(F: F64, I: I32, slot: int, j: int) -> None:
    """Issue the moves between the end of a piece and the start of the next one."""
    i: int = slot * chains.COLUMNS
    meets: int = I[chains.piece[slot * chains.PIECE] + chains.MEETS]
    if meets != ROUND and (meets < BRIDGE or meets == FORCED):
        return
    paced: int = chains.piece[j * chains.PIECE]
    if I[paced + moves.KIND] == moves.RAPID:
        paced = chains.piece[slot * chains.PIECE]
    kind: int = moves.RAPID if I[paced + moves.KIND] == moves.RAPID else moves.LINE
    sweep: float = 0.0
    if meets == ROUND:
        if kind == moves.RAPID:
            chain_around(F, I, slot, j)
            return
        kind = moves.ARC
        sweep = F[i + ROLL]
    following: int = j * chains.COLUMNS
    chain_line(F, F[i + BX], F[i + BY], F[following + AX], F[following + AY])
    chain_bend(F, F[i + X1], F[i + Y1], sweep)
    chain_insert(F, I, j, kind, I[paced + moves.PACE])


def chain_meet(F: F64, I: I32, slot: int, j: int, is_inside: bool) -> None:
    """Join two pieces; how they meet and whether the first one fits is noted with it."""
    i: int = slot * chains.COLUMNS
    epsilon: float = F[chains.epsilon_u]
    sweep_epsilon: float = F[chains.sweep_epsilon_rad]
    found: int = comp_meet(
        F, i, j * chains.COLUMNS, epsilon, sweep_epsilon, F[chains.root_u2], is_inside
    )
    fits: int = 0
    while found >= FIT_STEP:
        found -= FIT_STEP
        fits += 1
    I[chains.piece[slot * chains.PIECE] + chains.MEETS] = found
    I[chains.piece[slot * chains.PIECE] + chains.FITS] = fits


def chain_push(F: F64, I: I32) -> int:
    """Add the piece in the next slot to the chain, and issue those that need not wait."""
    slot: int = I[chains.next_slot]
    I[chains.is_inside] = 0
    I[chains.waiting[I[chains.piece_cnt]]] = slot
    I[chains.piece_cnt] += 1
    I[chains.next_slot] = slot + 1 if slot + 1 < chains.SLOTS else 0
    while I[chains.piece_cnt] > I[chains.most_waiting]:
        first: int = I[chains.waiting[0]]
        p: int = chains.piece[first * chains.PIECE]
        if I[p + chains.HOLDS] or I[p + chains.MEETS] > BRIDGE:
            return HOLDS
        chain_move(F, I, first)
        chain_between(F, I, first, I[chains.waiting[1]])
        chain_drop(I)
    return DONE


def chain_drop(I: I32) -> None:
    """Take the oldest piece out of the chain."""
    I[chains.piece_cnt] -= 1
    for k in range(I[chains.piece_cnt]):
        I[chains.waiting[k]] = I[chains.waiting[k + 1]]


def chain_connect(F: F64, I: I32) -> int:
    """Connect the piece in the next slot to the chain."""
    if I[chains.piece_cnt] == 0:
        return BROKEN
    last: int = I[chains.waiting[I[chains.piece_cnt] - 1]]
    p: int = chains.piece[last * chains.PIECE]
    if I[p + chains.IS_LEAD_IN]:
        return LEADS
    chain_meet(F, I, last, I[chains.next_slot], I[chains.is_inside] != 0)
    if I[p + chains.FITS] == GOUGES or I[p + chains.MEETS] == APART:
        return GOUGED
    return chain_push(F, I)


def chain_follow(F: F64, I: I32, R: I32, ends: F64, arcs: F64, first: int, count: int) -> int:
    """Add elements from `first` on to the chain, up to one that is not ordinary."""
    for k in range(first, count):
        I[chains.element] = k
        if I[chains.out_cnt] > chains.MOST_OUT - chains.OUT_ROOM:
            return FULL
        I[chains.found] = chain_lay(F, I, R, ends, arcs, k)
        if I[chains.found] == NOTHING:
            return STILL
        if I[chains.found] != PLAIN or I[chains.has_news]:
            return FOUND
        status: int = chain_connect(F, I)
        if status != DONE:
            return status
    return DONE
