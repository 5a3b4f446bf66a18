"""How a chain starts from rest; how it ends is the same in reverse.

Where it overlaps another chain, it may swing out by a distance e first, against its direction.
With a jerk of -J for the time t1, and of +J from then on,

    s = J (r^3/6 - t1^2 r - t1^3)     v = J (r^2/2 - t1^2)     a = J r     r = t - 2 t1

it turns back at r = sqrt(2) t1, where s = -DEPTH J t1^3 = -e. Without a swing, t1 = 0, that is
s = J t^3/6. The shape v(s) is the same for all jerks, but for a factor.
"""

import math

import numpy as np

from openacr.trajectory.path.setpoints import Reals

DEPTH = 1.0 + math.sqrt(8.0) / 3.0
MOST_STEPS = 20
CLOSE = 1e-14


def turn_s(swing_u: float, jerk: float) -> float:
    """The time t1 after which the jerk of a start that swings out changes its sign."""
    return math.cbrt(swing_u / (DEPTH * jerk))


def rest_u(time_s: float, swing_u: float, jerk: float) -> float:
    """The distance at a time, after the jerk has changed its sign."""
    t1 = turn_s(swing_u, jerk)
    r = time_s - 2.0 * t1
    return jerk * (r * r * r / 6.0 - t1 * t1 * (r + t1))


def rest_time(s: Reals | float, swing_u: float, jerk: float) -> Reals:
    """The time r = t - 2 t1 at distances, 0 at least, which are passed forwards."""
    t1 = turn_s(swing_u, jerk)
    wanted = 6.0 * (np.maximum(s, 0.0) / jerk + t1**3)
    r: Reals = np.cbrt(wanted) + math.sqrt(6.0) * t1  # above the solution, without a swing on it
    for _ in range(MOST_STEPS if swing_u else 0):
        change = (r * (r * r - 6.0 * t1 * t1) - wanted) / (3.0 * (r * r - 2.0 * t1 * t1))
        r = r - change
        if np.max(change / r) < CLOSE:
            break
    return r


def rest_h(s: Reals, swing_u: float, jerk: float) -> Reals:
    """H at distances after a start with a jerk."""
    r, t1 = rest_time(s, swing_u, jerk), turn_s(swing_u, jerk)
    found: Reals = (jerk * (0.5 * r * r - t1 * t1)) ** 2
    return found


def rest_shape(s: float, swing_u: float) -> tuple[float, float, float]:
    """h'/h, h''/h and t v at a distance; they do not depend on the jerk."""
    r, t1 = float(rest_time(s, swing_u, 1.0)), turn_s(swing_u, 1.0)
    v = 0.5 * r * r - t1 * t1
    return 2.0 * r / (v * v), 2.0 / (v * v * v), (r + 2.0 * t1) * v


def turn_row(time_s: float, s: float, swing_u: float) -> tuple[float, float, float, float]:
    """Time, distance, speed and acceleration where the jerk changes its sign.

    The start takes `time_s` to the distance s.
    """
    if not swing_u:
        return 0.0, 0.0, 0.0, 0.0
    t1 = turn_s(swing_u, 1.0)
    share = t1 / (float(rest_time(s, swing_u, 1.0)) + 2.0 * t1)
    back = -swing_u / DEPTH  # -J t1^3
    time = share * time_s
    return time, back / 6.0, 0.5 * back / time, back / time**2
