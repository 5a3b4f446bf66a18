"""What users get wrong with `openacr mill`: every time one sentence that names it."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app

READERS = ("check", "time", "list", "plot", "run")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "FOLDER").mkdir()
    (tmp_path / "OK.NC").write_text("G1 X1 F10\nM2\n")
    (tmp_path / "BIN.NC").write_bytes(bytes(range(256)) * 40)
    (tmp_path / "ESC.NC").write_bytes(b"G1 X1 \x1b[31m\nM2\n")
    return tmp_path


def mill(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", *words])
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.exit_code, result.output


@pytest.mark.parametrize("command", READERS)
def test_files_that_are_none(command: str) -> None:
    assert mill(command, "NONE.NC") == (2, "error: NONE.NC: no such file\n")
    assert mill(command, "FOLDER") == (2, "error: FOLDER: this is a folder, not a part program\n")


@pytest.mark.parametrize("command", READERS)
def test_bytes_that_are_no_program_are_refused_with_their_place(command: str) -> None:
    code, text = mill(command, "BIN.NC")
    assert code == 2
    said = "BIN.NC:1:2: not a text file: byte 0x01 at offset 1 (part programs are plain text)"
    assert text == f"error: {said}\n"


@pytest.mark.parametrize("command", ["check", "list", "run"])
def test_nothing_in_a_program_steers_the_terminal(command: str) -> None:
    code, text = mill(command, "ESC.NC")
    assert code == 1
    assert "G1 X1 ?[31m" in text
    assert "\x1b[31mM2" not in text


@pytest.mark.parametrize("command", READERS)
def test_looking_makes_no_store(command: str, folder: Path) -> None:
    assert mill(command, "OK.NC")[0] == 0
    assert not (folder / "sysvar.db").exists()
    code, text = mill(command, "OK.NC", "--store", "other.db")
    assert code == 2
    assert "other.db does not exist" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["run", "OK.NC", "--host", ""], "'' is neither HOST, HOST:PORT nor a serial port"),
        (["run", "OK.NC", "--line", "9"], "line 9: the program has lines 1 to 2"),
        (["run", "OK.NC", "--answer", "P5"], "--answer P5: write it as P200=1.5"),
        (
            ["check", "OK.NC", "--dialect", "x"],
            "unknown dialect x: choose one of acromill,",
        ),
        (["plot", "OK.NC", "none/x.png"], "there is no folder none"),
        (["plot", "OK.NC", "FOLDER"], "pictures end in .png, .svg or .html"),
        (["message", "set", "", "--bit", "5"], "a message must be one line of printable text"),
        (["message", "set", "x" * 133, "--bit", "5"], "133 characters: a message has at most 132"),
        (["part", "SLOT", "--set", "P200=99999"], "0.05 to 200 in"),
        (["batch", "BIN.NC"], "BIN.NC: this is no batch file"),
    ],
)
def test_what_is_wrong_is_named(words: list[str], said: str) -> None:
    code, text = mill(*words)
    assert code == 2
    assert said in text
