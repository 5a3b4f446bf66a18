"""The pages of the first day: every command in order, and all output that they show."""

import os
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import IO

import pytest
from tests import warm
from tests.docs.conversation import ANY, BLOCK, conversations, matches, openacr

from openacr.cli.commands import COMMANDS
from openacr.sysvar import Store
from openacr.sysvar.tabs import HOME

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "first-day.md").read_text(encoding="utf-8")


class Folder:
    """The empty folder of the page, and the server that a command starts in it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.port = ""
        self.server: subprocess.Popen[str] | None = None

    def run(self, command: str, shown: list[str]) -> str:
        words = command.removesuffix(" &").split()
        assert words[0] == "openacr", command
        if command.endswith(" &"):
            return self.serve(words[1:])
        words = [word.replace("127.0.0.1", f"127.0.0.1:{self.port}") for word in words[1:]]
        typed = "".join(f"{re.sub(r'^P00>', '', line)}\n" for line in shown if line != "P00>")
        result = openacr(words, self.path, typed)
        is_refused = any(line.startswith("failed: ") for line in shown)
        assert result.returncode == int(is_refused), result.stdout
        return result.stdout if result.stdout.endswith("\n") else f"{result.stdout}\n"

    def search_slowly(self) -> None:
        """A computer that is loaded stops the axes between switch and limit, too."""
        with Store(self.path / "plate" / "sysvar.db") as store:
            for axis in range(3):
                store.write(HOME.fast_speed[axis], 800.0)

    def serve(self, words: list[str]) -> str:
        """The server, on free ports; it prints those of the page."""
        ports = ["--ascii-port", "0", "--binary-port", "0", "--status-port", "0"]
        self.server = warm.Popen([*words, *ports], cwd=self.path, stdout=subprocess.PIPE, text=True)
        line = self.output().readline()
        found = re.findall(r"127\.0\.0\.1:(\d+)", line)
        self.port = found[0]
        for port, shown in zip(found, ("5002", "5006", "5003"), strict=True):
            line = line.replace(f":{port}", f":{shown}")
        return line

    def output(self) -> IO[str]:
        assert self.server is not None and self.server.stdout is not None
        return self.server.stdout


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Folder]:
    found = Folder(tmp_path)
    yield found
    if found.server is not None:
        found.server.terminate()
        found.server.wait(60)
        found.output().close()


@pytest.mark.timeout(300)
def test_every_command_of_the_tutorial_prints_what_the_page_shows(folder: Folder) -> None:
    files = [text for language, text in BLOCK.findall(PAGE) if language == "toml"]
    (folder.path / "jam.toml").write_text(files[0])
    for command, shown in conversations(PAGE):
        printed = folder.run(command, shown)
        if "sysvar import" in command:
            folder.search_slowly()
        printed = re.sub(r"^0:\d\d  \(", "0:08  (", printed, flags=re.MULTILINE)  # of the computer
        assert matches(shown, printed), f"$ {command}\n{printed}"
    assert os.path.getsize(folder.path / "plate" / "motion.html") > 1000


def test_the_comparison_notices_a_line_that_is_not_printed() -> None:
    assert matches(["a", ANY, "c ..."], "a\nb\nb\nc 1\n")
    assert matches([ANY, "c"], "c  \n")
    assert not matches(["a", "c"], "a\nb\nc\n")
    assert not matches(["a", ANY], "b\na\n")
    assert not matches(["a..."], "b\n")


@pytest.mark.parametrize("page", ["first-day.md", "installation.md"])
def test_every_command_named_exists(page: str) -> None:
    named = re.findall(r"`openacr ([a-z]+)", (DOCS / page).read_text(encoding="utf-8"))
    assert set(named) <= set(COMMANDS)
    assert named


def test_the_extras_of_the_installation_are_those_of_the_package() -> None:
    import tomllib

    project = tomllib.loads((DOCS.parent / "pyproject.toml").read_text())["project"]
    page = (DOCS / "installation.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `openacr\[(\w+)\]`", page, re.MULTILINE)) == {
        name for name in project["optional-dependencies"] if name not in ("dev", "site")
    }
    assert f"openacr-{project['version']}-py3-none-any.whl" in page
