"""What a card prints cannot change the user's terminal, whatever command shows it."""

from pathlib import Path

import pytest
from tests.io.served import LOOPBACK, openacr, serving
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.client.lines import split

PRINTS = 'PRINT CHR$(27);"[31mred";CHR$(155);"2J"'


def test_run_shows_escape_sequences_of_a_program(tmp_path: Path) -> None:
    path = tmp_path / "evil.8k"
    path.write_text(f"PROG0\nPROGRAM\nPBOOT\n{PRINTS}\nENDP\n")
    result = CliRunner().invoke(app, ["run", str(path), "--for", "1"])
    assert "^[[31mred<9B>2J" in result.output
    assert "\x1b" not in result.output
    assert "\x9b" not in result.output


def test_a_piped_terminal_shows_escape_sequences_of_a_card() -> None:
    with serving("--no-journal") as served:
        ended = openacr("term", f"{LOOPBACK}:{served.ascii_port}", text=f"{PRINTS}\n")
        assert ended.returncode == 0
        assert "^[[31mred<9B>2J" in ended.stdout
        assert "\x1b" not in ended.stdout


@pytest.mark.parametrize("text", [b"\x1b]0;owned\x07", b"\x9b2J", b"\xc2\x9b2J"])
def test_lines_of_an_answer_have_no_escape_sequences(text: bytes) -> None:
    (line,) = split(text + b"\r\n")
    assert not {"\x1b", "\x9b"} & set(line)
