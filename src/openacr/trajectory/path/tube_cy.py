"""Smoothing inside a tube: the smoothest sequence of points within given distances of others.

Points p lie uniformly on the programmed path. Wanted are points q with

    min sum |D3 q - g|^2     subject to |q_i - p_i| <= r_i

D3 is the third difference; g is that of the path itself inside arcs, which so keep their radius,
and 0 elsewhere. The solution is by alternating directions: with z a copy of q inside the tube, and
u the sum of what the two differ by,

    q = (D3'D3 + rho)^-1 (rho (z - u) + D3'g)       one banded solution, three bands each side
    z = p + clip(w q + (1-w) z + u - p, r)          each point by itself
    u = u + w q + (1-w) z_before - z

rho = (1/l)^6 smooths waves shorter than about l points at once; it rises in stages. The first
J[J_HEAD] and the last J[J_TAIL] points are given: there q stays as it is. Three points before the
first free one are needed, and room for three after the last point.

`W`: blocks of J[J_BLOCK] numbers each, which hold the points, row by row of J[J_AXES] numbers, or
something else of every sample; `J`: counts.
"""

from openacr.cmath import sqrt
from openacr.trajectory.path.piece_cy import (
    E_FIRST,
    E_LENGTH,
    E_POINTS,
    E_TOLERANCE,
    distance_to_line,
    piece_point,
)
from openacr.views import F64, I32

RELAX = 1.7  # w above
BANDS = 4
NARROWEST = 0.1  # of a radius that is left where a vertex is cut off

J_AXES = 0
J_COUNT = 1  # samples
J_BLOCK = 2
J_HEAD = 3
J_TAIL = 4
J_ROUNDS = 5  # of every stage
J_STAGES = 6
J_PIECES = 7  # of the chain that are known
J_BEGIN = 8  # the distance of the first sample, in steps
J_SIZE = 9

# Blocks.
PROGRAMMED = 0  # p
SMOOTHED = 1  # q
INSIDE = 2  # z
APART = 3  # u
FORCE = 4  # the right-hand side without rho
BAND = 5  # D3'D3: the diagonal and three bands above it
FACTOR = 6  # of D3'D3 + rho: 1/d, and l(i+1, i), l(i+2, i), l(i+3, i)
RADIUS = 7  # r
ARC = 8  # the number of the piece of an arc plus 1, 0 on lines
NUMBERS = 9
BLOCKS = 10

# Of the last block.
N_ORIGIN_U = 0  # where the first piece begins
N_STEP_U = 1  # between samples
N_SHARE = 2  # of the tolerance, which is the radius
N_LENGTHS = 3  # of the waves of every stage, in samples

__all__ = ["tube_sample", "tube_smooth"]


def tube_narrow(W: F64, i: int, cut: float) -> None:
    """Take a distance off the radius W[i]."""
    left: float = W[i] - cut
    W[i] = left if left > NARROWEST * W[i] else NARROWEST * W[i]


def tube_cut(J: I32, W: F64, i: int, E: F64, vertex: int) -> None:
    """Narrow the tube at two samples by what the line between them cuts off a vertex."""
    axes: int = J[J_AXES]
    after: int = PROGRAMMED * J[J_BLOCK] + i * axes
    cut: float = distance_to_line(E, vertex, W, after - axes, after, axes)
    tube_narrow(W, RADIUS * J[J_BLOCK] + i - 1, cut)
    tube_narrow(W, RADIUS * J[J_BLOCK] + i, cut)


def tube_sample(J: I32, W: F64, E: F64) -> None:
    """Write the points of a chain of pieces, with their radii and arcs."""
    axes: int = J[J_AXES]
    block: int = J[J_BLOCK]
    numbers: int = NUMBERS * block
    size: int = E_POINTS + 2 * axes
    piece: int = 0
    gone: float = W[numbers + N_ORIGIN_U]
    for i in range(J[J_COUNT]):
        s: float = float(J[J_BEGIN] + i) * W[numbers + N_STEP_U]
        before: int = piece
        while piece + 1 < J[J_PIECES] and s > gone + E[piece * size + E_LENGTH]:
            gone += E[piece * size + E_LENGTH]
            piece += 1
        o: int = piece * size
        piece_point(E, o, axes, s - gone, W, PROGRAMMED * block + i * axes)
        W[RADIUS * block + i] = W[numbers + N_SHARE] * E[o + E_TOLERANCE]
        W[ARC * block + i] = float(piece + 1) if E[o + E_FIRST] >= 0.0 else 0.0
        for n in range(before + 1, piece + 1):
            if i > 0:
                tube_cut(J, W, i, E, n * size + E_POINTS)


def tube_weight(m: int) -> float:
    """The weights of the third difference, -1 3 -3 1."""
    if m == 0:
        return -1.0
    if m == 1:
        return 3.0
    if m == 2:
        return -3.0
    return 1.0


def tube_bands(J: I32, W: F64) -> None:
    """Write D3'D3."""
    count: int = J[J_COUNT]
    for i in range(count):
        for o in range(BANDS):
            total: float = 0.0
            for m in range(BANDS - o):  # the difference that begins at i - m
                if i - m >= 0 and i - m + 3 < count:
                    total += tube_weight(m) * tube_weight(m + o)
            W[BAND * J[J_BLOCK] + BANDS * i + o] = total


