"""`openacr mill plot`: pictures of tool paths."""

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from matplotlib.lines import Line2D
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.cli.mill import plot
from openacr.cli.mill.check import loaded, opened_store
from openacr.cli.plots.toolpath import RAPID, Scene, shade
from openacr.cli.plots.toolpath_image import build_figure
from openacr.cnc.loading.load import load
from openacr.cnc.parts.library import names, part_named, prepared
from openacr.mill.config.colors import COLORS
from openacr.mill.plan.pictures import tool_path
from openacr.sysvar import Store

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


@pytest.fixture
def part(tmp_path: Path) -> Path:
    file = tmp_path / "PART.NC"
    file.write_text(PART)
    return file


def plotted(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["mill", "plot", *map(str, words)])
    return result.exit_code, result.output


def scene_of(part: Path, **settings: float) -> Scene:
    """The scene the command draws, with some settings of the store changed."""
    with opened_store(None) as cells:
        for name, value in settings.items():
            cells.write(int(name.removeprefix("P")), value)
        program, name = loaded(part, cells, None)
        return plot.scene_of(program, cells, name)[0]


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
    for label in ("rapid", "feed", "compensated", "inserted at corners", "programmed"):
        assert label in text
    assert "X  -2 … 6.25 inch" in text


@pytest.mark.req("MILL-GFX-COMPDASH")
def test_the_compensated_path_is_dashed_beside_the_programmed_one(part: Path) -> None:
    lines = lines_of(scene_of(part))
    dashed = [each for each in lines if each.is_dashed() and each.get_color() != RAPID]
    assert len(dashed) == 6  # its moves and those that are inserted, in each of three views
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
        "feed",
        "compensated",
        "inserted at corners",
    ]
    assert data["low"] == pytest.approx([-2, -0.25, -0.2])
    assert data["view"] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert len(data["contours"]) == 1


def test_what_is_wrong_is_reported_and_the_rest_is_drawn(tmp_path: Path) -> None:
    part = tmp_path / "NARROW.NC"
    part.write_text("P1001=.25\nG0 Y1\nG41 D1 G1 F10 X0 Y0\nX1\nX1.1 Y.1\nY2\nG40 X0 Y2\nM2\n")
    picture = tmp_path / "narrow.svg"
    code, text = plotted(part, picture)
    assert code == 1
    assert "NARROW.NC:5:1: E322" in text
    assert "with errors" in picture.read_text()


def test_the_stock_is_drawn_with_the_lines_where_something_is_wrong(
    part: Path, tmp_path: Path
) -> None:
    part.write_text("G10 L12 P1 R.25\nG0 X1 Y1 Z1\nX0 Y0\nD1 F10 G1 Z-.5\nX2\nG0 Y1\nZ1\nM2\n")
    picture = tmp_path / "stock.svg"
    code, text = plotted(part, picture, "--stock")
    assert (code, text.splitlines()[1]) == (0, f"{part}:6: a rapid goes through material")
    # The slot: 0.5 (0.5 * 2 + pi / 16) = 0.598; the rapid takes what is left of two corners.
    assert text.splitlines()[0] == f"{picture}: 0.6049 inch³ removed"
    shown = picture.read_text()
    assert "rapid in material: line 6" in shown
    assert "height [inch]" in shown


def test_the_stock_is_no_page(part: Path) -> None:
    page = part.with_suffix(".html")
    refused = f"error: {page}: pictures with --stock end in .png or .svg\n"
    assert plotted(part, page, "--stock") == (2, refused)


def test_a_flat_part_needs_no_view_from_the_front(tmp_path: Path) -> None:
    part = tmp_path / "FLAT.NC"
    part.write_text("F10 X1\nY1\nX0\nM2\n")
    assert len(build_figure(scene_of(part)).axes) == 2


def test_a_program_without_moves_has_no_picture(tmp_path: Path) -> None:
    part = tmp_path / "EMPTY.NC"
    part.write_text("M2\n")
    assert plotted(part, tmp_path / "empty.png") == (2, f"error: {part}: no moves to draw\n")


def test_other_forms_are_refused_before_anything_is_read(part: Path, tmp_path: Path) -> None:
    code, text = plotted(part, tmp_path / "part.gif")
    assert code == 2
    assert "pictures end in .png, .svg or .html" in text


def colors_of(scene: Scene) -> set[str]:
    return {str(line.get_color()) for line in lines_of(scene)}


@pytest.mark.req("MILL-GFX-PATHCOLOR")
def test_the_path_color_is_that_of_the_store(part: Path) -> None:
    assert COLORS[10].on_light in colors_of(scene_of(part))
    assert COLORS[4].on_light in colors_of(scene_of(part, P250114=4))
    assert COLORS[10].on_light not in colors_of(scene_of(part, P250114=4))


@pytest.mark.req("MILL-SYS-DISP-DCOLOR")
def test_tools_have_colors_when_the_store_says_so(tmp_path: Path) -> None:
    part = tmp_path / "TOOLS.NC"
    part.write_text("F10\nT1 M6\nX1\nT2 M6\nX2\nT18 M6\nY1\nM2\n")
    off = scene_of(part)
    assert {COLORS[n].on_light for n in (1, 2, 4, 10)} & colors_of(off) == {COLORS[10].on_light}
    on = scene_of(part, P850020=1, P901001=4)
    assert {COLORS[n].on_light for n in (1, 2, 4, 10)} & colors_of(on) == {
        COLORS[4].on_light,
        COLORS[2].on_light,
    }
    assert [look.get_label() for look in build_figure(on).legends[0].get_lines()][:3] == [
        "feed T1",
        "feed T2",
        "feed T18",
    ]


