"""What straight moves of a cutter leave of the material, as heights at the middles of cells.

`H`: the heights, row by row of Y; `M`: marks of the cells; `G`: what holds for all moves, and the
piece of a move in hand; `P`: x y z of the begin of the first move and of the end of every move;
`K`: kinds of the moves; `R`: their marks.

With the radius r, the place of a cell u along and q across the line of a move, its slope k,
w = sqrt(r^2 - q^2) and the axis of the cutter at c, from 0 to the length of the move:

    flat end    the lowest height of the tip for |u - c| <= w, which is at an end of that interval
    ball end    k c + r - sqrt(w^2 - (u - c)^2), lowest at u - c = k w / sqrt(1 + k^2)

so a move is exact at every cell, however it slopes.
"""

from openacr.cmath import fabs, sqrt
from openacr.views import F64, U8

__all__ = ["removal_moves"]

G_X_U = 0  # low corner
G_Y_U = 1
G_CELL_U = 2
G_COLUMNS = 3
G_ROWS = 4
G_BOTTOM_U = 5  # of the blank
G_TOP_U = 6
G_TOLERANCE_U = 7  # a rapid less deep in material, or a cut less below the bottom, is not marked
G_RADIUS_U = 8  # of the cutter
G_IS_BALL = 9
G_BEGIN_U = 10  # x y z of a piece,
G_TRAVEL_U = 13  # and how far it goes
G_SIZE = 16

CUTS = 0  # kinds
CROSSES = 1  # a rapid
PASSES = 2  # a rapid that begins at an unknown place: it removes nothing
RAPID = 1  # marks: a rapid has touched material
BELOW = 2  # a cutting move went below the bottom

PIECE = 6.0  # radii: a slanting move is done in pieces, so that few cells beside it are visited
SHORTEST = 1.0e-12
NEVER = 1.0e300


def removal_first(low: float, begin: float, cell: float) -> int:
    """The first cell whose middle is not below a place."""
    at: float = (low - begin) / cell - 0.5
    if at <= 0.0:
        return 0
    index: int = int(at)
    return index + 1 if at > index else index


def removal_last(high: float, begin: float, cell: float, count: int) -> int:
    """The last cell whose middle is not above a place, -1 for none."""
    at: float = (high - begin) / cell - 0.5
    if at < 0.0:
        return -1
    index: int = int(at)
    return index if index < count else count - 1


def removal_tip(
    G: F64, radius: float, x: float, y: float, ux: float, uy: float, length: float, slope: float
) -> float:
    """The lowest height of the cutter at a place, both relative to the begin of the move."""
    along: float = x * ux + y * uy
    across: float = x * uy - y * ux
    half2: float = radius * radius - across * across
    if half2 < 0.0:
        return NEVER
    half: float = sqrt(half2)
    if G[G_IS_BALL] == 0.0:
        first: float = along - half if along > half else 0.0
        last: float = along + half if along + half < length else length
        if first > last:
            return NEVER
        return slope * last if slope < 0.0 else slope * first
    axis: float = along - half * slope / sqrt(1.0 + slope * slope)
    if axis < 0.0:
        axis = 0.0
    if axis > length:
        axis = length
    depth2: float = half2 - (along - axis) * (along - axis)
    if depth2 < 0.0:
        return NEVER
    return slope * axis + radius - sqrt(depth2)


def removal_piece(H: F64, M: U8, G: F64, kind: int) -> int:
    """Remove what a piece of a move sweeps that goes far in one axis only; its marks."""
    x: float = G[G_BEGIN_U]
    y: float = G[G_BEGIN_U + 1]
    z: float = G[G_BEGIN_U + 2]
    dx: float = G[G_TRAVEL_U]
    dy: float = G[G_TRAVEL_U + 1]
    dz: float = G[G_TRAVEL_U + 2]
    tolerance: float = G[G_TOLERANCE_U]
    cell: float = G[G_CELL_U]
    radius: float = G[G_RADIUS_U] - tolerance if kind == CROSSES else G[G_RADIUS_U]
    if radius <= 0.0:
        return 0
    columns: int = int(G[G_COLUMNS])
    left: int = removal_first((x if dx > 0.0 else x + dx) - radius, G[G_X_U], cell)
    right: int = removal_last((x + dx if dx > 0.0 else x) + radius, G[G_X_U], cell, columns)
    front: int = removal_first((y if dy > 0.0 else y + dy) - radius, G[G_Y_U], cell)
    back: int = removal_last((y + dy if dy > 0.0 else y) + radius, G[G_Y_U], cell, int(G[G_ROWS]))
    length: float = sqrt(dx * dx + dy * dy)
    ux: float = 1.0
    uy: float = 0.0
    slope: float = 0.0
    if length < SHORTEST:
        length = 0.0
        z = z if dz > 0.0 else z + dz
    else:
        ux = dx / length
        uy = dy / length
        slope = dz / length
    lowest: float = z if slope > 0.0 else z + slope * length
    if kind == CUTS and lowest < G[G_BOTTOM_U] - tolerance:
        lowest = -NEVER  # cells at the bottom may have to be marked
    marks: int = 0
    for row in range(front, back + 1):
        py: float = G[G_Y_U] + cell * (row + 0.5) - y
        for column in range(left, right + 1):
            at: int = row * columns + column
            if H[at] <= lowest:
                continue
            px: float = G[G_X_U] + cell * (column + 0.5) - x
            tip: float = z + removal_tip(G, radius, px, py, ux, uy, length, slope)
            mark: int = 0
            if kind == CROSSES and tip < H[at] - tolerance:
                mark = RAPID
            if kind == CUTS and tip < G[G_BOTTOM_U] - tolerance:
                mark = BELOW
            if tip < H[at]:
                H[at] = tip if tip > G[G_BOTTOM_U] else G[G_BOTTOM_U]
            if mark != 0:
                M[at] = M[at] | mark
                marks = marks | mark
    return marks


def removal_move(H: F64, M: U8, G: F64, P: F64, at: int, kind: int) -> int:
    """Remove what a move sweeps; its marks."""
    z: float = P[at + 2]
    dx: float = fabs(P[at + 3] - P[at])
    dy: float = fabs(P[at + 4] - P[at + 1])
    dz: float = P[at + 5] - z
    if kind == PASSES or (z >= G[G_TOP_U] and z + dz >= G[G_TOP_U]):
        return 0
    slant: float = dx if dx < dy else dy
    pieces: int = 1 + int(slant / (PIECE * G[G_RADIUS_U]))
    share: float = 1.0 / pieces
    marks: int = 0
    for n in range(pieces):
        done: float = share * n
        for k in range(3):
            travel: float = P[at + 3 + k] - P[at + k]
            G[G_BEGIN_U + k] = P[at + k] + done * travel
            G[G_TRAVEL_U + k] = share * travel
        marks = marks | removal_piece(H, M, G, kind)
    return marks


def removal_moves(H: F64, M: U8, G: F64, P: F64, K: U8, R: U8, first: int, count: int) -> None:
    """Remove what moves sweep, from the first on, one after the other."""
    for move in range(first, first + count):
        R[move] = removal_move(H, M, G, P, 3 * move, K[move])
