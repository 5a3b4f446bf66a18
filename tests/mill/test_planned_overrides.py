"""Overrides above 100 percent while a planned curve is on the card."""

import itertools
import random
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mill.planned import (
    ACCEL,
    FEED,
    JERK,
    SPEED,
    TOLERANCE,
    Point,
    Reals,
    feed,
    follow,
    go_on,
    highest,
    off_path,
    path,
    planned_shop,
    stop,
    wave,
)
from tests.mill.shop import Shop, end
from tests.search import search, sparse

from openacr.cnc import canonical as c
from openacr.mill.run.lifecycle import Options, State

# Positions of 24 bits over the square and the cube of 4 ms, at 300 mm.
ROUNDING2, ROUNDING3 = 4e-3, 0.08
WITHIN_S = 0.5  # an override acts
HALF = 0.5 * SPEED  # programmed, so that 150 % are within the limits of the machine
MOST = 150.0
LEG: list[Point] = [(300.0, 0.0)]
LEGS: list[Point] = [(60.0, 0.0), (60.0, 40.0), (20.0, 41.0), (19.0, 0.0), (0.0, 0.0)]
BENT: list[Point] = [(40.0, 0.0), (90.0, 5.0), (140.0, 0.0), (150.0, -1.0), (190.0, -1.0)]
PATHS = {"legs": LEGS, "bent": BENT, "chords": wave(200), "leg": LEG}
# Each path and each time of a hold is there in a run of `make test`.
HOLDS = sparse(list(itertools.product(PATHS, [0.02, 0.2, 0.43, 0.5])), 5)
KINDS_AND_TIMES = sparse(list(itertools.product(["leg", "chords", "bent"], [0.6, 0.627, 0.87])), 4)


def limits(places: Reals, shop: Shop) -> None:
    """Assert that no limit is exceeded in any tick."""
    speed, accel, jerk = highest(places, shop.controller.period_s)
    assert speed <= 0.01 * MOST * HALF * (1 + 1e-4)
    assert accel <= ACCEL * (1 + ROUNDING2)
    assert jerk <= JERK * (1 + ROUNDING3)


def speeds(places: Reals, shop: Shop) -> Reals:
    """The speed along the path, tick by tick [mm/s]."""
    found: Reals = np.linalg.norm(np.diff(places, axis=0), axis=1) / shop.controller.period_s
    return found


def ends(points: Sequence[Point], shop: Shop) -> None:
    """Assert that the machine stands at the end of the path, on the pulse."""
    assert shop.pulses()[:2] == tuple(round(10_000 * value) for value in points[-1][:2])
    assert shop.runner.state is State.IDLE


@pytest.mark.parametrize(("kind", "at_s"), KINDS_AND_TIMES)
def test_it_acts_within_half_a_second(kind: str, at_s: float) -> None:
    points, shop = PATHS[kind], planned_shop()
    program: list[c.Entry] = [*path(points, feed=0.5 * FEED), end()]
    places = follow(shop, *program, actions=[(at_s, feed(MOST))])
    faster = np.flatnonzero(speeds(places, shop) > 1.001 * HALF)
    assert at_s < faster[0] * shop.controller.period_s <= at_s + WITHIN_S
    limits(places, shop)
    ends(points, shop)
    assert off_path(places, points) <= TOLERANCE


def test_a_long_leg_reaches_the_feed_of_the_override() -> None:
    slow, shop = planned_shop(), planned_shop()
    program: list[c.Entry] = [*path(LEG, feed=0.5 * FEED), end()]
    whole = follow(slow, *program)
    places = follow(shop, *program, actions=[(0.5, feed(MOST))])
    assert speeds(places, shop).max() == pytest.approx(0.01 * MOST * HALF, rel=1e-4)
    assert speeds(places, shop)[: round(0.9 / shop.controller.period_s)].max() < HALF * (1 + 1e-4)
    gained_s = (len(whole) - len(places)) * shop.controller.period_s
    assert gained_s == pytest.approx((300.0 / HALF - 0.96) / 3.0, abs=0.05)


def test_it_is_taken_back_before_it_is_exceeded() -> None:
    shop = planned_shop()
    program: list[c.Entry] = [*path(LEG, feed=0.5 * FEED), end()]
    places = follow(shop, *program, actions=[(0.5, feed(MOST)), (0.7, feed(100.0))])
    assert speeds(places, shop).max() <= HALF * (1 + 1e-4)
    limits(places, shop)
    ends(LEG, shop)


@pytest.mark.parametrize(("kind", "hold_s"), HOLDS)
def test_a_feed_hold_right_after_it(kind: str, hold_s: float) -> None:
    points, shop = PATHS[kind], planned_shop()
    program: list[c.Entry] = [*path(points, feed=0.5 * FEED), end()]
    actions = [(0.6, feed(MOST)), (0.6 + hold_s, stop), (1.6 + hold_s, go_on)]
    places = follow(shop, *program, actions=actions)
    limits(places, shop)
    ends(points, shop)
    assert off_path(places, points) <= 2 * TOLERANCE
    still = np.flatnonzero(speeds(places, shop) == 0.0) * shop.controller.period_s
    assert still[still > 0.6 + hold_s][0] - 0.6 - hold_s <= 0.35


def test_single_block_rests_at_the_end_of_every_move() -> None:
    shop = planned_shop()
    moves: list[c.Entry] = [*path(LEGS, feed=0.5 * FEED)]
    blocks = [each for move in moves for each in (move, c.BlockEnd(move.source))]
    shop.start(*blocks, end(), options=Options(is_single=True))
    for k, point in enumerate(LEGS):
        shop.pass_time(0.3)
        feed(MOST if k % 2 == 0 else 100.0)(shop)
        assert shop.until(State.HOLD) is State.HOLD
        assert shop.place() == (*point, 0.0)
        shop.runner.start()
    assert shop.until(State.IDLE) is State.IDLE


def test_rapids_are_not_raised() -> None:
    shop = planned_shop()
    far, back = path([(80.0, 0.0), (0.0, 0.0)], feed=0.5 * FEED)
    rapid = c.Rapid(back.source, back.end)
    places = follow(shop, far, rapid, end(), actions=[(0.0, feed(MOST))])
    coming = np.diff(places[:, 0]) < 0.0
    assert speeds(places, shop)[coming].max() == pytest.approx(SPEED, rel=1e-3)
    assert speeds(places, shop)[~coming].max() == pytest.approx(0.75 * SPEED, rel=1e-3)


@search(8, derandomize=True)
@given(st.sampled_from(sorted(PATHS)), st.integers(0, 10_000))
def test_overrides_of_any_course_keep_limits_tolerance_and_end(kind: str, seed: int) -> None:
    chance, now_s, actions = random.Random(seed), chance_s(seed), []
    for _ in range(7):
        actions.append((now_s, feed(chance.choice([MOST, MOST, 120.0, 100.0, 70.0, 30.0]))))
        now_s += chance.uniform(0.02, 0.7)
    shop = planned_shop()
    points = PATHS[kind]
    places = follow(shop, *path(points, feed=0.5 * FEED), end(), actions=actions)
    limits(places, shop)
    ends(points, shop)
    assert off_path(places, points) <= TOLERANCE


def chance_s(seed: int) -> float:
    """When the first override is turned."""
    return random.Random(-seed).uniform(0.0, 1.0)
