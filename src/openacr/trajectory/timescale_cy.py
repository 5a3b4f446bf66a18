r"""Time scale in front of a planned trajectory: override and hold that keep every limit.

A plan is a uniform cubic B-spline in time, C[i] its control points, one per knot period. It is
run through as y(t) = Y(s(t)), with the scale sigma = ds/dt from 0 (held) to 1, and sent as
another spline with the same knots. All times here are counted in knot periods. With rho =
dsigma/dt, the control point of the knot at s is

    c = Y(s) - y''/6,    y'' = Y'' sigma^2 + Y' rho,

which is C[s] itself where s is whole and sigma is 1, and Y(s) at rest. The curve of the card
lies between its control points, and so do its derivatives between their differences. So the
second and third differences of c are all that has to be compared with the limits.

The scale changes by maneuvers: u = d2sigma/dt2 is constant over `first` periods, then over
`coast`, then over `last`, and it ends at the wanted scale with rho = 0. A maneuver is run only
after every control point of it, and of the three periods that follow it, has been computed and
compared; and it is computed by the same function that runs it, so what was compared is what is
run. A quicker one may replace it later, after the same test; otherwise it goes on. A constant
scale keeps the limits of the plan where it is at most STEADY, because a time scale lowers
acceleration by sigma^2 and jerk by sigma^3 while the resampling raises jerk by a quarter at
most; and where it is 1 with s whole, because then nothing is resampled. A maneuver that ends
at 1 therefore ends at a whole s.

`C` holds the control points row by row, the first of them that of knot -1 of this window.
`K` and `W` hold integers and numbers: the names below.
"""

from openacr.cmath import fabs, floor, rint
from openacr.views import F64, I32

__all__ = ["scale_advance", "scale_point"]

# K: integers
K_AXES = 0
K_COUNT = 1  # control points that are known
K_COMPLETE = 2  # they end at rest
K_FIRST = 3  # periods left of the present maneuver, by phase
K_COAST = 4
K_LAST = 5
K_SIZE = 6
PHASES = 3

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
STEADY = 0.92  # highest constant scale other than 1
LONGEST = 96  # periods of a maneuver
FOLLOWING = 3  # periods after a maneuver whose control points still depend on it
SLACK = 1e-9  # relative, of rounding

# What `scale_advance` has done.
SENT = 0
AT_END = 1
UNKNOWN = 2  # the plan is not known as far as the next control point


def scale_goal(want: float) -> float:
    """The constant scale that stands for a wanted one."""
    if want >= 1.0:
        return 1.0
    return max(min(want, STEADY), 0.0)


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


def scale_try(C: F64, K: I32, W: F64, first: int, coast: int, last: int, goal: float) -> bool:
    """Whether the maneuver at W[W_PLAN_U] keeps all limits, and the periods that follow it."""
    for k in range(3):
        W[W_NOW + k] = W[W_S + k]
    for k in range(3 * AXES + 1):
        W[W_TRIAL + k] = W[W_SENT + k]
    periods: int = first + coast + last
    for n in range(periods + FOLLOWING):
        u: float = 0.0
        if n < first:
            u = W[W_PLAN_U]
        elif n < first + coast:
            u = W[W_PLAN_U + 1]
        elif n < periods:
            u = W[W_PLAN_U + 2]
        before: float = W[W_NOW]
        scale_tick(W, W_NOW, u)
        if n == periods - 1:
            scale_arrive(W, W_NOW, goal)
        sigma: float = W[W_NOW + 1]
        if sigma < -SLACK or sigma > 1.0 + SLACK or W[W_NOW] < before:
            return False
        if not scale_point(C, K, W, W[W_NOW], sigma, W[W_NOW + 2]):
            return False
        if not scale_keeps(K, W, W_TRIAL, W[W_TRIAL_SPEED2]):
            return False
        scale_push(W, W_TRIAL)
    return True


def scale_ramps(W: F64, m: float, p: float, q: float, goal: float) -> None:
    """Lay out a maneuver of m, p and q periods whose coast has u = 0."""
    rho: float = W[W_RHO]
    rise: float = goal - W[W_SIGMA]
    u: float = (rise - rho * (m + p + q / 2.0)) / (m * (m / 2.0 + p + q / 2.0))
    W[W_PLAN_U] = u
    W[W_PLAN_U + 1] = 0.0
    W[W_PLAN_U + 2] = -(rho + u * m) / q


def scale_end(W: F64, m: float, p: float, q: float) -> float:
    """Where the maneuver at W[W_PLAN_U] ends, knots from the beginning of the window."""
    n: float = m + p + q
    r: float = p + q
    gone: float = W[W_SIGMA] * n + W[W_RHO] * n * n / 2.0
    gone += W[W_PLAN_U] * (m * m * m / 6.0 + m * m * r / 2.0 + m * r * r / 2.0)
    gone += W[W_PLAN_U + 1] * (p * p * p / 6.0 + p * p * q / 2.0 + p * q * q / 2.0)
    gone += W[W_PLAN_U + 2] * q * q * q / 6.0
    return W[W_S] + gone


