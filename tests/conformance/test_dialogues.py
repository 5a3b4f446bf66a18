"""Dialogues with the card, character by character as a terminal shows them.

A file holds what the screen shows: lines behind a prompt are typed, the others are answers.
Lines with a semicolon in front are stage directions: `; type LINE` types a line whose answer
does not matter, `; wait SECONDS` lets time pass, everything else is a remark.
"""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from openacr import Controller

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
        expected = shown = ""
        words = line[1:].split(maxsplit=1)
        if words[:1] == ["wait"]:
            card.advance(seconds=float(words[1]))
        elif words[:1] == ["type"]:
            answer = say(card, words[1])
            prompt = answer[answer.rfind("\n") + 1 :]
    yield expected, shown


@pytest.mark.parametrize(
    "name",
    [
        "cams",
        "expressions",
        "filters",
        "gear_source",
        "kill_flags",
        pytest.param("list", marks=pytest.mark.req("ACR-FLOW-11", "ACR-FLOW-12")),
        "parsing",
        "plc",
        "profile_times",
        "ratchet",
        "run_all",
        "setpoints",
        "vectors",
    ],
)
def test_the_card_answers_as_written(name: str) -> None:
    for expected, shown in screens((FOLDER / f"{name}.txt").read_text()):
        assert shown == expected


def test_every_dialogue_is_held() -> None:
    assert len(list(FOLDER.glob("*.txt"))) == 13
