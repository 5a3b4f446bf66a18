"""Loops, branches and subroutines as programs on a card run them."""

import pytest
from tests.system.terminal import Console

from openacr.controller import Controller


@pytest.fixture
def card() -> Console:
    console = Console()
    console.type("DIM P(20)")
    return console


def run(card: Console, *lines: str) -> str:
    """What a program prints."""
    card.program(0, *lines)
    return card.listen(0, 0.5)


@pytest.mark.parametrize("prompt", ["SYS", "P03", "PLC1"])
@pytest.mark.parametrize("named", ["PROG2", "PROG 2"])
def test_a_named_program_is_started_and_followed_from_any_prompt(prompt: str, named: str) -> None:
    card = Controller()
    card.send("PROG2\rPROGRAM\rPRINT 7\rDWL 0.1\rPRINT 8\rENDP\r")
    card.send({"SYS": "SYS", "P03": "PROG3", "PLC1": "PLC1"}[prompt] + "\r")
    assert card.send(f"LRUN {named}\r") == f"LRUN {named}\r\n"
    card.advance(seconds=0.2)
    assert card.send("") == f"7\r\n8\r\n{prompt}>"
    card.send(f"LRUN 30 {named}\r")
    card.advance(seconds=0.2)
    assert card.send("") == f"8\r\n{prompt}>", "from a line of it"
    card.send(f"RUN {named}\r")
    assert card.send(f"LISTEN {named}\r") == f"LISTEN {named}\r\n"
    card.advance(seconds=0.2)
    assert card.send("\x1b").endswith(f"8\r\n\r\n{prompt}>")


def test_following_needs_one_program_that_exists() -> None:
    card = Controller()
    for word in ("LRUN", "LISTEN"):
        assert card.send(f"{word}\r") == f"{word}\r\nUnknown command\r\nSYS>"
        assert card.send(f"{word} PLC0\r") == f"{word} PLC0\r\nUnknown command\r\nSYS>"
        assert card.send(f"{word} PROG16\r") == f"{word} PROG16\r\nInvalid argument\r\nSYS>"
    card.send("PLC0\r")
    assert "Not valid at this level" in card.send("LRUN\r")
