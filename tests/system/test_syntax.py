"""Words that a command needs."""

import pytest
from tests.system.terminal import Console


@pytest.mark.req("ACR-SYN-04")
def test_flash_needs_its_word() -> None:
    card = Console()
    assert card.type("SYS", "FLASH") == "Syntax error"
    assert card.type("FLASH BURN") == "Syntax error"
    for word in ("SAVE", "LOAD", "IMAGE", "RES", "ERASE"):
        assert card.type(f"FLASH {word}") != "Syntax error", word
