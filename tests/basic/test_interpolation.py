"""Linear moves: targets, blocks, buffering and what refuses a move."""

import pytest
from tests.basic.motion_bench import Bench, ticks

from openacr.motion.axis import settings

IN_MOTION, BUFFERED = 516, 517
MOVE_PENDING = 1027


def bench(*axes: str) -> Bench:
    made = Bench(*(axes or ("X", "Y", "Z")))
    made.type("ACC 0 DEC 0 STP 0 VEL 1000")
    return made


def positions(made: Bench, count: int = 3) -> list[float]:
    return [made.p(12288 + 256 * axis) for axis in range(count)]


def run(made: Bench, *lines: str) -> list[float]:
    """Type moves one after the other, each when the last is done."""
    for line in lines:
        assert made.type(line) == ""
        made.until_clear(IN_MOTION)
    return positions(made)


def test_the_last_target_of_an_axis_in_a_block_wins() -> None:
    assert run(bench(), "X10 Y5 X20") == [20, 5, 0]


def test_what_follows_a_target_in_its_block_still_shapes_the_move() -> None:
    made = bench()
    made.type("X10 VEL 100")
    assert made.until_clear(IN_MOTION) == ticks(0.1)


# the buffer


def test_one_move_is_buffered_and_the_next_waits() -> None:
    made = bench()
    assert made.type("X10") == ""
    assert (made.bit(IN_MOTION), made.bit(BUFFERED), made.is_waiting) == (True, False, False)
    made.type("X20")
    assert (made.bit(BUFFERED), made.is_waiting) == (True, False)
    made.type("X30")
    assert made.is_waiting
    made.ticks(ticks(0.01) + 1)
    assert not made.is_waiting
    made.until_clear(IN_MOTION)
    assert positions(made) == [30, 0, 0]


def test_a_program_shows_that_it_waits_for_the_buffer() -> None:
    made = bench()
    made.run("X/10", "X/10", "X/10")
    made.ticks(5)
    assert made.bit(MOVE_PENDING)
    made.ticks(ticks(0.01))
    assert not made.bit(MOVE_PENDING)
    made.until_clear(IN_MOTION)
    assert positions(made) == [30, 0, 0]


def test_profile_values_are_taken_when_the_move_is_issued() -> None:
    made = bench()
    made.type("VEL 100 X10 : VEL 10 X20 : VEL 500")
    assert made.until_clear(IN_MOTION) == ticks(0.1 + 1.0)


def test_a_move_of_length_0_does_not_set_in_motion() -> None:
    made = bench()
    assert made.type("X0 Y0") == ""
    assert not made.bit(IN_MOTION)


def test_a_move_shows_its_target_at_once() -> None:
    made = bench()
    made.type("PPU X10 : X5")
    assert (made.p(12288), made.p(12289)) == (0, 50)


# what refuses a move


@pytest.mark.parametrize(
    ("setup", "message"),
    [
        ("SET 8467", "Associated Slave Kill Motion Request Active"),
        ("SET 8499", "Associated Slave Kill Motion Request Active"),
        ("SET 522", "Master Kill All Moves Request Active"),
        ("AXIS0 OFF", "Axis is off"),
        ("HLIM X1 : SET 0", "Hard limit"),
        ("SLIM X1 : SLM X(-1,-2)", "Soft limit"),
    ],
)
def test_a_move_is_refused_with_the_reason(setup: str, message: str) -> None:
    made = bench()
    made.type(setup)
    made.ticks(1)
    assert made.type("X10") == message
    assert not made.bit(IN_MOTION)
    made.ticks(20)
    assert positions(made) == [0, 0, 0]


@pytest.mark.parametrize(("switch", "inward"), [(0, "X-10"), (1, "X10")])
def test_an_active_limit_refuses_outward_moves_only(switch: int, inward: str) -> None:
    made = bench().all("HLIM X3", f"SET {switch}").ticks(1)
    assert made.type("X10" if switch == 0 else "X-10") == "Hard limit"
    assert made.type(inward) == ""
    made.until_clear(IN_MOTION)
    assert made.p(12288) == float(inward[1:])


@pytest.mark.parametrize("latch", [16132, 16133, 16140, 16141])
def test_a_limit_that_was_met_refuses_no_move(latch: int) -> None:
    made = bench().all("HLIM X3", "SLIM X3", "SLM X(20,-20)", f"SET {latch}").ticks(1)
    for target in (10, -10):
        assert made.type(f"X{target}") == ""
        made.until_clear(IN_MOTION)
        assert made.p(12288) == target
    assert made.bit(latch) == (latch < 16140)  # those of hardware limits are kept


@pytest.mark.parametrize("line", ["X(1,2)", "X", "MOV", "X/"])
def test_a_malformed_move_is_a_syntax_error(line: str) -> None:
    assert bench().type(line) == "Syntax error"


# MAXVEL


def test_maxvel_written_as_a_parameter_counts_too() -> None:
    made = bench()
    made.type("P12368 = 10")
    made.type("X10")
    assert made.until_clear(IN_MOTION) == ticks(1.0)


def test_maxvel_of_one_axis_is_cleared_by_its_prefix() -> None:
    made = bench()
    made.type("MAXVEL X3 Y4")
    made.type("AXIS0 MAXVEL OFF")
    assert made.type("MAXVEL X Y") == "0|4"
    assert settings.MAX_VELOCITY.read(made.card, 1) == 4.0