def scale_shift(W: F64, m: float, p: float, q: float, by: float) -> None:
    """Let the maneuver at W[W_PLAN_U] end `by` knots further on, at the same sigma and rho.

    What is added to the three u solves

        m a + p b + q c = 0                                   rho
        m (m/2 + p + q) a + p (p/2 + q) b + q^2/2 c = 0       sigma
        (cubics of `scale_end`) = by                          s

    The first two leave a = k p q (p + q), b = -k m q (m + 2p + q), c = k m p (m + p), and the
    third says what k is.
    """
    keep0: float = W[W_PLAN_U]
    keep1: float = W[W_PLAN_U + 1]
    keep2: float = W[W_PLAN_U + 2]
    a: float = p * q * (p + q)
    b: float = -m * q * (m + 2.0 * p + q)
    c: float = m * p * (m + p)
    r: float = p + q
    per: float = a * (m * m * m / 6.0 + m * m * r / 2.0 + m * r * r / 2.0)
    per += b * (p * p * p / 6.0 + p * p * q / 2.0 + p * q * q / 2.0)
    per += c * q * q * q / 6.0
    k: float = by / per
    W[W_PLAN_U] = keep0 + k * a
    W[W_PLAN_U + 1] = keep1 + k * b
    W[W_PLAN_U + 2] = keep2 + k * c


def scale_lay(C: F64, K: I32, W: F64, first: int, coast: int, last: int, goal: float) -> bool:
    """Lay out a maneuver to a scale and try it: its periods by phase."""
    m: float = first
    p: float = coast
    q: float = last
    scale_ramps(W, m, p, q, goal)
    if goal < 1.0:
        return scale_try(C, K, W, first, coast, last, goal)
    if coast == 0:
        return False
    end: float = scale_end(W, m, p, q)
    low: float = floor(end)
    scale_shift(W, m, p, q, low - end)
    if scale_try(C, K, W, first, coast, last, goal):
        return True
    scale_ramps(W, m, p, q, goal)
    scale_shift(W, m, p, q, low + 1.0 - end)
    return scale_try(C, K, W, first, coast, last, goal)


def scale_seek(C: F64, K: I32, W: F64, goal: float, most: int) -> bool:
    """Take over the shortest maneuver of fewer than `most` periods that keeps all limits."""
    periods: int = 2
    while periods < most:
        for quarter in range(4):
            ramp: int = (periods * (4 - quarter)) >> 3  # a half, 3/8, a quarter, an eighth
            before: int = (periods * (5 - quarter)) >> 3
            if ramp >= 1 and (quarter == 0 or ramp != before):
                coast: int = periods - 2 * ramp
                if scale_lay(C, K, W, ramp, coast, ramp, goal):
                    K[K_FIRST] = ramp
                    K[K_COAST] = coast
                    K[K_LAST] = ramp
                    W[W_GOAL] = goal
                    for k in range(PHASES):
                        W[W_U + k] = W[W_PLAN_U + k]
                    return True
        periods += 1 + (periods >> 3)
    return False


def scale_advance(C: F64, K: I32, W: F64) -> int:
    """Go on by one period: write the next control point to W[W_NEXT]; SENT, AT_END or UNKNOWN."""
    goal: float = scale_goal(W[W_WANT])
    left: int = K[K_FIRST] + K[K_COAST] + K[K_LAST]
    if left > 0:
        scale_seek(C, K, W, goal, left if W[W_GOAL] == goal else LONGEST + 1)
    elif W[W_SIGMA] != goal:
        scale_seek(C, K, W, goal, LONGEST + 1)
    for k in range(3):
        W[W_NOW + k] = W[W_S + k]
    phase: int = 0
    while phase < PHASES and K[K_FIRST + phase] == 0:
        phase += 1
    u: float = W[W_U + phase] if phase < PHASES else 0.0
    scale_tick(W, W_NOW, u)
    if phase < PHASES and K[K_FIRST] + K[K_COAST] + K[K_LAST] == 1:
        scale_arrive(W, W_NOW, W[W_GOAL])
    if not scale_point(C, K, W, W[W_NOW], W[W_NOW + 1], W[W_NOW + 2]):
        return UNKNOWN
    if phase < PHASES:
        K[K_FIRST + phase] -= 1
    for k in range(3):
        W[W_S + k] = W[W_NOW + k]
    scale_push(W, W_SENT)
    if K[K_COMPLETE] and W[W_S] >= K[K_COUNT] - 3:
        return AT_END
    return SENT
