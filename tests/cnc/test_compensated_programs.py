"""Cutter radius compensation as part programs switch it."""

from math import sqrt

import pytest
from tests.cnc.programs import STORE, errors, run

from openacr.cnc.canonical import Arc, BlockEnd, Line, Sync
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.interpreter.survey import Survey, survey
from openacr.cnc.loading.load import load
from openacr.cnc.state.shadow import Shadow

RADIUS = {1001: 0.25}


def surveyed(text: str, cells: dict[int, float]) -> Survey:
    shadow = Shadow(STORE)
    for n, value in cells.items():
        shadow.write(n, value)
    return survey(load(text, shadow), shadow)


def test_the_radius_of_the_setup_holds_without_d() -> None:
    text = "G41 F10 G1 X0 Y0\nX1\nY1\nG40 X0 Y1"
    assert run(text, {100_020: 0.25}, start=(0, 1, 0)).moves[1] == "L X0.75 Y0.25"


def test_a_z_move_on_the_way_is_made_where_the_tool_is() -> None:
    text = "G42 D1 F10 G1 X0 Y0\nX1\nZ-1\nM8\nY1\nG40 X0 Y1"
    done = run(text, RADIUS, start=(0, -1, 0))
    assert done.story[1:5] == [
        "L X1 Y-0.25",
        "L X1 Y-0.25 Z-1",
        "coolant 01",
        "A X1.25 Z-1 about 1,0 90",
    ]


def test_a_length_offset_on_the_way_moves_nothing_that_waits() -> None:
    text = "G41 D1 F10 G1 X0 Y0\nX1\nG43 H1\nY1\nZ0\nG40 X0 Y1"
    done = run(text, {1001: 0.25, 2001: 3.0}, start=(0, 1, 0))
    assert done.moves == [
        "L Y0.25",
        "L X0.75 Y0.25",
        "L X0.75 Y1",
        "L X0.75 Y1 Z3",
        "L Y1 Z3",
    ]


def test_a_work_offset_on_the_way_moves_nothing_that_waits() -> None:
    text = "G54 G41 D1 F10 G1 X0 Y0\nX1\nG55\nY-9\nG40 X-10 Y-9"
    done = run(text, {1001: 0.25, 920: 10.0, 921: 10.0}, start=(0, 1, 0))
    assert done.moves == ["L Y0.25", "L X0.75 Y0.25", "L X0.75 Y1", "L Y1"]


def test_after_a_lone_g40_another_plane_begins_where_the_tool_is() -> None:
    text = "G41 D1 F10 G1 X0 Y0\nX2\nG40\nG18\nZ1\nX3"
    done = run(text, RADIUS, start=(0, 1, 0))
    assert done.moves == ["L Y0.25", "L X2 Y0.25", "L X2 Y0.25 Z1", "L X3 Y0.25 Z1"]


def test_after_a_lone_g40_a_reference_move_begins_where_the_tool_is() -> None:
    text = "G41 D1 F10 G1 X0 Y0\nX2\nG40\nG28 Z1\nZ0"
    done = run(text, {1001: 0.25, 282: 5.0}, start=(0, 1, 0))
    assert done.moves[2:] == ["R X2 Y0.25 Z1", "R X2 Y0.25 Z5", "L X2 Y0.25"]


@pytest.mark.parametrize(
    ("code", "error"),
    [
        ("G53", "E310"),
        ("G18", "E311"),
        ("G51 X0 Y0 P2", "E311"),
        ("G68 X0 Y0 R45", "E311"),
        ("G28 X0", "E312"),
        ("G81 Z-1 R0", "E312"),
        ("G31 X9", "E243"),
    ],
)
def test_what_compensation_forbids(code: str, error: str) -> None:
    text = f"G41 D1 F10 G1 X0 Y0\nX2\n{code}\nX3\nM2\n$I CYCLES.TXT"
    assert errors(text, RADIUS) == [error]


