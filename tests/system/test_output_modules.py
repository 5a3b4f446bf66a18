"""CONFIG and the set-up of servo, stepper and commutated axes in the guide's examples."""

from pathlib import Path

import pytest
from tests.system.terminal import Console

from openacr import Controller

NOTICE = "CONFIG acts after ESAVE and REBOOT"


@pytest.fixture
def card() -> Console:
    return Console()


def test_config_says_that_it_is_not_in_effect_yet(card: Console) -> None:
    assert card.type("CONFIG ENC4 DAC4 STEPPER4 NONE") == NOTICE
    assert card.type("CONFIG CLEAR") == "", "what the card has"
    for other in ("ENC6 DAC4 DAC4 ADC8", "ENC8 DAC2 DAC4 ADC8", "ENC8 DAC4 DAC4 NONE",
                  "ENC8 DACSTEP4 DAC4 ADC8"):  # fmt: skip
        assert card.type(f"CONFIG {other}") == NOTICE
    assert card.type("CONFIG", "ESAVE") == "CONFIG ENC8 DACSTEP4 DAC4 ADC8"
    card.type("REBOOT")
    card.card.advance(1)
    card.type("ECHO 4")
    assert card.type("CONFIG ENC8 DACSTEP4 DAC4 ADC8") == ""
    assert card.type("CONFIG CLEAR") == NOTICE


def set_up(card: Console, *lines: str) -> None:
    """Lines that the card takes without a word."""
    assert card.type(*lines) == ""


def attached(card: Console, axis: int) -> str:
    """How an axis is attached."""
    return card.type("ATTACH").split("|")[axis]


@pytest.mark.req("ACR-OUTMOD-06", "ACR-OUTMOD-07")
def test_small_controllers_mix_servo_and_stepper_on_one_module(card: Console) -> None:
    assert card.type("CONFIG ENC3 DAC2 NONE ADC8") == NOTICE
    set_up(card, "ATTACH AXIS0 ENC0 DAC0", "ATTACH AXIS1 ENC1 DAC1")
    assert card.type("CONFIG ENC3 DACSTEP2 NONE ADC8") == NOTICE
    set_up(card, "ATTACH AXIS1 STEPPER0 STEPPER0")
    assert card.type("CONFIG") == "CONFIG ENC3 DACSTEP2 NONE ADC8"
    assert attached(card, 0) == "ATTACH AXIS0 ENC0 DAC0 ENC0"
    assert attached(card, 1) == "ATTACH AXIS1 STEPPER0 STEPPER0 STEPPER0"


@pytest.mark.req("ACR-OUTMOD-08")
def test_two_arguments_take_the_position_source_for_the_velocity_too(card: Console) -> None:
    set_up(card, "ATTACH AXIS2 ENC5 DAC2")
    assert attached(card, 2) == "ATTACH AXIS2 ENC5 DAC2 ENC5"


STEPPER_AXIS = (
    *("ATTACH AXIS0 STEPPER0 STEPPER0", "PROG0", "ATTACH MASTER0"),
    *('ATTACH SLAVE0 AXIS0 "X"', "PPU X100", "VEL 10"),
)


def restarted(modules: str) -> Controller:
    """A card that has been configured and restarted."""
    card = Controller()
    card.send(f"CONFIG {modules}\rESAVE\rREBOOT\r")
    card.advance(1)
    return card


@pytest.mark.req("ACR-OUTMOD-09")
def test_a_stepper_axis_counts_its_own_steps() -> None:
    card = restarted("ENC4 STEPPER4 DAC4 NONE")
    card.send("\r".join((*STEPPER_AXIS, "X5", "")))
    card.advance(seconds=2)
    assert card.p[12290] == 500  # actual position
    assert card.axis(0).following_error == 0


@pytest.mark.req("ACR-TRB-13")
def test_a_stepper_axis_moves_only_where_config_has_steppers() -> None:
    card = Controller()
    card.send("CONFIG ENC4 STEPPER4 DAC4 NONE\r")  # not yet restarted
    card.send("\r".join((*STEPPER_AXIS, "X5", "")))
    card.advance(seconds=2)
    assert (card.p[6156], card.p[12290], card.p[12288]) == (0, 0, 500)
    card = restarted("ENC4 STEPPER4 DAC4 NONE")
    card.send("\r".join((*STEPPER_AXIS, "X5", "")))
    card.advance(seconds=2)
    assert (card.p[6156], card.p[12290]) == (500, 500)
    assert card.p[12304] == pytest.approx(0.002441406)
    assert not any(card.p[12304 + row] for row in range(1, 12))


def test_a_project_sets_its_card_up_and_restarts_it(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("CONFIG NONE STEPPER4 STEPPER4 NONE\n")
    card = Controller.from_project(tmp_path)
    card.send("\r".join((*STEPPER_AXIS, "ATTACH AXIS0 STEPPER7 STEPPER7", "X5", "")))
    card.advance(seconds=2)
    assert card.p[6268] == 500
