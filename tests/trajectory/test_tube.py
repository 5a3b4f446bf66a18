"""How near a smoothed path is to the smoothest one within its tube."""

import math

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from openacr.trajectory.path import tube
from openacr.trajectory.path.setpoints import Reals

pytestmark = pytest.mark.evidence("oracle", "bounded least squares of scipy")
RADIUS = 0.008
STEP = 0.04
COUNT = 120


def smoothed(programmed: Reals) -> Reals:
    """The smoothed samples of one axis; the first and last ones are given."""
    samples = tube.Samples(len(programmed), 1, tube.ROUNDS)
    samples.programmed[:, 0] = samples.smoothed[:, 0] = programmed
    samples.radius[:] = RADIUS
    samples.smooth(tube.GIVEN, 3)
    found: Reals = samples.smoothed[:, 0]
    return found


def smoothest(programmed: Reals) -> Reals:
    """The same by bounded least squares: a sum of squares of third differences, in a box."""
    count = len(programmed)
    third = np.diff(np.eye(count), 3, axis=0)
    free = slice(tube.GIVEN, count - 3)
    given = programmed.copy()
    given[free] = 0.0
    low, high = programmed[free] - RADIUS, programmed[free] + RADIUS
    found = programmed.copy()
    side = -third @ given
    found[free] = lsq_linear(third[:, free], side, (low, high), method="bvls", max_iter=3000).x
    return found


def roughness(q: Reals) -> float:
    return float((np.diff(q, 3) ** 2).sum())


@pytest.mark.parametrize("turn_deg", [5.0, 15.0, 30.0])
def test_a_rounded_corner_is_nearly_the_smoothest(turn_deg: float) -> None:
    s = STEP * np.arange(COUNT)
    programmed = math.tan(math.radians(turn_deg)) * np.maximum(s - 2.413, 0.0)
    best = roughness(smoothest(programmed))
    found = smoothed(programmed)
    assert np.abs(found - programmed).max() <= 1.02 * RADIUS
    assert roughness(found) <= 1.005 * best
