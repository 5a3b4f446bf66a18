"""Speeds of axes with limits far apart: a path that turns makes one faster between knots."""

import numpy as np
import pytest
from tests.trajectory.measures import PERIOD_S, planned, points
from tests.trajectory.random_programs import program
from tests.trajectory.test_random_paths import ALLOWED

from openacr.trajectory import Limits
from openacr.trajectory.path.setpoints import Reals

WORST = [50, 394, 589]  # 0.7, 1.3 and 2.4 % too fast where cells are not checked
AGAIN = 255  # 0.08 % too fast where only cells are, not setpoints


def unlike(seed: int, axes: int) -> Reals:
    """Limits of velocity, acceleration and jerk, each down to a hundredth of the highest."""
    most = 100.0 ** -np.random.default_rng([seed, 7]).random((3, axes))
    found: Reals = most / most.max(axis=1)[:, None] * [[100.0], [1000.0], [20_000.0]]
    return found


def used(seed: int) -> Reals:
    """The largest shares of the limits of speed, acceleration and jerk."""
    segments, axes, _ = program(seed)
    most = unlike(seed, axes)
    machine = Limits(*(tuple(row) for row in most.tolist()))
    control = points(planned(segments, (0.0,) * axes, machine))
    assert control[-1].tolist() == list(segments[-1].end)
    found = [(np.abs(np.diff(control, order, axis=0)) / PERIOD_S**order / limit).max()
             for order, limit in enumerate(most, start=1)]  # fmt: skip
    return np.array(found)


@pytest.mark.parametrize("seed", [*range(3), 13, *WORST, AGAIN])
def test_no_axis_exceeds_its_speed_where_the_path_turns_between_knots(seed: int) -> None:
    assert used(seed).max() <= ALLOWED


@pytest.mark.soak
@pytest.mark.parametrize("hundred", range(15))
def test_no_axis_of_fifteen_hundred_unlike_machines_exceeds_a_limit(hundred: int) -> None:
    for seed in range(100 * hundred, 100 * (hundred + 1)):
        assert used(seed).max() <= ALLOWED, seed


def test_limits_of_speeds_between_knots_take_no_more_time_than_they_need() -> None:
    """Without the check of cells the whole window would be slowed: 1654 setpoints before."""
    segments, axes, _ = program(589)
    machine = Limits(*(tuple(row) for row in unlike(589, axes).tolist()))
    assert len(points(planned(segments, (0.0,) * axes, machine))) < 1.01 * 1654
