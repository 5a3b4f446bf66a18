"""How far plans are from the joint optimum of path and time."""

import math

import numpy as np
import pytest
from tests.trajectory.joint_optimum import Path, fewest
from tests.trajectory.measures import PERIOD_S, deviations, limits, planned, points
from tests.trajectory.programs import PARTS, Segments, line

pytestmark = pytest.mark.evidence("oracle", "linear programmes of scipy over path and time")
START, TOLERANCE, LEG, HEADING, JERK = (0.0, 0.0, 0.0), 0.01, 3.0, math.radians(20.0), 20_000.0


def chain(turn_deg: float) -> Segments:
    """Two legs with a corner, along no axis."""
    after = HEADING + math.radians(turn_deg)
    corner = LEG * np.array([math.cos(HEADING), math.sin(HEADING)])
    end = corner + LEG * np.array([math.cos(after), math.sin(after)])
    return [line(n, x, y, 0, TOLERANCE) for n, (x, y) in enumerate((corner, end), 1)]


def plan_and_best(segments: Segments, jerk: float | None) -> tuple[int, int]:
    """The counts of periods of a plan and of the joint optimum, which is within the tolerance."""
    plan = points(planned(segments, START, limits(jerk)))
    best = fewest(Path.of(segments, START, PERIOD_S, has_jerk=jerk is not None), plan)
    in_space = np.concatenate([best[:, :2], np.zeros((len(best), 1))], axis=1)
    assert max(deviations(in_space, segments, START)) <= 1.1 * TOLERANCE
    return len(plan), len(best)


@pytest.mark.parametrize("turn_deg", [10.0, 30.0, 90.0])
def test_a_corner_takes_at_most_twelve_percent_more_than_the_joint_optimum(turn_deg: float) -> None:
    found, best = plan_and_best(chain(turn_deg), JERK)
    assert best <= found <= 1.12 * best
    # even the optimum takes a quarter longer than the plan without a jerk limit
    assert best > 1.25 * len(points(planned(chain(turn_deg), START, limits(None))))


def test_lines_with_an_arc_between_them_take_at_most_a_tenth_more_than_the_joint_optimum() -> None:
    found, best = plan_and_best(PARTS["pocket"](TOLERANCE), JERK)
    without, best_without = plan_and_best(PARTS["pocket"](TOLERANCE), None)
    assert best <= found <= 1.1 * best
    assert best_without <= without <= 1.1 * best_without
    # even the optimum takes a sixth longer than the plan without a jerk limit
    assert best > 7 / 6 * without
