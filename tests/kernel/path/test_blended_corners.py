"""Chains of short moves under jerk: their corners are blended, within all limits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.kernel.path.test_corners import (
    EVENTS,
    Event,
    Point,
    accelerations,
    disturbed,
    follow,
    jerks,
    off_path,
    rig,
    wave,
)
from tests.kernel.path.test_late_corners import (
    DEPTHS,
    EVERY,
    JRK,
    RAMPS,
    TOLERANCES,
    Ramps,
    chain,
    keeps_limits,
    late_rig,
)
from tests.kernel.rig import Reals, Rig, T, examples

from openacr.map import numbers as at
from openacr.map.rows import masters
from openacr.map.rows import moves as records
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target

CIRCLE = chain([(0.4, 3.0)] * 60)


@st.composite
def chords(draw: st.DrawFn) -> list[Point]:
    """Curves of short legs that bend more and less, now and then with a long or a sharp one."""
    leg = 10.0 ** draw(st.floats(-1.3, 0.5))
    spread = draw(st.sampled_from([0.0, 0.03, 0.3]))
    bend = 10.0 ** draw(st.floats(-1.0, 1.2))
    legs = []
    for _ in range(draw(st.integers(4, 20))):
        bend *= draw(st.sampled_from([1.0, 1.0, 1.0, 1.0, 0.5, 2.0, -1.0]))
        turn = draw(st.sampled_from([bend, 0.8 * bend, 1.25 * bend, bend, bend, 0.0, 90.0]))
        length = leg * 10.0 ** (spread * draw(st.floats(-1.0, 1.0)))
        legs.append((length, max(min(turn, 170.0), -170.0)))
    return chain(legs)


def slowest(places: Reals, share: float = 0.25) -> float:
    """The lowest speed on the path without its beginning and end."""
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / T
    edge = int(len(speeds) * share)
    return float(speeds[edge:-edge].min())


def test_equal_chords_of_a_circle_are_passed_at_one_speed_far_above_that_of_their_corners() -> None:
    places = follow(late_rig(0.01, 14), CIRCLE)
    turn = 2.0 * math.sin(math.radians(1.5))
    alone = 0.98 * (JRK * 0.1**2 / turn) ** (1 / 3)
    assert alone == pytest.approx(15.3, abs=0.1)
    speed = 0.8 ** math.ceil(math.log((0.46 * JRK * 0.4**2 / turn) ** (1 / 3)) / math.log(0.8))
    assert speed == pytest.approx(28.42, abs=0.01)
    assert slowest(places) == pytest.approx(speed, rel=1e-3)
    keeps_limits(places, CIRCLE, 0.01)


def test_the_path_stays_off_its_corners_by_a_sixth_of_a_chord_times_their_turn() -> None:
    places = follow(late_rig(0.01, 14), CIRCLE)
    off = 0.4 * 2.0 * math.sin(math.radians(1.5)) / 6.0
    assert off_path(places, CIRCLE) == pytest.approx(off, rel=0.01)


@pytest.mark.parametrize(
    ("points", "depth", "before", "seconds"),
    [
        (wave(0.2), 10, 5.128, 2.608),
        (wave(0.3), 10, 3.972, 2.10),
        (wave(0.4), 10, 3.368, 2.11),
        (wave(0.5), 10, 3.026, 1.83),
        (wave(1.0), 10, 2.300, 1.75),
    ],
)
def test_waves_of_short_chords_take_less_time_than_with_corners_of_their_own(
    points: list[Point], depth: int, before: float, seconds: float
) -> None:
    places = follow(late_rig(0.01, depth), points)
    assert len(places) * T == pytest.approx(seconds, rel=0.02)
    assert len(places) * T < 0.8 * before
    keeps_limits(places, points, 0.01)


@settings(max_examples=examples(150))
@given(chords(), TOLERANCES, DEPTHS, EVERY, RAMPS, EVENTS)
def test_any_chain_of_chords_keeps_all_limits_whatever_happens(
    points: list[Point],
    tolerance: float,
    depth: int,
    every: int,
    ramps: Ramps,
    events: list[Event],
) -> None:
    made = late_rig(tolerance, depth, ramps)
    places = follow(made, points, disturbed(made, events) if events else None, every=every)
    keeps_limits(places, points, tolerance)


@pytest.mark.parametrize("tick", range(40, 500, 23))
@pytest.mark.parametrize("what", ["hold", "fov"])
def test_a_hold_and_an_override_keep_all_limits_at_any_place_of_a_chain(
    tick: int, what: str
) -> None:
    made = late_rig(0.01, 14)
    events: list[Event] = [(tick, what, 0.3), (400, "go", 0.0), (1, "fov", 2.0)]
    places = follow(made, CIRCLE, disturbed(made, events))
    if what == "hold":
        rests = np.all(np.diff(places, axis=0) == 0.0, axis=1)
        assert np.count_nonzero(rests) > 50
    keeps_limits(places, CIRCLE, 0.01)


@pytest.mark.parametrize("tick", range(40, 700, 37))
def test_a_chain_that_is_turned_back_comes_to_rest_within_all_limits(tick: int) -> None:
    made = late_rig(0.01, 14)

    def meanwhile(now: int) -> None:
        if now == tick:
            targets = [Target(0, -3.0), Target(1, -5.0)]
            moves.issue(made.card, 0, targets, replace=True)

    places = follow(made, CIRCLE[:40], meanwhile)
    assert accelerations(places).max() <= 1000 * (1 + 1e-4)
    assert jerks(places).max() <= JRK * (1 + 1e-3)


def test_windings_to_either_side_add_up_the_jerk_of_their_windows() -> None:
    points = chain([(0.4, 4.0 * (-1) ** k) for k in range(60)])
    places = follow(late_rig(0.01, 14), points)
    keeps_limits(places, points, 0.01)
    turn = 2.0 * math.sin(math.radians(2.0))
    assert slowest(places) <= (0.46 * JRK * 0.4**2 / (2.0 * turn)) ** (1 / 3)
    assert slowest(places) > 1.3 * 0.98 * (JRK * 0.1**2 / turn) ** (1 / 3)


def blended(made: Rig) -> list[bool]:
    """Of each move that waits, whether it goes over into the next."""
    first, queued = made.I[masters.first[0]], made.I[masters.queued[0]]
    return [made.F[records.blend_u[first + k]] > 0.0 for k in range(queued)]


@pytest.mark.parametrize(
    ("legs", "expected"),
    [
        ([(0.4, 0.0), (0.4, 3.0), (0.4, 3.0)], [True, True, False]),
        ([(0.4, 0.0), (0.4, 3.0), (9.0, 3.0)], [True, False, False]),
        ([(9.0, 0.0), (0.4, 3.0), (0.4, 3.0)], [False, True, False]),
        ([(0.4, 0.0), (0.4, 4.0), (0.4, 18.0)], [True, False, False]),
    ],
)
def test_moves_are_blended_where_both_are_short_and_turn_little(
    legs: list[tuple[float, float]], expected: list[bool]
) -> None:
    made = rig(0.1, jrk=JRK)
    for point in chain(legs):
        made.move(*point)
    assert blended(made) == expected


@pytest.mark.parametrize("row", ["acc", "dec", "jrk"])
def test_moves_with_limits_of_their_own_are_not_blended(row: str) -> None:
    made = rig(0.01, jrk=JRK)
    first, second, third = chain([(0.4, 0.0), (0.4, 3.0), (0.4, 3.0)])
    made.move(*first)
    made.move(*second)
    made.master(**{row: {"acc": 500.0, "dec": 500.0, "jrk": 5000.0}[row]})
    made.move(*third)
    assert blended(made) == [True, False, False]


def test_a_third_axis_that_joins_a_chain_leaves_and_comes_smoothly() -> None:
    made = rig(0.01, axes=3, jrk=JRK)
    points: list[Point] = [
        (x, y, 0.05 * max(0, k - 12)) for k, (x, y) in enumerate(chain([(0.4, 2.0)] * 24))
    ]
    waiting = [
        [Target(n, value) for n, value in enumerate(p) if n < 2 or k > 12]
        for k, p in enumerate(points)
    ][::-1]

    def issue(_: Point) -> None:
        moves.issue(made.card, 0, waiting.pop())

    places = follow(made, points, issue=issue)
    keeps_limits(places, points, 0.01)
    assert off_path(places, points) > 0.001


@settings(max_examples=examples(15))
@given(chords(), TOLERANCES, st.integers(2, 12))
def test_both_builds_agree_about_blended_chains(
    points: list[Point], tolerance: float, depth: int
) -> None:
    digests = []
    for pure in (False, True):
        made = late_rig(tolerance, depth, pure=pure)
        for point in points[:depth]:
            made.move(*point)
        for point in points[depth:]:
            made.ticks(25)
            if moves.has_room(made.card, 0):
                made.move(*point)
        made.ticks(100)
        digests.append(made.memory.digest())
    assert digests[0] == digests[1]


@pytest.mark.parametrize("override", [0.5, 2.0])
def test_an_override_does_not_lift_a_chain_above_its_speed(override: float) -> None:
    made = late_rig(0.01, 14).master(fov=override)
    made.S[at.MA_BASE + at.MA_FEEDRATE_OVERRIDE] = override
    places = follow(made, CIRCLE)
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1) / T
    assert speeds.max() <= 69.5
    assert slowest(places) == pytest.approx(28.42, rel=0.01)
