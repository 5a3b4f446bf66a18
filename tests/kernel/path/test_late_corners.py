"""Corners under jerk whose moves come late: one at a time, or into a short buffer."""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tests.kernel.path.test_corners import (
    EVENTS,
    IN_MOTION,
    Event,
    Point,
    accelerations,
    disturbed,
    follow,
    jerks,
    off_path,
    rig,
)
from tests.kernel.rig import Reals, Rig, T
from tests.search import search

from openacr.map.words import mf4
from openacr.motion.path import moves
from openacr.motion.path.move_request import Circle, Direction

ACC = 1000.0
JRK = 20_000.0


Ramps = tuple[float, float]


def late_rig(tolerance: float, depth: int, ramps: Ramps = (1.0, 1.0), *, pure: bool = False) -> Rig:
    """A card that looks ahead over `depth` moves, with DEC and STP as shares of ACC."""
    made = rig(tolerance, jrk=JRK, pure=pure)
    made.master(dec=ramps[0] * ACC, stp=ramps[1] * ACC)
    made.depth(depth)
    return made


def keeps_limits(places: Reals, points: Sequence[Point], tolerance: float) -> None:
    assert tuple(places[-1]) == pytest.approx(points[-1], abs=1e-9)
    assert off_path(places, points) <= tolerance * (1 + 1e-6) + 1e-9
    assert accelerations(places).max() <= ACC * (1 + 1e-4)
    assert jerks(places).max() <= JRK * (1 + 1e-3)


def chain(legs: Sequence[tuple[float, float]]) -> list[Point]:
    """Legs of a length, each turned by an angle in degrees against the one before it."""
    x, y, heading = 0.0, 0.0, 0.0
    points: list[Point] = []
    for length, turn_deg in legs:
        heading += math.radians(turn_deg)
        x, y = x + length * math.cos(heading), y + length * math.sin(heading)
        points.append((x, y))
    return points


LENGTHS = st.floats(math.log10(0.05), math.log10(20.0)).map(lambda e: 10.0**e)
TURNS = st.one_of(
    st.just(0.0),
    st.floats(-2.0, 1.5).flatmap(lambda e: st.sampled_from([10.0**e, -(10.0**e)])),
    st.floats(-180.0, 180.0),
)
CHAINS = st.lists(st.tuples(LENGTHS, TURNS), min_size=2, max_size=12).map(chain)
TOLERANCES = st.floats(-3.0, 0.0).map(lambda e: 10.0**e)
DEPTHS = st.one_of(st.integers(1, 3), st.integers(4, 12))
EVERY = st.one_of(st.just(0), st.floats(0.0, 2.5).map(lambda e: int(10.0**e)))
RAMPS = st.sampled_from([(1.0, 1.0), (1.0, 0.5), (0.6, 1.0)])

# The corner to the third leg takes a part of the second, to which the path then comes too fast.
TOO_FAST = [(0.64, 0.0), (0.32, 17.0), (0.9, 17.0)]
# An accelerating path comes over a straight joint to a line whose corner allows little.
STRAIGHT_ON = [(0.09, 0.0), (0.4, 0.0), (0.19, 101.0), (17.0, 106.0), (4.0, 113.0)]


@search(300)
@given(CHAINS, TOLERANCES, DEPTHS, EVERY, RAMPS)
@example(chain(TOO_FAST), 0.8, 1, 0, (1.0, 0.5))
@example(chain(STRAIGHT_ON), 0.5, 8, 0, (1.0, 1.0))
def test_under_jerk_any_path_keeps_all_limits_however_late_its_moves_come(
    points: list[Point], tolerance: float, depth: int, every: int, ramps: Ramps
) -> None:
    places = follow(late_rig(tolerance, depth, ramps), points, every=every)
    keeps_limits(places, points, tolerance)


