"""The pieces of docs/adding-a-command.md make commands that answer as the page shows."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.controller.hosts import Host

from openacr import Controller
from openacr.basic.language import grammar, registry
from openacr.basic.language.registry import Node

TEXT = (Path(__file__).parents[2] / "docs" / "adding-a-command.md").read_text(encoding="utf-8")
PIECES = re.findall(r"^```python\n(.*?)^```\n\n```text\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
PROMPT = re.compile(r"^(SYS|P\d\d|PLC\d)>")


def copied(node: Node) -> Node:
    return Node({word: copied(each) for word, each in node.children.items()}, node.command)


@pytest.fixture(autouse=True)
def own_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands of a piece are forgotten after its test."""
    monkeypatch.setattr(registry, "root", copied(registry.root))
    monkeypatch.setattr(registry, "_commands", dict(registry._commands))


def exchanges(dialogue: str) -> Iterator[tuple[str, str]]:
    """Each typed line with its prompt, and the lines that answer it."""
    typed, answer = "", ""
    for line in [*dialogue.splitlines(), "SYS>"]:
        if PROMPT.match(line):
            if typed:
                yield typed, answer
            typed, answer = line, ""
        else:
            answer += line + "|"


@pytest.mark.parametrize(("piece", "dialogue"), PIECES, ids=["command", "wait", "values"])
def test_a_piece_makes_the_commands_its_dialogue_shows(piece: str, dialogue: str) -> None:
    exec(compile(piece, "piece of adding-a-command.md", "exec"), {"__name__": "piece"})
    card = Controller()
    card.advance(seconds=0.25)
    host = Host(card)
    prompt = host.send("\r").removeprefix("|")
    for typed, answer in exchanges(dialogue):
        assert typed.startswith(prompt), typed
        heard = host.type(typed.removeprefix(prompt))
        prompt = heard.rpartition("|")[2]
        assert heard.removesuffix(prompt) == answer, typed


def test_the_table_of_arguments_names_what_there_is() -> None:
    table = TEXT.partition("## The arguments")[2].partition("\n## ")[0]
    forms = re.findall(
        r"`([A-Z]\w+)\(", "".join(row.split("|")[1] for row in re.findall(r"^\|.*", table, re.M))
    )
    assert len(forms) > 15
    assert [form for form in forms if not hasattr(grammar, form)] == []


def test_every_file_the_page_names_exists() -> None:
    source = Path(__file__).parents[2] / "src" / "openacr"
    named = set(re.findall(r"`(?:src/openacr/)?((?:basic|motion)/[\w/]+\.py)`", TEXT))
    assert len(named) >= 4
    assert [each for each in named if not (source / each).is_file()] == []
