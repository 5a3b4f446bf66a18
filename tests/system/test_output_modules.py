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


def attached(card: Console, axis: int) -> str:
    """How an axis is attached."""
    return card.type("ATTACH").split("|")[axis]


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


def test_a_project_sets_its_card_up_and_restarts_it(tmp_path: Path) -> None:
    (tmp_path / "setup.8k").write_text("CONFIG NONE STEPPER4 STEPPER4 NONE\n")
    card = Controller.from_project(tmp_path)
    card.send("\r".join((*STEPPER_AXIS, "ATTACH AXIS0 STEPPER7 STEPPER7", "X5", "")))
    card.advance(seconds=2)
    assert card.p[6268] == 500
