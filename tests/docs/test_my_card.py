"""The page of a machine that exists: every command in order, on a card that is served."""

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests import warm
from tests.docs.conversation import conversations, matches, openacr

from openacr.cli.commands import COMMANDS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "my-card.md").read_text(encoding="utf-8")
ADDRESS = "192.168.10.40"
DIFFERS = "different: "


@pytest.fixture
def card() -> Iterator[str]:
    """The card of the page: a gantry with normally closed limit switches."""
    ports = ["--ascii-port", "0", "--binary-port", "0", "--status-port", "0"]
    words = ["serve", str(ROOT / "examples" / "gantry"), "--no-journal", *ports]
    with warm.Popen(words, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        yield server.stdout.readline().split("ascii=")[1].split()[0]
        server.terminate()
        server.wait(60)


@pytest.mark.timeout(300)
def test_every_command_of_the_page_prints_what_it_shows(card: str, tmp_path: Path) -> None:
    for command, shown in conversations(PAGE):
        words = command.split()
        assert words[0] == "openacr", command
        if words[1] != "ip":
            words = [word.replace(ADDRESS, card) for word in words]
        typed = "".join(f"{re.sub(r'^SYS>', '', line)}\n" for line in shown if line != "SYS>")
        result = openacr(words[1:], tmp_path, typed)
        printed = result.stdout.replace(card, ADDRESS)
        assert matches(shown, printed.rstrip("\n") + "\n"), f"$ {command}\n{printed}"
        is_different = any(line.startswith(DIFFERS) for line in shown)
        assert result.returncode == int(is_different), printed
    assert (tmp_path / "mine" / "motion.html").stat().st_size > 1000


def test_every_command_the_page_names_exists() -> None:
    named = set(re.findall(r"`openacr ([a-z]+)", PAGE))
    assert named <= set(COMMANDS)
    assert len(named) > 2
