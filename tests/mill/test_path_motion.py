"""Speed, acceleration and jerk along paths, against closed forms and the limits they keep."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.mill.planned import ACCEL, FEED, JERK, SQUARE, path, planned_shop
from tests.mill.shop import Shop, at, end, line, rapid, src

from openacr.cnc import canonical as c
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.estimate.trajectory import Trajectory
from openacr.mill.plan.pictures import path_motion
from openacr.mill.plan.pictures.path_motion import Motion, PathMotion
from openacr.mill.plan.pictures.quantities import Quantity

Reals = NDArray[np.float64]
SPEED, ACCELERATION, OF_JERK = Quantity.SPEED, Quantity.ACCELERATION, Quantity.JERK


def motion(
    entries: Sequence[c.Entry], quantity: Quantity, shop: Shop | None = None
) -> tuple[Motion, float]:
    """What a program is coloured by, and its predicted time."""
    settings = Settings((shop or Shop()).store)
    reader = PathMotion(settings, (0, 1, 2), quantity)
    predictor = Predictor(settings, at(), reader=reader)
    for entry in entries:
        predictor.add(entry)
    predictor.close()
    return reader.finished(), predictor.found.time_s


def circle(radius: float, feed: float, rise: float = 0.0, grown: float = 0.0) -> list[c.Entry]:
    """A full turn from (0, 0) counter-clockwise around (-radius, 0)."""
    finish = at(grown, 0.0, rise)
    pace = c.Pace(feed)
    centre, turn = (-radius, 0.0), 2 * math.pi
    return [c.Arc(src(1), finish, c.Plane.XY, centre, turn, radius, radius + grown, pace), end()]


def test_a_line_has_the_speed_and_acceleration_of_its_trapezoid() -> None:
    # 10 units/s, 100 units/s2, 5 units: 0.1 s up, 0.4 s along, 0.1 s down
    found, _ = motion([line(1, at(3, 4)), end()], SPEED)
    places = np.linalg.norm(found.points, axis=1)
    t = (np.arange(16) + 0.5) / 16 * 0.1
    ramp = 60 * 100 * t
    assert found.values.tolist() == pytest.approx([*ramp, 600.0, *ramp[::-1]])
    assert places[:17] == pytest.approx(50 * (np.arange(17) / 16 * 0.1) ** 2)
    assert places[17] == pytest.approx(4.5)
    assert found.points[-1].tolist() == pytest.approx([3, 4, 0])
    found, _ = motion([line(1, at(3, 4)), end()], ACCELERATION)
    assert found.values.tolist() == pytest.approx([100.0] * 16 + [0.0] + [100.0] * 16)
    assert found.moves.all()


@pytest.mark.parametrize("rise", [0.0, 3.0])
def test_a_circle_has_v_squared_by_r_across_and_its_ramp_along(rise: float) -> None:
    radius, feed_ups = 2.0, 5.0
    found, _ = motion(circle(radius, 60 * feed_ups, rise), ACCELERATION)
    speeds, _ = motion(circle(radius, 60 * feed_ups, rise), SPEED)
    flat = 2 * math.pi * radius / math.hypot(2 * math.pi * radius, rise)  # of the speed
    along = np.isclose(speeds.values, 60 * feed_ups)
    assert along.sum() > 100
    assert found.values[along] == pytest.approx((flat * feed_ups) ** 2 / radius)
    across = (flat * speeds.values / 60) ** 2 / radius
    ramps = np.sqrt(found.values[~along] ** 2 - across[~along] ** 2)
    assert np.ptp(ramps) < 1e-9 * ramps[0]
    assert 50.0 < ramps[0] < 100.0
    assert np.hypot(found.points[:, 0] + radius, found.points[:, 1]) == pytest.approx(radius)


def accelerations(entries: Sequence[c.Entry], period_s: float = 1e-4) -> Reals:
    """Accelerations of the plan from differences of its samples."""
    parts: list[Reals] = []
    settings = Settings(Shop().store)
    trajectory = Trajectory(settings, period_s, parts.append)
    predictor = Predictor(settings, at(), reader=trajectory)
    for entry in entries:
        predictor.add(entry)
    predictor.close()
    trajectory.close()
    places = np.concatenate(parts)[:-1, 1:4]
    return np.asarray(np.linalg.norm(np.diff(places, n=2, axis=0), axis=1) / period_s**2)


def corner() -> list[c.Entry]:
    pace = c.Pace(600, tolerance_u=0.01)
    return [c.Line(src(1), at(1), pace), c.Line(src(2), at(1, 1), pace), end()]


@pytest.mark.parametrize(
    "entries", [circle(1.0, 300, grown=0.8), circle(1.0, 300, -0.5, -0.4), corner()]
)
def test_spirals_and_rounded_corners_have_the_acceleration_of_their_samples(
    entries: list[c.Entry],
) -> None:
    found, time_s = motion(entries, ACCELERATION)
    speeds, _ = motion(entries, SPEED)
    steps = np.linalg.norm(np.diff(found.points, axis=0), axis=1)
    moving = found.moves
    assert steps[~moving] == pytest.approx(0.0, abs=1e-12)  # both moves meet on the corner
    ends = np.cumsum(np.where(moving, steps / np.where(moving, speeds.values / 60, 1.0), 0.0))
    middles = (ends - 0.5 * np.where(moving, steps / np.nan_to_num(speeds.values / 60, nan=1), 0))[
        moving
    ]
    assert ends[-1] == pytest.approx(time_s, rel=1e-3)
    sampled = accelerations(entries)
    at_sample = np.clip(np.round(middles / 1e-4).astype(int) - 1, 0, len(sampled) - 1)
    off = np.abs(sampled[at_sample] - found.values[moving])
    assert np.median(off) < 0.05
    assert (off < 1.0).mean() > 0.85  # the others are next to the end of a phase


def test_a_planned_path_has_a_value_for_every_period_of_its_control_points() -> None:
    entries: list[c.Entry] = [*path([(60.0, 0.0)]), end()]
    for quantity, highest in ((SPEED, FEED), (ACCELERATION, 0.99 * ACCEL), (OF_JERK, 0.96 * JERK)):
        found, time_s = motion(entries, quantity, planned_shop())
        assert len(found.values) * PERIOD_S == pytest.approx(time_s, abs=4 * PERIOD_S)
        assert found.highest == pytest.approx(highest, rel=5e-3)
        assert found.highest <= highest * (1 + 1e-9)
        assert found.moves.all() and found.known.all()
        assert found.points[0].tolist() == [0, 0, 0]
        assert found.points[-1].tolist() == [60, 0, 0]
    middle = len(found.values) // 2
    assert found.values[middle] == pytest.approx(0.0, abs=1e-3 * JERK)


def test_a_planned_speed_is_that_of_the_middle_of_its_period() -> None:
    found, _ = motion([*path([(60.0, 0.0)]), end()], SPEED, planned_shop())
    steps = np.linalg.norm(np.diff(found.points, axis=0), axis=1)
    most = JERK * PERIOD_S**2 / 24  # what the jerk makes of a mean
    assert found.values / 60 == pytest.approx(steps / PERIOD_S, abs=1.01 * most)


def test_a_planned_circle_has_v_squared_by_r() -> None:
    feed_ups, radius = 40.0, 20.0
    pace = c.Pace(60 * feed_ups, tolerance_u=0.01)
    turn = c.Arc(
        src(1), at(), c.Plane.XY, (-radius, 0.0), 2 * math.pi, radius, radius, pace
    )  # fmt: skip
    for quantity, value in (
        (SPEED, 60 * feed_ups),
        (ACCELERATION, feed_ups**2 / radius),
        (OF_JERK, feed_ups**3 / radius**2),
    ):
        found, _ = motion([turn, end()], quantity, planned_shop())
        middle = found.values[len(found.values) // 3 : -len(found.values) // 3]
        assert middle == pytest.approx(value, rel=5e-3)


def test_no_planned_value_is_above_its_limits() -> None:
    entries: list[c.Entry] = [*path(SQUARE), *path([(5.0, 1.0), (10.0, 0.0), (15.0, 3.0)]), end()]
    axes = math.sqrt(2.0)  # two axes at their limits
    for quantity, most in ((SPEED, FEED), (ACCELERATION, axes * ACCEL), (OF_JERK, axes * JERK)):
        found, _ = motion(entries, quantity, planned_shop())
        assert 0.5 * most < found.highest <= most * (1 + 1e-12)


def test_the_jerk_of_moves_of_their_own_is_unknown_beside_that_of_planned_ones() -> None:
    entries: list[c.Entry] = [
        *path([(20.0, 0.0)]),
        line(2, at(20, 10), feed=FEED),
        *path([(0.0, 10.0)]),
        end(),
    ]
    found, _ = motion(entries, OF_JERK, planned_shop())
    alone = found.unknown
    begins, ends = found.points[:-1][alone], found.points[1:][alone]
    assert begins[0].tolist() == [20, 0, 0] and ends[-1].tolist() == [20, 10, 0]
    assert (~found.moves).sum() == 2  # before and after it
    assert found.known.any() and not (found.known & alone).any()
    assert motion([line(1, at(1)), end()], OF_JERK)[0].highest == 0.0


def test_rapids_between_planned_moves_count_once() -> None:
    entries: list[c.Entry] = [
        *path([(20.0, 0.0)]),
        rapid(2, at(20, 10)),
        *path([(0.0, 10.0)]),
        end(),
    ]
    found, _ = motion(entries, SPEED, planned_shop())
    length = np.linalg.norm(np.diff(found.points, axis=0), axis=1).sum()
    assert length == pytest.approx(50.0, abs=0.05)


def test_a_full_picture_leaves_out_the_moves_that_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_motion, "MOST_POINTS", 18)
    found, _ = motion([line(1, at(5)), line(2, at(5, 5)), end()], SPEED)
    assert found.points[-1].tolist() == pytest.approx([5, 0, 0])
    assert found.is_cut
    monkeypatch.setattr(path_motion, "MOST_POINTS", 19)
    found, _ = motion([line(1, at(5)), line(2, at(5, 5)), end()], SPEED)
    assert found.points[-1].tolist() == pytest.approx([5, 5, 0])


def test_a_program_without_moves_has_no_values() -> None:
    found, _ = motion([end()], SPEED)
    assert found.values.tolist() == [] and not found.is_cut
