"""Gains, dead zone and filters: by command, and what they do to the output."""

import pytest
from tests.basic.motion_bench import Bench

from openacr.map.rows import motors

D_TERM = 12314


# what they do: a motor that never turns, so that the error is what is commanded


def stalled(*lines: str) -> Bench:
    made = Bench("X")
    made.memory.I[motors.kind[0]] = 1
    made.all("ACC 0 DEC 0 STP 0 VEL 100000", "TLM X100", "PGAIN X0")
    return made.all(*lines)


def step(made: Bench, pulses: int) -> Bench:
    """Command a position within one tick."""
    made.all(f"VEL 1e9 X{pulses}").ticks(2)
    return made


def test_dgain_puts_the_smoothing_into_effect() -> None:
    made = stalled("DGAIN X0.001", "P12402 = 2")
    step(made, 10)
    assert made.p(D_TERM) == 0.0  # the slope of the step has passed
    made.all("DGAIN X0.001")
    made.all("VEL 1e9 X0").ticks(3)
    assert made.p(D_TERM) == pytest.approx(0.001 * -10 / 0.0005 / 4)


# filters


def test_a_new_servo_period_keeps_the_frequency_of_a_filter() -> None:
    made = Bench("X").all("LOPASS X100")
    at_half_ms = made.p(12340)
    made.all("PERIOD 0.001")
    assert made.type("LOPASS X") == "100"
    assert made.p(12340) > 2 * at_half_ms


# the loop as a whole
