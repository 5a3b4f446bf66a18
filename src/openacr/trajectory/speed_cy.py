"""The fastest time law along a path, within velocity, acceleration and jerk of every axis.

The unknowns are the coefficients of the curve of squared speed h (speed_curve_cy.py). Every
limit is a row g >= 0 of the three coefficients at a knot:

    g = 1 - h/cap                          speeds
    g = 1 -+ (q_k' h'/2 + q_k'' h)/A_k     accelerations
    g = h^-1/2 -+ (q_k' h''/2 + 3/2 q_k'' h' + q_k''' h)/J_k - d_k h/J_k       jerks

where q_k''' +- d_k are the values of the third derivative on half the cells on both sides. The
last row is
not convex, but h^-1/2 is: a step that keeps the linearised row keeps the row itself. So an
interior point method
stays inside: from a law that is slow enough to keep all limits every iterate keeps them, and
could be run. One step solves, with multipliers z and the time T = sum w h^-1/2,

    (b T'' + sum z/g a a') dx = -T' - sum (mu/g) a       a = -dg/dx
    dz = mu/g - z + (z/g) a dx

a matrix of five diagonals; b < 1 lets slow laws grow faster. Its target mu = kappa w falls
towards `least`.
"""

from openacr.cmath import sqrt
from openacr.trajectory.speed_curve_cy import AXIS_ROWS, VALUES, WEIGHTS, speed_values
from openacr.views import F64

STEP_SHARE = 0.95  # of the distance to the nearest limit
BOLD = 0.5

__all__ = ["speed_solve"]


def speed_row(M: F64, Y: F64, o: int, W: F64, w: int, a0: float, a1: float, a2: float,
              z: float, force: float) -> None:  # fmt: skip
    """Add a row a = a0 dh + a1 dh' + a2 dh'' with weight z to the matrix, -force a to the side."""
    b0: float = a0 * W[w] + a1 * W[w + 3] + a2 * W[w + 6]
    b1: float = a0 * W[w + 1] + a1 * W[w + 4] + a2 * W[w + 7]
    b2: float = a0 * W[w + 2] + a1 * W[w + 5] + a2 * W[w + 8]
    M[3 * o] = M[3 * o] + z * b0 * b0
    M[3 * o + 1] = M[3 * o + 1] + z * b0 * b1
    M[3 * o + 2] = M[3 * o + 2] + z * b0 * b2
    M[3 * o + 3] = M[3 * o + 3] + z * b1 * b1
    M[3 * o + 4] = M[3 * o + 4] + z * b1 * b2
    M[3 * o + 6] = M[3 * o + 6] + z * b2 * b2
    Y[o] = Y[o] - force * b0
    Y[o + 1] = Y[o + 1] - force * b1
    Y[o + 2] = Y[o + 2] - force * b2


def speed_assemble(
    W: F64,
    D: F64,
    cap: F64,
    weight: F64,
    first: int,
    stop: int,
    axes: int,
    kappa: float,
    H: F64,
    Z: F64,
    M: F64,
    Y: F64,
) -> None:
    """Write the matrix of five diagonals to M and the right-hand side to Y."""
    for i in range(first, stop + 2):
        M[3 * i] = 0.0
        M[3 * i + 1] = 0.0
        M[3 * i + 2] = 0.0
        Y[i] = 0.0
    rows: int = 1 + 4 * axes
    for i in range(first, stop):
        w: int = WEIGHTS * i
        h: float = H[VALUES * i]
        h1: float = H[VALUES * i + 1]
        h2: float = H[VALUES * i + 2]
        back: float = 1.0 / sqrt(h)  # h^-1/2
        bend: float = 0.5 * back / h  # minus its derivative
        mu: float = kappa * weight[i]
        force: float = weight[i] * bend
        speed_row(M, Y, i, W, w, 1.0, 0.0, 0.0, 1.5 * BOLD * force / h, -force)
        g: float = 1.0 - h / cap[i]
        z: float = Z[rows * i]
        speed_row(M, Y, i, W, w, 1.0 / cap[i], 0.0, 0.0, z / g, mu / g)
        for k in range(axes):
            d: int = AXIS_ROWS * (i * axes + k)
            r: int = rows * i + 1 + 4 * k
            u: float = D[d] * h + D[d + 1] * h1
            up: float = 1.0 / (1.0 - u)
            down: float = 1.0 / (1.0 + u)
            speed_row(M, Y, i, W, w, D[d], D[d + 1], 0.0,
                      Z[r] * up + Z[r + 1] * down, mu * (up - down))  # fmt: skip
            j: float = D[d + 2] * h + D[d + 3] * h1 + D[d + 4] * h2
            room: float = back - D[d + 5] * h
            up = 1.0 / (room - j)
            down = 1.0 / (room + j)
            fall: float = bend + D[d + 5]
            speed_row(M, Y, i, W, w, fall + D[d + 2], D[d + 3], D[d + 4], Z[r + 2] * up, mu * up)
            speed_row(M, Y, i, W, w, fall - D[d + 2], -D[d + 3], -D[d + 4],
                      Z[r + 3] * down, mu * down)  # fmt: skip


