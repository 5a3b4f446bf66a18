"""What a program does, counted without a machine."""

import math

import pytest
from tests.cnc.programs import STORE

from openacr.cnc.interpreter.survey import Survey, survey
from openacr.cnc.loading.load import load
from openacr.cnc.state.shadow import Shadow


def of(text: str, cells: dict[int, float] | None = None) -> Survey:
    shadow = Shadow(STORE)
    for n, value in (cells or {}).items():
        shadow.write(n, value)
    return survey(load(text, shadow), shadow)


def test_moves_and_lengths_are_counted() -> None:
    found = of("G0 X3 Y4\nG1 F10 X0\nG4 F1\nT2 M6\nG0 Z5\nM2")
    assert found.move_cnts == {"rapid": 2, "feed": 1, "arc": 0, "dwell": 1}
    assert found.lengths == {"rapid": 10.0, "feed": 3.0}
    assert found.tools == [2]
    assert found.end[:3] == (0, 4, 5)


def test_arcs_reach_farther_than_their_ends() -> None:
    found = of("G0 X1\nG3 F10 X-1 I0 J0\nM2")
    assert found.lengths["feed"] == pytest.approx(math.pi)
    assert found.high[:2] == pytest.approx([1, 1])
    assert found.low[:2] == pytest.approx([-1, 0])


@pytest.mark.parametrize(
    ("text", "low", "high"),
    [
        ("G0 X10 Y5\nG1 Z-1 F10\nX12\nM2", (10, 5, -1), (12, 5, 0)),  # Z is cut from 0 on
        ("G0 X10 Y5\nG0 Z2\nG1 Z-1 F10\nX12\nM2", (10, 5, -1), (12, 5, 2)),
        ("G91 F10\nX1\nY1\nX-1\nM2", (0, 0, 0), (1, 1, 0)),  # the cut begins at zero
        ("G0 X4\nG3 F10 X6 Y2 I4 J2\nM2", (4, 0, 0), (6, 2, 0)),
        ("G0 X-5\nX5\nM2", (-5, 0, 0), (5, 0, 0)),
    ],
)
def test_extents_begin_where_the_program_brings_the_axes(
    text: str, low: tuple[float, ...], high: tuple[float, ...]
) -> None:
    found = of(text)
    assert [*found.low[:3], *found.high[:3]] == pytest.approx([*low, *high])


def test_the_data_are_complete() -> None:
    data = of("G1 X1 F10 G0\nX1").data()
    assert data["lines"] == 2
    assert data["errors"][0]["code"] == "E201"
    assert data["errors"][0]["column"] == 11
    assert data["end"] == {"X": 0.0, "Y": 0.0, "Z": 0.0}
    assert data["extents"] == {"min": [], "max": []}


def test_nothing_is_written_to_the_store() -> None:
    before = STORE.read(901), STORE.read(150)
    of("P150=99\nG10 L2 P1 X7\nM2")
    assert (STORE.read(901), STORE.read(150)) == before


def test_an_error_at_run_time_is_found_with_its_line() -> None:
    (error,) = of("X1 F10\nX(1/P150)\nM2", {150: 0}).errors
    assert (error.code, error.line) == ("E210", 2)


@pytest.mark.req("MILL-COMP-09", "MILL-COMP-27")
def test_all_gouges_are_found() -> None:
    """Example 27: the .4 sides of the rectangle cannot be reached with radius .25."""
    text = "G0 X0.5 Y0.2\nG42 D1 G1 F10 X0.5 Y0\nX0\nY0.4\nX1\nY0\nX0.5\nG40 X0.5 Y0.2\nM2"
    errors = of(text, {1001: 0.25}).errors
    assert {(e.code, e.line) for e in errors if e.code == "E322"} >= {("E322", 4), ("E322", 6)}


def test_errors_of_the_geometry_are_found_beside_errors_at_load() -> None:
    text = "G1 X1 F10\nG2 X5 Y5 I100\nG4 F0.05\nX(1/0)\nM2"
    assert [(f.code, f.line) for f in of(text).errors] == [("E240", 3)]
    narrow = "G0 X0.5 Y0.2\nG42 D1 G1 F10 X0.5 Y0\nX0\nY0.4\nX1\nY0\nX0.5\nG40 X0.5 Y0.2\n"
    found = of(f"{narrow}X1 X2\nX(1/0)\nM2", {1001: 0.25})
    assert [(f.code, f.line) for f in found.errors] == [("E322", 4), ("E322", 6), ("E202", 9)]
    assert found.move_cnts["feed"] == 0


def test_an_error_in_front_of_a_wrong_line_is_found_too() -> None:
    found = of("X1 F10\nX(1/P150)\nX1 X2\nM2", {150: 0})
    assert [(f.code, f.line) for f in found.errors] == [("E210", 2), ("E202", 3)]


def test_of_too_many_findings_the_errors_are_kept() -> None:
    """150 spirals, each with a warning, and then a move that cannot be read."""
    text = "F10\n" + "G2 X2 I.9 J0\nG0 X0\n" * 150 + "G2 X1 I0 J1\n"
    found = of(text)
    assert len(found.findings) == 100
    assert [(each.code, each.line) for each in found.errors] == [("E230", 302)]
    assert [each.line for each in found.warnings] == list(range(2, 200, 2))


@pytest.mark.parametrize(
    ("text", "store_unit", "unit", "x", "feed"),
    [
        ("G21 F100 G1 X50.8", 0.0, "mm", 50.8, 50.8),
        ("G20 F10 G1 X2", 0.0, "inch", 2.0, 2.0),
        ("G20 F10 G1 X2", 1.0, "inch", 2.0, 2.0),
        ("G21 F10 G1 X2", 1.0, "mm", 2.0, 2.0),
        ("F10 G1 X2", 0.0, "inch", 2.0, 2.0),
        ("G21\nG20 F10 G1 X2\nG21 X101.6", 0.0, "inch", 4.0, 4.0),  # that of the first move
        ("M3", 1.0, "inch", 0.0, 0.0),  # that of the start
    ],
)
def test_a_program_is_reported_in_its_own_unit(
    text: str, store_unit: float, unit: str, x: float, feed: float
) -> None:
    data = of(text, {250_001: store_unit}).data()
    assert data["unit"] == unit
    assert data["end"]["X"] == pytest.approx(x)
    assert data["length"]["feed"] == pytest.approx(feed)
    if x:
        assert data["extents"]["max"][0] == pytest.approx(x)


def test_a_rotary_axis_is_reported_in_degrees() -> None:
    found = of("G21 F100 G1 X25.4 A90", {203_012: 1.0})
    assert found.data()["end"] == {"X": 25.4, "Y": 0.0, "Z": 0.0, "A": 90.0}
    assert [found.unit_of(letter) for letter in "XA"] == ["mm", "deg"]