@search(150)
@given(CHAINS, TOLERANCES, DEPTHS, EVERY, RAMPS, EVENTS)
def test_under_jerk_late_moves_keep_all_limits_whatever_happens(
    points: list[Point],
    tolerance: float,
    depth: int,
    every: int,
    ramps: Ramps,
    events: list[Event],
) -> None:
    made = late_rig(tolerance, depth, ramps)
    places = follow(made, points, disturbed(made, events), every=every)
    keeps_limits(places, points, tolerance)


def second_after(ticks: int) -> Callable[[Rig], Reals]:
    """A line of 10 units, and `ticks` later one that turns by 30 degrees."""

    def run(made: Rig) -> Reals:
        return follow(made, chain([(10.0, 0.0), (10.0, 30.0)]), every=ticks)

    return run


@pytest.mark.parametrize(("ticks", "rounded"), [(1, True), (100, True), (200, False), (420, False)])
@pytest.mark.parametrize("ramps", [(1.0, 1.0), (0.6, 1.0)])
def test_a_corner_that_comes_too_late_is_a_stop_at_its_very_place(
    ramps: Ramps, ticks: int, rounded: bool
) -> None:
    places = second_after(ticks)(late_rig(0.1, 1, ramps))
    nearest = np.min(np.linalg.norm(places - (10.0, 0.0), axis=1))
    if rounded:
        assert nearest == pytest.approx(0.1, rel=0.02)
    else:
        assert nearest < 1e-6
    keeps_limits(places, chain([(10.0, 0.0), (10.0, 30.0)]), 0.1)


def test_a_line_in_parts_is_as_quick_as_the_line() -> None:
    whole = follow(late_rig(0.1, 12), chain([(8.0, 0.0), (8.0, 60.0), (8.0, 60.0)]))
    legs = [(2.0, 0.0), (5.0, 0.0), (1.0, 0.0), (1.0, 60.0), (7.0, 0.0), (4.0, 60.0), (4.0, 0.0)]
    parts = follow(late_rig(0.1, 12), chain(legs))
    # the reach of a corner is a quarter of the shorter part: 0.25 units of 1
    assert len(parts) == pytest.approx(len(whole), abs=30)
    rests = np.linalg.norm(np.diff(parts, axis=0), axis=1) / T < 1.0
    assert not rests[30:-30].any()
    keeps_limits(parts, chain(legs), 0.1)


@pytest.mark.parametrize("tick", range(170, 230, 6))
def test_a_hold_that_is_released_as_it_brakes_in_front_of_a_corner_keeps_all_limits(
    tick: int,
) -> None:
    points = chain([(10.0, 0.0), (10.0, 30.0)])
    made = late_rig(0.1, 4)
    places = follow(made, points, disturbed(made, [(tick, "hold", 0.0), (60, "go", 0.0)]))
    keeps_limits(places, points, 0.1)


@search(15)
@given(CHAINS, TOLERANCES, st.integers(1, 6))
def test_both_builds_agree_about_late_corners(
    points: list[Point], tolerance: float, depth: int
) -> None:
    digests = []
    for pure in (False, True):
        made = late_rig(tolerance, depth, pure=pure)
        for point in points[:depth]:
            made.move(*point)
        made.ticks(150)
        if moves.has_room(made.card, 0):
            made.move(21.0, 34.0)
        made.ticks(150)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]


@pytest.mark.parametrize("turn_deg", [60.0, 90.0, 175.0])
@pytest.mark.parametrize("depth", [1, 2, 3, 10])
def test_without_jerk_a_late_sharp_corner_keeps_the_acceleration(
    depth: int, turn_deg: float
) -> None:
    """The corner takes a part of the line on which the path was to stop."""
    made = rig(1.0)
    made.depth(depth)
    places = follow(made, chain([(1.0, 0.0)] * 6 + [(1.0, turn_deg)]))
    assert accelerations(places).max() <= ACC * (1 + 1e-4)


def without_jerk(tolerance: float, depth: int, ramps: Ramps) -> Rig:
    made = late_rig(tolerance, depth, ramps)
    made.master(jrk=0.0)
    return made