def speed_newton(head: int, stop: int, M: F64, Y: F64) -> None:
    """Solve in place for the unknowns head ... stop-1; M is replaced by its factors."""
    for i in range(head, stop):
        d: float = M[3 * i]
        e: float = M[3 * i + 1]
        if i - 1 >= head:
            d -= M[3 * i - 2] * M[3 * i - 2] * M[3 * i - 3]
            e -= M[3 * i - 2] * M[3 * i - 1] * M[3 * i - 3]
            Y[i] = Y[i] - M[3 * i - 2] * Y[i - 1]
        if i - 2 >= head:
            d -= M[3 * i - 4] * M[3 * i - 4] * M[3 * i - 6]
            Y[i] = Y[i] - M[3 * i - 4] * Y[i - 2]
        M[3 * i] = d
        M[3 * i + 1] = e / d
        M[3 * i + 2] = M[3 * i + 2] / d
    for n in range(stop - head):
        j: int = stop - 1 - n
        Y[j] = Y[j] / M[3 * j]
        if j + 1 < stop:
            Y[j] = Y[j] - M[3 * j + 1] * Y[j + 1]
        if j + 2 < stop:
            Y[j] = Y[j] - M[3 * j + 2] * Y[j + 2]


def speed_shorter(step: float, have: float, change: float) -> float:
    """The step after which `have` is still above 0, at most the step given."""
    if have + change * step <= (1.0 - STEP_SHARE) * have and change < 0.0:
        return -STEP_SHARE * have / change
    return step


def speed_reach(
    D: F64,
    cap: F64,
    weight: F64,
    first: int,
    stop: int,
    axes: int,
    kappa: float,
    H: F64,
    Z: F64,
    N: F64,
    E: F64,
) -> None:
    """Write to E the longest steps of unknowns and multipliers; changes of these go to N."""
    step: float = 1.0
    dual: float = 1.0
    rows: int = 1 + 4 * axes
    for i in range(first, stop):
        v: int = VALUES * i
        h: float = H[v]
        back: float = 1.0 / sqrt(h)
        bend: float = 0.5 * back / h
        mu: float = kappa * weight[i]
        step = speed_shorter(step, h, H[v + 3])
        g: float = 1.0 - h / cap[i]
        dg: float = -H[v + 3] / cap[i]
        step = speed_shorter(step, g, dg)
        r: int = rows * i
        N[r] = mu / g - Z[r] - Z[r] / g * dg
        dual = speed_shorter(dual, Z[r], N[r])
        for k in range(axes):
            d: int = AXIS_ROWS * (i * axes + k)
            r = rows * i + 1 + 4 * k
            u: float = D[d] * h + D[d + 1] * H[v + 1]
            du: float = D[d] * H[v + 3] + D[d + 1] * H[v + 4]
            j: float = D[d + 2] * h + D[d + 3] * H[v + 1] + D[d + 4] * H[v + 2]
            dj: float = D[d + 2] * H[v + 3] + D[d + 3] * H[v + 4] + D[d + 4] * H[v + 5]
            for m in range(4):
                if m == 0:
                    g = 1.0 - u
                    dg = -du
                elif m == 1:
                    g = 1.0 + u
                    dg = du
                elif m == 2:
                    g = back - D[d + 5] * h - j
                    dg = -(bend + D[d + 5]) * H[v + 3] - dj
                else:
                    g = back - D[d + 5] * h + j
                    dg = -(bend + D[d + 5]) * H[v + 3] + dj
                step = speed_shorter(step, g, dg)
                N[r + m] = mu / g - Z[r + m] - Z[r + m] / g * dg
                dual = speed_shorter(dual, Z[r + m], N[r + m])
    E[0] = step
    E[1] = dual


