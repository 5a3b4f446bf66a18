"""Attachments: feedback and output of axes, masters and slaves of programs."""

import pytest
from tests.system.terminal import Console


@pytest.mark.req("ACR-ATT-03")
@pytest.mark.parametrize("word", ["ENC", "ADC", "STEPPER"])
@pytest.mark.parametrize(("model", "steppers"), [("ACR9000", 8), ("ACR8020", 16)])
def test_the_position_is_any_encoder_analog_input_or_stepper_of_the_card(
    word: str, model: str, steppers: int
) -> None:
    console = Console(model)
    count = {"ENC": 20, "ADC": 16, "STEPPER": steppers}[word]
    for number in range(count):
        given = f"{word}{number} {f'STEPPER{number}' if word == 'STEPPER' else 'DAC2'}"
        assert console.type(f"ATTACH AXIS2 {given}") == ""
        shown = console.type("ATTACH").split("|")[2]
        assert shown == f"ATTACH AXIS2 {given} {word}{number}"
    assert console.type(f"ATTACH AXIS2 {word}{count} DAC2") == "Invalid argument"
