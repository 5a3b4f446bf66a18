"""CONFIG and the set-up of servo, stepper and commutated axes in the guide's examples."""

from pathlib import Path

import pytest
from tests.system.terminal import Console

from openacr import Controller

DEFAULT = "CONFIG ENC8 DAC4 DAC4 ADC8"
NOTICE = "CONFIG acts after ESAVE and REBOOT"


@pytest.fixture
def card() -> Console:
    return Console()


def accepts(card: Console, modules: str) -> bool:
    """Whether CONFIG takes these modules and shows them afterwards."""
    said = card.type(f"CONFIG {modules}")
    shown = card.type("CONFIG")
    is_taken = said in ("", NOTICE)
    assert is_taken == (shown == f"CONFIG {modules}"), (said, shown)
    return is_taken


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


@pytest.mark.req("ACR-CFG-01", "ACR-CFG-02", "ACR-CFG-08")
@pytest.mark.parametrize("model", ["ACR9000", "ACR8020", "ACR1505"])
def test_a_new_card_has_a_configuration(model: str) -> None:
    assert Console(model).type("CONFIG") == DEFAULT


@pytest.mark.req("ACR-CFG-02", "ACR-CFG-03")
def test_a_new_configuration_is_reported_and_clear_brings_the_old_one_back(card: Console) -> None:
    assert accepts(card, "ENC4 DAC4 STEPPER4 NONE")
    assert card.type("CONFIG CLEAR", "CONFIG") == DEFAULT
    assert card.type("CONFIG ENC8 DAC4") == "Syntax error"


@pytest.mark.req("ACR-CFG-04")
def test_the_encoder_argument_has_seven_words(card: Console) -> None:
    for word in ("NONE", "ENC2", "ENC3", "ENC4", "ENC6", "ENC8", "ENC10"):
        assert accepts(card, f"{word} DAC4 DAC4 ADC8"), word
    for word in ("ENC1", "ENC5", "ENC7", "ENC9", "ENC11", "DAC4"):
        assert not accepts(card, f"{word} DAC2 DAC4 ADC8"), word


@pytest.mark.req("ACR-CFG-05")
def test_module_0_takes_dacs_steppers_or_both(card: Console) -> None:
    for word in ("NONE", "DAC2", "DAC4", "STEPPER2", "STEPPER4", "DACSTEP2", "DACSTEP4"):
        assert accepts(card, f"ENC8 {word} DAC4 ADC8"), word
    for word in ("DAC3", "ADC8", "ENC8", "STEPPER8"):
        assert not accepts(card, f"ENC8 {word} DAC2 ADC8"), word


@pytest.mark.req("ACR-CFG-06")
def test_module_1_takes_dacs_or_steppers(card: Console) -> None:
    for word in ("NONE", "DAC2", "DAC4", "STEPPER2", "STEPPER4"):
        assert accepts(card, f"ENC8 DAC4 {word} ADC8"), word
    for word in ("DACSTEP2", "DACSTEP4", "ADC8"):
        assert not accepts(card, f"ENC8 DAC2 {word} ADC8"), word


@pytest.mark.req("ACR-CFG-07")
def test_module_2_takes_analog_inputs_or_nothing(card: Console) -> None:
    assert accepts(card, "ENC8 DAC4 DAC4 NONE")
    assert accepts(card, "ENC8 DAC4 DAC4 ADC8")
    for word in ("DAC4", "ADC4", "STEPPER2"):
        assert not accepts(card, f"ENC8 DAC2 DAC4 {word}"), word


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


@pytest.mark.req("ACR-CFG-09")
def test_hardware_that_config_does_not_name_reads_0_and_is_not_driven() -> None:
    card = restarted("ENC4 DAC4 NONE NONE")
    lines = [f'ATTACH SLAVE{n} AXIS{n + 3} "{name}"' for n, name in enumerate("XY")]
    assert "not" not in card.send("\r".join(("PROG0", "ATTACH MASTER0", *lines, "")))
    card.send("PPU X1000 Y1000\rVEL 10\rX1 Y1\rP6464=5\r")
    card.advance(seconds=1)
    assert (card.p[6192], card.p[12290 + 3 * 256]) == (1000, 1000)  # encoder 3, axis 3
    assert (card.p[6208], card.p[12290 + 4 * 256]) == (0, 0)
    assert card.p[12288 + 4 * 256] == 1000  # commanded all the same
    assert card.p[6464] == 0  # analog output 4
    assert card.p[12288 + 4 * 256 + 31] > 2  # the servo loop has its output


def test_a_project_sets_its_card_up_and_restarts_it(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("CONFIG NONE STEPPER4 STEPPER4 NONE\n")
    card = Controller.from_project(tmp_path)
    card.send("\r".join((*STEPPER_AXIS, "ATTACH AXIS0 STEPPER7 STEPPER7", "X5", "")))
    card.advance(seconds=2)
    assert card.p[6268] == 500
