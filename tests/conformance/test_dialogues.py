"""Dialogues with the card, character by character as a terminal shows them.

A file holds what the screen shows: lines after a prompt are typed, the others are answers.
Lines with a semicolon in front are stage directions: `; type LINE` types a line whose answer
does not matter, `; wait SECONDS` lets time pass, `; press CTRL_Y` presses a key, `; flag 0 1` sets
or clears a flag (an input), `; packet HEX` sends bytes, whose reply is the line `= HEX` below;
everything else is a remark.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from openacr import Controller
from openacr.protocol.events import ControlKey

pytestmark = pytest.mark.evidence("client", "real hosts and the guides: evidence.toml")

FOLDER = Path(__file__).parent / "dialogues"
PATIENCE_TK = 40_000
TYPED = re.compile(r"((?:SYS|P\d\d|PLC\d)>)(.*)")


def say(card: Controller, line: str) -> str:
    """Type a line; what the card sends up to its prompt."""
    shown = card.send(f"{line}\r")
    for _ in range(PATIENCE_TK):
        if shown.endswith(">"):
            break
        card.advance(1)
        shown += card.take_output(card.console).decode("latin-1")
    return shown.replace("\r\n", "\n")


def exchange(card: Controller, packet: str) -> str:
    """Send the bytes of a packet; the line that shows the reply."""
    card.receive(card.console, bytes.fromhex(packet))
    card.advance(1)
    return f"= {card.take_output(card.console).hex(' ').upper()}".rstrip() + "\n"


def direct(card: Controller, verb: str, what: str) -> str:
    """Follow a stage direction; what is shown of it."""
    match verb:
        case "wait":
            card.advance(seconds=float(what))
        case "press":
            card.press(ControlKey[what])
        case "flag":
            number, state = map(int, what.split())
            card.bit[number] = bool(state)
        case "packet":
            return exchange(card, what)
    return ""


def screens(text: str) -> Iterator[tuple[str, str]]:
    """The dialogue as it stands in the file and as it is held with a card, part by part."""
    card = Controller()
    prompt = "SYS>"
    expected = shown = ""
    for line in text.splitlines():
        if not line.startswith(";"):
            expected += f"{line}\n"
            if typed := TYPED.fullmatch(line):
                answer = say(card, typed[2])
                shown += prompt + answer[: answer.rfind("\n") + 1]
                prompt = answer[answer.rfind("\n") + 1 :]
            continue
        yield expected, shown
        verb, _, what = line[1:].strip().partition(" ")
        expected, shown = "", direct(card, verb, what)
        if verb == "type":
            answer = say(card, what)
            prompt = answer[answer.rfind("\n") + 1 :]
    yield expected, shown


@pytest.mark.parametrize(
    "name",
    [
        "buffered_moves",
        "cams",
        "curves",
        "expressions",
        "feed_hold",
        "filters",
        "gear_source",
        "homing",
        "kill_flags",
        "limit_recovery",
        pytest.param("list", marks=pytest.mark.req("ACR-FLOW-11", "ACR-FLOW-12")),
        "parsing",
        "plc",
        "profile_times",
        "ratchet",
        "run_all",
        "setpoints",
        "startup_scanner",
        "startup_stage",
        "status",
        "vectors",
    ],
)
def test_the_card_answers_as_written(name: str) -> None:
    for expected, shown in screens((FOLDER / f"{name}.txt").read_text()):
        assert shown == expected


def test_every_dialogue_is_held() -> None:
    assert len(list(FOLDER.glob("*.txt"))) == 21
