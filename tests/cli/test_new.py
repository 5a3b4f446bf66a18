"""`openacr new`: options, questions, and what is never overwritten."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr import wording
from openacr.cli import new as command
from openacr.cli.main import app

FILES = [
    ".gitignore", "README.md", "configure.toml", "machine.toml", "prog0.8k", "prog15.8k",
    "scenario.toml", "setup.8k", "test_machine.py",
]  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def new(*words: str, typed: str = "") -> Result:
    return CliRunner().invoke(app, ["new", *words], input=typed)


def test_without_a_terminal_nothing_is_asked_and_the_defaults_are_taken(folder: Path) -> None:
    result = new("mine")
    assert result.exit_code == 0
    assert result.stdout.split() == [os.path.join("mine", name) for name in FILES]
    assert result.stderr == "run it: openacr run mine\n"
    assert sorted(path.name for path in folder.rglob("*")) == sorted([*FILES, "mine"])


def test_the_options_are_in_the_json(folder: Path) -> None:
    words = ("--kind", "gantry", "--axes", "XY", "--units", "in", "--travel", "10", "--limits")
    more = ("soft", "--homing", "switch", "--inputs", "start, door", "--plc", "--json")
    result = new("mine", *words, *more)
    assert json.loads(result.stdout) == {
        "folder": "mine", "files": sorted([*FILES, "plc0.8k"]), "kind": "gantry",
        "axes": ["X", "Y"], "units": "in", "travel": 10.0, "limits": "soft",
        "homing": "switch", "inputs": ["start", "door"], "plc": True,
    }  # fmt: skip
    assert result.stderr == ""


def test_axes_are_single_letters_or_names_between_commas() -> None:
    assert json.loads(new("a", "--axes", "XYZ", "--json").stdout)["axes"] == ["X", "Y", "Z"]
    found = json.loads(new("b", "--axes", "x, FEED", "--json").stdout)["axes"]
    assert found == ["X", "FEED"]
    assert json.loads(new("c", "--axes", "FEED,", "--json").stdout)["axes"] == ["FEED"]


def test_questions_take_defaults_and_ask_again_after_a_wrong_answer() -> None:
    typed = "gantry\nX,X\nXY\nmm\n1\nfar\n300\nsoft\n\nstart\ny\n"
    result = new("mine", "--ask", typed=typed)
    assert result.exit_code == 0, result.output
    assert "--axes: X is there twice" in result.stderr
    assert "--travel: 1 mm; give 20 to 10000 mm" in result.stderr
    assert "--travel far: give a number, with or without a unit" in result.stderr
    machine = Path("mine/machine.toml").read_text()
    assert "travel = [-12.5, 312.5]" in machine and "positive_limit" not in machine
    assert "MSEEK" in Path("mine/prog0.8k").read_text()  # the homing of a gantry by default
    assert Path("mine/plc0.8k").exists()


def test_what_an_option_gives_is_not_asked() -> None:
    words = ("--kind", "mill", "--axes", "XYZ", "--units", "mm", "--travel", "100", "--limits")
    given = (*words, "both", "--homing", "none", "--inputs", "", "--no-plc", "--ask")
    result = new("mine", *given)
    assert result.exit_code == 0, result.output
    assert Path("mine/machine.toml").exists()


def test_answers_that_end_are_an_error_and_leave_nothing(folder: Path) -> None:
    result = new("mine", "--ask", typed="mill\n")
    assert result.exit_code == 2
    assert "error: the answers end before 'Axes'; --no-ask takes the defaults" in result.stderr
    assert list(folder.iterdir()) == []


def test_a_terminal_is_asked_unless_json_or_no_ask_is_given(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(command, "_is_terminal", lambda: True)
    assert new("a").exit_code == 2
    assert new("a", "--json").exit_code == 0
    assert new("b", "--no-ask").exit_code == 0


def test_an_empty_folder_is_filled(folder: Path) -> None:
    assert new(".").exit_code == 0
    assert sorted(path.name for path in folder.iterdir()) == sorted(FILES)


@pytest.mark.parametrize("other", ["machine.toml", "notes.txt"])
def test_nothing_is_overwritten(folder: Path, other: str) -> None:
    (folder / "mine").mkdir()
    (folder / "mine" / other).write_text("my own")
    result = new("mine")
    assert result.exit_code == 2
    assert result.stderr == (
        "error: mine is there already, and not an empty folder; nothing is replaced\n"
    )
    assert [path.name for path in (folder / "mine").iterdir()] == [other]
    assert (folder / "mine" / other).read_text() == "my own"


def test_a_file_of_the_name_is_left_alone(folder: Path) -> None:
    (folder / "mine").write_text("my own")
    assert new("mine").exit_code == 2
    assert (folder / "mine").read_text() == "my own"


@pytest.mark.parametrize("name", ["a\nb", "-", 'a"b', "a.", "nowhere/mine", "_a"])
def test_names_that_cannot_be_are_refused(folder: Path, name: str) -> None:
    result = CliRunner().invoke(app, ["new", "--json", "--", name])
    assert result.exit_code == 2
    assert json.loads(result.stdout)["errors"][0]["message"]
    assert list(folder.iterdir()) == []


def test_an_error_while_writing_leaves_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "rename", full)
    result = new("mine")
    assert result.exit_code == 2
    assert result.stderr == "error: mine: cannot be written: no space left on device\n"
    assert list(folder.iterdir()) == []


def test_the_test_of_the_project_passes_and_notices_an_error(folder: Path) -> None:
    assert new("mine").exit_code == 0
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "mine"]
    passed = subprocess.run(words, capture_output=True, text=True, check=False)
    assert passed.returncode == 0, passed.stdout
    assert "2 passed" in passed.stdout
    with Path("mine/prog0.8k").open("a") as program:
        program.write("FOO\n")
    failed = subprocess.run(words, capture_output=True, text=True, check=False)
    assert "2 failed" in failed.stdout and "Unknown command" in failed.stdout


def test_the_words_of_an_option_are_completed() -> None:
    environment = os.environ | {
        "_OPENACR_COMPLETE": "complete_bash", "COMP_WORDS": "openacr new mine --kind ",
        "COMP_CWORD": "4",
    }  # fmt: skip
    code = "from openacr.cli.main import app; app(prog_name='openacr')"
    words = [sys.executable, "-c", code]
    found = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    assert found.stdout.split() == ["axis", "gantry", "mill", "turntable"]


def test_a_folder_with_a_space_is_shown_in_quotes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wording, "WINDOWS", False)
    assert new("my mill").stderr == "run it: openacr run 'my mill'\n"


def test_a_travel_is_written_with_any_unit_of_its_kind(tmp_path: Path) -> None:
    def made(*options: str) -> Result:
        words = ["new", str(tmp_path / "m"), "--no-ask", "--json", *options]
        return CliRunner().invoke(app, words)

    assert json.loads(made("--travel", "10cm").stdout)["travel"] == 100
    refused = made("--travel", "10s")
    assert refused.exit_code == 2
    refused = CliRunner().invoke(
        app, ["new", str(tmp_path / "n"), "--no-ask", "--units", "in", "--travel", "10s"]
    )
    assert refused.stderr == (
        "error: --travel 10s: give a number, with or without a unit"
        " (um, mm, cm, m, in, inch), such as 8 or 5cm\n"
    )
    two = ["new", str(tmp_path / "o"), "--no-ask", "--json", "--units", "in", "--travel", "25.4cm"]
    assert json.loads(CliRunner().invoke(app, two).stdout)["travel"] == pytest.approx(10)
