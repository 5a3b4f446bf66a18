"""Pages that show commands and what they print: read as data, compared with what is printed."""

import os
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests import warm

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
ANY = "..."


def conversations(page: str) -> list[tuple[str, list[str]]]:
    """Every command of the page with the lines that it shows of the output."""
    found: list[tuple[str, list[str]]] = []
    for language, text in BLOCK.findall(page):
        for line in text.splitlines() if not language else ():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def matches(shown: list[str], printed: str) -> bool:
    """Whether this was printed: `...` is any lines, at the end of a line any rest of it."""
    pattern = ""
    for line in shown:
        if line == ANY:
            pattern += r"(?:.*\n)*?"
        else:
            pattern += re.escape(line.rstrip()).replace(re.escape(ANY), ".*") + r" *\n"
    return re.fullmatch(pattern, printed) is not None


def openacr(words: Sequence[str], folder: Path, typed: str) -> subprocess.CompletedProcess[Any]:
    """Perform a command of a page; only a terminal is typed at. `stdout` is all that it prints."""
    return warm.run(
        words, cwd=folder, text=True, encoding="utf-8", input=typed if words[0] == "term" else "",
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