def test_a_stop_on_the_way_breaks_the_chain() -> None:
    text = "G42 D1 F10 G1 X0 Y0\nX1\nM0\nY1\nG40 X0 Y1"
    done = run(text, RADIUS, start=(0, -1, 0))
    assert done.story[1:4] == ["L X1 Y-0.25", "M0", "A X1.25 about 1,0 90"]
    kinds = [type(e) for e in done.entries]
    assert Sync in kinds[2:5]


def test_single_block_stops_after_the_inserted_move() -> None:
    text = "G42 D1 F10 G1 X0 Y0\nX1\nY1\nG40 X0 Y1"
    done = run(text, RADIUS, start=(0, -1, 0), options=Options(has_block_ends=True))
    steps = [
        e.source.line if isinstance(e, BlockEnd) else type(e).__name__
        for e in done.entries
        if isinstance(e, BlockEnd | Line | Arc)
    ]
    assert steps == ["Line", 1, "Line", "Arc", 2, "Line", 3, "Line", 4]


def test_the_check_finds_a_neck_between_distant_lines() -> None:
    text = "G0 X-1 Y2\nG41 D1 G1 F10 X0 Y0\nX3\nY1\nX4\nY.3\nX6\nY3\nX2.7\nY.7\nX0\nG40 X-1 Y.3\nM2"
    found = surveyed(text, {1001: 0.2})
    near = [f for f in found.warnings if f.code == "W323"]
    assert ("tool comes to 0.1 from line 4, its radius is 0.2", 10) in [
        (f.text, f.line) for f in near
    ]
    assert "W323" not in {f.code for f in surveyed(text, {1001: 0.05}).warnings}


def test_with_gouge_stop_off_the_program_runs_without_what_cannot_be_reached() -> None:
    text = "G41 D1 F10 G1 X0 Y0\nX1\nX1.1 Y.1\nY2\nG40 X0 Y2"
    done = run(text, {1001: 0.5, 250_130: 0}, start=(0, 2, 0))
    assert done.moves == ["L Y0.5", "L X0.6 Y0.5", "L X0.6 Y2", "L Y2"]
    assert "W322" in done.codes


def test_leads_to_and_from_a_closed_contour_are_no_edges_of_it() -> None:
    """Quarters of a circle touch the contour at one point, which the tool has to pass."""
    around = "F10 G0 X2.4 Y0\nG41 D1 G1 X2.5 Y-.5\nG3 X3 Y0 I2.5 J0\nG1 {}\n"
    around += "G3 X2.5 Y.5 I2.5 J0\nG40 G1 X2.4 Y0\nM2"
    closed = surveyed(around.format("Y3\nX-3\nY-3\nX3\nY0"), RADIUS)
    assert closed.findings == []
    spike = "X-3\nY1\nX2.6 Y.8\nX-3 Y.6\nY-3"  # its tip is too near to the other side
    narrow = surveyed(around.format(f"Y3\n{spike}\nX3\nY0"), RADIUS)
    assert narrow.errors == []
    assert {f.code for f in narrow.warnings} == {"W323"}


@pytest.mark.req("MILL-SYS-CTL-ROOTEPS")
@pytest.mark.parametrize(("root_epsilon", "codes"), [(None, []), (-3, []), (-5, ["E321"])])
def test_the_root_epsilon_says_which_circles_still_meet(
    root_epsilon: float | None, codes: list[str]
) -> None:
    # A lens of two circles of radius .0502 whose centres are .1 apart, cut with radius .001: the
    # argument of the root is .0492^2 - .05^2 = -7.94e-5, between -10^-4 (the default) and -10^-5.
    top = sqrt(0.0502**2 - 0.05**2)
    text = (
        f"G0 X0 Y0\nG41 D1 G1 X0 Y{-top:.9f} F10\n"
        f"G3 X0 Y{top:.9f} I-.05 J0\nG3 X0 Y{-top:.9f} I.05 J0\nG40 G1 X0 Y0"
    )
    cells = {1001: 0.001, 250_101: 1e-4}
    if root_epsilon is not None:
        cells[250_103] = root_epsilon
    assert errors(text, cells) == codes
    if not codes:
        done = run(text, cells)
        assert done.ends[1] == (0, 0, 0)  # forced to meet, midway between the centres
        assert "W320" in done.codes
