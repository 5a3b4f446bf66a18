"""The curve of squared speed over the path: a cubic spline, and the limits at its knots.

With ' = d/ds, h(s) = (ds/dt)^2 and the path q(s) the axis k has

    speed         q_k' sqrt(h)
    acceleration  q_k' h'/2 + q_k'' h
    jerk          sqrt(h) (q_k' h''/2 + 3/2 q_k'' h' + q_k''' h)

At a knot i three coefficients of the spline count, x_i, x_i+1 and x_i+2: h, h' and h'' are sums of
them with nine weights.

`K`: a row of J[J_ROW] numbers for every knot, with two more knots on each side; `N`: numbers of
the whole window, then those of its axes, group after group; `J`: counts. `X`: the coefficients.
"""

from openacr.cmath import sqrt
from openacr.views import F64, I32

J_AXES = 0
J_POINTS = 1  # control points of the path
J_KNOTS = 2
J_ROW = 3
J_FIRST = 4  # the knots whose limits count
J_STOP = 5
J_HEAD = 6  # the coefficients that are free
J_TAIL = 7
J_STEPS = 8  # of the solver, at most
J_SIZE = 9

# A knot.
K_AT_U = 0
K_LENGTH_U = 1  # of the path that it counts for
K_CAP = 2  # the highest h
K_FEED_UPS = 3
K_TOOL_UPS = 4  # the feed of the axes that carry the tool
K_PUSH = 5  # shares of the limits of acceleration and jerk that its rows may use,
K_SOFT = 6
K_ZONE = 7  # and that of the jerk that the cell after it may use
K_NORMAL_UPS2 = 8  # the highest acceleration across the path
K_PLAIN = 9  # weights of the three coefficients, for h, h' and h''
K_TIED = 18  # the same where a start or an end at rest has one free coefficient
K_H = 27  # h, h' and h'',
K_STEP = 30  # and their changes
K_CELL = 33  # speed^2, acceleration and jerk of the cell after it, by the limits
K_DUAL = 36  # the multiplier of its cap, and its change
K_AXES = 38  # AXIS numbers for each axis

# An axis at a knot: what h, h' and h'' are multiplied with, by the limits.
A_PUSH = 0  # q''/A  q'/2A
A_JERK = 2  # q'''/J  3q''/2J  q'/2J
A_SPREAD = 5  # half the spread of q''' next to the knot, /J
A_DUAL = 6  # multipliers: acceleration up and down, jerk up and down; then their changes
A_DUAL_STEP = 10
AXIS = 14

N_STEP_U = 0  # between control points
N_ORIGIN_U = 1  # where the path begins
N_LONG_S = 2  # a cell that takes longer is no mean
N_KAPPA = 3  # the target of the solver,
N_LEAST = 4  # and where it ends
N_REACH = 5  # how far unknowns and multipliers can go
N_DUAL_REACH = 6
N_LIMITS = 7  # velocities, accelerations and jerks of the axes, and 1 where one carries the tool
SLOPES = 4  # groups of the axes: q', q'' and q'''
CELL = 7  # what is summed up over a cell
GROUPS = 12
WEIGHTS = 9

__all__ = ["speed_values", "speed_weights", "speed_worst"]


def knot_row(J: I32, i: int) -> int:
    """Where the row of a knot begins in K; -1 and -2 are those before the first."""
    return J[J_ROW] * (i + 2)


def speed_weights(J: I32, K: F64) -> None:
    """Write the weights of h, h' and h'' at all knots."""
    row: int = J[J_ROW]
    for i in range(J[J_KNOTS]):
        o: int = knot_row(J, i)
        w: int = o + K_PLAIN
        at: int = o + K_AT_U
        wide: float = K[at + row] - K[at - row]
        left: float = (K[at + row] - K[at - 2 * row]) * wide
        right: float = (K[at + 2 * row] - K[at - row]) * wide
        after: float = K[at + row] - K[at]
        before: float = K[at] - K[at - row]
        K[w] = after * after / left
        K[w + 2] = before * before / right
        K[w + 1] = 1.0 - K[w] - K[w + 2]
        K[w + 3] = -3.0 * after / left
        K[w + 5] = 3.0 * before / right
        K[w + 4] = -K[w + 3] - K[w + 5]
        K[w + 6] = 6.0 / left
        K[w + 8] = 6.0 / right
        K[w + 7] = -K[w + 6] - K[w + 8]


def speed_values(
    J: I32, K: F64, V: F64, every: int, first: int, stop: int, weights: int, values: int
) -> None:
    """Write h, h' and h'' at knots first ... stop-1, or their changes, to their places.

    The coefficient i is the last of `every` numbers, V[every * i + every - 1].
    """
    for i in range(first, stop):
        o: int = knot_row(J, i)
        v: int = every * i + every - 1
        for m in range(3):
            w: int = o + weights + 3 * m
            K[o + values + m] = K[w] * V[v] + K[w + 1] * V[v + every] + K[w + 2] * V[v + 2 * every]


def speed_worst(J: I32, K: F64, X: F64) -> float:
    """The smallest slack of a row, relative to its limit; below 0: broken."""
    worst: float = 1.0
    speed_values(J, K, X, 1, J[J_FIRST], J[J_STOP], K_TIED, K_H)
    for i in range(J[J_FIRST], J[J_STOP]):
        o: int = knot_row(J, i)
        h: float = K[o + K_H]
        h1: float = K[o + K_H + 1]
        h2: float = K[o + K_H + 2]
        if h <= 0.0:
            return -1.0
        g: float = 1.0 - h / K[o + K_CAP]
        if g < worst:
            worst = g
        root: float = sqrt(h)
        for k in range(J[J_AXES]):
            a: int = o + K_AXES + AXIS * k
            u: float = K[a + A_PUSH] * h + K[a + A_PUSH + 1] * h1
            j: float = root * (K[a + A_JERK] * h + K[a + A_JERK + 1] * h1 + K[a + A_JERK + 2] * h2)
            if u < 0.0:
                u = -u
            if j < 0.0:
                j = -j
            j += root * h * K[a + A_SPREAD]
            if j > u:
                u = j
            if 1.0 - u < worst:
                worst = 1.0 - u
    return worst
