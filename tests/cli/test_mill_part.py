"""`openacr mill part` lists parts, describes them, and makes programs of them."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.cli.mill.part import complete_part
from openacr.sysvar import Store


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["mill", "part", *arguments], env={"COLUMNS": "100"})


@pytest.mark.req("MILL-LIB-LIST")
def test_all_parts_are_listed() -> None:
    output = run().output
    assert "RECTANGLE" in output
    assert "Circle of holes" in output
    assert len(json.loads(run("--json").output)) >= 20


def test_a_part_is_described() -> None:
    output = run("rectangle", "--show").output
    assert "RECTANGLE: Rectangle, outside, with rounded corners" in output
    assert "starts at: lower left corner" in output
    assert "must hold: P202*2 <= P200" in output
    described = json.loads(run("gearblnk", "--show", "--json").output)
    assert described["sizes"][0]["unit"] == "mm"


def test_a_program_is_printed_or_written_with_the_wanted_sizes(tmp_path: Path) -> None:
    printed = run("rectangle", "--set", "P200=50.8mm", "--set", "width in y=3").output
    assert "P200=2 ; Length in X" in printed
    assert "P201=3 ; Width in Y" in printed
    out = tmp_path / "R.TXT"
    result = run("rectangle", "--set", "P200=2", "--set", "P201=3", "-o", str(out))
    assert "R.TXT: Rectangle, outside" in result.output
    assert out.read_text() == printed
    assert json.loads(run("rectangle", "--json").output)["values"]["P200"] == 4.0


def test_the_unit_is_that_of_the_start_unless_one_is_given(own_store: Path) -> None:
    assert "\nG20\n" in run("circle").output
    assert "\nG21\n" in run("circle", "--unit", "mm").output
    with Store(own_store) as store:
        store.write(850_030, 21)
    assert "P200=76.2 ; Diameter" in run("circle").output


def test_the_tool_comes_from_the_store(own_store: Path) -> None:
    with Store(own_store) as store:
        store.write(1004, 0.25)
    output = run("circle", "--tool", "4").output
    assert "\nD4\n" in output
    assert "P224=0.25 ; radius of the tool" in output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["gear"], "there is no part gear (there are ARCSLOT"),
        (["circle", "--set", "P200"], "write SIZE=VALUE"),
        (["circle", "--set", "P200=big"], "P200 Diameter takes 0.05 to 200 in"),
        (["polygon", "--set", "P201=6mm"], "P201 Number of corners takes 3 to 60"),
        (["circle", "--set", "P299=1"], "CIRCLE has no size P299"),
        (["circle", "--set", "P200=1000"], "E222 value out of range: P200 Diameter = 1000"),
        (["rectangle", "--set", "P202=1.5"], "E222 value out of range: P202*2 <= P201 does not"),
        (["circle", "--unit", "cm"], "unit 'cm' is neither inch nor mm"),
        (["circle", "--library", "/nowhere"], "/nowhere: cannot be read"),
        (["circle", "-o", "/nowhere/x.TXT"], "there is no folder /nowhere"),
    ],
)
def test_slips_are_explained(arguments: list[str], words: str) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert words in result.output


def test_names_are_completed() -> None:
    assert complete_part("rec") == ["RECTANGLE"]


@pytest.mark.req("MILL-LIB-RUN")
def test_sizes_are_asked_for_until_they_can_be(tmp_path: Path) -> None:
    file = tmp_path / "SLOT.TXT"
    words = ["mill", "part", "slot", "--ask", "--set", "P201=0.75", "-o", str(file)]
    answers = "3\n.2\nwide\n99\n0\n.1\n.1\n.5\n"
    result = CliRunner().invoke(app, words, input=answers)
    assert result.exit_code == 0
    assert "P200 Distance of the centres (0.05 to 200 in)" in result.output
    assert "error: --set P207=wide" in result.output
    assert "error: P207 Ramp angle, 0 plunges = 99 (0 to 45 deg)" in result.output
    text = file.read_text()
    assert "P200=3 ;" in text
    assert "P201=0.75 ;" in text
    assert "P222=0.5 ;" in text


def test_a_file_that_is_there_is_overwritten_with_force_alone(tmp_path: Path) -> None:
    target = tmp_path / "plate.txt"
    target.write_text("mine")
    refused = CliRunner().invoke(app, ["mill", "part", "circle", "-o", str(target)])
    assert refused.exit_code == 2
    assert refused.stderr == (
        f"error: {target} is there already (--force overwrites it, -o names another)\n"
    )
    assert target.read_text() == "mine"
    forced = CliRunner().invoke(app, ["mill", "part", "circle", "-o", str(target), "--force"])
    assert forced.exit_code == 0
    assert target.read_text().startswith("; CIRCLE\n")
