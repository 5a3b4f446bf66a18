"""Moves of part programs as points for a picture."""

from math import cos, hypot, pi

import numpy as np
import pytest

from openacr.cnc.canonical import Line, Pace, PathMode, Plane, Polyline, Source
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.mill.plan.pictures import tool_path
from openacr.mill.plan.pictures.tool_path import Drawing, Kind, ToolPath, chords, thinned
from openacr.sysvar import Store

STORE = Store()


def drawn(text: str, axes: tuple[int, ...] = (0, 1, 2)) -> Drawing:
    cells = Shadow(STORE)
    for axis in range(3):
        cells.write(200_012 + 1000 * axis, 1.0)
    cells.write(1001, 0.25)
    path = ToolPath(axes, 1e-4)
    machine = Interpreter(load(text, cells), cells, VirtualMachine(), options=Options(watch=path))
    for entry in machine.entries():
        path.add(entry)
    return path.finished()


PART = "G42 D1 F10 G1 X0 Y0\nX1\nY1\nG40 X0 Y1\nG0 Z1"


def test_kinds_of_moves_are_distinguished() -> None:
    drawing = drawn("G0 X-1 Y-1\nG1 F10 X0 Y-1\n" + PART)
    kinds = [Kind(kind) for kind in drawing.kinds]
    assert kinds[:4] == [Kind.RAPID, Kind.FEED, Kind.COMPENSATED, Kind.COMPENSATED]
    assert kinds[-3:] == [Kind.COMPENSATED, Kind.COMPENSATED, Kind.RAPID]
    assert set(kinds[4:-3]) == {Kind.INSERTED}
    assert drawing.lines[:4].tolist() == [1, 2, 3, 4]
    assert len(drawing.points) == len(kinds) + 1


def test_the_programmed_contour_is_kept_beside_the_compensated_path() -> None:
    (contour,) = drawn("G0 X-1 Y-1\n" + PART).contours
    assert contour.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]


def test_a_contour_that_does_not_go_on_is_a_new_one() -> None:
    assert len(drawn("G0 Y-1\n" + PART + "\nX5 Y-1\n" + PART).contours) == 2


@pytest.mark.req("MILL-GFX-ARCS")
@pytest.mark.parametrize("radius", [0.1, 2.0])
def test_arcs_are_drawn_as_curves(radius: float) -> None:
    start, end = (radius, *(0.0,) * 7), (-radius, *(0.0,) * 7)
    points = np.array([start, *chords(start, end, Plane.XY, (0, 0), pi, 1e-4)])
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(radius)
    assert (points[:, 1] >= -1e-12).all()
    middles = 0.5 * (points[1:] + points[:-1])
    assert (radius - np.hypot(middles[:, 0], middles[:, 1])).max() <= 1.1e-4


@pytest.mark.req("MILL-GFX-ARCS")
def test_a_helix_rises_along_its_turns() -> None:
    drawing = drawn("F10 G0 X1\nG3 X1 Y0 Z-1 I0 J0 G200 F2")
    turn = drawing.points[1:]
    assert np.hypot(turn[:, 0], turn[:, 1]) == pytest.approx(1.0)
    assert (np.diff(turn[:, 2]) < 0).all()
    assert turn[-1] == pytest.approx([1, 0, -1])


def test_very_large_arcs_get_no_more_than_360_chords_a_turn() -> None:
    start = (1e6, *(0.0,) * 7)
    assert len(chords(start, start, Plane.XY, (0, 0), 2 * pi, 1e-9)) == 360
    small = (1e-3, *start[1:])
    assert len(chords(small, small, Plane.XY, (0, 0), 2 * pi, 1.0)) == 72


def test_extents_include_the_start_and_the_bulge_of_arcs() -> None:
    drawing = drawn("F10\nG3 X0 Y2 I0 J1 G200 F2\nG1 X0 Z-3")
    assert drawing.low == pytest.approx([0, 0, -3])
    assert drawing.high == pytest.approx([1, 2, 0], abs=1e-3)


def test_tools_have_strokes_of_their_own() -> None:
    drawing = drawn("T1 M6\nF10 X1\nG0 Y1\nT2 M6\nG1 X2\nX3\nG0 Y5\nG1 X7")
    assert drawing.styles() == [(Kind.RAPID, 0), (Kind.FEED, 1), (Kind.FEED, 2)]
    stroke = drawing.strokes(Kind.FEED, 2)
    gaps = np.isnan(stroke[:, 0])
    assert gaps.tolist() == [True, False, False, False, True, False, False]
    assert stroke[~gaps][:, :2].tolist() == [[1, 1], [2, 1], [3, 1], [3, 5], [7, 5]]
    assert drawing.style_numbers().tolist() == [1, 0, 2, 2, 0, 2]


def test_bands_of_height_together_are_the_whole() -> None:
    drawing = drawn("F10 X1 Z-1\nX2 Z-2\nX3 Z0\nX4 Z-.5")
    moves = sum(
        int((~np.isnan(drawing.strokes(Kind.FEED, 0, band, 4)[:, 0])).sum())
        - int(np.isnan(drawing.strokes(Kind.FEED, 0, band, 4)[:, 0]).sum())
        for band in range(4)
    )
    assert moves == 4


def test_many_lines_at_once_are_taken_as_they_are() -> None:
    path = ToolPath((0, 1, 2), 1e-4)
    ends = np.arange(24, dtype=np.float64).reshape(3, 8)
    path.add(Polyline(Source("", 5, ""), ends, np.array([5, 6, 7]), None))  # type: ignore[arg-type]
    drawing = path.finished()
    assert drawing.points.tolist() == [[0, 0, 0], [0, 1, 2], [8, 9, 10], [16, 17, 18]]
    assert drawing.lines.tolist() == [5, 6, 7]


def test_a_machine_without_z_is_drawn_flat() -> None:
    assert drawn("F10 X1 Y2 Z3", axes=(0, 1)).high.tolist() == [1, 2, 0]


def test_thinning_keeps_ends_gaps_and_the_picture() -> None:
    angle = np.linspace(0, 20 * pi, 20_000)
    spiral = np.column_stack([angle * np.cos(angle), angle * np.sin(angle)])
    strokes = np.vstack([[[np.nan, np.nan]], spiral, [[np.nan, np.nan]], spiral[::-1]])
    few = thinned(strokes, 0.5)
    assert len(few) < len(strokes) / 4
    assert np.isnan(few[:, 0]).sum() == 2
    assert few[1].tolist() == few[-1].tolist() == spiral[0].tolist()
    steps = np.diff(few[~np.isnan(few[:, 0])], axis=0)
    assert np.hypot(*steps.T).max() <= hypot(0.5, 0.5) * 2 * (1 + cos(0))


def test_a_picture_keeps_three_values_a_point_and_a_bounded_count(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(tool_path, "MOST_POINTS", 10)
    monkeypatch.setattr(tool_path, "AT_ONCE", 4)
    path = ToolPath((0, 1, 2), 0.001)
    for n in range(30):
        end = (float(n + 1), 0.0, 0.0, *(0.0,) * 5)
        path.add(Line(Source("", n + 1, ""), end, Pace(1.0, PathMode.FREE)))
        assert path.is_full == (n >= 9)
    drawing = path.finished()
    assert drawing.points[:, 0].tolist() == [float(n) for n in range(11)]
    assert drawing.lines.tolist() == list(range(1, 11))
    assert drawing.points.shape == (11, 3)
