"""Laws that are slow enough to keep all limits: where the solver of a window starts."""

import math
from collections.abc import Callable

import numpy as np

from openacr.trajectory.course.course import Soft
from openacr.trajectory.course.end_law import rest_h
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.speed.window import Curve, Rules, Window

SLOW_JERK, SLOW_ACCELERATION = 0.35, 0.25  # shares at the slow speed ahead
BRAKE = 0.6  # share of the acceleration near rest


def slow_h(
    curve: Curve, rules: Callable[[Reals], Rules], first_u: float, end_u: float,
    step_u: float, most: float,
) -> float:  # fmt: skip
    """A constant h = (ds/dt)^2, `most` at the highest, that keeps all limits between distances.

    With a constant speed acceleration is q'' h and jerk q''' h^(3/2).
    """
    s = np.arange(first_u, end_u, step_u)
    if not len(s):
        return most
    knots = np.concatenate([s[:1] - 2e-6, s[:1] - 1e-6, s, s[-1:] + 1e-6, s[-1:] + 2e-6])
    window = Window(curve, knots, rules(knots), None, None)
    bend = float(np.abs(window.rows[:, :, 0]).max())
    jerk = float((np.abs(window.rows[:, :, 2]) + window.rows[:, :, 5]).max())
    return min(
        most,
        float(SLOW_ACCELERATION * window.cap.min()),
        SLOW_ACCELERATION / max(bend, 1e-12),
        float((SLOW_JERK / max(jerk, 1e-12)) ** (2 / 3)),
    )


def places(knots: Reals) -> Reals:
    """The distances at which the coefficients of a spline with these knots act."""
    inner = (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3.0
    found: Reals = np.concatenate([knots[1:2], inner, knots[-2:-1]])
    return found


def to_rest(inverse: Reals, distance: Reals, acceleration: float, soft: Soft, ease: float) -> None:
    """Slow a law, given as h^-2, down towards rest, with a share of acceleration and jerk."""
    inverse += rest_h(distance, soft.swing_u, 0.4 * ease * soft.jerk) ** -2.0
    inverse += (BRAKE * ease * acceleration * (distance + soft.swing_u)) ** -2.0


def eased(before: float, after: Reals, distance: Reals, length_u: float) -> Reals:
    """From a level to others over a length, without a jump of the slope."""
    share = np.clip(distance / length_u, 0.0, 1.0)
    found: Reals = before + (after - before) * share * share * (3.0 - 2.0 * share)
    return found


def stop_speed(length_u: float, jerk: float) -> float:
    """The speed from which a stop with a jerk takes the length, half of it braking harder."""
    return float(np.cbrt(length_u * length_u * jerk))


def stop_rows(row: list[float], jerk: float, acceleration: float) -> list[float]:
    """Three more rows of a time law: from a constant speed to rest."""
    t, s, v, _ = row
    peak = min(math.sqrt(v * jerk), acceleration)
    rise, hold = peak / jerk, v / peak - peak / jerk
    found: list[float] = []
    a = 0.0
    for time, j in ((rise, -jerk), (hold, 0.0), (rise, jerk)):
        s += time * (v + time * (0.5 * a + time * j / 6.0))
        v += time * (a + 0.5 * j * time)
        a += j * time
        t += time
        found += [t, s, v, a]
    found[-2:] = [0.0, 0.0]
    return found