def speed_gap(
    D: F64, cap: F64, weight: F64, first: int, stop: int, axes: int, H: F64, Z: F64
) -> float:
    """The mean of multiplier times slack, relative to the weights of the knots."""
    rows: int = 1 + 4 * axes
    total: float = 0.0
    whole: float = 0.0
    for i in range(first, stop):
        v: int = VALUES * i
        h: float = H[v]
        back: float = 1.0 / sqrt(h)
        total += Z[rows * i] * (1.0 - h / cap[i])
        whole += float(rows) * weight[i]
        for k in range(axes):
            d: int = AXIS_ROWS * (i * axes + k)
            r: int = rows * i + 1 + 4 * k
            u: float = D[d] * h + D[d + 1] * H[v + 1]
            j: float = D[d + 2] * h + D[d + 3] * H[v + 1] + D[d + 4] * H[v + 2]
            total += Z[r] * (1.0 - u) + Z[r + 1] * (1.0 + u)
            room: float = back - D[d + 5] * h
            total += Z[r + 2] * (room - j) + Z[r + 3] * (room + j)
    return total / whole


def speed_start(
    D: F64, cap: F64, weight: F64, first: int, stop: int, axes: int, kappa: float, H: F64, Z: F64
) -> None:
    """Set the multipliers at knots first ... stop-1 to what belongs to kappa."""
    rows: int = 1 + 4 * axes
    for i in range(first, stop):
        v: int = VALUES * i
        h: float = H[v]
        back: float = 1.0 / sqrt(h)
        mu: float = kappa * weight[i]
        Z[rows * i] = mu / (1.0 - h / cap[i])
        for k in range(axes):
            d: int = AXIS_ROWS * (i * axes + k)
            r: int = rows * i + 1 + 4 * k
            u: float = D[d] * h + D[d + 1] * H[v + 1]
            j: float = D[d + 2] * h + D[d + 3] * H[v + 1] + D[d + 4] * H[v + 2]
            Z[r] = mu / (1.0 - u)
            Z[r + 1] = mu / (1.0 + u)
            room: float = back - D[d + 5] * h
            Z[r + 2] = mu / (room - j)
            Z[r + 3] = mu / (room + j)


def speed_solve(
    X: F64,
    W: F64,
    D: F64,
    cap: F64,
    weight: F64,
    first: int,
    stop: int,
    head: int,
    tail: int,
    axes: int,
    kappa: float,
    least: float,
    rounds: int,
    H: F64,
    Z: F64,
    N: F64,
    M: F64,
    Y: F64,
    E: F64,
) -> int:
    """Improve the coefficients X[head] ... X[tail-1]; returns the number of steps made.

    Only rows at the knots first ... stop-1 count. X has to keep all limits there and does so
    after every step.
    """
    gap: float = kappa
    speed_values(X, W, first, stop, H, 0)
    speed_start(D, cap, weight, first, stop, axes, kappa, H, Z)
    for step in range(rounds):
        speed_assemble(W, D, cap, weight, first, stop, axes, kappa, H, Z, M, Y)
        for i in range(first, stop + 2):
            if i < head or i >= tail:
                Y[i] = 0.0
        speed_newton(head, tail, M, Y)
        total: float = 0.0
        for i in range(head, tail):
            total += Y[i]
        if total - total != 0.0:  # not a number: the present law stays
            return step
        speed_values(Y, W, first, stop, H, 3)
        speed_reach(D, cap, weight, first, stop, axes, kappa, H, Z, N, E)
        for i in range(head, tail):
            X[i] = X[i] + E[0] * Y[i]
        for i in range((1 + 4 * axes) * first, (1 + 4 * axes) * stop):
            Z[i] = Z[i] + E[1] * N[i]
        speed_values(X, W, first, stop, H, 0)
        gap = speed_gap(D, cap, weight, first, stop, axes, H, Z)
        if gap <= 2.0 * least and E[0] > 0.9:
            return step + 1
        reach: float = E[0] if E[0] < E[1] else E[1]
        share: float = (1.0 - reach) * (1.0 - reach)
        if share < 0.1:
            share = 0.1
        kappa = gap * share
        if kappa < least:
            kappa = least
    return rounds
