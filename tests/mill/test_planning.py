"""How fast moves may follow each other."""

import math
import random
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from tests.mill.prediction import corner_speed

from openacr.cnc.canonical import PathMode
from openacr.errors import UserError
from openacr.mill.plan.moves.planning import (
    CornerRules,
    PlannedMove,
    Planner,
)

FEED = 4.0
RAMP = 100.0


def line(
    direction: float, length: float = 1.0, feed: float = FEED, mode: PathMode = PathMode.CORNER
) -> PlannedMove:
    """A straight move in the plane, its direction in degrees."""
    travel = (math.cos(math.radians(direction)), math.sin(math.radians(direction)), 0.0)
    return PlannedMove(
        length_u=length,
        feed_ups=feed,
        ramp_ups2=RAMP,
        start=travel,
        end=travel,
        mode=mode,
    )


@given(st.floats(-180.0, 180.0), st.floats(0.0, 180.0))
def test_the_angle_of_a_corner_is_the_one_between_the_tangents(first: float, turn: float) -> None:
    """Slowed to 0 from 0 to 180 degrees: the speed says the angle."""
    speed = corner_speed(line(first), line(first + turn), CornerRules(0.0, 180.0))
    assert 180.0 * (1.0 - speed / FEED) == pytest.approx(turn, abs=1e-9)


@pytest.mark.parametrize(
    ("turn", "angle1", "angle2", "speed"),
    [
        (90.0, 0.0, 0.0, FEED),  # rule off
        (30.0, 30.0, 90.0, FEED),
        (60.0, 30.0, 90.0, FEED - (FEED - 1.0) / 2),
        (90.0, 30.0, 90.0, 0.0),
        (120.0, 30.0, 90.0, 0.0),
        (105.0, 30.0, 0.0, FEED - (FEED - 1.0) / 2),
        (180.0, 30.0, 0.0, 1.0),
    ],
)
@pytest.mark.req("MILL-LOOK-CORNER", "MILL-SYS-CTL-ACUTE1", "MILL-SYS-CTL-ACUTE2")
def test_g62_slows_from_the_first_angle_and_stops_from_the_second(
    turn: float, angle1: float, angle2: float, speed: float
) -> None:
    rules = CornerRules(angle1_deg=angle1, angle2_deg=angle2, slowest_ups=1.0)
    assert corner_speed(line(0.0), line(turn), rules) == pytest.approx(speed)


def test_the_slowest_corner_speed_never_raises_the_feed() -> None:
    rules = CornerRules(angle1_deg=10.0, slowest_ups=100.0)
    assert corner_speed(line(0.0), line(90.0, feed=1.0), rules) == 1.0


def test_g64_passes_every_corner_at_the_lower_feed() -> None:
    rules = CornerRules(angle1_deg=10.0, angle2_deg=20.0)
    before = line(0.0, mode=PathMode.FREE)
    assert corner_speed(before, line(170.0, feed=2.0), rules) == 2.0


def test_corner_step_bounds_the_jump_of_every_single_axis() -> None:
    rules = CornerRules(step_ups=0.5)
    before, after = line(0.0, mode=PathMode.FREE), line(90.0)
    assert corner_speed(before, after, rules) == pytest.approx(0.5)


def test_exact_stops_and_rapids_end_at_rest() -> None:
    rules = CornerRules()
    rapid = line(0.0)
    rapid.is_rapid = True
    assert corner_speed(line(0.0, mode=PathMode.EXACT), line(0.0), rules) == 0.0
    assert corner_speed(rapid, line(0.0), rules) == 0.0
    assert corner_speed(line(0.0), rapid, rules) == 0.0


def test_angles_in_the_wrong_order_are_refused_by_name() -> None:
    with pytest.raises(UserError, match="Acute Angle2"):
        CornerRules(angle1_deg=90.0, angle2_deg=30.0)


Chosen = list[tuple[float, float, float]]
moves = st.lists(
    st.tuples(st.floats(-180, 180), st.floats(1e-4, 2.0), st.floats(0.1, 10.0)),
    min_size=1,
    max_size=60,
)


