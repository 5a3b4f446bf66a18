"""Errors of programs that run: the file and line of the project they come from."""

import json
import os
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.controller import Controller
from openacr.project import find_project

SETUP = "DIM PROG0(2000)\nDIM PROG2(2000)\n"
# The error is in line 8 of its file: a remark, an empty line and a broken line come before it.
PROGRAM = 'REM first\n\nPBOOT\nDIM LV(3)\nLV0 = (1 +\n    2)\nLV1 = 1/(LV0 - 3)\nPRINT "never"\n'


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "setup.8k").write_text(SETUP)
    (folder / "prog2.8k").write_text(f"PROGRAM\n{PROGRAM}ENDP\n")
    return Path("mine")


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["run", *map(str, arguments)])
    return result.exit_code, result.stdout, result.stderr


def test_a_run_time_error_names_file_and_line_as_the_path_was_given(project: Path) -> None:
    code, _, shown = run(project, "--for", "1")
    assert code == 1
    place = f"mine{os.sep}prog2.8k:8"
    assert f"error: {place}: PROG2 line 60: Divide by zero\n    LV1 = 1/(LV0-3)\n" in shown
    assert f"PROG2: stopped in line 60 ({place}): Divide by zero" in shown


def test_the_absolute_path_is_named_when_it_was_given(project: Path) -> None:
    code, _, shown = run(project.resolve(), "--for", "1")
    assert code == 1
    assert f"error: {project.resolve()}{os.sep}prog2.8k:8: PROG2 line 60: " in shown


def test_the_summary_has_file_and_line_of_the_error(project: Path) -> None:
    _, shown, _ = run(project, "--for", "1", "--json")
    assert json.loads(shown)["programs"]["2"] == {
        "state": "error",
        "line": 60,
        "error": "Divide by zero",
        "file": f"mine{os.sep}prog2.8k",
        "file_line": 8,
    }


def test_lines_with_numbers_are_found_whatever_their_order(tmp_path: Path) -> None:
    file = tmp_path / "a.8k"
    file.write_text("DIM PROG0(1000)\nPROG0\n30 P1 = 1/0\n20 P0 = 1\nSYS\nPROG0\n")
    card, refused = Controller.load(find_project(file))
    assert refused == []
    assert card.origin(0, 30) == (str(file), 3)
    assert card.origin(0, 20) == (str(file), 4)
    assert card.origin(0, 25) is None
    assert card.origin(1, 30) is None


def test_a_line_that_was_typed_since_has_no_place_in_the_file(tmp_path: Path) -> None:
    file = tmp_path / "a.8k"
    file.write_text("DIM PROG0(1000)\nPROG0\n10 P1 = 1\n20 P0 = 1\n")
    card, _ = Controller.load(find_project(file))
    card.send("PROG0\r10 P1 = 2\r20 P0 = 1\r30 P2 = 1\r")
    assert card.origin(0, 10) is None
    assert card.origin(0, 20) == (str(file), 4)
    assert card.origin(0, 30) is None


def test_a_line_deleted_from_the_card_has_no_place(tmp_path: Path) -> None:
    file = tmp_path / "a.8k"
    file.write_text("DIM PROG0(1000)\nPROG0\n10 P1 = 1\n")
    card, _ = Controller.load(find_project(file))
    card.send("PROG0\r10\r")
    assert card.origin(0, 10) is None


def test_lines_of_plcs_have_places_too(tmp_path: Path) -> None:
    file = tmp_path / "a.8k"
    file.write_text("DIM PLC1(500)\nPLC1\n10 LD 0\n20 OUT 32\n")
    card, refused = Controller.load(find_project(file))
    assert refused == []
    assert card.origin(17, 20) == (str(file), 4)


@pytest.mark.parametrize("name", ["run.svg", "run.html"])
def test_a_picture_of_the_run_shows_the_event(project: Path, name: str) -> None:
    code, _, _ = run(project, "--for", "1", "--plot", name)
    assert code == 1
    text = Path(name).read_text(encoding="utf-8")
    assert f"PROG2: stopped in line 60 (mine{os.sep}prog2.8k:8): Divide by zero" in text


@pytest.mark.parametrize("name", ["\udcff", "\x1b[31m\x07", "a$x_{1$b$", "<!--<script>"])
@pytest.mark.parametrize("suffix", [".html", ".png", ".svg"])
def test_no_name_of_a_project_can_spoil_pictures_and_messages(
    project: Path, name: str, suffix: str
) -> None:
    folder, picture = project.rename(name), Path(f"p{suffix}")
    code, out, err = run(folder, "--for", "1", "--json", "--plot", picture)
    assert code == 1
    assert not {"\x1b", "\x07"} & set(out + err)
    shown = name.replace("\udcff", "?").replace("\x1b", "^[").replace("\x07", "^G")
    place = f"{shown}{os.sep}prog2.8k"
    assert json.loads(out)["programs"]["2"]["file"] == place
    if suffix == ".png":
        assert picture.stat().st_size > 5000
        return
    text = picture.read_text(encoding="utf-8")
    if suffix == ".svg":
        text = "".join(ET.fromstring(text).itertext())
    else:
        found = re.search(r'<script id="data" type="application/json">(.*?)</script>', text)
        assert found is not None
        data = json.loads(found[1])
        assert data["title"] == shown
        text = data["events"][0]["text"]
    assert f"({place}:8): Divide by zero" in text


def empty_starts(shown: str) -> list[str]:
    return [line for line in shown.splitlines() if "is empty: its RUN" in line]


def test_a_start_of_an_empty_program_is_mentioned_once_with_its_place(project: Path) -> None:
    (project / "setup.8k").write_text(
        f"{SETUP}RUN PROG2\nRUN PROG2\nPROG3\nLRUN\nRUN PLC1\nRUN ALL\n"
    )
    (project / "prog2.8k").write_text("PROGRAM\nPBOOT\nRUN PROG5\nRUN PROG3\nSET 32\nENDP\n")
    code, _, shown = run(project, "--for", "1")
    assert code == 0
    setup, program = f"mine{os.sep}setup.8k", f"mine{os.sep}prog2.8k"
    assert [line.split(" s: ")[1] for line in empty_starts(shown)] == [
        f"PROG2 is empty: its RUN starts nothing ({setup}:3)",
        f"PROG3 is empty: its RUN starts nothing ({setup}:6)",
        f"PROG5 is empty: its RUN starts nothing ({program}:3)",
        f"PLC1 is empty: its RUN starts nothing ({setup}:7)",
    ]
    assert empty_starts(run(project, "--for", "1", "--quiet")[2]) == []


def test_a_typed_start_of_an_empty_program_has_its_time_and_no_place(project: Path) -> None:
    (project / "prog2.8k").write_text("PROGRAM\nSET 32\nENDP\n")
    scenario = '[[at]]\ntime_s = 0.2\nsend = "RUN PROG7\\r"\n'
    (project / "scenario.toml").write_text(scenario)
    _, _, shown = run(project, "--for", "1")
    assert empty_starts(shown) == ["note: 0.2000 s: PROG7 is empty: its RUN starts nothing"]
