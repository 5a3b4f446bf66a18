"""The pieces of docs/controller.md run, and the page knows every public call."""

import re
from pathlib import Path

import pytest

from openacr import Controller

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "controller.md").read_text(encoding="utf-8")
PIECES = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
# What serves streams and journals uses these; a program that embeds a card does not need them.
OF_SERVERS = {
    "accepts_input", "beside", "close_stream", "differences", "fast_status", "has_stream", "image",
    "load", "open_stream", "receive", "replying", "take_output", "take_over", "type_lines",
    "console", "is_journalled", "recorder", "owns_console",
}  # fmt: skip


@pytest.mark.parametrize("number", range(len(PIECES)))
def test_a_piece_runs(
    number: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    exec(compile(PIECES[number], "piece of controller.md", "exec"), {})
    assert capsys.readouterr().err == ""


def test_the_page_names_every_call_for_programs() -> None:
    public = {name for name in dir(Controller) if not name.startswith("_")}
    assert public - OF_SERVERS - set(re.findall(r"\w+", TEXT)) == set()


def test_the_page_has_its_pieces() -> None:
    assert len(PIECES) >= 6
