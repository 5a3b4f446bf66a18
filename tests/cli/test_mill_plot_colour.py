"""`openacr mill plot --colour`: paths coloured by speed, acceleration or jerk."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from tests.cli.test_mill_plot import lines_of
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.plots.motion_colors import BANDS, COLORS, UNKNOWN, draw_motion
from openacr.cli.plots.toolpath import Scene
from openacr.cli.plots.toolpath_image import build_figure
from openacr.mill.plan.pictures import path_motion
from openacr.mill.plan.pictures.path_motion import Motion
from openacr.mill.plan.pictures.quantities import Quantity

pytest.importorskip("matplotlib")

PART = "G21\nG64 P.02\nG0 X0 Y0\nF6000\nG1 X40 Y0\nG1 X40 Y30\n"
LIMITS = ("650000=6000", "650007=1000", "650008=1000")


@pytest.fixture(autouse=True)
def stored(own_store: Path) -> None:
    chosen("250001=1", *LIMITS)


def chosen(*cells: str) -> None:
    words = [f"P{cell}" for cell in cells]
    result = CliRunner().invoke(app, ["sysvar", "set", "--unit", "mm", *words])
    assert result.exit_code == 0, result.output


def plotted(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(
        app, ["mill", "plot", "--dialect", "rs274ngc", *map(str, words)], env={"COLUMNS": "300"}
    )
    return result.exit_code, result.output


def written(folder: Path, text: str = PART + "M2\n") -> Path:
    file = folder / "part.ngc"
    file.write_text(text)
    return file


def scene_of(file: Path, colour: Quantity) -> Scene:
    from openacr.cli.mill import plot
    from openacr.cli.mill.check import loaded, opened_store

    with opened_store(None) as cells:
        program, name = loaded(file, cells, "rs274ngc")
        return plot.scene_of(program, cells, name, colour=colour)[0]


@pytest.mark.parametrize(
    ("colour", "label"),
    [
        ("speed", "speed [mm/min]"),
        ("acceleration", "acceleration [mm/s²]"),
        ("jerk", "jerk [mm/s³]"),
    ],
)
def test_an_svg_names_the_quantity_of_its_colour_bar_with_the_unit(
    colour: str, label: str, tmp_path: Path
) -> None:
    chosen("650015=20000")
    picture = tmp_path / "part.svg"
    code, text = plotted(written(tmp_path), picture, "--colour", colour)
    assert (code, text) == (0, f"{picture}: 2 moves\n")
    drawn = picture.read_text()
    assert f">{label}<" in drawn
    assert ">jerk not planned<" not in drawn and ">feed<" not in drawn
    assert ">start<" in drawn


def test_the_colour_bar_goes_from_rest_to_the_highest_speed(tmp_path: Path) -> None:
    scene = scene_of(written(tmp_path), Quantity.SPEED)
    assert scene.motion is not None
    assert scene.motion.highest == pytest.approx(6000.0, rel=1e-5)
    bar = next(panel for panel in build_figure(scene).axes if panel.get_ylabel().startswith("sp"))
    assert bar.get_ylim() == pytest.approx((0.0, 6000.0), rel=1e-5)


def test_a_value_has_the_colour_of_its_share_of_the_highest_one() -> None:
    points = np.array([(k, k * k, 0.0) for k in range(6)])
    values, is_move = np.array([0.0, 5.0, np.nan, 10.0, np.nan]), np.array([1, 1, 1, 1, 0]) > 0
    motion = Motion(Quantity.SPEED, points, values, is_move, is_cut=False)
    panel = Figure().add_subplot()
    draw_motion(panel, motion, np.eye(3)[:, :2], 0.1, 1.0)
    seen = [
        (to_rgba(each.get_color()), np.asarray(each.get_xydata())[-2:].tolist())
        for each in panel.get_lines()
    ]
    assert seen == [
        (to_rgba(UNKNOWN), [[2, 4], [3, 9]]),
        (to_rgba(COLORS(0)), [[0, 0], [1, 1]]),
        (to_rgba(COLORS(BANDS // 2)), [[1, 1], [2, 4]]),
        (to_rgba(COLORS(BANDS - 1)), [[3, 9], [4, 16]]),
    ]


def test_inches_are_the_unit_of_a_machine_in_inches(tmp_path: Path) -> None:
    chosen("250001=0")
    picture = tmp_path / "part.svg"
    assert plotted(written(tmp_path), picture, "--colour", "speed")[0] == 0
    assert ">speed [inch/min]<" in picture.read_text()


def test_jerk_without_a_plan_is_refused_and_says_what_is_missing(tmp_path: Path) -> None:
    file, picture = written(tmp_path), tmp_path / "part.png"
    assert plotted(file, picture, "--colour", "jerk") == (
        2,
        f"error: {file}: no move has a planned jerk; paths are planned where Path jerk (P650015)"
        " and a tolerance (G64 P, or P650018) are above 0\n",
    )
    assert not picture.exists()


def test_moves_without_a_plan_are_grey_beside_planned_ones(tmp_path: Path) -> None:
    chosen("650015=20000")
    file = written(tmp_path, PART + "G61 X0 Y30\nM2\n")
    picture = tmp_path / "part.svg"
    assert plotted(file, picture, "--colour", "jerk") == (0, f"{picture}: 3 moves\n")
    assert ">jerk not planned<" in picture.read_text()
    grey = [each for each in lines_of(scene_of(file, Quantity.JERK)) if each.get_color() == UNKNOWN]
    assert len(grey) == 2  # one in each view


def test_a_picture_that_is_full_is_noted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_motion, "MOST_POINTS", 3)
    picture = tmp_path / "part.svg"
    assert plotted(written(tmp_path), picture, "--colour", "speed") == (
        0,
        f"note: the picture shows the first 49 points\n{picture}: 2 moves\n",
    )


def test_the_default_picture_is_a_png(tmp_path: Path) -> None:
    file = written(tmp_path)
    assert plotted(file, "--colour", "speed") == (0, f"{file.with_suffix('.png')}: 2 moves\n")


def test_a_page_and_other_colours_are_refused(tmp_path: Path) -> None:
    file, page = written(tmp_path), tmp_path / "part.html"
    assert plotted(file, page, "--colour", "speed") == (
        2,
        f"error: {page}: pictures with --colour end in .png or .svg\n",
    )
    for option in ("--by-tool", "--stock"):
        assert plotted(file, "--colour", "speed", option) == (
            2,
            f"error: --colour speed with {option}: one picture has one of them\n",
        )
    code, text = plotted(file, "--colour", "snap")
    assert code == 2
    assert "'snap' is not one of 'speed', 'acceleration', 'jerk'" in text
    assert sorted(each.suffix for each in tmp_path.iterdir() if each.stem == "part") == [".ngc"]
