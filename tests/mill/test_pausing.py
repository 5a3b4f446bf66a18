"""A held program: hands in between, buttons at the wrong moment, and on along the same path."""

import pytest
from tests.mill.shop import Shop

from openacr.errors import UserError
from openacr.mill.run.lifecycle import State

FEED_HOLD, CYCLE_START = "P400_002", "P400_003"
SPINDLE_CW = "P800_005"


def paused(shop: Shop, text: str, after_s: float, rest_s: float = 0.5) -> None:
    shop.load(text)
    shop.pass_time(after_s)
    shop.runner.stop()
    shop.pass_time(rest_s)
    assert shop.runner.state is State.PAUSED


def moved_by_hand(shop: Shop, axis: int, distance_u: float) -> None:
    shop.runner.jog(lambda jog: jog.move(axis, distance_u))
    for _ in range(20_000):
        if not shop.runner.jogging.is_active:
            return
        shop.pass_time(0.005)
    raise AssertionError("the jog does not end")


def test_a_refused_resume_does_not_forget_where_the_machine_was_held() -> None:
    shop = Shop()
    paused(shop, "G1 F600 X1\nG4 F5\nG1 X2\nM2\n", 1.0)
    moved_by_hand(shop, 1, 0.5)
    for _ in range(2):
        with pytest.raises(UserError, match="move it back, or abort"):
            shop.runner.resume()
        shop.pass_time(0.1)
    moved_by_hand(shop, 1, -0.5)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses() == (20000, 0, 0)


@pytest.mark.parametrize("gap_s", [0.0, 0.005, 0.02, 0.1])
def test_a_resume_close_after_the_stop_goes_on(gap_s: float) -> None:
    shop = Shop(P650_008=2.0)
    paused(shop, "G1 F600 X30\nM2\n", 2.0, rest_s=gap_s)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses() == (300_000, 0, 0)


def test_a_machine_moved_before_its_first_move_comes_back_before_it_begins() -> None:
    shop = Shop()
    paused(shop, "G1 F600 X2\nM2\n", 0.0)
    moved_by_hand(shop, 1, 0.5)
    moved_by_hand(shop, 2, 0.5)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses() == (20000, 0, 0)
    assert max(y for x, y, _ in shop.path if x > 0.01) < 1e-3


def test_no_axis_is_moved_by_hand_before_the_hold_has_come_to_rest() -> None:
    shop = Shop(P650_008=2.0)
    paused(shop, "G1 F600 X50\nM2\n", 3.0, rest_s=0.2)
    with pytest.raises(UserError, match="has not come to rest"):
        shop.runner.jog(lambda jog: jog.move(0, 0.5))
    shop.pass_time(4.0)
    moved_by_hand(shop, 1, 0.1)
    assert shop.pulses()[1] == 1000


def test_no_program_starts_and_no_axis_is_jogged_while_the_last_one_is_being_ended() -> None:
    shop = Shop(P650_008=2.0)
    shop.load("G1 F600 X50\nM2\n")
    shop.pass_time(3.0)
    shop.runner.abort()
    shop.pass_time(0.1)
    with pytest.raises(UserError, match="still being ended"):
        shop.load("G1 F60 Y1\nM2\n")
    with pytest.raises(UserError, match="still being ended"):
        shop.runner.jog(lambda jog: jog.move(1, 0.5))
    shop.until(State.IDLE)
    shop.run_text("G1 F60 Y1\nM2\n")
    assert shop.pulses()[1] == 10000


# --- buttons ----------------------------------------------------------------------------


def test_cycle_start_at_the_wrong_moment_is_refused_and_ends_nothing() -> None:
    shop = Shop(**{CYCLE_START: 7})
    paused(shop, "G1 F60 X1\nM2\n", 0.3)
    shop.runner.jog(lambda jog: jog.move(1, 0.5))
    shop.controller.set_input(7, True)
    shop.pass_time(0.1)
    assert (shop.runner.state, shop.said) == (State.PAUSED, ["an axis is being jogged"])


def test_a_start_button_held_down_when_the_feed_hold_ends_starts_nothing() -> None:
    shop = Shop(**{FEED_HOLD: 6, CYCLE_START: 7})
    shop.load("G1 F60 X1\nM2\n")
    shop.pass_time(0.2)
    shop.controller.set_input(6, True)
    shop.pass_time(0.3)
    shop.controller.set_input(7, True)
    shop.pass_time(0.1)
    shop.controller.set_input(6, False)
    shop.pass_time(0.3)
    assert shop.runner.state is State.PAUSED
    shop.controller.set_input(7, False)
    shop.pass_time(0.1)
    shop.controller.set_input(7, True)
    shop.until(State.IDLE)


def test_the_feed_hold_input_stops_a_jog_and_bars_the_next_one() -> None:
    shop = Shop(**{FEED_HOLD: 6})
    shop.runner.jog(lambda jog: jog.move(0, 5.0))
    shop.pass_time(0.2)
    shop.controller.set_input(6, True)
    shop.pass_time(1.0)
    assert not shop.runner.jogging.is_active
    assert 0 < shop.pulses()[0] < 40000
    with pytest.raises(UserError, match="feed hold input is active"):
        shop.runner.jog(lambda jog: jog.move(0, 0.5))


# --- single block -----------------------------------------------------------------------


@pytest.mark.req("MILL-RUN-BLOCK-MID")
def test_block_switched_on_in_a_pause_stops_after_the_held_block() -> None:
    shop = Shop()
    paused(shop, "F600\n" + "".join(f"G1 X{n}\n" for n in range(1, 9)) + "M2\n", 0.15)
    shop.runner.block(True)
    shop.runner.resume()
    for n in (2, 3):  # it was held between 1 and 2
        shop.until(State.HOLD)
        shop.pass_time(0.1)
        assert shop.pulses()[0] == 10000 * n
        shop.runner.start()
    shop.runner.block(False)
    shop.until(State.IDLE)
    assert shop.pulses()[0] == 80000


def test_block_switched_on_at_rest_in_front_of_a_code_leaves_the_code_in_its_place() -> None:
    shop = Shop(**{SPINDLE_CW: 40})
    shop.load("G1 F600 X1\nM3 S500\nG1 X2\nM2\n")
    shop.pass_time(0.1)
    shop.controller.advance(seconds=1.0)  # at X1, and nothing has polled yet
    shop.runner.block(True)
    spins_at = []
    for _ in range(2):
        shop.until(State.HOLD)
        spins_at.append((shop.place()[0], shop.outputs([40])))
        shop.runner.start()
    assert (1.0, [True]) in spins_at
    assert (2.0, [False]) not in spins_at


def test_stop_and_resume_while_block_is_taking_the_moves_back_keep_the_path() -> None:
    shop = Shop(P650_008=20.0)
    shop.load("F600\nG1 X10\nY10\nM2\n")
    shop.pass_time(0.8)
    shop.runner.block(True)
    shop.pass_time(0.1)
    shop.runner.stop()
    shop.pass_time(0.1)
    shop.runner.resume()
    shop.until(State.HOLD)
    assert shop.pulses() == (100000, 0, 0)
    assert max(y for _, y, _ in shop.path) == 0.0
    shop.runner.start()
    shop.until(State.HOLD, State.IDLE)
    assert shop.pulses() == (100000, 100000, 0)
