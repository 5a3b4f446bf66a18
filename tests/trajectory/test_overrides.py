"""Feeds that are raised while a path is planned: from where, how fast, and within which limits."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.search import search, sparse
from tests.trajectory.measures import PERIOD_S, deviations, limits, planned, points
from tests.trajectory.programs import Segments, corners, line, surface
from tests.trajectory.random_programs import program

from openacr.trajectory import Segment, Setpoints, TrajectoryError, TrajectoryPlanner
from openacr.trajectory.path.setpoints import Reals
from openacr.trajectory.stream.smooth_course import SmoothCourse

ALLOWED = 1.0 + 1e-6
HALF = 0.5
FACTORS = (1.0, 1.2, 1.5, 2.0)
FEW = 8  # points of one take
AHEAD = 300  # points planned before they are taken
START = (0.0, 0.0, 0.0)
SLOT = [line(1, 200, 0, 0, 0.01), *(line(2 + k, 200 + x, x * x / 20, 0, 0.01) for k, x in
        enumerate(np.arange(0.5, 8.0, 0.5)))]  # fmt: skip

WAVE = [line(k, 0.4 * k, 2 * math.sin(k / 10), 0, 0.01) for k in range(1, 250)]
WHOLE: dict[str, Segments] = {
    "leg": [line(1, 300, 0, 0, 0.01)], "slot": SLOT, "corners": corners(0.01, count=14),
    "surface": surface(0.01, rows=1, width=40.0), "wave": WAVE,
}  # fmt: skip


def start_of(name: str) -> tuple[float, ...]:
    """Where a program of WHOLE begins."""
    return WHOLE[name][0].end if name == "surface" else START


def slower(segments: Segments) -> Segments:
    """The same at half the feeds, which may be doubled."""
    return [replace(each, feed_ups=HALF * each.feed_ups,
                    fastest=1.0 if each.is_rapid else 2.0) for each in segments]  # fmt: skip


def run(
    segments: Segments,
    start: tuple[float, ...],
    turns: dict[int, float],
    known: int = 10_000,
    ahead: int = 0,
) -> list[Setpoints]:
    """The setpoints of segments that are added `known` at a time, `ahead` planned before.

    `turns`: the factors of the feeds, by the count of control points after which they are set.
    """
    planner = TrajectoryPlanner(start, limits(axes=len(start)), PERIOD_S)
    left, found, count, waiting = list(segments), [], 0, sorted(turns.items())
    while True:
        while waiting and waiting[0][0] <= count:
            planner.override(waiting.pop(0)[1])
        while planner.prepare(ahead):
            pass
        setpoints = planner.take(FEW)
        if setpoints is not None:
            found.append(setpoints)
            count += len(setpoints.points)
        elif left:
            for segment in left[:known]:
                planner.add(segment)
            del left[:known]
            if not left:
                planner.stop()
        else:
            return found


def require_all(found: list[Setpoints], segments: Segments, start: tuple[float, ...]) -> Reals:
    """No sample above a limit or its feed, no point off the path, the end exact; the speeds."""
    control = points(found)
    v, a, j = (np.diff(control, n, axis=0) / PERIOD_S**n for n in (1, 2, 3))
    assert np.abs(v).max() <= 100.0 * ALLOWED
    assert np.abs(a).max() <= 1000.0 * ALLOWED
    assert np.abs(j).max() <= 20_000.0 * ALLOWED
    assert max(deviations(control, segments, start)) <= segments[0].tolerance_u
    assert control[-1].tolist() == list(segments[-1].end)
    assert [each.first for each in found[1:]] == [each.end for each in found[:-1]]
    speed: Reals = np.linalg.norm(v, axis=1)[2:]
    if not any(segment.is_rapid for segment in segments):
        factors = np.concatenate([each.factors for each in found])
        feed = max(segment.feed_ups for segment in segments)
        assert (speed <= feed * np.maximum(factors[1:], factors[:-1]) * ALLOWED).all()
    return speed


@search(40, derandomize=True)
@given(
    st.integers(0, 5000),
    st.lists(st.tuples(st.integers(0, 80), st.sampled_from(FACTORS)), min_size=3, max_size=9),
    st.sampled_from([1, 4, 10_000]),
    st.sampled_from([0, 40, AHEAD]),
)
def test_overrides_of_any_course_keep_limits_tolerance_and_end(
    seed: int, turns: list[tuple[int, float]], known: int, ahead: int
) -> None:
    whole, axes, _ = program(seed)
    segments, at, wanted = slower(whole), 0, {}
    for after, factor in turns:
        at += after
        wanted[at] = factor
    start = (0.0,) * axes
    require_all(run(segments, start, wanted, known, ahead), segments, start)


@pytest.mark.parametrize("name", ["leg", "slot", "corners", "surface", "wave"])
def test_what_is_planned_ahead_makes_no_difference_until_it_is_planned_again(name: str) -> None:
    segments, at, start = slower(WHOLE[name]), 100, start_of(name)
    before = points(run(segments, start, {}))
    ahead = points(run(segments, start, {}, ahead=AHEAD))
    assert np.abs(ahead - before).max() <= 0.2 * segments[0].tolerance_u  # as for other takes
    found = [run(segments, start, {at: 2.0}, ahead=count) for count in (0, AHEAD)]
    for each in found:
        require_all(each, segments, start)
    lazy, early = (len(points(each)) for each in found)
    assert early <= lazy + 6  # the windows are others


def test_a_window_before_the_last_one_is_planned_again() -> None:
    segments, at = slower(WHOLE["wave"]), 104
    speed = require_all(run(segments, START, {at: 2.0}, ahead=AHEAD), segments, START)
    assert speed[:at].max() <= HALF * 100.0 * ALLOWED
    assert speed[at : at + 24].max() > 1.02 * HALF * 100.0


# a course begins amid the end of another one
@pytest.mark.parametrize(("seed", "first"), sparse(list(product([52, 157, 298], range(3))), 4))
def test_a_course_that_overlaps_another_keeps_the_limits(seed: int, first: int) -> None:
    whole, axes, _ = program(seed)
    turns = {at: FACTORS[1 + (k % 3)] for k, at in enumerate(range(11 + first, 700, 19))}
    require_all(run(slower(whole), (0.0,) * axes, turns), slower(whole), (0.0,) * axes)


@pytest.mark.parametrize("name", ["leg", "slot", "corners", "surface"])
def test_no_point_that_was_taken_changes_and_the_next_ones_are_faster(name: str) -> None:
    segments, at, start = slower(WHOLE[name]), 100, start_of(name)
    before, found = run(segments, start, {}), run(segments, start, {at: 2.0})
    speed = require_all(found, segments, start)
    taken = -(-at // FEW) * FEW + 2
    assert (points(found)[:taken] == points(before)[:taken]).all()
    most = {"leg": 0.7, "slot": 0.75, "corners": 0.95, "surface": 0.8}[name]
    assert len(points(found)) < len(points(before)) * most
    if name in ("leg", "slot"):
        assert speed[taken - 2 : taken + 10].max() > 1.02 * HALF * 100.0
        assert speed.max() == pytest.approx(100.0, rel=1e-3)


def test_a_leg_is_raised_again_and_again() -> None:
    segments = slower([line(1, 300, 0, 0, 0.01)])
    speed = require_all(run(segments, START, {100: 1.2, 300: 1.5, 500: 2.0}), segments, START)
    for at, feed in ((250, 60.0), (450, 75.0), (650, 100.0)):
        assert speed[at] == pytest.approx(feed, rel=1e-9)


def test_a_path_that_is_raised_before_it_begins_is_the_faster_path() -> None:
    segments = slower(corners(0.01, count=14))
    fast = [replace(each, feed_ups=2.0 * each.feed_ups) for each in segments]
    planner, found = TrajectoryPlanner(START, limits(), PERIOD_S), []
    for segment in segments:
        planner.add(segment)
    planner.stop()
    for factor in (1.5, 1.0, 2.0):
        planner.override(factor)
        assert planner._plan_more()
    planner.override(1.5)
    planner.override(2.0)
    while (setpoints := planner.take()) is not None:
        found.append(setpoints)
    apart = points(found) - points(planned(fast, START, limits()))
    assert np.abs(apart).max() < 1e-9


def test_no_move_is_raised_further_than_it_may_be() -> None:
    segments = [Segment(1, (60.0, 0.0, 0.0), 50.0, 0.01, fastest=1.4),
                Segment(2, (120.0, 0.0, 0.0), 50.0, 0.01, is_rapid=True)]  # fmt: skip
    found = run(segments, START, {0: 2.0})
    control = points(found)
    speed = np.diff(control[:, 0]) / PERIOD_S
    assert speed[control[1:, 0] < 60.0].max() == pytest.approx(70.0, rel=1e-9)
    assert speed[control[:-1, 0] > 60.0].max() == pytest.approx(50.0, rel=1e-9)


def test_a_course_that_finds_no_faster_law_is_what_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(course: SmoothCourse) -> None:
        raise TrajectoryError("no speed keeps the limits")

    segments = slower(SLOT)
    planner = TrajectoryPlanner(START, limits(), PERIOD_S)
    for segment in segments:
        planner.add(segment)
    planner.stop()
    found = [planner.take(FEW)]
    planner.override(2.0)
    monkeypatch.setattr(SmoothCourse, "_plan", fails)
    found.append(planner.take(FEW))
    monkeypatch.undo()
    while (setpoints := planner.take(FEW)) is not None:
        found.append(setpoints)
    require_all([each for each in found if each is not None], segments, START)


def test_a_leg_that_is_raised_by_much_keeps_its_acceleration() -> None:
    segments = [Segment(1, (300.0, 0.0, 0.0), 20.0, 0.01, fastest=5.0)]
    speed = require_all(run(segments, START, {200: 5.0}), segments, START)
    assert speed.max() == pytest.approx(100.0, rel=1e-9)
    assert np.diff(speed).max() / PERIOD_S == pytest.approx(1000.0, rel=1e-3)
