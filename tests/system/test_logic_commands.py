"""Flags, waits and masks: what programs and terminals do with bits."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    return Console()


@pytest.mark.req("ACR-CMD-SET", "ACR-CMD-CLR", "ACR-PAR-04", "ACR-PAR-05", "ACR-PAR-06")
@pytest.mark.parametrize("on", ["SET 32", "SET BIT32", "BIT32=1"])
@pytest.mark.parametrize("off", ["CLR 32", "CLR BIT32", "BIT32=0"])
def test_bits_are_set_and_cleared_in_three_forms_and_read_as_minus_one_and_zero(
    card: Console, on: str, off: str
) -> None:
    assert card.type(on, "?BIT32", "?P4097") == "-1|1"
    assert card.type(off, "?BIT32", "?P4097") == "0|0"
