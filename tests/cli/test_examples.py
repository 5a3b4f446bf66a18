"""`openacr examples`: listed, completed, copied, never over anything."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr import wording
from openacr.cli.main import app
from openacr.starter.supplied import examples

ROOT = Path(__file__).parents[2]
FOLDERS = [path.name for path in (ROOT / "examples").iterdir() if path.is_dir()]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def command(*words: str) -> Result:
    return CliRunner().invoke(app, ["examples", *words])


def test_every_example_is_listed_with_the_title_of_its_readme() -> None:
    lines = command("list").stdout.splitlines()
    assert [line.split()[0] for line in lines] == sorted([*FOLDERS, "parts"])
    assert "gantry            Camera gantry: the tutorial machine of the programming guide" in lines
    assert command().stdout == command("list").stdout
    assert all(each.title for each in examples())


def test_the_list_as_json_names_the_files() -> None:
    found = {each["name"]: each for each in json.loads(command("list", "--json").stdout)}
    assert found["gantry"] == {
        "name": "gantry",
        "title": "Camera gantry: the tutorial machine of the programming guide",
        "files": [
            "README.md", "configure.toml", "machine.toml", "prog0.8k", "prog1.8k",
            "scenario.toml", "settings.toml", "setup.8k",
        ],
    }  # fmt: skip


def test_options_without_a_sub_command_are_those_of_the_list() -> None:
    meant = command("--json")
    assert (meant.exit_code, meant.stdout) == (0, command("list", "--json").stdout)
    assert "copy" in command("-h").stdout


def test_an_example_is_copied_under_its_name_and_runs(folder: Path) -> None:
    result = command("copy", "square")
    assert result.exit_code == 0
    source = ROOT / "examples" / "square"
    assert result.stdout.split() == sorted(
        f"square{os.sep}{path.name}" for path in source.iterdir()
    )
    assert result.stderr == "run it: openacr run square\n"
    for path in source.iterdir():
        assert (folder / "square" / path.name).read_bytes() == path.read_bytes()
    assert CliRunner().invoke(app, ["run", "square", "--quiet"]).exit_code == 0


def test_part_programs_are_copied_without_a_word_about_run() -> None:
    result = command("copy", "parts", "mine", "--json")
    files = json.loads(result.stdout)
    assert files["folder"] == "mine" and "plate.nc" in files["files"]
    assert command("copy", "parts").stderr == ""


@pytest.mark.parametrize("is_folder", [True, False])
def test_nothing_is_overwritten(folder: Path, is_folder: bool) -> None:
    if is_folder:
        (folder / "mine").mkdir()
    else:
        (folder / "mine").touch()
    result = command("copy", "square", "mine")
    assert result.exit_code == 2
    assert result.stderr == "error: mine is there already; nothing is replaced\n"
    assert [path.name for path in folder.rglob("*")] == ["mine"]


def test_a_name_that_is_not_there_gets_those_that_are() -> None:
    result = command("copy", "../examples/square")
    assert result.exit_code == 2
    assert "there is no such example; there are basic_motion, brushless, " in result.stderr
    assert command("copy", "square", "nowhere/mine").stderr == (
        "error: nowhere/mine: there is no folder nowhere\n"
    )


def test_an_error_while_copying_leaves_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(source: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(shutil, "copyfile", full)
    result = command("copy", "square")
    assert result.stderr == "error: square: cannot be written: no space left on device\n"
    assert list(folder.iterdir()) == []


def test_names_are_completed() -> None:
    environment = os.environ | {
        "_OPENACR_COMPLETE": "complete_bash", "COMP_WORDS": "openacr examples copy ga",
        "COMP_CWORD": "3",
    }  # fmt: skip
    words = [sys.executable, "-c", "from openacr.cli.main import app; app(prog_name='openacr')"]
    found = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    assert found.stdout.split() == ["gantry", "gantry_lock"]


def test_a_folder_with_a_space_is_shown_in_quotes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wording, "WINDOWS", False)
    assert command("copy", "square", "my mill").stderr == "run it: openacr run 'my mill'\n"
