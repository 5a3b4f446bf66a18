"""Plain lines in a row: many blocks in one entry, each of them still a block."""

from tests.mill.shop import Shop

from openacr.mill.card import alarms
from openacr.mill.run.lifecycle import Options, State

STAIRS = "G90 G1 F6000\n" + "".join(f"X{0.1 * n:.1f}\n" for n in range(1, 41)) + "M2\n"


def test_single_block_stops_after_every_line_of_a_long_path() -> None:
    shop = Shop(P650_000=6000.0)
    shop.load(STAIRS, Options(is_single=True))
    seen = []
    while shop.until(State.HOLD, State.IDLE) is State.HOLD:
        seen.append(shop.pulses()[0])
        shop.runner.start()
    assert seen == [0, *range(1000, 40001, 1000)]


def test_single_block_can_be_switched_on_amid_a_long_path_and_off_again() -> None:
    shop = Shop(P650_000=60.0)
    shop.load(STAIRS)
    shop.pass_time(1.03)
    shop.runner.block(True)
    assert shop.until(State.HOLD) is State.HOLD
    first = shop.pulses()[0]
    assert first % 1000 == 0
    shop.runner.start()
    assert shop.until(State.HOLD) is State.HOLD
    assert shop.pulses()[0] == first + 1000
    shop.runner.block(False)
    shop.runner.start()
    assert shop.until(State.IDLE) is State.IDLE
    assert shop.pulses()[0] == 40000


def test_a_line_beyond_a_soft_limit_ends_the_program_in_front_of_it() -> None:
    shop = Shop(P650_000=6000.0, P200_000=2.05, P200_001=-2.0, P200_002=0, P271=1)
    shop.load(STAIRS)
    shop.until(State.ALARM, State.IDLE)
    assert shop.runner.alarms.active[0].kind is alarms.TARGET_BEYOND
    assert "line 22" in shop.runner.alarms.active[0].detail
    assert shop.pulses()[0] == 20000


def test_a_probing_move_beyond_what_pulses_can_say_is_refused_before_it_starts() -> None:
    shop = Shop(P650_000=6000.0, P600_000=3.0)
    shop.load("G31 X300000 F100\nM2\n")
    shop.until(State.ALARM, State.IDLE)
    assert "E403 axis X at 300000 inch" in shop.runner.alarms.active[0].detail
    assert shop.pulses()[0] == 0