def tube_factor(J: I32, W: F64, rho: float) -> None:
    """Factor D3'D3 + rho of the points that are free."""
    head: int = J[J_HEAD]
    stop: int = J[J_COUNT] - J[J_TAIL]
    bands: int = BAND * J[J_BLOCK]
    factors: int = FACTOR * J[J_BLOCK]
    for i in range(head, stop):
        f: int = factors + BANDS * i
        for o in range(BANDS):
            value: float = W[bands + BANDS * i + o]
            if o == 0:
                value += rho
            for m in range(1, BANDS - o):
                if i - m >= head:
                    j: int = f - BANDS * m
                    value -= W[j + m] * W[j + m + o] / W[j]
            if o == 0:
                W[f] = 1.0 / value
            else:
                W[f + o] = value * W[f] if i + o < stop else 0.0
    for i in range(factors + BANDS * (head - 3), factors + BANDS * head):
        W[i] = 0.0


def tube_solve(J: I32, W: F64) -> None:
    """Solve in place for the right-hand side in q; factors of points that are given are 0."""
    head: int = J[J_HEAD]
    stop: int = J[J_COUNT] - J[J_TAIL]
    axes: int = J[J_AXES]
    q: int = SMOOTHED * J[J_BLOCK]
    factors: int = FACTOR * J[J_BLOCK]
    for i in range(head, stop):
        f: int = factors + BANDS * i
        a1: float = W[f - BANDS + 1]
        a2: float = W[f - 2 * BANDS + 2]
        a3: float = W[f - 3 * BANDS + 3]
        for k in range(q + i * axes, q + (i + 1) * axes):
            rest: float = W[k] - (a3 * W[k - 3 * axes] + a2 * W[k - 2 * axes])
            W[k] = rest - a1 * W[k - axes]
    for n in range(stop - head):
        i = stop - 1 - n
        f = factors + BANDS * i
        b0: float = W[f]
        b1: float = W[f + 1]
        b2: float = W[f + 2]
        b3: float = W[f + 3]
        for k in range(q + i * axes, q + (i + 1) * axes):
            rest = W[k] * b0 - (b3 * W[k + 3 * axes] + b2 * W[k + 2 * axes])
            W[k] = rest - b1 * W[k + axes]


def tube_force(J: I32, W: F64) -> None:
    """Write what D3'g and the given points contribute to the right-hand side."""
    count: int = J[J_COUNT]
    axes: int = J[J_AXES]
    block: int = J[J_BLOCK]
    bands: int = BAND * block
    arcs: int = ARC * block
    for i in range(count):
        for k in range(axes):
            total: float = 0.0
            for m in range(BANDS):  # the difference that begins at j
                j: int = i - m
                if j >= 0 and j + 3 < count:
                    if W[arcs + j] > 0.0 and W[arcs + j] == W[arcs + j + 3]:
                        o: int = PROGRAMMED * block + j * axes + k
                        total += tube_weight(m) * (
                            W[o + 3 * axes] - 3.0 * W[o + 2 * axes] + 3.0 * W[o + axes] - W[o]
                        )
            q: int = SMOOTHED * block + i * axes + k
            for m in range(1, BANDS):
                if 0 <= i - m < J[J_HEAD]:
                    total -= W[bands + BANDS * (i - m) + m] * W[q - m * axes]
                if i + m < count and i + m >= count - J[J_TAIL]:
                    total -= W[bands + BANDS * i + m] * W[q + m * axes]
            W[FORCE * block + i * axes + k] = total


def tube_clip(J: I32, W: F64) -> None:
    """Move z to the point of the tube nearest to the relaxed q + u, and add the rest to u."""
    axes: int = J[J_AXES]
    block: int = J[J_BLOCK]
    for i in range(J[J_HEAD], J[J_COUNT] - J[J_TAIL]):
        p: int = PROGRAMMED * block + i * axes
        q: int = SMOOTHED * block + i * axes
        z: int = INSIDE * block + i * axes
        u: int = APART * block + i * axes
        r: float = W[RADIUS * block + i]
        off2: float = 0.0
        for k in range(axes):
            free: float = RELAX * W[q + k] + (1.0 - RELAX) * W[z + k] + W[u + k]
            W[u + k] = free
            off2 += (free - W[p + k]) * (free - W[p + k])
        share: float = 1.0
        if off2 > r * r:
            share = r / sqrt(off2)
        for k in range(axes):
            W[z + k] = W[p + k] + share * (W[u + k] - W[p + k])
            W[u + k] = W[u + k] - W[z + k]


def tube_stage(J: I32, W: F64, rho: float) -> None:
    """Smooth all waves that are long for rho."""
    axes: int = J[J_AXES]
    block: int = J[J_BLOCK]
    tube_factor(J, W, rho)
    for _ in range(J[J_ROUNDS]):
        for i in range(J[J_HEAD] * axes, (J[J_COUNT] - J[J_TAIL]) * axes):
            W[SMOOTHED * block + i] = (
                rho * (W[INSIDE * block + i] - W[APART * block + i]) + W[FORCE * block + i]
            )
        tube_solve(J, W)
        tube_clip(J, W)


def tube_smooth(J: I32, W: F64) -> None:
    """Smooth the points in stages; q comes in with the given points and a guess of the others."""
    block: int = J[J_BLOCK]
    lengths: int = NUMBERS * block + N_LENGTHS
    first: int = J[J_HEAD] * J[J_AXES]
    stop: int = (J[J_COUNT] - J[J_TAIL]) * J[J_AXES]
    tube_bands(J, W)
    tube_force(J, W)
    for i in range(first, stop):
        W[INSIDE * block + i] = W[SMOOTHED * block + i]
    for stage in range(J[J_STAGES]):
        length: float = W[lengths + stage]
        inverse: float = 1.0 / length
        if stage == 0 or length != W[lengths + stage - 1]:
            for i in range(first, stop):
                W[APART * block + i] = 0.0
        tube_stage(J, W, inverse * inverse * inverse * inverse * inverse * inverse)
