"""`openacr dxf`: a drawing becomes moves of the card, which go where the drawing is."""

import math
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import CliRunner, Result

from openacr import Controller
from openacr.cli.main import app

CIRCLES = Path(__file__).parents[2] / "examples" / "circles"
SLOT = [(0, 0, 0), (20, 0, 1), (20, 10, 0), (0, 10, 1)]  # straight sides and half circles


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The table of two screws, and a drawing of a slot, a square and a circle."""
    monkeypatch.chdir(tmp_path)
    for name in ("machine.toml", "setup.8k"):
        shutil.copy(CIRCLES / name, tmp_path)
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_lwpolyline(SLOT, format="xyb", close=True)
    space.add_lwpolyline([(40, 0), (50, 0), (50, 10), (40, 10)], close=True)
    space.add_circle((70, 5), 5)
    space.add_text("no path")
    document.saveas(tmp_path / "part.dxf")
    return tmp_path


def openacr(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


def path_of(card: Controller, limit_s: float = 60.0) -> NDArray[np.float64]:
    """Where X and Y are commanded to stand, every 1 ms, while program 0 runs."""
    card.record(2)
    card.send("PROG0\rRUN\r")
    card.advance(seconds=0.1)
    while card.bit[516] or card.bit[1032]:
        card.advance(seconds=0.1)
        assert card.time_s < limit_s
    axes = card.take_trace().axes
    return np.column_stack([axes[0].commanded_u, axes[1].commanded_u])


def test_the_axes_run_along_the_chains_of_the_drawing(project: Path) -> None:
    result = openacr("dxf", "part.dxf", "--vel", "50", "--rapid", "200", "--acc", "1000")
    assert result.exit_code == 0, result.output
    assert result.stdout == "prog0.8k: 3 chains (3 closed) of 3 entities, in mm\n"
    assert result.stderr == "note: not used: 1 TEXT\n"
    assert openacr("check", ".").exit_code == 0
    places = path_of(Controller.from_project(project))
    speed = np.linalg.norm(np.diff(places, axis=0), axis=1) / 0.001
    is_cut = speed < 51.0
    x, y = places[1:][is_cut].T
    off_slot = np.hypot(x - np.clip(x, 0, 20), y - 5) - 5.0
    off_square = np.maximum(np.abs(x - 45), np.abs(y - 5)) - 5.0
    off_circle = np.hypot(x - 70, y - 5) - 5.0
    off = np.abs([off_slot, off_square, off_circle])
    lengths = [speed[is_cut][each < 0.002].sum() * 0.001 for each in off]
    assert lengths == pytest.approx([40 + 10 * math.pi, 40.0, 10 * math.pi], abs=1.3)
    # 1.25 mm of the travel from the slot to the next chain are as slow, and lie on it


def test_the_speed_is_kept_where_pieces_join_without_a_corner(project: Path) -> None:
    openacr("dxf", "part.dxf", "--vel", "50", "--acc", "1000")
    text = Path("prog0.8k").read_text()
    slot = text[text.index("length 71.41593") :].split("REM")[0].split("\n")
    assert slot[1:] == [
        "X0 Y0", "VEL 50", "STP 0", "CIRCW X(0,0) Y(10,5)", "X20 Y10",
        "CIRCW X(20,20) Y(0,5)", "STP 1000", "X0 Y0", "",
    ]  # fmt: skip
    square = text[text.index("length 40") :].split("REM")[0]
    assert "STP" not in square
    openacr("dxf", "part.dxf", "--force")
    text = Path("prog0.8k").read_text()
    assert not any(word in text for word in ("STP", "VEL", "ACC"))


def test_z_and_an_output_follow_the_path(project: Path) -> None:
    openacr(
        "dxf", "part.dxf", "-o", "prog1.8k", "--safe-height", "5", "--cut-z", "-1.5",
        "--output", "40", "--axes", "A,B,C", "--ccw",
    )  # fmt: skip
    lines = Path("prog1.8k").read_text().splitlines()
    assert lines[:1] == ["PROGRAM"] and lines[-2:] == ["INH -548", "ENDP"]
    assert lines[2] == "C5"
    circle = next(k for k, line in enumerate(lines) if line.startswith("CIRCCW A(75,70)"))
    assert lines[circle - 4 : circle + 4] == [
        "A75 B5", "C-1.5", "INH -548", "SET 40", "CIRCCW A(75,70) B(5,5)", "INH -548", "CLR 40",
        "C5",
    ]  # fmt: skip


def test_the_unit_is_that_of_the_drawing_or_of_the_option(project: Path) -> None:
    document = ezdxf.readfile("part.dxf")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = 0
    document.saveas("none.dxf")
    for options, unit in (((), "mm"), (("--inch",), "inch")):
        result = openacr("dxf", "none.dxf", "--force", *options)
        assert result.stdout.endswith(f", in {unit}\n")
        assert f"the drawing states no unit: taken as {unit}" in result.stderr


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["-o", "part.nc"], "part.nc: name the program prog0.8k to prog7.8k"),
        (["-o", "prog8.8k"], "prog8.8k: name the program prog0.8k to prog7.8k"),
        (["--cut-z", "-1"], "--safe-height and --cut-z belong together"),
        (["--vel", "0"], "--vel 0: it must be above 0"),
        (["--acc", "inf"], "--acc inf: it must be above 0"),
        (["--output", "31"], "--output 31: it must be a bit, 32 to 4095"),
        (["--axes", "X"], "--axes X: give 2 names of letters"),
        (["--axes", "X,Y", "--cut-z", "0", "--safe-height", "1"], "give 3 names of letters"),
        (["--layer", "NONE"], "the drawing has no layer NONE"),
        (["--cut-z", "nan", "--safe-height", "1"], "--cut-z nan: it must be a number"),
    ],
)
def test_mistakes_are_named(project: Path, options: list[str], said: str) -> None:
    result = openacr("dxf", "part.dxf", *options)
    assert result.exit_code != 0
    assert said in result.output
    assert not list(project.glob("prog*.8k"))


def test_a_program_that_is_there_is_kept_without_force(project: Path) -> None:
    Path("prog0.8k").write_text("mine")
    assert openacr("dxf", "part.dxf").exit_code != 0
    assert Path("prog0.8k").read_text() == "mine"
