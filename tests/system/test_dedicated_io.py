"""Limit and home inputs (HLBIT), drive signals."""

import pytest
from tests.system.terminal import Console


@pytest.mark.req("ACR-HLBIT-03")
def test_no_parameter_shows_or_changes_the_assignment() -> None:
    console = Console()
    before = console.card.memory.I[4096:40960].tolist()
    assert console.type("AXIS0 HLBIT 12", "AXIS0 HLBIT") == "12"
    assert console.card.memory.I[4096:40960].tolist() == before
