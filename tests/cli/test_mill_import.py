"""`openacr mill import` writes a part program beside the drawing."""

import json
from pathlib import Path

import ezdxf
import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.sysvar import Store


@pytest.fixture
def square(tmp_path: Path) -> Path:
    """A drawing of a square and two holes, in a folder with a store."""
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = 1
    document.modelspace().add_lwpolyline([(0, 0), (2, 0), (2, 2), (0, 2)], close=True)
    for x in (0.5, 1.5):
        document.modelspace().add_point((x, 1))
    path = tmp_path / "SQUARE.dxf"
    document.saveas(path)
    return path


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["mill", "import", *arguments])


@pytest.mark.req("MILL-DXF-02", "MILL-DXF-08")
def test_path_or_drill_pattern_can_be_chosen_and_success_is_said(square: Path) -> None:
    result = run(str(square))
    assert result.exit_code == 0
    assert "SQUARE.TXT: 1 chain (1 closed) of 1 entity, in inch" in result.output
    assert "not used: 2 POINT" in result.output
    assert "G1 X2 Y2" in square.with_suffix(".TXT").read_text()
    holes = square.with_name("HOLES.TXT")
    result = run(str(square), "--drill", "-o", str(holes), "--drill-z", "-0.25", "--feed", "7")
    assert "HOLES.TXT: 2 holes, in inch" in result.output
    assert "G98 G81 X0.5 Y1 Z-0.25 R0.1 F7" in holes.read_text()


def test_settings_come_from_the_store_and_options_go_before_them(square: Path) -> None:
    with Store(square.parent / "sysvar.db") as store:
        store.write(250_120, 0.75)
    run(str(square))
    assert "G0 Z0.75" in square.with_suffix(".TXT").read_text()
    run(str(square), "--force", "--safe-height", "0.5", "--direction", "1")
    text = square.with_suffix(".TXT").read_text()
    assert "G0 Z0.5" in text
    assert "counter-clockwise" in text


def test_the_depth_of_a_path_is_an_option_and_a_cut_at_the_surface_is_said(square: Path) -> None:
    program = square.with_suffix(".TXT")
    note = "note: the path is cut at Z0: set the depth with --cut-z\n"
    assert note in run(str(square)).output
    assert program.read_text().count("G1 Z0\n") == 1
    assert note not in run(str(square), "--force", "--cut-z", "0").output
    assert program.read_text().count("G1 Z0\n") == 1
    result = run(str(square), "--force", "--cut-z", "-0.125")
    assert note not in result.output
    text = program.read_text()
    assert text.count("G1 Z-0.125\n") == 1
    assert "Z0\n" not in text
    run(str(square), "--force", "--cut-z", "-0.25", "--tool", "3")
    assert program.read_text().count("G1 Z-0.25\n") == 1
    assert note not in run(str(square), "--force", "--drill").output
    result = run(str(square), "--force", "--cut-z", "nan")
    assert (result.exit_code, result.output) == (2, "error: --cut-z nan: it must be a number\n")


def test_the_depth_is_in_the_unit_of_the_store(square: Path) -> None:
    with Store(square.parent / "sysvar.db") as store:
        store.write(250_001, 1)
    run(str(square), "--cut-z", "-2.54")
    assert "G1 Z-0.1\n" in square.with_suffix(".TXT").read_text()


def test_a_program_that_is_there_is_kept(square: Path) -> None:
    square.with_suffix(".TXT").write_text("G1 X1\n")
    result = run(str(square))
    assert result.exit_code == 2
    assert "is there already (--force overwrites it" in result.output
    assert square.with_suffix(".TXT").read_text() == "G1 X1\n"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--epsilon", "0"], "--epsilon 0: it must be above 0"),
        (["--feed", "-1"], "--feed -1: it must be above 0"),
        (["--safe-height", "inf"], "--safe-height inf: it must be a number"),
        (["--drill-z", "nan"], "--drill-z nan: it must be a number"),
        (["--tool", "401"], "D401: offsets are D1 to D400"),
        (["--tool", "1", "--lead", "0"], "--lead 0: it must be above 0"),
        (["--layer", "CUT"], "the drawing has no layer CUT"),
        (["-o", "/nowhere/x.TXT"], "there is no folder /nowhere"),
    ],
)
def test_slips_are_explained_and_nothing_is_written(
    square: Path, arguments: list[str], words: str
) -> None:
    result = run(str(square), *arguments)
    assert result.exit_code == 2
    assert words in result.output
    assert not square.with_suffix(".TXT").exists()


def test_json_says_what_was_done(square: Path) -> None:
    record = json.loads(run(str(square), "--json").output)
    assert record["pattern"] == "path"
    assert record["unit"] == "inch"
    assert record["notes"] == [
        "not used: 2 POINT",
        "the path is cut at Z0: set the depth with --cut-z",
    ]


def test_without_a_name_the_drawings_of_the_folder_are_listed(
    square: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(square.parent)
    square.with_name("older.DXF").write_text("")
    square.with_name("notes.txt").write_text("")
    assert run().output == "SQUARE.dxf\nolder.DXF\n"
    assert json.loads(run("--json").output) == ["SQUARE.dxf", "older.DXF"]
    empty = square.parent / "empty"
    empty.mkdir()
    monkeypatch.chdir(empty)
    assert run().output == "there are no drawings (*.dxf) here\n"


@pytest.mark.req("MILL-DXF-07")
def test_the_name_of_the_program_is_asked_with_those_that_are_there(square: Path) -> None:
    square.with_name("PLATE.TXT").write_text("M2\n")
    words = ["mill", "import", str(square), "--ask"]
    result = CliRunner().invoke(app, words, input="COVER\n")
    assert result.exit_code == 0
    assert "existing: PLATE.TXT" in result.output
    assert "Name of the program [SQUARE.TXT]" in result.output
    assert "G1 X2 Y2" in square.with_name("COVER.TXT").read_text()
    result = CliRunner().invoke(app, words, input="PLATE.TXT\n")
    assert result.exit_code == 2
    assert "PLATE.TXT is there already" in result.output
