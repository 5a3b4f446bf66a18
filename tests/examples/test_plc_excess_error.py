"""The interlock of the tuning appendix: output 32 is on while all eight axes follow."""

from math import exp, log

import pytest
from tests.examples.observe import load, observe
from tests.examples.watches import EXCESS

OUTPUT, PLC_RUNNING = 32, 1536
NOT_EXCESS = [769 + 32 * axis for axis in range(8)]
SLOW_SCAN_S = 0.05
BAND_REV = 4.0


def seconds_to_the_band(gain: float) -> float:
    """Time at which a motor with this gain alone lags a move of 5 rev/s by four revolutions.

    A drive of 10 rev/s per volt gives e' = v - k e with k = 10 * 4096 * gain; the ramp
    takes 0.1 s at 50 rev/s2.
    """
    k, velocity, accel, ramp_s = 10 * 4096 * gain, 5.0, 50.0, 0.1
    after_ramp = accel / k**2 * (k * ramp_s - 1 + exp(-k * ramp_s))
    return ramp_s + log((velocity / k - after_ramp) / (velocity / k - BAND_REV)) / k


@pytest.mark.req("MILL-TUNE-03")
@pytest.mark.parametrize("axis", range(8))
def test_the_output_drops_when_any_axis_leaves_its_band(axis: int) -> None:
    card = load("plc_excess_error")
    card.advance(seconds=SLOW_SCAN_S)
    assert card.bit[PLC_RUNNING] and card.bit[OUTPUT]
    name = "XYZABCUV"[axis]
    card.send(f"PROG0\rPGAIN {name}0.00002\rFFVEL {name}0\r{name}30\r")
    start = card.tick
    assert card.until(OUTPUT, is_=False, timeout_s=3.0)
    assert [card.bit[flag] for flag in NOT_EXCESS] == [n != axis for n in range(8)]
    late_s = (card.tick - start) * card.period_s - seconds_to_the_band(0.00002)
    assert -0.001 < late_s < SLOW_SCAN_S + 0.01


def test_the_output_changes_in_the_tick_of_the_flag() -> None:
    run = observe(EXCESS)
    (off,), (on,) = run.falls(OUTPUT)[:1], run.rises(OUTPUT)[-1:]
    assert 929 in off.fallen and 929 in on.risen


def test_motors_that_follow_keep_the_output_on() -> None:
    card = load("plc_excess_error")
    card.advance(seconds=SLOW_SCAN_S)
    card.send("PROG0\rX5 Y5 Z5 A5 B5 C5 U5 V5\r")
    assert not card.until(OUTPUT, is_=False, timeout_s=4.0)
    assert [card.axis(axis).commanded_u for axis in range(8)] == [5.0] * 8