RULES = CornerRules(30.0, 120.0, 0.5)


def planned(chosen: Chosen, takes: int) -> list[PlannedMove]:
    """The moves with their end speeds, taken out in pieces of a few moves."""
    planner: Planner[PlannedMove] = Planner(RULES)
    out: list[PlannedMove] = []
    for at, (direction, length, feed) in enumerate(chosen, start=1):
        planner.add(line(direction, length, feed))
        if at % takes == 0:
            out += planner.release(10000, is_complete=False)
    out += planner.release(10000, is_complete=True)
    return out


@given(moves, st.integers(1, 20))
def test_every_end_speed_can_be_braked_away_in_time(chosen: Chosen, takes: int) -> None:
    out = planned(chosen, takes)
    assert len(out) == len(chosen)
    assert out[-1].exit_ups == 0.0
    for move, after in pairwise(out):
        reach2 = after.exit_ups**2 + 2.0 * after.ramp_ups2 * after.length_u
        assert move.exit_ups**2 <= reach2 * (1 + 1e-12)
        assert move.exit_ups <= corner_speed(move, after, RULES)


@given(moves)
def test_nothing_is_lost_by_sending_before_all_is_known(chosen: Chosen) -> None:
    """Moves held back long enough end as fast as with the whole program known."""
    whole = [move.exit_ups for move in planned(chosen, len(chosen) + 1)]
    pieces = [move.exit_ups for move in planned(chosen, 1)]
    assert np.allclose(whole, pieces, rtol=0, atol=1e-12)


def test_long_queues_are_planned_as_short_ones() -> None:
    chance = random.Random(7)
    chosen = [
        (chance.uniform(-180.0, 180.0), chance.uniform(1e-3, 0.3), chance.uniform(1.0, 10.0))
        for _ in range(700)
    ]
    whole = [move.exit_ups for move in planned(chosen, len(chosen) + 1)]
    for takes in (1, 40, 300):
        assert [move.exit_ups for move in planned(chosen, takes)] == whole


def test_a_chain_of_short_tangent_moves_keeps_the_feed() -> None:
    out = planned([(0.0, 0.01, FEED)] * 400, 10)
    brake = FEED**2 / (2 * RAMP)
    kept = [move.exit_ups for move in out[: -math.ceil(brake / 0.01) - 1]]
    assert kept == [FEED] * len(kept)


def test_as_many_moves_wait_as_were_asked_for() -> None:
    planner: Planner[PlannedMove] = Planner(CornerRules(), least_ahead=10)
    for _ in range(25):
        planner.add(line(0.0, length=100.0))
    assert len(list(planner.release(10000, is_complete=False))) == 15
    assert len(planner) == 10


@given(
    st.lists(st.tuples(st.floats(0.1, 40.0), st.sampled_from([20.0, 100.0])), min_size=1),
    st.lists(st.integers(0, 5)),
)
def test_moves_wait_over_the_longest_braking_distance_of_those_in_the_queue(
    moves: list[tuple[float, float]], takes: list[int]
) -> None:
    require_held(moves, [*takes, 0])


def test_many_moves_wait_over_their_longest_braking_distance() -> None:
    chance = random.Random(3)
    moves = [(chance.uniform(5.0, 40.0), chance.choice([20.0, 100.0])) for _ in range(400)]
    require_held(moves, [0, 1, 3, 5])


def require_held(moves: list[tuple[float, float]], takes: list[int]) -> None:
    planner: Planner[PlannedMove] = Planner(CornerRules())
    for k, (feed, ramp) in enumerate(moves):
        planner.add(replace(line(0.0, 0.5, feed), ramp_ups2=ramp))
        list(planner.release(takes[k % len(takes)], is_complete=False))
        longest_u = max(each.feed_ups**2 / (2.0 * each.ramp_ups2) for each in planner)
        held = min(len(planner), math.ceil(longest_u / 0.5))
        assert planner.ready() == len(planner) - held
