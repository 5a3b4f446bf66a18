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

Between STEADY and 1 a constant scale keeps the limits of most plans, and of those that switch
their jerk at every knot it does not. So a return to STEADY, in three phases of K_BACK periods,
has been compared before the scale arrives there and before each period it stays; where none is
found any more, the last one is run.

`C`, `K` and `W` are those of `timescale_points_cy`.
"""

from openacr.cmath import floor
from openacr.trajectory.override.timescale_points_cy import (
    AXES,
    K_BACK,
    K_COAST,
    K_COMPLETE,
    K_COUNT,
    K_FIRST,
    K_LAST,
    K_TRIED_BACK,
    SLACK,
    W_GOAL,
    W_NOW,
    W_PLAN_U,
    W_RHO,
    W_S,
    W_SENT,
    W_SIGMA,
    W_TRIAL,
    W_TRIAL_SPEED2,
    W_U,
    W_WANT,
    scale_arrive,
    scale_keeps,
    scale_point,
    scale_push,
    scale_tick,
)
from openacr.views import F64, I32

__all__ = ["scale_advance", "scale_start"]

PHASES = 3
STEADY = 0.92  # highest scale below 1 that may stay constant whatever the plan does
LONGEST = 96  # periods of a maneuver
SHORT_BACK = 6  # periods of a phase of a return to STEADY, at least and at most
LONG_BACK = 30
FOLLOWING = 3  # periods after a maneuver whose control points still depend on it

# What `scale_advance` has done.
SENT = 0
AT_END = 1
UNKNOWN = 2  # the plan is not known as far as the next control point


def scale_is_steady(sigma: float) -> bool:
    """Whether a scale may stay constant whatever the plan does."""
    return sigma <= STEADY or sigma >= 1.0


def scale_start(want: float) -> float:
    """The scale that a plan begins at, at rest, for a wanted one."""
    return want if scale_is_steady(want) else STEADY


def scale_back(goal: float, back: int) -> float:
    """Find u of the first phase of a return to STEADY; that of the third is its negative."""
    return (STEADY - goal) / (2.0 * back * back)


def scale_try(
    C: F64, K: I32, W: F64, first: int, coast: int, last: int, goal: float, back: int
) -> int:
    """How many periods of the maneuver at W[W_PLAN_U] and of what follows keep all limits.

    What follows is the return to STEADY in three phases of `back` periods, if any, and FOLLOWING
    periods.
    """
    for k in range(3):
        W[W_NOW + k] = W[W_S + k]
    for k in range(3 * AXES + 1):
        W[W_TRIAL + k] = W[W_SENT + k]
    periods: int = first + coast + last
    whole: int = periods + PHASES * back
    rest: float = scale_back(goal, back) if back > 0 else 0.0
    for n in range(whole + FOLLOWING):
        u: float = 0.0
        if n < first:
            u = W[W_PLAN_U]
        elif n < first + coast:
            u = W[W_PLAN_U + 1]
        elif n < periods:
            u = W[W_PLAN_U + 2]
        elif n < periods + back:
            u = rest
        elif periods + 2 * back <= n < whole:
            u = -rest
        before: float = W[W_NOW]
        scale_tick(W, W_NOW, u)
        if n == periods - 1:
            scale_arrive(W, W_NOW, goal)
        elif n == whole - 1:
            scale_arrive(W, W_NOW, STEADY)
        sigma: float = W[W_NOW + 1]
        if sigma < -SLACK or sigma > 1.0 + SLACK or W[W_NOW] < before:
            return n
        if not scale_point(C, K, W, W[W_NOW], sigma, W[W_NOW + 2]):
            return n
        if not scale_keeps(K, W, W_TRIAL, W[W_TRIAL_SPEED2]):
            return n
        scale_push(W, W_TRIAL)
    return whole + FOLLOWING


def scale_holds(C: F64, K: I32, W: F64, first: int, coast: int, last: int, goal: float) -> bool:
    """Whether the maneuver at W[W_PLAN_U] keeps all limits, and what can follow it."""
    periods: int = first + coast + last
    back: int = 0
    if not scale_is_steady(goal):
        back = K[K_BACK] if K[K_BACK] > 0 else SHORT_BACK  # the last one will mostly do again
    kept: int = scale_try(C, K, W, first, coast, last, goal, back)
    is_kept: bool = kept == periods + PHASES * back + FOLLOWING
    K[K_TRIED_BACK] = back
    if is_kept or back == 0 or kept < periods:
        return is_kept
    back = SHORT_BACK
    while back <= LONG_BACK:
        K[K_TRIED_BACK] = back
        kept = scale_try(C, K, W, first, coast, last, goal, back)
        if kept == periods + PHASES * back + FOLLOWING:
            return True
        back += back >> 1
    return False


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
        return scale_holds(C, K, W, first, coast, last, goal)
    if coast == 0:
        return False
    end: float = scale_end(W, m, p, q)
    low: float = floor(end)
    scale_shift(W, m, p, q, low - end)
    if scale_holds(C, K, W, first, coast, last, goal):
        return True
    scale_ramps(W, m, p, q, goal)
    scale_shift(W, m, p, q, low + 1.0 - end)
    return scale_holds(C, K, W, first, coast, last, goal)


def scale_take(K: I32, W: F64, first: int, coast: int, last: int, goal: float, back: int) -> None:
    """Let the maneuver at W[W_PLAN_U] be the next one."""
    K[K_FIRST] = first
    K[K_COAST] = coast
    K[K_LAST] = last
    K[K_BACK] = back
    W[W_GOAL] = goal
    for k in range(PHASES):
        W[W_U + k] = W[W_PLAN_U + k]


def scale_stay(C: F64, K: I32, W: F64) -> None:
    """Stay at a scale that is not steady for one period, or take the return to STEADY."""
    goal: float = W[W_SIGMA]
    for k in range(PHASES):
        W[W_PLAN_U + k] = 0.0
    if scale_holds(C, K, W, 1, 0, 0, goal):
        scale_take(K, W, 1, 0, 0, goal, K[K_TRIED_BACK])
        return
    back: int = K[K_BACK]
    W[W_PLAN_U] = scale_back(goal, back)
    W[W_PLAN_U + 2] = -W[W_PLAN_U]
    scale_take(K, W, back, back, back, STEADY, 0)


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
                    scale_take(K, W, ramp, coast, ramp, goal, K[K_TRIED_BACK])
                    return True
        periods += 1 + (periods >> 3)
    return False


def scale_advance(C: F64, K: I32, W: F64) -> int:
    """Go on by one period: write the next control point to W[W_NEXT]; SENT, AT_END or UNKNOWN."""
    goal: float = W[W_WANT]
    left: int = K[K_FIRST] + K[K_COAST] + K[K_LAST]
    if left > 0:
        scale_seek(C, K, W, goal, left if W[W_GOAL] == goal else LONGEST + 1)
    elif W[W_SIGMA] != goal:
        scale_seek(C, K, W, goal, LONGEST + 1)
    if K[K_FIRST] + K[K_COAST] + K[K_LAST] == 0 and not scale_is_steady(W[W_SIGMA]):
        scale_stay(C, K, W)
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
