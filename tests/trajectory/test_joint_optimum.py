"""How far plans are from the joint optimum of path and time."""

import math

import numpy as np
import pytest
from tests.trajectory.joint_optimum import fewest
from tests.trajectory.measures import PERIOD_S, limits, planned, points
from tests.trajectory.programs import line

from openacr.trajectory.setpoints import Reals

pytestmark = pytest.mark.evidence("oracle", "linear programmes of scipy over path and time")
TOLERANCE, LEG, HEADING = 0.01, 3.0, math.radians(20.0)


def chain(turn_deg: float) -> Reals:
    """Two legs with a corner, along no axis."""
    after = HEADING + math.radians(turn_deg)
    corner = LEG * np.array([math.cos(HEADING), math.sin(HEADING)])
    return np.array(
        [[0.0, 0.0], corner, corner + LEG * np.array([math.cos(after), math.sin(after)])]
    )


def plan(vertices: Reals, jerk: float | None) -> Reals:
    segments = [line(n, x, y, 0, TOLERANCE) for n, (x, y) in enumerate(vertices[1:], 1)]
    return points(planned(segments, (0.0, 0.0, 0.0), limits(jerk)))[:, :2]


@pytest.mark.parametrize("turn_deg", [10.0, 30.0, 90.0])
def test_a_corner_takes_at_most_twelve_percent_more_than_the_joint_optimum(turn_deg: float) -> None:
    vertices = chain(turn_deg)
    found = plan(vertices, 20_000.0)
    best = fewest(vertices, TOLERANCE, found, PERIOD_S)
    assert best <= len(found) <= 1.12 * best
    # even the optimum takes a quarter longer than the plan without a jerk limit
    assert best > 1.25 * len(plan(vertices, None))
