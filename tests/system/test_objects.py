"""Objects addressed by name and number: axes, encoders, DACs, ADCs, masters, drives."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    return Console()


@pytest.mark.req("ACR-CMD-PERIOD", "ACR-PAR-08")
def test_the_servo_period_is_shown_and_scales_the_updates_per_second(card: Console) -> None:
    assert card.type("PERIOD") == "0.0005"
    before = card.card.tick
    card.card.advance(seconds=0.1)
    assert card.card.tick - before == 200
    assert card.type("PERIOD 0.001", "PERIOD") == "0.001"
    before = card.card.tick
    card.card.advance(seconds=0.1)
    assert card.card.tick - before == 100


@pytest.mark.req("ACR-CMD-DRIVE", "ACR-TRB-21")
def test_a_drive_is_switched_and_reported_but_not_in_motion(card: Console) -> None:
    card.type("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"')
    card.type("PPU X1000 Y1000", "SET 8468", "SET 8500", "VEL 1")
    card.card.advance(seconds=0.1)
    assert card.type("DRIVE ON X Y") == ""
    card.card.advance(seconds=0.1)
    assert card.type("DRIVE X", "DRIVE Y") == "DRIVE ON X|DRIVE ON Y"
    assert card.type("DRIVE OFF X", "DRIVE X", "DRIVE RES X", "DRIVE ON X") == "DRIVE OFF X"
    card.card.advance(seconds=0.1)
    card.type("X5")
    card.card.advance(seconds=0.1)
    assert card.type("DRIVE OFF X") == "Not valid while in motion"
    assert card.type("JOG VEL Y1", "JOG FWD Y", "DRIVE OFF Y") == "Not valid while in motion"


@pytest.mark.parametrize(
    "line",
    [
        "CMT0", "CMT0 ON", "CMT0 OFF", "CMT0 MODE 1", "CMT0 OFFSET(0,0)", "CMT0 PPR 1000",
        "CMT0 ENC0 ENC1", "CMT0 DAC0 DAC1", "CMT0 ADC0 ADC1", "ATTACH AXIS0 ENC0 CMT0 ENC0",
    ],
)  # fmt: skip
def test_an_acr8000_has_no_commutators(line: str) -> None:
    assert Console("ACR8000").type(line) == "Invalid argument"
    assert Console("ACR8010").type(line) != "Invalid argument"
    last, beyond = line.replace("CMT0", "CMT7"), line.replace("CMT0", "CMT8")
    assert Console("ACR8010").type(last) != "Invalid argument"
    assert Console("ACR8010").type(beyond) == "Invalid argument"


@pytest.mark.req("ACR-EVAL-14")
def test_random_numbers_make_patterns_of_the_outputs(card: Console) -> None:
    seen = {card.type("P4097=RND(4294967295)", "?P4097") for _ in range(20)}
    assert len(seen) == 20
    bits = [int(value) for value in seen]
    assert any(value < 0 for value in bits)  # bit 31 too
    assert all(-(1 << 31) <= value < 1 << 31 for value in bits)
