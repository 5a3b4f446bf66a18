"""The constant speed that a window starts with, on circles."""

import math

import numpy as np
import pytest

from openacr.trajectory import Limits
from openacr.trajectory.path.arrays import flat
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.speed.slow_law import SLOW_ACCELERATION, SLOW_JERK, slow_h
from openacr.trajectory.speed.window import Curve, Rules

STEP_U, SPEED, ACCEL, PERIOD_S = 0.05, 1000.0, 2000.0, 0.004
NEAR = 0.01  # of control points as points of a circle, and of jerk between knots


def circle(radius: float, length_u: float) -> Curve:
    """A circle as control points of a cubic B-spline in distance."""
    angles = STEP_U / radius * np.arange(-3, round(length_u / STEP_U) + 3)
    points = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return Curve(flat(np.ascontiguousarray(points)), len(points), 2, STEP_U, -3 * STEP_U)


@pytest.mark.parametrize(
    ("radius", "jerk", "feed", "wanted"),
    [
        (2.0, 1e9, 1000.0, SLOW_ACCELERATION * ACCEL * 2.0),  # v^2 / r
        (2.0, 500.0, 1000.0, (SLOW_JERK * 500.0 * 2.0**2) ** (2 / 3)),  # v^3 / r^2
        (2.0, 1e9, 10.0, SLOW_ACCELERATION * 10.0**2),
    ],
)
def test_a_constant_speed_keeps_the_slow_shares_of_all_limits(
    radius: float, jerk: float, feed: float, wanted: float
) -> None:
    limits = Limits((SPEED,) * 2, (ACCEL,) * 2, (jerk,) * 2)

    def rules(knots: Reals) -> Rules:
        ones = np.ones(len(knots) - 4)
        row = np.array(limits.planned(PERIOD_S))
        return Rules(feed * ones, math.inf * ones, ones, ones, ones, ones, 1e12 * ones, row,
                     math.inf)  # fmt: skip

    curve = circle(radius, 12.0)
    found = slow_h(curve, rules, 0.5, 11.5, STEP_U, 1e9)
    assert found == pytest.approx(wanted, rel=NEAR)
    assert slow_h(curve, rules, 0.5, 11.5, STEP_U, 0.5 * wanted) == 0.5 * wanted
    assert slow_h(curve, rules, 0.5, 0.5, STEP_U, 7.0) == 7.0  # nothing known ahead
