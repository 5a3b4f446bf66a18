"""The fastest time law along a path, within velocity, acceleration and jerk of every axis.

Unknown are the coefficients of the curve of squared speed h (speed_curve_cy.py). Every limit is a
row g >= 0 of the three coefficients at a knot:

    g = 1 - h/cap                                                              speeds
    g = 1 -+ (q_k' h'/2 + q_k'' h)/A_k                                         accelerations
    g = h^-1/2 -+ (q_k' h''/2 + 3/2 q_k'' h' + q_k''' h)/J_k - d_k h/J_k       jerks

where q_k''' +- d_k are the values of the third derivative on half the cells on both sides of the
knot. The last row is not convex, but h^-1/2 is: where the linearised row is kept the row itself is.
So an interior point method stays inside. It starts at a law that is slow enough to keep all limits;
every iterate keeps them, too, and could be run.

With the time T = sum w h^-1/2 over the knots, w the length of path that each counts for, and a
multiplier z for every row, a step solves

    (b T'' + sum z/g a a') dx = -T' - sum (mu/g) a        a = -dg/dx
    dz = mu/g - z + (z/g) a dx

that is a matrix of five diagonals. With b < 1 slow laws grow faster. The target mu = kappa w of
z g falls towards `least`.

`M`: four numbers for every coefficient, the diagonal of the matrix and two bands beside it, and
the right-hand side, in whose place the solution dx comes.
"""

from openacr.cmath import sqrt
from openacr.trajectory.speed.speed_curve_cy import (
    A_DUAL,
    A_DUAL_STEP,
    A_JERK,
    A_PUSH,
    A_SPREAD,
    AXIS,
    J_AXES,
    J_FIRST,
    J_HEAD,
    J_STEPS,
    J_STOP,
    J_TAIL,
    K_AXES,
    K_CAP,
    K_DUAL,
    K_H,
    K_LENGTH_U,
    K_STEP,
    K_TIED,
    N_DUAL_REACH,
    N_KAPPA,
    N_LEAST,
    N_REACH,
    knot_row,
    speed_values,
)
from openacr.views import F64, I32

STEP_SHARE = 0.95  # of the distance to the nearest limit
BOLD = 0.5  # b above
LIMITS = 4  # of an axis at a knot
M_SIDE = 3
UNKNOWN = 4

__all__ = ["speed_solve"]


def speed_row(
    M: F64, i: int, K: F64, w: int, a0: float, a1: float, a2: float, z: float, force: float
) -> None:
    """Add a row a = a0 dh + a1 dh' + a2 dh'' with weight z to the matrix, -force a to the side."""
    b0: float = a0 * K[w] + a1 * K[w + 3] + a2 * K[w + 6]
    b1: float = a0 * K[w + 1] + a1 * K[w + 4] + a2 * K[w + 7]
    b2: float = a0 * K[w + 2] + a1 * K[w + 5] + a2 * K[w + 8]
    m: int = UNKNOWN * i
    n: int = m + UNKNOWN
    o: int = n + UNKNOWN
    M[m] = M[m] + z * b0 * b0
    M[m + 1] = M[m + 1] + z * b0 * b1
    M[m + 2] = M[m + 2] + z * b0 * b2
    M[n] = M[n] + z * b1 * b1
    M[n + 1] = M[n + 1] + z * b1 * b2
    M[o] = M[o] + z * b2 * b2
    M[m + M_SIDE] = M[m + M_SIDE] - force * b0
    M[n + M_SIDE] = M[n + M_SIDE] - force * b1
    M[o + M_SIDE] = M[o + M_SIDE] - force * b2


def speed_assemble(J: I32, N: F64, K: F64, M: F64) -> None:
    """Write the matrix and the right-hand side."""
    for i in range(UNKNOWN * J[J_FIRST], UNKNOWN * (J[J_STOP] + 2)):
        M[i] = 0.0
    for i in range(J[J_FIRST], J[J_STOP]):
        row: int = knot_row(J, i)
        w: int = row + K_TIED
        cap: float = K[row + K_CAP]
        h: float = K[row + K_H]
        h1: float = K[row + K_H + 1]
        h2: float = K[row + K_H + 2]
        back: float = 1.0 / sqrt(h)  # h^-1/2
        bend: float = 0.5 * back / h  # minus its derivative
        mu: float = N[N_KAPPA] * K[row + K_LENGTH_U]
        force: float = K[row + K_LENGTH_U] * bend
        speed_row(M, i, K, w, 1.0, 0.0, 0.0, 1.5 * BOLD * force / h, -force)
        g: float = 1.0 - h / cap
        speed_row(M, i, K, w, 1.0 / cap, 0.0, 0.0, K[row + K_DUAL] / g, mu / g)
        for k in range(J[J_AXES]):
            a: int = row + K_AXES + AXIS * k
            z: int = a + A_DUAL
            p0: float = K[a + A_PUSH]
            p1: float = K[a + A_PUSH + 1]
            u: float = p0 * h + p1 * h1
            up: float = 1.0 / (1.0 - u)
            down: float = 1.0 / (1.0 + u)
            speed_row(M, i, K, w, p0, p1, 0.0, K[z] * up + K[z + 1] * down, mu * (up - down))
            j0: float = K[a + A_JERK]
            j1: float = K[a + A_JERK + 1]
            j2: float = K[a + A_JERK + 2]
            j: float = j0 * h + j1 * h1 + j2 * h2
            room: float = back - K[a + A_SPREAD] * h
            up = 1.0 / (room - j)
            down = 1.0 / (room + j)
            fall: float = bend + K[a + A_SPREAD]
            speed_row(M, i, K, w, fall + j0, j1, j2, K[z + 2] * up, mu * up)
            speed_row(M, i, K, w, fall - j0, -j1, -j2, K[z + 3] * down, mu * down)


