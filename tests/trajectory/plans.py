"""Plans made of formulas, as control points that keep limits of 1000 mm/s2 and 20,000 mm/s3."""

from collections.abc import Callable

import numpy as np
import ruckig
from numpy.typing import NDArray

Rows = NDArray[np.float64]
Distance = Callable[[float], float]
PERIOD_S = 0.005
SPEED, ACCEL, JERK = 100.0, 1000.0, 20_000.0  # mm/s on the path, the others by axis


def s_curve(length: float, speed: float = SPEED, accel: float = ACCEL, jerk: float = JERK) -> Rows:
    """The distance along a path from rest to rest, one value per period."""
    asked, found = ruckig.InputParameter(1), ruckig.Trajectory(1)
    asked.current_position, asked.target_position = [0.0], [length]
    asked.max_velocity, asked.max_acceleration, asked.max_jerk = [speed], [accel], [jerk]
    ruckig.Ruckig(1).calculate(asked, found)
    count = int(np.ceil(found.duration / PERIOD_S)) + 1
    times = np.arange(count) * PERIOD_S
    return np.array([found.at_time(min(t, found.duration))[0][0] for t in times])


def rested(points: Rows) -> Rows:
    """A plan that begins and ends with three equal control points."""
    return np.concatenate([points[:1], points[:1], points, points[-1:], points[-1:]])


def line(length: float = 40.0, **limits: float) -> Rows:
    """One straight move along X."""
    gone = s_curve(length, **limits)
    return rested(np.stack([gone, 0.0 * gone, 0.0 * gone], axis=1))


def lines(seed: int, count: int = 12) -> Rows:
    """Straight moves in space, each from rest to rest."""
    chance, start, parts = np.random.default_rng(seed), np.zeros(3), []
    for _ in range(count):
        away = chance.uniform(-1.0, 1.0, 3) * chance.choice([0.3, 3.0, 30.0])
        length = float(np.linalg.norm(away))
        most = float(np.abs(away).max()) / length
        gone = s_curve(length, SPEED, ACCEL / most, JERK / most)
        parts.append(rested(start + np.outer(gone / length, away)))
        start = start + away
    return np.concatenate(parts)


def circle(radius: float) -> Rows:
    """A full circle at the speed its radius allows; the ramps leave room for the curvature."""
    speed = min(SPEED, 0.9 * (ACCEL * radius) ** 0.5, 0.8 * (JERK * radius**2) ** (1 / 3))
    gone = s_curve(2.0 * np.pi * radius, speed, 0.3 * ACCEL, 0.2 * JERK)
    turned = gone / radius
    return rested(radius * np.stack([np.cos(turned), np.sin(turned), 0.0 * gone], axis=1))


def smooth(seed: int) -> Rows:
    """Sums of sines, as fast as the tightest of the limits allows."""
    chance, times = np.random.default_rng(seed), np.arange(2400) * PERIOD_S
    points = np.zeros((len(times), 3))
    for axis in range(3):
        for _ in range(9):
            w = chance.uniform(2.0, 28.0)
            points[:, axis] += np.sin(w * times + chance.uniform(0, 6.3)) / w**2
    for ramp in (times, times[::-1]):
        x = np.clip(ramp / 0.6, 0.0, 1.0)[:, None]
        points = (points - points[0]) * x**4 * (35 - 84 * x + 70 * x**2 - 20 * x**3)
    found = highest(points)
    return rested(points * min(a / b for a, b in zip((SPEED, ACCEL, JERK), found, strict=True)))


def bang_bang() -> Rows:
    """A jerk that changes its sign at every knot: no plan is harder to sample elsewhere."""
    third = JERK * PERIOD_S**3 * np.where(np.arange(400) % 2, -1.0, 1.0)
    speed = 0.5 * PERIOD_S * 60.0 * (1.0 - np.cos(np.linspace(0.0, 2.0 * np.pi, 400)))
    gone = np.cumsum(np.cumsum(np.cumsum(third) - third.mean()) * 0.0 + speed)
    second = np.cumsum(third)
    ripple = np.cumsum(np.cumsum(second - second.mean()) - 0.25 * third[0])
    return rested(np.stack([gone, ripple - ripple[0], 0.0 * gone], axis=1))


def highest(points: Rows) -> tuple[float, float, float]:
    """Bounds of path speed, and of acceleration and jerk of any axis, of a curve in mm and s."""
    speed = np.linalg.norm(np.diff(points, axis=0), axis=1).max() / PERIOD_S
    accel = np.abs(np.diff(points, 2, axis=0)).max() / PERIOD_S**2
    return float(speed), float(accel), float(np.abs(np.diff(points, 3, axis=0)).max() / PERIOD_S**3)


def curve(points: Rows, per_knot: int, phase: float = 0.0) -> Rows:
    """Places on the B-spline of control points, `per_knot` to a period, from `phase` of one on."""
    steps = np.arange((len(points) - 3) * per_knot) + phase
    i = (steps // per_knot).astype(int)
    x = (steps / per_knot - i)[:, None]
    r = 1.0 - x
    weights = (r**3, 3 * x**3 - 6 * x**2 + 4, 3 * r**3 - 6 * r**2 + 4, x**3)
    return np.asarray(sum(w * points[i + k] for k, w in enumerate(weights)) / 6.0)
