"""Objects addressed by name and number: axes, encoders, DACs, ADCs, masters, drives."""

import pytest
from tests.system.terminal import Console


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
