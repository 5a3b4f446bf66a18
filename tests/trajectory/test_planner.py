"""Trajectories of whole programs: limits in every phase, tolerance, exact ends, times."""

import numpy as np
import pytest
import ruckig
from tests.trajectory.measures import PERIOD_S, deviations, limits, planned, points, sampled
from tests.trajectory.programs import KINDS, Segments, corners, line, square, surface

from openacr.trajectory import Limits, Segment, TrajectoryError, TrajectoryPlanner

pytestmark = pytest.mark.evidence("oracle", "differences of sampled setpoints; times of ruckig")

SMALL = {
    "square": lambda e: square(e, rounds=1),
    "corners": lambda e: corners(e, count=14),
    "pocket": lambda e: KINDS["pocket"](e)[:18],
    "circles": lambda e: KINDS["circles"](e)[:12],
    "surface": lambda e: surface(e, rows=1, width=40.0),
}
ALLOWED = 1.0 + 1e-6
START = (0.0, 0.0, 0.0)


def first_point(segments: Segments, kind: str) -> tuple[float, ...]:
    return segments[0].end if kind == "surface" else START


@pytest.mark.parametrize("tolerance", [0.01, 0.05])
@pytest.mark.parametrize("kind", KINDS)
def test_every_sample_of_every_phase_is_within_the_limits(kind: str, tolerance: float) -> None:
    segments = SMALL[kind](tolerance)
    start = first_point(segments, kind)
    control = points(planned(segments, start, limits()))
    for sample_s in (0.001, 0.0005):
        found = sampled(control, PERIOD_S, sample_s)
        assert found.speed <= 100.0 * ALLOWED
        assert found.acceleration <= 1000.0 * ALLOWED
        assert found.jerk <= 20_000.0 * ALLOWED
    deviation, vertex = deviations(control, segments, start)
    assert deviation <= tolerance
    assert vertex <= tolerance
    assert control[-1].tolist() == list(segments[-1].end)
    assert control[-1].tolist() == control[-2].tolist() == control[-3].tolist()


@pytest.mark.parametrize("kind", KINDS)
def test_without_jerk_speed_and_acceleration_of_every_axis_are_kept(kind: str) -> None:
    segments = SMALL[kind](0.01)
    start = first_point(segments, kind)
    control = points(planned(segments, start, limits(None)))
    found = sampled(control, PERIOD_S, 0.001)
    assert found.speed <= 100.0 * ALLOWED
    assert found.acceleration <= 1000.0 * ALLOWED
    deviation, vertex = deviations(control, segments, start)
    assert deviation <= 0.01
    assert vertex <= 0.01
    assert control[-1].tolist() == list(segments[-1].end)


@pytest.mark.parametrize("length", [0.01, 0.3, 2.0, 20.0, 150.0])
def test_a_straight_move_is_as_fast_as_the_best_rest_to_rest_profile(length: float) -> None:
    asked, best = ruckig.InputParameter(1), ruckig.Trajectory(1)
    asked.current_position, asked.target_position = [0.0], [length]
    asked.max_velocity, asked.max_acceleration, asked.max_jerk = [100.0], [1000.0], [20_000.0]
    ruckig.Ruckig(1).calculate(asked, best)
    setpoints = planned([line(1, length, 0, 0, 0.01)], START, limits())
    moving = sum(len(each.points) for each in setpoints) - 3  # rest at both ends
    assert moving * PERIOD_S == pytest.approx(best.duration, abs=PERIOD_S)


def test_setpoints_follow_each_other_and_the_path_never_goes_back() -> None:
    setpoints = planned(surface(0.01, rows=1), surface(0.01)[0].end, limits())
    assert [each.first for each in setpoints[1:]] == [each.end for each in setpoints[:-1]]
    path = np.concatenate([each.path_u for each in setpoints])
    assert (np.diff(path) >= 0.0).all()
    lines = np.concatenate([each.lines for each in setpoints])
    assert sorted(set(lines.tolist())) == lines.tolist()[:1] + sorted(set(lines.tolist()))[1:]
    assert (np.diff(lines) >= 0).all()


@pytest.mark.parametrize(
    ("kind", "tolerance"),
    [("corners", 0.01), ("corners", 0.05), ("pocket", 0.05), ("circles", 0.01), ("surface", 0.05)],
)
def test_the_plan_is_the_same_whether_moves_come_one_by_one_or_all_at_once(
    kind: str, tolerance: float
) -> None:
    segments = KINDS[kind](tolerance)
    start = first_point(segments, kind)
    planner, found = TrajectoryPlanner(start, limits(), PERIOD_S), []
    for segment in segments:
        planner.add(segment)
    planner.stop()
    while (setpoints := planner.take()) is not None:
        found.append(setpoints)
    one_by_one = points(planned(segments, start, limits()))
    assert points(found).shape == one_by_one.shape
    assert np.abs(points(found) - one_by_one).max() < 1e-6


def test_what_has_been_given_out_can_always_be_brought_to_rest() -> None:
    setpoints = planned(surface(0.01, rows=2), surface(0.01)[0].end, limits())
    done = np.empty((0, 3))
    for each in setpoints[:-1]:
        done = np.concatenate([done, each.points])
        control = np.concatenate([done[:1], done[:1], done, each.rest])
        assert control[-1].tolist() == control[-2].tolist() == control[-3].tolist()
        found = sampled(control[-900:], PERIOD_S, 0.001, phases=2)
        assert found.acceleration <= 1000.0 * ALLOWED
        assert found.jerk <= 20_000.0 * ALLOWED


