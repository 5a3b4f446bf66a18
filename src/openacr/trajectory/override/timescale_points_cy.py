"""Control points of a plan that is run through at another scale of its time, one by one.

The formulas are explained in `timescale_cy`. `C` holds the control points of the plan row by row,
the first of them that of knot -1 of this window. `K` and `W` hold integers and numbers: the names
below.
"""

from openacr.cmath import fabs, floor, rint
from openacr.views import F64, I32

__all__ = ["scale_arrive", "scale_keeps", "scale_point", "scale_push", "scale_tick"]

# K: integers
K_AXES = 0
K_COUNT = 1  # control points that are known
K_COMPLETE = 2  # they end at rest
K_FIRST = 3  # periods left of the present maneuver, by phase
K_COAST = 4
K_LAST = 5
K_BACK = 6  # periods of a phase of the return to STEADY at the end of it
K_TRIED_BACK = 7
K_SIZE = 8

# W: numbers
W_S = 0  # knots from the beginning of the window
W_SIGMA = 1
W_RHO = 2
W_WANT = 3
W_U = 4  # u of the three phases
W_GOAL = 7  # scale at the end of the maneuver
W_ACCEL = 8  # limits of the second differences, by axis
W_JERK = 16  # limits of the third differences
W_SENT = 24  # the last three control points sent, the newest first
W_SENT_SPEED2 = 48  # square of the highest speed of the plan around the newest one
W_NOW = 49  # s, sigma, rho of a trial
W_TRIAL = 52  # its last three control points
W_TRIAL_SPEED2 = 76
W_NEXT = 80  # the next control point
W_NEXT_SPEED2 = 88
W_PLAN_U = 89  # u of the three phases of a maneuver that is laid out
W_SIZE = 92

AXES = 8
SLACK = 1e-9  # relative, of rounding


def scale_point(C: F64, K: I32, W: F64, s: float, sigma: float, rho: float) -> bool:
    """Write the control point at s to W[W_NEXT]; False where the plan is not known that far."""
    axes: int = K[K_AXES]
    last: int = K[K_COUNT] - 3  # interval with all its control points
    i: int = int(floor(s))
    x: float = s - i
    if i > last or (i == last and x > 0.0):
        if not K[K_COMPLETE]:
            return False
        i = last
        x = 0.0
    if i == last:  # the interval before, at its end
        i -= 1
        x = 1.0
    r: float = 1.0 - x
    b0: float = r * r * r / 6.0
    b1: float = (3.0 * x * x * x - 6.0 * x * x + 4.0) / 6.0
    b2: float = (3.0 * r * r * r - 6.0 * r * r + 4.0) / 6.0
    b3: float = x * x * x / 6.0
    fastest2: float = 0.0
    for k in range(3):
        speed2: float = 0.0
        for axis in range(axes):
            step: float = C[(i + k + 1) * axes + axis] - C[(i + k) * axes + axis]
            speed2 += step * step
        fastest2 = max(fastest2, speed2)
    W[W_NEXT_SPEED2] = fastest2
    for axis in range(axes):
        c0: float = C[i * axes + axis]
        c1: float = C[(i + 1) * axes + axis]
        c2: float = C[(i + 2) * axes + axis]
        c3: float = C[(i + 3) * axes + axis]
        place: float = b0 * c0 + b1 * c1 + b2 * c2 + b3 * c3
        slope: float = 0.5 * (
            r * r * (c1 - c0) + (1.0 + 2.0 * x * r) * (c2 - c1) + x * x * (c3 - c2)
        )
        bend: float = r * (c0 - 2.0 * c1 + c2) + x * (c1 - 2.0 * c2 + c3)
        W[W_NEXT + axis] = place - (bend * sigma * sigma + slope * rho) / 6.0
    if sigma == 1.0 and rho == 0.0 and x == 0.0:
        for axis in range(axes):
            W[W_NEXT + axis] = C[(i + 1) * axes + axis]
    if sigma == 1.0 and rho == 0.0 and x == 1.0:
        for axis in range(axes):
            W[W_NEXT + axis] = C[(i + 2) * axes + axis]
    return True


def scale_tick(W: F64, at: int, u: float) -> None:
    """Take s, sigma and rho at W[at] on by one period."""
    W[at] += W[at + 1] + W[at + 2] / 2.0 + u / 6.0
    W[at + 1] += W[at + 2] + u / 2.0
    W[at + 2] += u


def scale_arrive(W: F64, at: int, goal: float) -> None:
    """End a maneuver: what rounding has left is dropped."""
    W[at + 1] = goal
    W[at + 2] = 0.0
    if goal >= 1.0:
        W[at] = rint(W[at])


def scale_keeps(K: I32, W: F64, sent: int, speed2: float) -> bool:
    """Whether the next control point after those at W[sent] keeps the limits."""
    axes: int = K[K_AXES]
    square: float = 0.0
    for axis in range(axes):
        c0: float = W[W_NEXT + axis]
        c1: float = W[sent + axis]
        c2: float = W[sent + AXES + axis]
        c3: float = W[sent + 2 * AXES + axis]
        square += (c0 - c1) * (c0 - c1)
        if fabs(c0 - 2.0 * c1 + c2) > W[W_ACCEL + axis] * (1.0 + SLACK):
            return False
        if fabs(c0 - 3.0 * c1 + 3.0 * c2 - c3) > W[W_JERK + axis] * (1.0 + SLACK):
            return False
    return square <= max(speed2, W[W_NEXT_SPEED2]) * (1.0 + SLACK)


def scale_push(W: F64, sent: int) -> None:
    """Note the next control point as the newest of those at W[sent]."""
    for k in range(2 * AXES):
        W[sent + 3 * AXES - 1 - k] = W[sent + 2 * AXES - 1 - k]
    for axis in range(AXES):
        W[sent + axis] = W[W_NEXT + axis]
    W[sent + 3 * AXES] = W[W_NEXT_SPEED2]
