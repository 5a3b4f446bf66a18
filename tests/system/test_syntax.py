"""How commands are written: case, signs, expressions, several axes, reports."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    """A card at PROG0 with the axes X and Y."""
    console = Console()
    console.type("DIM P(100)", "DIM DEF(5)", "PROG0", "ATTACH MASTER0")
    console.type('ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"', "PPU X1000 Y1000")
    console.type("VEL 100", "ACC 0", "DEC 0", "STP 0")
    return console


@pytest.mark.req("ACR-SYN-04")
def test_flash_needs_its_word() -> None:
    card = Console()
    assert card.type("SYS", "FLASH") == "Syntax error"
    assert card.type("FLASH BURN") == "Syntax error"
    for word in ("SAVE", "LOAD", "IMAGE", "RES", "ERASE"):
        assert card.type(f"FLASH {word}") != "Syntax error", word


@pytest.mark.req("ACR-PAR-14")
def test_aliases_stand_for_parameters_and_bits_everywhere(card: Console) -> None:
    card.type("#DEFINE Speed P5", "#DEFINE Lamp BIT33", "Speed=7", "SET Lamp")
    assert card.type("?Speed", "?P5", "?BIT33", "?Lamp") == "7|7|-1|-1"
    assert card.type("VEL (Speed*2)", "VEL", "CLR Lamp", "?BIT33") == "14|0"
    card.program(0, "IF (Lamp) THEN P6=1", "IF (NOT Lamp) THEN P6=2")
    card.type("RUN")
    card.card.advance(seconds=0.05)
    assert card.type("?P6") == "2"