def speed_newton(head: int, stop: int, M: F64) -> None:
    """Solve in place for the unknowns head ... stop-1; the matrix is replaced by its factors."""
    for i in range(head, stop):
        m: int = UNKNOWN * i
        one: int = m - UNKNOWN  # the unknown before
        two: int = one - UNKNOWN
        d: float = M[m]
        e: float = M[m + 1]
        if i - 1 >= head:
            d -= M[one + 1] * M[one + 1] * M[one]
            e -= M[one + 1] * M[one + 2] * M[one]
            M[m + M_SIDE] = M[m + M_SIDE] - M[one + 1] * M[one + M_SIDE]
        if i - 2 >= head:
            d -= M[two + 2] * M[two + 2] * M[two]
            M[m + M_SIDE] = M[m + M_SIDE] - M[two + 2] * M[two + M_SIDE]
        M[m] = d
        M[m + 1] = e / d
        M[m + 2] = M[m + 2] / d
    for n in range(stop - head):
        j: int = stop - 1 - n
        m = UNKNOWN * j
        M[m + M_SIDE] = M[m + M_SIDE] / M[m]
        if j + 1 < stop:
            M[m + M_SIDE] = M[m + M_SIDE] - M[m + 1] * M[m + UNKNOWN + M_SIDE]
        if j + 2 < stop:
            M[m + M_SIDE] = M[m + M_SIDE] - M[m + 2] * M[m + 2 * UNKNOWN + M_SIDE]


def speed_shorter(step: float, have: float, change: float) -> float:
    """The step after which `have` is still above 0, at most the step given."""
    if have + change * step <= (1.0 - STEP_SHARE) * have and change < 0.0:
        return -STEP_SHARE * have / change
    return step


def speed_reach(J: I32, N: F64, K: F64) -> None:
    """Find how far unknowns and multipliers can go, and the changes of the multipliers."""
    step: float = 1.0
    dual: float = 1.0
    for i in range(J[J_FIRST], J[J_STOP]):
        row: int = knot_row(J, i)
        v: int = row + K_H
        dv: int = row + K_STEP
        h: float = K[v]
        back: float = 1.0 / sqrt(h)
        bend: float = 0.5 * back / h
        mu: float = N[N_KAPPA] * K[row + K_LENGTH_U]
        step = speed_shorter(step, h, K[dv])
        g: float = 1.0 - h / K[row + K_CAP]
        dg: float = -K[dv] / K[row + K_CAP]
        step = speed_shorter(step, g, dg)
        z: int = row + K_DUAL
        K[z + 1] = mu / g - K[z] - K[z] / g * dg
        dual = speed_shorter(dual, K[z], K[z + 1])
        for k in range(J[J_AXES]):
            a: int = row + K_AXES + AXIS * k
            p: int = a + A_PUSH
            q: int = a + A_JERK
            spread: float = K[a + A_SPREAD]
            u: float = K[p] * h + K[p + 1] * K[v + 1]
            du: float = K[p] * K[dv] + K[p + 1] * K[dv + 1]
            j: float = K[q] * h + K[q + 1] * K[v + 1] + K[q + 2] * K[v + 2]
            dj: float = K[q] * K[dv] + K[q + 1] * K[dv + 1] + K[q + 2] * K[dv + 2]
            for m in range(LIMITS):
                if m == 0:
                    g = 1.0 - u
                    dg = -du
                elif m == 1:
                    g = 1.0 + u
                    dg = du
                elif m == 2:
                    g = back - spread * h - j
                    dg = -(bend + spread) * K[dv] - dj
                else:
                    g = back - spread * h + j
                    dg = -(bend + spread) * K[dv] + dj
                step = speed_shorter(step, g, dg)
                z = a + A_DUAL + m
                dz: int = a + A_DUAL_STEP + m
                K[dz] = mu / g - K[z] - K[z] / g * dg
                dual = speed_shorter(dual, K[z], K[dz])
    N[N_REACH] = step
    N[N_DUAL_REACH] = dual


