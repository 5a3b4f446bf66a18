"""INT, TRJ, TRG and HSINT: moves that begin, end or turn elsewhere by flags and captures."""

from itertools import pairwise

import pytest
from tests.basic.motion_bench import Bench, ticks

from openacr.map.rows import axes, masters

IN_MOTION, TRG_PENDING = 516, 539
VELOCITY = masters.vector_velocity[0]
RESPONSE = masters.int_response_period[0]
FLAG = 128
REGISTERED = 778


def bench(*lines: str) -> Bench:
    """A card with axes of 1000 pulses per unit and ramps of 0.1 s."""
    made = Bench("X", "Y").all("PPU X1000 Y1000", "ACC 100 DEC 100 STP 100 VEL 10")
    return made.all(*lines)


def speeds(made: Bench, limit_s: float = 10.0) -> list[float]:
    """Path speed of every tick until the motion ends."""
    found: list[float] = []
    while made.bit(IN_MOTION) and len(found) < limit_s / 0.0005:
        made.ticks(1)
        found.append(made.p(VELOCITY))
    return found


def smooth(values: list[float], rate_ups2: float = 100.0) -> bool:
    """Whether no change of speed is faster than the ramp."""
    changes = (abs(b - a) for a, b in pairwise(values))
    return max(changes) <= rate_ups2 * 0.0005 * 1.01


# INT


def test_a_hold_during_the_stop_of_int_keeps_it_ended() -> None:
    made = bench()
    made.type(f"INT {FLAG} X100")
    made.ticks(1000).all(f"SET {FLAG}").ticks(20).all("SET 520").ticks(600)
    stopped = made.psp(0)
    made.all("SET 521").ticks(300)
    assert not made.bit(IN_MOTION)
    assert made.psp(0) == stopped


def test_int_refuses_flags_that_are_none() -> None:
    assert bench().type("INT 99999 X1") == "Invalid bit"


# TRJ


@pytest.mark.req("ACR-CMD-TRJ")
def test_trj_backwards_comes_to_rest_first() -> None:
    made = bench()
    made.type("X100")
    made.ticks(ticks(0.5))
    made.type("TRJ X0")
    found = speeds(made)
    assert smooth(found)
    assert min(found[: ticks(0.15)]) < 0.06
    assert made.psp(0) == 0


def test_trj_never_waits_for_the_buffer() -> None:
    made = bench()
    made.type("X100 : X200")
    assert made.type("TRJ X30") == ""
    assert not made.is_waiting
    made.until_clear(IN_MOTION)
    assert made.psp(0) == 30000


# TRG


def test_trg_is_for_the_move_issued_after_it() -> None:
    made = bench()
    made.type(f"X1 : TRG -{FLAG} : SET {FLAG} : X2")
    made.ticks(1000)
    assert (made.psp(0), made.bit(TRG_PENDING)) == (1000, True)
    made.all(f"CLR {FLAG}")
    made.until_clear(IN_MOTION)
    assert made.psp(0) == 2000


def test_trg_waits_for_a_capture() -> None:
    made = bench("TRG X(11)", "X1").ticks(50)
    assert made.psp(0) == 0
    made.all("SET 113")
    made.until_clear(IN_MOTION)
    assert made.psp(0) == 1000


def test_a_capture_that_trg_waits_for_is_copied_to_its_parameter() -> None:
    made = bench("JOG VEL X1", "JOG FWD X", "TRG X(11, P38912)").ticks(50)
    made.all("SET 113").ticks(2)
    captured = made.p(axes.hardware_capture[0])
    assert captured > 0
    assert made.p(38912) == captured


@pytest.mark.parametrize(
    "line", ["TRG X(16)", "TRG X(11, 38912)", "TRG X(11, P0)", "TRG X(11) Y(11)"]
)
def test_trg_takes_a_known_mode_of_one_axis_and_a_long_parameter(line: str) -> None:
    made = bench()
    made.type(line)
    assert not made.bit(TRG_PENDING)


@pytest.mark.parametrize("line", ["TRG OFF", "SET 522", "HALT"])
def test_trg_is_lifted_by_off_kill_and_halt(line: str) -> None:
    made = bench(f"TRG {FLAG}", "X1").ticks(3)
    made.type(line)
    made.ticks(600)
    assert not made.bit(TRG_PENDING)
    assert made.psp(0) == (1000 if line == "TRG OFF" else 0)


# HSINT


def hsint(made: Bench, arguments: str, at_s: float) -> Bench:
    """Start HSINT on X, capture by software after a time, and wait for the end."""
    assert made.type(f"HSINT X({arguments})") == ""
    made.ticks(ticks(at_s)).all("SET 113")
    return made


def test_hsint_leads_a_distance_beyond_the_capture() -> None:
    made = hsint(bench(), "11,100,3", at_s=1.0)
    captured = made.ticks(1).p(axes.hardware_capture[0])
    found = speeds(made)
    assert smooth(found)
    assert made.bit(REGISTERED)
    assert made.psp(0) == captured + 3000


@pytest.mark.parametrize("line", ["HSINT X(11,100,3)", "HSINT X(11,30,3,7,5)"])
def test_the_new_end_of_hsint_counts_from_the_capture_with_the_offsets_of_the_axis(
    line: str,
) -> None:
    made = bench("JOG VEL X10", "JOG ACC X1000", "JOG DEC X1000", "JOG INC X4").seconds(1.0)
    made.all(line).ticks(ticks(1.0)).all("SET 113")
    captured = made.ticks(1).p(axes.hardware_capture[0])
    assert made.bit(REGISTERED)
    made.until_clear(IN_MOTION)
    assert made.psp(0) == captured + 3000
    assert made.p(12288) == captured + 3000 - 4000


def test_hsint_passes_a_new_end_that_is_too_near_and_returns() -> None:
    made = hsint(bench(), "11,100,0.1", at_s=1.0)
    captured = made.ticks(1).p(axes.hardware_capture[0])
    farthest = 0.0
    while made.bit(IN_MOTION):
        farthest = max(farthest, made.ticks(1).psp(0))
    assert farthest > captured + 400
    assert made.psp(0) == captured + 100


def test_a_response_period_of_minus_1_never_turns_hsint() -> None:
    made = hsint(bench(f"P{RESPONSE} = -1"), "11,12,3", at_s=0.5)
    made.until_clear(IN_MOTION)
    assert (made.psp(0), made.bit(REGISTERED)) == (12000, True)