def keeps_ramps(places: Reals, points: Sequence[Point], tolerance: float) -> None:
    assert tuple(places[-1]) == pytest.approx(points[-1], abs=1e-9)
    assert off_path(places, points) <= tolerance * (1 + 1e-6) + 1e-9
    assert accelerations(places).max() <= ACC * (1 + 1e-4)


# Stops with STP, and a corner comes that is refused: it would have to brake with DEC, less.
REFUSED = [(1.278, 0.0), (0.247, 0.0), (0.075, 10.01), (2.766, 0.27), (9.481, 0.02)]


@search(200)
@given(CHAINS, TOLERANCES, DEPTHS, EVERY, RAMPS, EVENTS)
@example(chain(REFUSED), 0.12, 2, 50, (0.6, 1.0), [])
def test_without_jerk_late_moves_keep_the_acceleration_whatever_happens(
    points: list[Point],
    tolerance: float,
    depth: int,
    every: int,
    ramps: Ramps,
    events: list[Event],
) -> None:
    made = without_jerk(tolerance, depth, ramps)
    places = follow(made, points, disturbed(made, events), every=every)
    keeps_ramps(places, points, tolerance)


@pytest.mark.parametrize("tick", range(150, 215, 5))
def test_a_hold_softer_than_the_stop_ahead_comes_to_rest_in_it(tick: int) -> None:
    """With DEC, less than STP, the path would pass the corner that is a stop."""
    points = chain([(3.0, 0.0), (3.0, 120.0), (3.0, 0.0)])
    made = without_jerk(1e-3, 1, (0.6, 1.0))
    places = follow(made, points, disturbed(made, [(tick, "hold", 0.0)]), every=150)
    keeps_ramps(places, points, 1e-3)


# Refused corners: with a final velocity of 20 units/s the path came to them too fast to stop.
TO_A_STOP = [(0.356, 5.0), (0.056, 37.0), (0.562, 45.0), (0.305, 0.0), (0.092, -141.0), (1.2, 98.0)]


@search(150)
@given(CHAINS, TOLERANCES, DEPTHS, EVERY, RAMPS, EVENTS, st.sampled_from([0.0, JRK]))
@example(chain(TO_A_STOP), 0.14, 1, 50, (1.0, 1.0), [], 0.0)
@example(chain(TO_A_STOP), 0.14, 1, 50, (1.0, 1.0), [], JRK)
def test_a_final_velocity_takes_no_room_from_corners_with_a_tolerance(
    points: list[Point],
    tolerance: float,
    depth: int,
    every: int,
    ramps: Ramps,
    events: list[Event],
    jrk: float,
) -> None:
    made = late_rig(tolerance, depth, ramps).master(jrk=jrk, fvel=20.0)
    places = follow(made, points, disturbed(made, events), every=every)
    keeps_ramps(places, points, tolerance)
    if jrk:
        assert jerks(places).max() <= jrk * (1 + 1e-3)


@pytest.mark.parametrize(
    ("tolerance", "looks", "end_ups"), [(0.0, True, 20.0), (0.1, True, 0.0), (0.1, False, 20.0)]
)
def test_without_a_tolerance_or_look_a_path_ends_with_its_final_velocity(
    tolerance: float, looks: bool, end_ups: float
) -> None:
    made = rig(tolerance).master(fvel=20.0)
    if not looks:
        made.I[mf4.word[0]] &= ~mf4.LOOK_AHEAD_MODE
    places = follow(made, [(10.0, 0.0)])
    last = np.linalg.norm(np.diff(places[-4:], axis=0), axis=1) / T
    assert last.max() == pytest.approx(end_ups, abs=2.0)


def test_an_arc_with_a_tolerance_ends_with_its_final_velocity() -> None:
    made = rig(0.1).master(fvel=20.0)
    speeds: list[float] = []
    arc = Circle((0, 1), (5.0, 5.0), (0.0, 5.0), Direction.COUNTER_CLOCKWISE)
    moves.issue(made.card, 0, [arc])
    while made.bit(IN_MOTION):
        speeds.append(made.path_velocity)
        made.ticks()
    assert speeds[-1] == pytest.approx(20.0, abs=1.0)