def seen(scene: Scene, point: tuple[float, float, float]) -> tuple[float, float]:
    """Where the view from above shows a point: right and up, in pixels."""
    figure = build_figure(scene)
    figure.canvas.draw()
    top = figure.axes[1]
    across, up = (scene.view.axis_on(direction)[0] for direction in (0, 1))
    place = top.transData.transform((point[across], point[up]))
    return float(place[0]), float(place[1])


@pytest.mark.req("MILL-SYS-DISP-FLIPX", "MILL-SYS-DISP-FLIPY", "MILL-SYS-DISP-XCHG")
@pytest.mark.parametrize(
    ("cells", "x_goes", "y_goes"),
    [
        ({}, (1, 0), (0, 1)),
        ({"P850021": 1}, (-1, 0), (0, 1)),
        ({"P850022": 1}, (1, 0), (0, -1)),
        ({"P850021": 1, "P850022": 1}, (-1, 0), (0, -1)),
        ({"P850023": 1}, (0, 1), (1, 0)),
        ({"P850021": 1, "P850023": 1}, (0, -1), (1, 0)),
        ({"P850021": 1, "P850022": 1, "P850023": 1}, (0, -1), (-1, 0)),
    ],
)
def test_flips_and_exchange_turn_the_drawing_alone(
    part: Path, cells: dict[str, float], x_goes: tuple[int, int], y_goes: tuple[int, int]
) -> None:
    scene = scene_of(part, **cells)
    origin, x, y = (seen(scene, point) for point in ((0, 0, 0), (1, 0, 0), (0, 1, 0)))
    assert np.sign(np.round(np.subtract(x, origin))).tolist() == list(x_goes)
    assert np.sign(np.round(np.subtract(y, origin))).tolist() == list(y_goes)
    # The space view and the page turn by the same matrix; numbers stay those of the machine.
    assert (np.array([1.0, 0, 0]) @ scene.view.matrix)[:2].tolist() == list(x_goes)
    assert (np.array([0, 1.0, 0]) @ scene.view.matrix)[:2].tolist() == list(y_goes)
    assert scene.drawing.points[-1] == pytest.approx([-2, 1, 0.5])
    assert (scene.low, scene.high) == ((-2, -0.25, -0.2), (6.25, 6.25, 0.5))


def test_shades_go_from_dark_to_light() -> None:
    assert shade("#0072B2", 0, 1) == "#0072B2"
    assert shade("#808080", 0, 3) == "#2d2d2d"
    assert shade("#808080", 1, 3) == "#808080"
    assert shade("#808080", 2, 3) == "#d3d3d3"


@pytest.mark.parametrize(
    "name",
    ["@DATA@.nc", "@TITLE@@DATA@.nc", "a$x_{1$b$.nc", "<!--<script>.nc", "<_script>&amp;.nc",
     "\\1\\g<0>.nc", "-x.nc", "\udcff.nc", "\x1b[31m\x07.nc"],
)  # fmt: skip
@pytest.mark.parametrize("suffix", [".html", ".png", ".svg"])
def test_no_name_of_a_file_can_spoil_the_picture(tmp_path: Path, name: str, suffix: str) -> None:
    part = tmp_path / name
    part.write_text("F10 G1 X1\nY1\n")
    picture = tmp_path / f"p{suffix}"
    code, _ = plotted(part, picture)
    assert code == 0
    if suffix == ".html":
        page = picture.read_text()
        found = re.search(r'<script id="data" type="application/json">(.*?)</script>', page)
        assert found is not None
        shown = name.encode("utf-8", "replace").decode()
        assert json.loads(found[1])["title"] == shown
        assert "<" not in found[1]
        assert page.count("<title>") == 1
        assert len(re.findall("@DATA@|@TITLE@", page)) == 2 * len(
            re.findall("@DATA@|@TITLE@", shown)
        )
    else:
        assert picture.stat().st_size > 5000
        if suffix == ".svg":
            ET.parse(picture)


def test_a_picture_of_too_many_moves_is_cut_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tool_path, "MOST_POINTS", 100)
    part = tmp_path / "long.nc"
    part.write_text("F10\nP200=0\nN10 P200=P200+1\nG1 X(P200)\nIF P200<500 THEN GOTO 10\n")
    code, text = plotted(part, tmp_path / "long.svg")
    assert (code, text.splitlines()[0]) == (0, "note: the picture shows the first 100 points")
    assert text.splitlines()[1].endswith(": 500 moves")


@pytest.mark.req("MILL-LIB-LIST")
@pytest.mark.parametrize("name", names())
def test_every_part_of_the_library_has_a_preview(name: str) -> None:
    store = Store()
    program = prepared(part_named(name), {}, store, is_metric=False, feed=10.0).program
    drawn = plot.scene_of(load(program, store), store, "acromill")[0].drawing.points
    assert len(drawn) > 1
    assert np.ptp(drawn, axis=0).max() > 0.0
