"""TMOV, TOV and SRC: moves of a given time, and masters on another time base."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.basic.motion_bench import Bench, ticks

from openacr.map.rows import masters

IN_MOTION = 516
SHORT_TIME, IN_TMOV, TOV = 2054, 2055, 2057
TMOV_VELOCITY = masters.tmov_velocity[0]
ACCELERATION = masters.vector_acceleration[0]
JERK = masters.vector_jerk[0]
INTERNAL = masters.tov_internal[0]
RATE = masters.tov_rate[0]


def bench(*lines: str) -> Bench:
    """A card with axes of 1000 pulses per unit."""
    made = Bench("X", "Y").all("PPU X1000 Y1000", "ACC 100 DEC 100 STP 100 VEL 50")
    return made.all(*lines)


def duration(made: Bench, line: str) -> int:
    """Ticks a move takes."""
    assert made.type(line) == ""
    return made.until_clear(IN_MOTION)


# TMOV


@pytest.mark.parametrize(
    "profile",
    ["JRK 1000", "STP 0", "FVEL 5", "ACC 0", "IVEL 2", "ACC 30 STP 70 JRK 500", "ACC 0 STP 0"],
)
def test_tmov_holds_for_every_profile(profile: str) -> None:
    made = bench(profile, "TMOV 1.5")
    assert duration(made, "X10") == ticks(1.5)
    assert not made.bit(SHORT_TIME)


@settings(max_examples=20, deadline=None)
@given(
    length=st.floats(0.1, 20), time_s=st.floats(0.05, 2.0), acc=st.floats(10, 500),
    stp=st.floats(10, 500), jerk=st.sampled_from([0, 2000, 20000]),
)  # fmt: skip
def test_tmov_is_met_to_the_tick_or_short(
    length: float, time_s: float, acc: float, stp: float, jerk: int
) -> None:
    made = bench(f"ACC {acc:.3f} STP {stp:.3f} JRK {jerk} TMOV {time_s:.6f}")
    took = duration(made, f"X{length:.3f}")
    if made.bit(SHORT_TIME):
        assert took >= ticks(time_s)
    else:
        assert abs(took - ticks(time_s)) <= 1
        assert made.p(TMOV_VELOCITY) <= 50


def test_tmov_is_switched_without_losing_its_value() -> None:
    made = bench("TMOV 2", "TMOV OFF")
    assert (made.type("TMOV"), made.bit(IN_TMOV), made.p(8217)) == ("2", False, 2.0)
    assert duration(made, "X10") == ticks(0.632456)
    made.all("TMOV ON")
    assert duration(made, "X0") == ticks(2.0)
    made.all("TMOV 0")
    assert not made.bit(IN_TMOV)
    assert made.type("TMOV ON") == "Invalid argument"
    assert made.type("TMOV -1") == "Invalid argument"


def test_a_circle_takes_its_time_too() -> None:
    made = bench("TMOV 3")
    assert duration(made, "CIRCCW X(0,1) Y(0,0)") == ticks(3.0)


# TOV


@pytest.mark.req("ACR-CMD-TOV")
def test_the_acceleration_and_jerk_shown_are_those_of_the_slower_time() -> None:
    made = bench(f"P{RATE} = 0", "JRK 1000", "TOV 0.5")
    made.type("X40")
    made.ticks(100)
    assert made.p(JERK) == pytest.approx(1000 * 0.5**3)
    assert made.p(ACCELERATION) == pytest.approx(125 * 0.05, rel=0.02)


def test_tov_approaches_its_value_at_its_rate() -> None:
    made = bench("TOV 0.5").ticks(ticks(0.25))
    assert made.bit(TOV)
    assert made.p(INTERNAL) == pytest.approx(0.75, abs=1e-4)
    made.ticks(ticks(0.5))
    assert made.p(INTERNAL) == 0.5
    made.all("TOV OFF").ticks(ticks(0.6))
    assert (made.p(INTERNAL), made.type("TOV"), made.p(8220)) == (1.0, "0.5", 0.5)


def test_tov_keeps_the_path_and_0_stands_still() -> None:
    made = bench(f"P{RATE} = 0", "X5 Y3").ticks(100)
    made.all("TOV 0").ticks(100)
    here = made.psp(0)
    made.ticks(100)
    assert made.psp(0) == here
    assert made.bit(IN_MOTION)
    made.all("TOV 2")
    while made.bit(IN_MOTION):
        made.ticks(7)
        assert made.psp(0) * 3 == pytest.approx(made.psp(1) * 5)


@pytest.mark.parametrize("value", ["-0.1", "2.1"])
def test_tov_is_limited(value: str) -> None:
    assert bench().type(f"TOV {value}") == "Invalid argument"


# SRC


def test_a_source_backwards_takes_the_path_back_to_its_start() -> None:
    made = bench("SRC P6288", "X10")
    made.memory.write(6288, 300)
    far = made.ticks(1).psp(0)
    made.memory.write(6288, 200)
    near = made.ticks(1).psp(0)
    made.memory.write(6288, -5000)
    assert 0 < near < far
    assert made.ticks(1).psp(0) == 0
    made.memory.write(6288, -4700)
    assert made.ticks(1).psp(0) == pytest.approx(far)


def test_a_source_wraps_at_32_bits() -> None:
    made = bench("ACC 0 STP 0 VEL 10", "P6288 = 2147483647", "SRC ENC9", "X1")
    made.memory.write(6288, -2147483648 + 49)
    assert made.ticks(1).psp(0) == pytest.approx(500)


def test_what_a_source_did_before_the_move_does_not_count() -> None:
    made = bench("SRC ENC9").ticks(3)
    made.memory.write(6288, 100000)
    made.ticks(3).all("X10").ticks(3)
    assert made.psp(0) == 0


@pytest.mark.parametrize(
    ("given", "text"),
    [("CLK", "CLK"), ("NONE", "NONE"), ("ENC3", "ENC3"), ("AXIS1", "AXIS1"), ("ADC0", "ADC0"),
     ("P6916", "P6916"), ("6916", "P6916"), ("CLOCK", "CLK"), ("STEPPER2", "STEPPER2")],
)  # fmt: skip
def test_src_is_reported_as_written(given: str, text: str) -> None:
    made = bench(f"SRC {given}")
    assert made.type("SRC") == text


@pytest.mark.parametrize("given", ["ENC99", "P5000"])
def test_sources_that_are_none_are_refused(given: str) -> None:
    assert bench().type(f"SRC {given}") == "Invalid source"


def test_a_master_without_source_stands_still_and_goes_on_with_the_clock() -> None:
    made = bench("SRC NONE", "X10").ticks(50)
    assert made.psp(0) == 0
    made.all("SRC CLK")
    assert made.until_clear(IN_MOTION) == ticks(0.632456)
