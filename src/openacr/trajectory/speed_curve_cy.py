"""The curve of squared speed over the path: a cubic spline, and the limits at its knots.

With ' = d/ds, h(s) = (ds/dt)^2 and the path q(s) the axis k has

    speed         q_k' sqrt(h)
    acceleration  q_k' h'/2 + q_k'' h
    jerk          sqrt(h) (q_k' h''/2 + 3/2 q_k'' h' + q_k''' h)

At a knot three coefficients of the spline count, x_i, x_i+1 and x_i+2. The rows `D` of an axis
at a knot hold what
h, h' and h'' are multiplied with, divided by the limits, and the spread of the third derivative.
"""

from openacr.cmath import sqrt
from openacr.views import F64

AXIS_ROWS = 6  # q''/A q'/2A | q'''/J 3q''/2J q'/2J | half the spread of q''' next to the knot, /J
WEIGHTS = 9  # of three coefficients, for h, h' and h''
VALUES = 6  # h, h', h'' and their changes

__all__ = ["speed_values", "speed_weights", "speed_worst"]


def speed_weights(at: F64, count: int, W: F64) -> None:
    """Write the weights of h, h' and h'' at `count` knots; `at` has two knots more on each side."""
    for i in range(count):
        o: int = i + 2
        w: int = WEIGHTS * i
        wide: float = at[o + 1] - at[o - 1]
        left: float = (at[o + 1] - at[o - 2]) * wide
        right: float = (at[o + 2] - at[o - 1]) * wide
        after: float = at[o + 1] - at[o]
        before: float = at[o] - at[o - 1]
        W[w] = after * after / left
        W[w + 2] = before * before / right
        W[w + 1] = 1.0 - W[w] - W[w + 2]
        W[w + 3] = -3.0 * after / left
        W[w + 5] = 3.0 * before / right
        W[w + 4] = -W[w + 3] - W[w + 5]
        W[w + 6] = 6.0 / left
        W[w + 8] = 6.0 / right
        W[w + 7] = -W[w + 6] - W[w + 8]


def speed_values(X: F64, W: F64, first: int, stop: int, H: F64, shift: int) -> None:
    """Write h, h' and h'' of coefficients X at knots to H[6i + shift] ..."""
    for i in range(first, stop):
        for m in range(3):
            w: int = WEIGHTS * i + 3 * m
            H[VALUES * i + shift + m] = W[w] * X[i] + W[w + 1] * X[i + 1] + W[w + 2] * X[i + 2]


def speed_worst(
    X: F64, W: F64, D: F64, cap: F64, first: int, stop: int, axes: int, H: F64
) -> float:
    """The smallest slack at knots first ... stop-1, relative to its limit; below 0: broken."""
    worst: float = 1.0
    speed_values(X, W, first, stop, H, 0)
    for i in range(first, stop):
        h: float = H[VALUES * i]
        if h <= 0.0:
            return -1.0
        g: float = 1.0 - h / cap[i]
        if g < worst:
            worst = g
        root: float = sqrt(h)
        for k in range(axes):
            d: int = AXIS_ROWS * (i * axes + k)
            u: float = D[d] * h + D[d + 1] * H[VALUES * i + 1]
            j: float = root * (
                D[d + 2] * h + D[d + 3] * H[VALUES * i + 1] + D[d + 4] * H[VALUES * i + 2]
            )
            if u < 0.0:
                u = -u
            if j < 0.0:
                j = -j
            j += root * h * D[d + 5]
            if j > u:
                u = j
            if 1.0 - u < worst:
                worst = 1.0 - u
    return worst