def test_a_rapid_begins_and_ends_at_rest() -> None:
    segments = [line(1, 10, 0, 0, 0.05), Segment(2, (10.0, 0.0, 5.0), 1.0, 0.05, is_rapid=True),
                line(3, 10, 10, 5, 0.05)]  # fmt: skip
    control = points(planned(segments, START, limits()))
    for vertex in ((10.0, 0.0, 0.0), (10.0, 0.0, 5.0)):
        there = np.flatnonzero((control == np.array(vertex)).all(axis=1))
        assert len(there) >= 3
        assert (np.diff(there) == 1).all()


@pytest.mark.parametrize("feed", [25.0, 80.0])
def test_a_rapid_straight_on_is_a_move_of_its_own_at_its_own_speed(feed: float) -> None:
    segments = [line(1, 10, 0, 0, 0.05), Segment(2, (30.0, 0.0, 0.0), feed, 0.0, is_rapid=True),
                line(3, 40, 0, 0, 0.05)]  # fmt: skip
    control = points(planned(segments, START, limits()))
    speeds = np.diff(control[:, 0]) / PERIOD_S
    inside = (control[:-1, 0] >= 10.0) & (control[1:, 0] <= 30.0)
    assert speeds[inside].max() == pytest.approx(feed, rel=1e-9)
    for x in (10.0, 30.0):
        assert (control[:, 0] == x).sum() >= 3


@pytest.mark.parametrize("length", [30.0, 30.2, 30.5])
def test_a_corner_without_a_tolerance_keeps_the_limits_of_moves_that_come_one_by_one(
    length: float,
) -> None:
    segments = [line(1, length, 0, 0, 0.01), line(2, length, 30, 0, 0.0), line(3, 1, 2, 3, 0.0)]
    control = points(planned([*segments, line(4, 0, 30, 0, 0.01)], START, limits()))
    for sample_s in (0.001, 0.0005):
        found = sampled(control, PERIOD_S, sample_s)
        assert found.acceleration <= 1000.0 * ALLOWED
        assert found.jerk <= 20_000.0 * ALLOWED
    assert control[-1].tolist() == [0.0, 30.0, 0.0]


def test_a_stop_ends_exactly_at_its_point_and_the_path_goes_on() -> None:
    planner = TrajectoryPlanner(START, limits(), PERIOD_S)
    planner.add(line(1, 10, 0, 0, 0.05))
    planner.stop()
    first = planner.take()
    assert first is not None
    assert first.points[-3:].tolist() == [[10.0, 0.0, 0.0]] * 3
    planner.add(line(2, 10, 10, 0, 0.05))
    assert planner.take() is None
    planner.stop()
    second = planner.take()
    assert second is not None
    assert second.first == first.end
    assert second.points[-1].tolist() == [10.0, 10.0, 0.0]


def test_a_slower_feed_inside_a_smooth_chain_is_kept_without_a_stop() -> None:
    segments = [line(n, 2.0 * n, 0.02 * (n % 2), 0, 0.01, feed=80.0 if n < 20 else 30.0)
                for n in range(1, 40)]  # fmt: skip
    setpoints = planned(segments, START, limits())
    control = points(setpoints)
    lines = np.concatenate([each.lines for each in setpoints])
    speed = np.linalg.norm(np.diff(control[2:], axis=0), axis=1) / PERIOD_S
    assert speed[lines[:-1] >= 20].max() <= 30.0
    assert speed[lines[:-1] < 20].max() > 60.0
    assert speed[20:-20].min() > 20.0


def test_no_path_is_planned_for_a_wrong_limit_or_number_of_axes() -> None:
    with pytest.raises(TrajectoryError, match=r"limit of jerk of axis 1 is -1\.0"):
        Limits((1.0, 1.0), (1.0, 1.0), (1.0, -1.0))
    with pytest.raises(TrajectoryError, match="2 limits of jerk for 1 axes"):
        Limits((1.0,), (1.0,), (1.0, 1.0))
    with pytest.raises(TrajectoryError, match="a start with 2 axes and limits of 3"):
        TrajectoryPlanner((0.0, 0.0), limits())
    planner = TrajectoryPlanner(START, limits())
    with pytest.raises(TrajectoryError, match="line 7: an end with 2 axes, not 3"):
        planner.add(Segment(7, (1.0, 1.0), 10.0, 0.01))


@pytest.mark.parametrize(
    ("kind", "tolerance", "time_s"),
    [("square", 0.01, 3.903), ("corners", 0.01, 2.727), ("corners", 0.05, 2.247),
     ("pocket", 0.01, 4.662), ("pocket", 0.05, 4.29), ("circles", 0.01, 2.016),
     ("surface", 0.01, 0.63), ("surface", 0.05, 0.63)],
)  # fmt: skip
def test_programs_take_their_time_to_half_a_percent(
    kind: str, tolerance: float, time_s: float
) -> None:
    segments = SMALL[kind](tolerance)
    control = points(planned(segments, first_point(segments, kind), limits()))
    assert len(control) * PERIOD_S == pytest.approx(time_s, rel=0.005)
