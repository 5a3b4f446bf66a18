"""Smoothing inside a tube: the smoothest sequence of points within given distances of others.

Points p lie uniformly on the programmed path. Wanted are points q with

    min sum |D3 q - g|^2     subject to |q_i - p_i| <= r_i

D3 is the third difference; g is that of the path itself inside arcs, which so keep their radius,
0 elsewhere. It is
solved by alternating directions: with z a copy of q inside the tube and u the sum of what they
differ by,

    q = (D3'D3 + rho)^-1 (rho (z - u) + D3'g)       one banded solution, three bands each side
    z = p + clip(w q + (1-w) z + u - p, r)          each point by itself
    u = u + w q + (1-w) z_before - z

rho = (1/l)^6 smooths waves shorter than about l points at once; it rises in stages. The first
`head` and the last `tail` points are given: there q stays as it is. Rows are `axes` numbers.
"""

from openacr.cmath import sqrt
from openacr.views import F64

RELAX = 1.7
BANDS = 4

__all__ = ["tube_smooth"]


def tube_bands(count: int, B: F64) -> None:
    """Write D3'D3 to B, the diagonal and three bands above it: row i is B[4i] ... B[4i+3]."""
    for i in range(count):
        for o in range(BANDS):
            total: float = 0.0
            for m in range(BANDS - o):  # the difference that begins at i - m
                if i - m >= 0 and i - m + 3 < count:
                    total += tube_weight(m) * tube_weight(m + o)
            B[BANDS * i + o] = total


def tube_weight(m: int) -> float:
    """The weights of the third difference, -1 3 -3 1."""
    if m == 0:
        return -1.0
    if m == 1:
        return 3.0
    if m == 2:
        return -3.0
    return 1.0


def tube_factor(head: int, stop: int, rho: float, B: F64, L: F64) -> None:
    """Factor D3'D3 + rho of the points from head to stop: L[4i] is 1/d, L[4i+o] = l(i+o, i)."""
    for i in range(head, stop):
        for o in range(BANDS):
            value: float = B[BANDS * i + o]
            if o == 0:
                value += rho
            for m in range(1, BANDS - o):
                j: int = i - m
                if j >= head:
                    value -= L[BANDS * j + m] * L[BANDS * j + m + o] / L[BANDS * j]
            if o == 0:
                L[BANDS * i] = 1.0 / value
            else:
                L[BANDS * i + o] = value * L[BANDS * i] if i + o < stop else 0.0


def tube_solve(head: int, stop: int, axes: int, L: F64, Q: F64) -> None:
    """Solve in place for the right-hand side in Q; factors outside head ... stop-1 are 0."""
    for i in range(head, stop):
        a1: float = L[BANDS * (i - 1) + 1]
        a2: float = L[BANDS * (i - 2) + 2]
        a3: float = L[BANDS * (i - 3) + 3]
        o: int = i * axes
        for k in range(axes):
            rest: float = Q[o + k] - (a3 * Q[o - 3 * axes + k] + a2 * Q[o - 2 * axes + k])
            Q[o + k] = rest - a1 * Q[o - axes + k]
    for n in range(stop - head):
        j: int = stop - 1 - n
        b0: float = L[BANDS * j]
        b1: float = L[BANDS * j + 1]
        b2: float = L[BANDS * j + 2]
        b3: float = L[BANDS * j + 3]
        o = j * axes
        for k in range(axes):
            rest = Q[o + k] * b0 - (b3 * Q[o + 3 * axes + k] + b2 * Q[o + 2 * axes + k])
            Q[o + k] = rest - b1 * Q[o + axes + k]


def tube_force(
    count: int, axes: int, head: int, tail: int, B: F64, P: F64, G: F64, Q: F64, K: F64
) -> None:
    """Write to K what D3'g and the given points contribute to the right-hand side."""
    for i in range(count):
        for k in range(axes):
            total: float = 0.0
            for m in range(BANDS):  # the difference that begins at j
                j: int = i - m
                if j >= 0 and j + 3 < count and G[j] > 0.0 and G[j] == G[j + 3]:
                    o: int = j * axes + k
                    total += tube_weight(m) * (
                        P[o + 3 * axes] - 3.0 * P[o + 2 * axes] + 3.0 * P[o + axes] - P[o]
                    )
            for m in range(1, BANDS):
                if 0 <= i - m < head:
                    total -= B[BANDS * (i - m) + m] * Q[(i - m) * axes + k]
                if i + m < count and i + m >= count - tail:
                    total -= B[BANDS * i + m] * Q[(i + m) * axes + k]
            K[i * axes + k] = total


def tube_clip(head: int, stop: int, axes: int, P: F64, R: F64, Q: F64, Z: F64, U: F64) -> None:
    """Move z to the point of the tube nearest to the relaxed q + u, and add the rest to u."""
    for i in range(head, stop):
        off2: float = 0.0
        for k in range(axes):
            o: int = i * axes + k
            free: float = RELAX * Q[o] + (1.0 - RELAX) * Z[o] + U[o]
            U[o] = free
            off2 += (free - P[o]) * (free - P[o])
        share: float = 1.0
        if off2 > R[i] * R[i]:
            share = R[i] / sqrt(off2)
        for k in range(axes):
            o = i * axes + k
            Z[o] = P[o] + share * (U[o] - P[o])
            U[o] = U[o] - Z[o]


def tube_excess(head: int, stop: int, axes: int, P: F64, R: F64, Q: F64) -> float:
    """The largest ratio of a distance to its radius."""
    worst: float = 0.0
    for i in range(head, stop):
        off2: float = 0.0
        for k in range(axes):
            d: float = Q[i * axes + k] - P[i * axes + k]
            off2 += d * d
        ratio: float = sqrt(off2) / R[i]
        if ratio > worst:
            worst = ratio
    return worst


def tube_smooth(
    count: int,
    axes: int,
    head: int,
    tail: int,
    P: F64,
    R: F64,
    G: F64,
    stages: int,
    T: F64,
    rounds: int,
    Q: F64,
    Z: F64,
    U: F64,
    K: F64,
    B: F64,
    L: F64,
) -> float:
    """Smooth `count` points in stages of the lengths T (in points); returns the largest excess.

    Q comes in with the given points, and a first guess of the others; Z, U, K (as Q), B and L
    (4 numbers a point) are room to work. Q has three more points after the last, and `head` is 3
    at least.
    """
    stop: int = count - tail
    tube_bands(count, B)
    tube_force(count, axes, head, tail, B, P, G, Q, K)
    for i in range(head * axes, stop * axes):
        Z[i] = Q[i]
    for stage in range(stages):
        inverse: float = 1.0 / T[stage]
        rho: float = inverse * inverse * inverse * inverse * inverse * inverse
        tube_factor(head, stop, rho, B, L)
        for i in range(BANDS * (head - 3), BANDS * head):
            L[i] = 0.0
        if stage == 0 or T[stage] != T[stage - 1]:
            for i in range(head * axes, stop * axes):
                U[i] = 0.0
        for _ in range(rounds):
            for i in range(head * axes, stop * axes):
                Q[i] = rho * (Z[i] - U[i]) + K[i]
            tube_solve(head, stop, axes, L, Q)
            tube_clip(head, stop, axes, P, R, Q, Z, U)
    return tube_excess(head, stop, axes, P, R, Q)
