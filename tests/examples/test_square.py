"""The square: four buffered sides for ever, started with LRUN, stopped with PAUSE."""

import pytest
from tests.examples.observe import Observation, load, observe
from tests.examples.watches import SQUARE

MOTION, FEEDHOLDING, IN_FEEDHOLD = 516, 518, 519
PPU = 8000
SIDE_S = 5 / 50 + 5 / 5  # half a ramp lost at each end: 0.1 s + (5 - 0.5)/5 + 0.1 s = 1.1 s


@pytest.fixture(scope="module")
def run() -> Observation:
    return observe(SQUARE)


def test_the_corners_are_reached_to_the_count_every_eleven_tenths_of_a_second() -> None:
    card = load("square")
    card.send("PROG0\rRUN\r")
    assert card.until(MOTION)
    side_tk = round(SIDE_S / card.period_s)
    for corner in [(5, 0), (5, 5), (0, 5), (0, 0)] * 2:
        card.advance(side_tk - 1)
        before = [card.axis(axis).commanded_u for axis in (0, 1)]
        assert before != [float(u) for u in corner]
        assert before == pytest.approx(corner, abs=0.001)
        card.advance(1)
        assert [card.axis(axis).commanded_cnt for axis in (0, 1)] == [u * PPU for u in corner]


def test_the_motors_keep_up(run: Observation) -> None:
    for axis in (0, 1):
        assert run.card.statistics(axis).peak_velocity_ups == pytest.approx(5.0)
        assert 0.0 < run.card.statistics(axis).peak_following_error_u < 0.01


def test_a_pause_stops_within_a_side_at_the_set_deceleration(run: Observation) -> None:
    (start,), (end,) = run.rises(FEEDHOLDING), run.rises(IN_FEEDHOLD)
    assert end.time_s - start.time_s == pytest.approx(5 / 50, abs=0.001)
    distance = end.commanded_u[0] - start.commanded_u[0]
    assert distance == pytest.approx(5.0**2 / (2 * 50), abs=0.01)
    assert run.card.axis(0).commanded_u == pytest.approx(end.commanded_u[0], abs=1e-9)
    assert MOTION in end.flags


def test_a_resumed_square_goes_on_to_the_same_corner() -> None:
    card = load("square")
    card.send("PROG0\rRUN\r")
    card.advance(seconds=0.5)
    card.send("PAUSE\r")
    assert card.until(IN_FEEDHOLD, timeout_s=1.0)
    assert 0.0 < card.axis(0).commanded_u < 5.0
    card.send("RESUME\r")
    assert card.until(IN_FEEDHOLD, is_=False, timeout_s=1.0)
    for _ in range(4000):
        card.advance(1)
        if card.axis(1).commanded_cnt > 0:
            break
    assert card.axis(0).commanded_cnt == 5 * PPU
