"""The loop of a chain: elements laid out, joined to the one before and issued, one after another.

`F` has a row for each piece of the chain (`curve_cy`), then scratch rows and settings; `C` the
state of the chain and, for each piece, its numbers. Elements come as rows of moves, and what is
issued leaves as such rows (`canonical.batches`). The loop ends where an element is more than a
part of a contour that the tool can follow: the status says what is to be done about it.
"""

from openacr.cmath import ceil, cos, fabs, sin
from openacr.cnc.compensation.curve_cy import (
    AWAY,
    AX,
    AY,
    BX,
    BY,
    COLUMNS,
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
    TOOL_SWEEP,
    X1,
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
from openacr.views import F64, I32

__all__ = [
    "chain_between", "chain_connect", "chain_drop", "chain_follow", "chain_lay", "chain_meet",
    "chain_move", "chain_push",
]  # fmt: skip

SLOTS = 64  # more than the pieces that are not issued yet, and those left out between them
SCRATCH_CNT = 3  # rows of the search for the largest radius

# Settings, after the rows of F.
T_AWAY = COLUMNS * (SLOTS + SCRATCH_CNT)  # of the elements to come
T_EPSILON = T_AWAY + 1
T_SWEEP = T_AWAY + 2
T_ROOT = T_AWAY + 3
T_AT = T_AWAY + 4  # where the contour has come to, 8 axes
T_SHIFT = T_AWAY + 12  # from program to machine, 8 axes
T_SIZE = T_AWAY + 20

# The chain in C: what is not issued yet, the oldest first.
S_COUNT = 0
S_CHAIN = 1  # slots of its pieces
S_NEXT = 9  # the slot that is filled next
S_LAST = 10  # the slot issued last, or -1
S_WAITING = 11  # most pieces that wait
S_HAS_NEWS = 12  # there is something to report with the next element
S_IS_INSIDE = 13  # an element before the next one was left out
S_AT = 14  # the element in work
S_FOUND = 15  # what comp_lay found
S_OUT = 16  # count of rows that were issued
S_TAG = 17  # added to the number of an element
S_PIECES = 18

# A piece in C: the row of its element, then
P_FITS = 8
P_MEETS = 9  # how the next piece follows
P_IS_LEAD_IN = 10
P_LEFT_OUT = 11  # elements left out after it
P_HOLDS = 12  # entries wait for its end
P_TAG = 13  # the element it was made of; below 0 it is known
PIECE = 14
S_SIZE = S_PIECES + SLOTS * PIECE

# Rows of moves.
ROW = 8
R_KIND = 0
R_PACE = 2
R_PLANE = 3
R_FLAGS = 7
CURVE = 5
AXES = 8
RAPID = 0
LINE = 1
ARC = 2
INSERTED = 1
COMPENSATED = 2
EXTRA = 5  # of what is issued: start in the plane, radius of the tool, centre
OUT_ROOM = 128  # rows of all pieces of a chain
MOST_OUT = 1024

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


def chain_lay(F: F64, C: I32, R: I32, ends: F64, arcs: F64, k: int) -> int:
    """Lay out an element in the next slot; returns what was found."""
    slot: int = C[S_NEXT]
    i: int = slot * COLUMNS
    p: int = S_PIECES + slot * PIECE
    for n in range(ROW):
        C[p + n] = R[k * ROW + n]
    C[p + P_FITS] = FITS
    C[p + P_MEETS] = JOINED
    C[p + P_IS_LEAD_IN] = 0
    C[p + P_LEFT_OUT] = 0
    C[p + P_HOLDS] = 0
    C[p + P_TAG] = C[S_TAG] + k
    for axis in range(AXES):
        F[i + START + axis] = F[T_AT + axis]
        F[i + END + axis] = ends[k * AXES + axis]
        F[T_AT + axis] = ends[k * AXES + axis]
    first: int = plane_first(C[p + R_PLANE])
    second: int = plane_second(C[p + R_PLANE])
    cx: float = 0.0
    cy: float = 0.0
    sweep: float = 0.0
    if C[p + R_KIND] == ARC:
        cx = arcs[k * CURVE]
        cy = arcs[k * CURVE + 1]
        sweep = arcs[k * CURVE + 2]
    return comp_lay(
        F, i, F[i + START + first], F[i + START + second], F[i + END + first], F[i + END + second],
        cx, cy, sweep, F[T_AWAY], F[T_EPSILON], F[T_SWEEP],
    )  # fmt: skip


def chain_row(
    F: F64, C: I32, slot: int, x: float, y: float, axes: int, kind: int, pace: int, flags: int,
    O: I32, points: F64
) -> int:  # fmt: skip
    """Issue a move to a point of the plane; other axes as in the columns `axes` of the slot."""
    row: int = C[S_OUT]
    p: int = S_PIECES + slot * PIECE
    for n in range(ROW):
        O[row * ROW + n] = C[p + n]
    O[row * ROW + R_KIND] = kind
    O[row * ROW + R_PACE] = pace
    O[row * ROW + R_FLAGS] = flags
    for axis in range(AXES):
        points[row * AXES + axis] = F[slot * COLUMNS + axes + axis]
    points[row * AXES + plane_first(C[p + R_PLANE])] = x
    points[row * AXES + plane_second(C[p + R_PLANE])] = y
    C[S_OUT] = row + 1
    return row


def chain_curve(
    F: F64, C: I32, slot: int, row: int, ax: float, ay: float, bx: float, by: float, cx: float,
    cy: float, sweep: float, curves: F64, extra: F64
) -> None:  # fmt: skip
    """Put down start, radius and, with a sweep, the arc of an issued move."""
    p: int = S_PIECES + slot * PIECE
    extra[row * EXTRA] = ax
    extra[row * EXTRA + 1] = ay
    extra[row * EXTRA + 2] = fabs(F[slot * COLUMNS + AWAY])
    extra[row * EXTRA + 3] = cx
    extra[row * EXTRA + 4] = cy
    if sweep != 0.0:
        first: int = T_SHIFT + plane_first(C[p + R_PLANE])
        second: int = T_SHIFT + plane_second(C[p + R_PLANE])
        # As if the centre came from the program: to it and back to the machine, with the rounding.
        curves[row * CURVE] = cx - F[first] + F[first]
        curves[row * CURVE + 1] = cy - F[second] + F[second]
        curves[row * CURVE + 2] = sweep
        curves[row * CURVE + 3] = arc_distance(ax, ay, cx, cy)
        curves[row * CURVE + 4] = arc_distance(bx, by, cx, cy)


def chain_is_still(F: F64, C: I32, slot: int) -> bool:
    """Whether nothing is left of a piece."""
    i: int = slot * COLUMNS
    if fabs(F[i + BX] - F[i + AX]) >= SHORTEST or fabs(F[i + BY] - F[i + AY]) >= SHORTEST:
        return False
    plane: int = C[S_PIECES + slot * PIECE + R_PLANE]
    for axis in range(AXES):
        if axis != plane_first(plane) and axis != plane_second(plane):
            if F[i + START + axis] != F[i + END + axis]:
                return False
    return True


def chain_move(
    F: F64, C: I32, slot: int, O: I32, points: F64, curves: F64, extra: F64
) -> None:  # fmt: skip
    """Issue the move of the tool beside an element, if anything is left of it."""
    i: int = slot * COLUMNS
    p: int = S_PIECES + slot * PIECE
    kind: int = C[p + R_KIND]
    sweep: float = 0.0
    C[S_LAST] = slot
    if kind == ARC:
        kind = LINE
    if F[i + TOOL_SWEEP] != 0.0 and C[p + P_FITS] == FITS:
        sweep = F[i + TOOL_SWEEP]
        kind = ARC
    elif (C[p + P_FITS] != FITS or C[p + P_IS_LEAD_IN]) and chain_is_still(F, C, slot):
        return
    row: int = chain_row(
        F, C, slot, F[i + BX], F[i + BY], END, kind, C[p + R_PACE], COMPENSATED, O, points
    )
    chain_curve(
        F, C, slot, row, F[i + AX], F[i + AY], F[i + BX], F[i + BY], F[i + CX], F[i + CY], sweep,
        curves, extra,
    )  # fmt: skip


def chain_insert(
    F: F64, C: I32, slot: int, ax: float, ay: float, bx: float, by: float, cx: float, cy: float,
    sweep: float, kind: int, pace: int, O: I32, points: F64, curves: F64, extra: F64
) -> None:  # fmt: skip
    """Issue an inserted move; axes outside the plane stay where the next element starts."""
    flags: int = INSERTED + COMPENSATED
    row: int = chain_row(F, C, slot, bx, by, START, kind, pace, flags, O, points)
    chain_curve(F, C, slot, row, ax, ay, bx, by, cx, cy, sweep, curves, extra)


def chain_around(
    F: F64, C: I32, slot: int, j: int, O: I32, points: F64, curves: F64, extra: F64
) -> None:  # fmt: skip
    """Issue tangents around an arc, for rapid moves: they never come nearer to the corner."""
    i: int = slot * COLUMNS
    pace: int = C[S_PIECES + j * PIECE + R_PACE]
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
        chain_insert(
            F, C, j, ax, ay, bx, by, 0.0, 0.0, 0.0, RAPID, pace, O, points, curves, extra
        )  # fmt: skip
        ax = bx
        ay = by
        k = k + 1.0
    bx = F[j * COLUMNS + AX]
    by = F[j * COLUMNS + AY]
    chain_insert(F, C, j, ax, ay, bx, by, 0.0, 0.0, 0.0, RAPID, pace, O, points, curves, extra)


def chain_between(
    F: F64, C: I32, slot: int, j: int, O: I32, points: F64, curves: F64, extra: F64
) -> None:  # fmt: skip
    """Issue the moves between the end of a piece and the start of the next one."""
    i: int = slot * COLUMNS
    meets: int = C[S_PIECES + slot * PIECE + P_MEETS]
    if meets != ROUND and (meets < BRIDGE or meets == FORCED):
        return
    paced: int = S_PIECES + j * PIECE
    if C[paced + R_KIND] == RAPID:
        paced = S_PIECES + slot * PIECE
    kind: int = RAPID if C[paced + R_KIND] == RAPID else LINE
    sweep: float = 0.0
    if meets == ROUND:
        if kind == RAPID:
            chain_around(F, C, slot, j, O, points, curves, extra)
            return
        kind = ARC
        sweep = F[i + ROLL]
    chain_insert(
        F, C, j, F[i + BX], F[i + BY], F[j * COLUMNS + AX], F[j * COLUMNS + AY], F[i + X1],
        F[i + Y1], sweep, kind, C[paced + R_PACE], O, points, curves, extra,
    )  # fmt: skip


def chain_meet(F: F64, C: I32, slot: int, j: int, is_inside: bool) -> None:
    """Join two pieces; how they meet and whether the first one fits is noted with it."""
    found: int = comp_meet(
        F, slot * COLUMNS, j * COLUMNS, F[T_EPSILON], F[T_SWEEP], F[T_ROOT], is_inside
    )  # fmt: skip
    fits: int = 0
    while found >= FIT_STEP:
        found -= FIT_STEP
        fits += 1
    C[S_PIECES + slot * PIECE + P_MEETS] = found
    C[S_PIECES + slot * PIECE + P_FITS] = fits


def chain_push(
    F: F64, C: I32, O: I32, points: F64, curves: F64, extra: F64
) -> int:  # fmt: skip
    """Add the piece in the next slot to the chain, and issue those that need not wait."""
    slot: int = C[S_NEXT]
    C[S_IS_INSIDE] = 0
    C[S_CHAIN + C[S_COUNT]] = slot
    C[S_COUNT] = C[S_COUNT] + 1
    C[S_NEXT] = slot + 1 if slot + 1 < SLOTS else 0
    while C[S_COUNT] > C[S_WAITING]:
        first: int = C[S_CHAIN]
        p: int = S_PIECES + first * PIECE
        if C[p + P_HOLDS] or C[p + P_MEETS] > BRIDGE:
            return HOLDS
        chain_move(F, C, first, O, points, curves, extra)
        chain_between(F, C, first, C[S_CHAIN + 1], O, points, curves, extra)
        chain_drop(C)
    return DONE


def chain_drop(C: I32) -> None:
    """Take the oldest piece out of the chain."""
    C[S_COUNT] = C[S_COUNT] - 1
    for k in range(C[S_COUNT]):
        C[S_CHAIN + k] = C[S_CHAIN + k + 1]


def chain_connect(
    F: F64, C: I32, O: I32, points: F64, curves: F64, extra: F64
) -> int:  # fmt: skip
    """Connect the piece in the next slot to the chain."""
    if C[S_COUNT] == 0:
        return BROKEN
    last: int = C[S_CHAIN + C[S_COUNT] - 1]
    p: int = S_PIECES + last * PIECE
    if C[p + P_IS_LEAD_IN]:
        return LEADS
    chain_meet(F, C, last, C[S_NEXT], C[S_IS_INSIDE] != 0)
    if C[p + P_FITS] == GOUGES or C[p + P_MEETS] == APART:
        return GOUGED
    return chain_push(F, C, O, points, curves, extra)


def chain_follow(
    F: F64, C: I32, R: I32, ends: F64, arcs: F64, first: int, count: int, O: I32, points: F64,
    curves: F64, extra: F64
) -> int:  # fmt: skip
    """Add elements from `first` on to the chain, up to one that is not ordinary."""
    for k in range(first, count):
        C[S_AT] = k
        if C[S_OUT] > MOST_OUT - OUT_ROOM:
            return FULL
        C[S_FOUND] = chain_lay(F, C, R, ends, arcs, k)
        if C[S_FOUND] == NOTHING:
            return STILL
        if C[S_FOUND] != PLAIN or C[S_HAS_NEWS]:
            return FOUND
        status: int = chain_connect(F, C, O, points, curves, extra)
        if status != DONE:
            return status
    return DONE
