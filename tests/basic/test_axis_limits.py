"""Bands, limit switches and software limits by command."""

import pytest
from tests.basic.motion_bench import Bench


def bench(*lines: str) -> Bench:
    """Axes X and Y of 1000 pulses per unit on one master, Z on another."""
    made = Bench("X", "Y")
    made.attach(1, (2, "Z"))
    made.all("PPU X1000 Y1000", "PPU AXIS2 1000", "ACC 0 DEC 0 STP 0 VEL 10")
    made.all("JOG ACC X0 Y0 : JOG DEC X0 Y0 : JOG VEL X10 Y10")
    return made.all(*lines)


# software limits


def test_what_follows_a_source_is_stopped_again_beyond_a_software_limit() -> None:
    made = bench("SLM X(1,-1)", "SLIM X3", "SLDEC X10000", "GEAR SRC X P12550", "GEAR PPU X1000")
    made.all("JOG FWD Y", "GEAR ON X").seconds(0.5)
    place = made.psp(0)
    assert 1000 <= place < 1020
    made.all("CLR 522", "JOG FWD Y", "GEAR ON X").ticks(40)
    assert place < made.psp(0) < place + 30
    assert made.type("AXIS0 GEAR") == "OFF"


def test_the_jog_flag_starts_no_jog_farther_out() -> None:
    made = bench("SLM X(1,-1)", "SLIM X3", "JOG FWD X").seconds(0.5)
    place = made.psp(0)
    made.all("CLR 522", "SET 796").ticks(20)
    assert (made.psp(0), made.bit(796)) == (place, False)
    made.all("SET 797").ticks(20)
    assert made.psp(0) == pytest.approx(place - 100)


def test_a_software_limit_switched_off_bars_nothing() -> None:
    made = bench("SLM X(1,-1)", "SLIM X3", "JOG FWD X").seconds(0.5)
    assert made.type("JOG FWD X") == "Soft limit"
    made.all("SLIM X0").ticks(1)
    made.all("JOG FWD X").ticks(20)
    assert made.psp(0) == pytest.approx(1100, abs=10)


def test_limits_follow_the_units_of_an_axis_with_negative_ppu() -> None:
    made = bench("PPU X-1000", "SLM X(1,-1)", "SLIM X3", "JOG FWD X").seconds(0.5)
    assert made.p(12294) == pytest.approx(-1000, abs=10)
    assert made.type("JOG FWD X") == "Soft limit"
    made.all("JOG REV X").seconds(0.5)
    assert made.p(12294) == pytest.approx(1000, abs=10)
