"""Knots of a time law: how far they are apart on lines, circles and in bends."""

import numpy as np
import pytest

from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.speed.spacing import continued, widest

STEP = 0.04
ACCELERATION, JERK = 1000.0, 20_000.0
DENSE = 0.08


def gaps(points: Reals, feed: float = 100.0, dense: float = DENSE) -> Reals:
    return widest(points, STEP, np.full(len(points) - 3, feed), ACCELERATION, JERK, dense)


def line(count: int) -> Reals:
    return np.stack([STEP * np.arange(count), np.zeros(count)], axis=1)


def circle(radius: float, count: int) -> Reals:
    angles = STEP * np.arange(count) / radius
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


@pytest.mark.parametrize(("feed", "gap"), [(100.0, 0.4), (30.0, 0.12), (5.0, 0.08)])
def test_knots_on_a_line_are_a_share_of_the_build_up_of_acceleration_apart(
    feed: float, gap: float
) -> None:
    # 0.08 of 50 ms at the feed, but not less than the dense distance
    assert gaps(line(50), feed) == pytest.approx(gap)


@pytest.mark.parametrize(("radius", "gap"), [(50.0, 0.4), (2.0, 0.12), (0.5, 0.08)])
def test_knots_on_a_circle_follow_its_turn(radius: float, gap: float) -> None:
    # 0.06 rad, but not more than on a line, nor less than the dense distance
    assert gaps(circle(radius, 60)) == pytest.approx(gap, rel=2e-3)


def test_knots_are_dense_where_the_third_derivative_changes() -> None:
    bent = line(101)
    bent[50:, 1] += 0.3 * STEP * np.arange(51)
    found = gaps(bent)
    assert found[47:51] == pytest.approx(DENSE)
    assert found[:47] == pytest.approx(0.4)
    assert found[51:] == pytest.approx(0.4)


def test_distances_of_knots_grow_by_twelve_percent_of_the_path_between() -> None:
    s = np.arange(0.0, 20.0, STEP)
    wanted = np.where(np.abs(s - 10.0) < 0.5, DENSE, 1.0)
    knots = continued(np.array([-0.1, 0.0]), s, wanted, 18.0, None)
    found = np.diff(knots)
    assert knots[-1] <= 18.0
    assert found[0] == pytest.approx(0.1)  # as the one before
    assert found.min() == pytest.approx(DENSE)
    assert found.max() > 0.85
    assert np.abs(np.diff(found) / found[1:]).max() == pytest.approx(0.12, abs=0.012)


def test_knots_before_an_end_fill_the_distance_evenly() -> None:
    s = np.arange(0.0, 3.0, STEP)
    knots = continued(np.array([-0.3, 0.0]), s, np.full(len(s), 0.3), 2.0, 0.3)
    assert np.diff(knots[1:]) == pytest.approx(2.0 / 7.0)
    assert knots[-1] == pytest.approx(2.0 - 2.0 / 7.0)


def test_no_knot_is_added_where_the_path_ends_at_the_last_one() -> None:
    knots = np.array([0.9, 1.0])
    assert continued(knots, np.array([0.5, 1.5]), np.full(2, 0.1), 1.0, None) is knots
