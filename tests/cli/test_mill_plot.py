"""`openacr mill plot`: pictures of tool paths."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.lines import Line2D
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.plots.toolpath import RAPID, Scene, shade
from openacr.cli.plots.toolpath_image import build_figure
from openacr.mill.plot import ToolPath

pytest.importorskip("matplotlib")

PART = """\
P1001=.25
G0 X-1 Y1 Z.5
T3 M6
G1 Z-.2 F10
G41 D1 X0 Y0
Y2
G3 Y4 I0 J1 G200 F1
G1 Y6
X6 Y0
X-1
G40 X-2 Y1
G0 Z.5
M2
"""


@pytest.fixture(autouse=True)
def own_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "sysvar.db"))


@pytest.fixture
def part(tmp_path: Path) -> Path:
    file = tmp_path / "PART.NC"
    file.write_text(PART)
    return file


def plotted(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", "plot", *map(str, words)])
    return result.exit_code, result.output


def scene_of(part: Path) -> Scene:
    """The scene the command draws."""
    from openacr.cli.mill import loaded, opened_store
    from openacr.cli.mill_plot import _surveyed

    with opened_store(None) as cells:
        program, name = loaded(part, cells, None)
        _, path = _surveyed(program, cells, name)
    assert isinstance(path, ToolPath)
    return Scene(path.finished(), part.name, ("X", "Y", "Z"), "inch")


def lines_of(scene: Scene) -> list[Line2D]:
    return [line for panel in build_figure(scene).axes for line in panel.get_lines()]


@pytest.mark.req("MILL-GFX-3D")
def test_a_png_has_three_views(part: Path, tmp_path: Path) -> None:
    picture = tmp_path / "part.png"
    code, text = plotted(part, picture)
    assert (code, text) == (0, f"{picture}: 14 moves\n")
    assert picture.read_bytes().startswith(b"\x89PNG")
    titles = [panel.get_title(loc="left") for panel in build_figure(scene_of(part)).axes]
    assert sorted(titles) == ["", "from above", "from the front"]


def test_an_svg_names_what_is_drawn(part: Path, tmp_path: Path) -> None:
    picture = tmp_path / "part.svg"
    assert plotted(part, picture)[0] == 0
    text = picture.read_text()
    for label in ("rapid", "feed T3", "compensated T3", "inserted at corners", "programmed"):
        assert label in text
    assert "X  -2 … 6.25 inch" in text


@pytest.mark.req("MILL-GFX-COMPDASH")
def test_the_compensated_path_is_dashed_beside_the_programmed_one(part: Path) -> None:
    lines = lines_of(scene_of(part))
    dashed = [each for each in lines if each.is_dashed() and each.get_color() != RAPID]
    assert len(dashed) == 3  # one in each view
    top = build_figure(scene_of(part)).axes[1]
    contour = next(each for each in top.get_lines() if each.get_color() == "#444444")
    assert not contour.is_dashed()
    assert np.asarray(contour.get_xydata())[:2].tolist() == [[0, 0], [0, 2]]


@pytest.mark.req("MILL-GFX-EXTENTS")
def test_the_whole_path_is_inside_its_views(part: Path) -> None:
    figure = build_figure(scene_of(part))
    figure.canvas.draw()
    for panel in figure.axes:
        (x0, x1), (y0, y1) = panel.get_xlim(), panel.get_ylim()
        for line in panel.get_lines():
            x, y = np.asarray(line.get_xydata(), dtype=np.float64).T
            assert not ((x < x0) | (x > x1) | (y < y0) | (y > y1)).any()


def test_a_page_holds_everything_itself(part: Path) -> None:
    code, text = plotted(part)
    page = part.with_suffix(".html")
    assert (code, text) == (0, f"{page}: 14 moves\n")
    content = page.read_text()
    assert not re.search(r"https?://|src=|@DATA@|@TITLE@", content)
    found = re.search(r'<script id="data" type="application/json">(.*?)</script>', content)
    assert found is not None
    data = json.loads(found.group(1))
    assert [look["label"] for look in data["looks"]] == [
        "rapid",
        "feed T3",
        "compensated T3",
        "inserted at corners",
    ]
    assert data["low"] == pytest.approx([-2, -0.25, -0.2])
    assert len(data["contours"]) == 1


def test_what_is_wrong_is_told_and_the_rest_is_drawn(tmp_path: Path) -> None:
    part = tmp_path / "NARROW.NC"
    part.write_text("P1001=.25\nG0 Y1\nG41 D1 G1 F10 X0 Y0\nX1\nX1.1 Y.1\nY2\nG40 X0 Y2\nM2\n")
    picture = tmp_path / "narrow.svg"
    code, text = plotted(part, picture)
    assert code == 1
    assert "NARROW.NC:5:1: E322" in text
    assert "with errors" in picture.read_text()


def test_a_flat_part_needs_no_view_from_the_front(tmp_path: Path) -> None:
    part = tmp_path / "FLAT.NC"
    part.write_text("F10 X1\nY1\nX0\nM2\n")
    assert len(build_figure(scene_of(part)).axes) == 2


def test_a_program_without_moves_has_no_picture(tmp_path: Path) -> None:
    part = tmp_path / "EMPTY.NC"
    part.write_text("M2\n")
    assert plotted(part, tmp_path / "empty.png") == (2, f"error: {part}: nothing moves\n")


def test_other_forms_are_refused_before_anything_is_read(part: Path, tmp_path: Path) -> None:
    code, text = plotted(part, tmp_path / "part.gif")
    assert code == 2
    assert "pictures end in .png, .svg or .html" in text


def test_shades_go_from_dark_to_light() -> None:
    assert shade("#0072B2", 0, 1) == "#0072B2"
    assert shade("#808080", 0, 3) == "#2d2d2d"
    assert shade("#808080", 1, 3) == "#808080"
    assert shade("#808080", 2, 3) == "#d3d3d3"
