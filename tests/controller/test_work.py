"""What one host asks for is dealt with in slices: others are served between."""

from collections.abc import Iterator

import pytest
from tests.controller.hosts import Host

from openacr.basic.commands.program_control import SHOWN_LINE_WORK, WORK_PER_SLICE

LINES = 230
SLICE_TICKS = 2
PER_SLICE = WORK_PER_SLICE // SHOWN_LINE_WORK
BODY = ("IF (BIT1)", *(f"SET {number}" for number in range(128, 128 + LINES)), "ENDIF")
SHOWN = ["PROGRAM", " IF (BIT 1)", *(f"  {line}" for line in BODY[1:-1]), "  ENDIF", "ENDP"]


@pytest.fixture
def long(host: Host) -> Host:
    """A host at a program of many lines."""
    host.type("PROG0", "PROGRAM", *BODY, "ENDP")
    return host


def slices(host: Host, line: str) -> Iterator[str]:
    """The answer, one time slice after the other, until the prompt."""
    heard = host.send(line + "\r").removeprefix(line + "|")
    yield heard
    while not heard.endswith("P00>"):
        heard = host.after(SLICE_TICKS)
        yield heard


def test_a_long_list_comes_slice_by_slice_and_is_complete(long: Host) -> None:
    answers = list(slices(long, "LIST"))
    assert "".join(answers) == "".join(f"{line}|" for line in SHOWN) + "P00>"
    assert len(answers) == -(-len(SHOWN) // PER_SLICE)
    assert all(answer.count("|") == PER_SLICE for answer in answers[:-1])
    assert long.type("LIST 10,30") == f"{SHOWN[0]}|{SHOWN[1]}|{SHOWN[2]}|P00>"
    assert long.type("LIST 20 : LIST 20") == f"{SHOWN[1]}|{SHOWN[1]}|P00>", "each from its start"


def test_a_range_of_a_list_keeps_the_depth_of_its_blocks(long: Host) -> None:
    wanted = f"{SHOWN[200]}|{SHOWN[201]}|P00>"
    assert "".join(slices(long, "LIST 2010-2020")) == wanted
    assert long.type("LIST 2010-2020") == wanted, "what is known is passed over at once"
    number = 10 * len(SHOWN)
    assert long.type(f"LIST {number}") == f"{SHOWN[-1]}|P00>"


def test_another_host_is_answered_while_a_list_goes_on(long: Host) -> None:
    other = Host(long.card)
    long.send("LIST\rVER\r")
    assert other.ask("?BIT1") == "0"
    assert other.send("\x18") == ""
    heard = long.after(SLICE_TICKS * 20)
    assert heard.count("P00>") == 2, "the next line follows the list"


def test_a_list_goes_on_in_a_snapshot(long: Host) -> None:
    answers = slices(long, "LIST")
    heard = next(answers)
    kept = long.card.snapshot()
    rest = "".join(answers)
    long.card.restore(kept)
    again = ""
    while not again.endswith("P00>"):
        again += long.after(SLICE_TICKS)
    assert again == rest
    assert heard + rest == "".join(f"{line}|" for line in SHOWN) + "P00>"


def test_a_list_that_is_broken_off_leaves_nothing_to_the_next_one(long: Host) -> None:
    long.send("LIST\r")
    long.close()
    again = Host(long.card)
    again.type("PROG0")
    assert again.type("LIST 20") == f"{SHOWN[1]}|P00>"