def speed_gap(J: I32, K: F64) -> float:
    """The mean of multiplier times slack, relative to the lengths of the knots."""
    total: float = 0.0
    whole: float = 0.0
    for i in range(J[J_FIRST], J[J_STOP]):
        row: int = knot_row(J, i)
        v: int = row + K_H
        h: float = K[v]
        back: float = 1.0 / sqrt(h)
        total += K[row + K_DUAL] * (1.0 - h / K[row + K_CAP])
        whole += float(1 + LIMITS * J[J_AXES]) * K[row + K_LENGTH_U]
        for k in range(J[J_AXES]):
            a: int = row + K_AXES + AXIS * k
            z: int = a + A_DUAL
            p: int = a + A_PUSH
            q: int = a + A_JERK
            u: float = K[p] * h + K[p + 1] * K[v + 1]
            j: float = K[q] * h + K[q + 1] * K[v + 1] + K[q + 2] * K[v + 2]
            total += K[z] * (1.0 - u) + K[z + 1] * (1.0 + u)
            room: float = back - K[a + A_SPREAD] * h
            total += K[z + 2] * (room - j) + K[z + 3] * (room + j)
    return total / whole


def speed_start(J: I32, N: F64, K: F64) -> None:
    """Set the multipliers to what belongs to the target."""
    for i in range(J[J_FIRST], J[J_STOP]):
        row: int = knot_row(J, i)
        v: int = row + K_H
        h: float = K[v]
        back: float = 1.0 / sqrt(h)
        mu: float = N[N_KAPPA] * K[row + K_LENGTH_U]
        K[row + K_DUAL] = mu / (1.0 - h / K[row + K_CAP])
        for k in range(J[J_AXES]):
            a: int = row + K_AXES + AXIS * k
            z: int = a + A_DUAL
            p: int = a + A_PUSH
            q: int = a + A_JERK
            u: float = K[p] * h + K[p + 1] * K[v + 1]
            j: float = K[q] * h + K[q + 1] * K[v + 1] + K[q + 2] * K[v + 2]
            K[z] = mu / (1.0 - u)
            K[z + 1] = mu / (1.0 + u)
            room: float = back - K[a + A_SPREAD] * h
            K[z + 2] = mu / (room - j)
            K[z + 3] = mu / (room + j)


def speed_take(J: I32, N: F64, K: F64, X: F64, M: F64) -> None:
    """Take the step as far as unknowns and multipliers can go."""
    for i in range(J[J_HEAD], J[J_TAIL]):
        X[i] = X[i] + N[N_REACH] * M[UNKNOWN * i + M_SIDE]
    for i in range(J[J_FIRST], J[J_STOP]):
        z: int = knot_row(J, i) + K_DUAL
        K[z] = K[z] + N[N_DUAL_REACH] * K[z + 1]
        for k in range(J[J_AXES]):
            a: int = knot_row(J, i) + K_AXES + AXIS * k
            for m in range(LIMITS):
                K[a + A_DUAL + m] = K[a + A_DUAL + m] + N[N_DUAL_REACH] * K[a + A_DUAL_STEP + m]


def speed_target(N: F64, gap: float) -> None:
    """Lower the target: the more, the further the last step has reached."""
    reach: float = N[N_REACH] if N[N_REACH] < N[N_DUAL_REACH] else N[N_DUAL_REACH]
    share: float = (1.0 - reach) * (1.0 - reach)
    share = share if share > 0.1 else 0.1
    N[N_KAPPA] = gap * share if gap * share > N[N_LEAST] else N[N_LEAST]


def speed_solve(J: I32, N: F64, K: F64, X: F64, M: F64) -> int:
    """Improve the coefficients that are free; returns the number of steps made.

    X has to keep all limits that count, and does so after every step.
    """
    first: int = J[J_FIRST]
    stop: int = J[J_STOP]
    speed_values(J, K, X, 1, first, stop, K_TIED, K_H)
    speed_start(J, N, K)
    for step in range(J[J_STEPS]):
        speed_assemble(J, N, K, M)
        for i in range(first, stop + 2):
            if i < J[J_HEAD] or i >= J[J_TAIL]:
                M[UNKNOWN * i + M_SIDE] = 0.0
        speed_newton(J[J_HEAD], J[J_TAIL], M)
        total: float = 0.0
        for i in range(J[J_HEAD], J[J_TAIL]):
            total += M[UNKNOWN * i + M_SIDE]
        if total - total != 0.0:  # not a number: the present law stays
            return step
        speed_values(J, K, M, UNKNOWN, first, stop, K_TIED, K_STEP)
        speed_reach(J, N, K)
        speed_take(J, N, K, X, M)
        speed_values(J, K, X, 1, first, stop, K_TIED, K_H)
        gap: float = speed_gap(J, K)
        if gap <= 2.0 * N[N_LEAST] and N[N_REACH] > 0.9:
            return step + 1
        speed_target(N, gap)
    return J[J_STEPS]
