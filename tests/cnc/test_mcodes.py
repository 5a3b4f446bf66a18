"""M codes: spindle, coolant, outputs, waits, tools, stops, the tangential axis."""

from pathlib import Path

import pytest
from tests.cnc.programs import errors, run

from openacr.cnc.canonical import End, Rapid
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.loading.load import Folders

DRY = Options(is_dry=True)


def test_m30_ends_the_program_where_that_is_chosen() -> None:
    done = run("F10 X1\nM30\nX2", {700_002: 1.0})
    assert done.moves == ["L X1"]
    assert done.of(End)[0].is_by_code  # type: ignore[union-attr]
    assert "W216" not in done.codes
    assert "W216" in run("F10 X1\nM30").codes


@pytest.mark.parametrize(("text", "is_doubtful"), [("M3", True), ("S0\nM3", False), ("M5", False)])
def test_a_spindle_without_a_speed_is_doubtful(text: str, is_doubtful: bool) -> None:
    assert ("W217" in run(text).codes) == is_doubtful


def test_actions_stand_on_their_side_of_the_motion() -> None:
    done = run("M9 M5 M8 S5 M3 G1 X1 F10 M0").story
    assert done == ["M3 S5", "coolant 01", "L X1", "M5 S5", "coolant 00", "M0", "end"]


@pytest.mark.req("MILL-M-DRYRUN")
def test_dry_runs_leave_the_standard_codes_out() -> None:
    codes = "\n".join(f"M{n}" for n in [0, 1, 3, 4, 5, 7, 8, 9, *range(12, 38)])
    assert run(f"S10\n{codes}\nF10 X1\nM2", options=DRY).story == ["L X1", "end"]
    done = run("M105\nT3 M6\nP200=P235\nG4 F1", options=DRY)
    assert done.story == ["say M105: wait left out", "SetCell", "dwell 1", "end"]
    assert done.p(200) == 3


@pytest.mark.req("MILL-VAR-CUSTOM")
@pytest.mark.parametrize("line", ["P200=1/P201", "G1 X(1/P201)", "GOTO (P201+77)"])
def test_a_code_of_the_user_that_fails_stops_the_program(tmp_path: Path, line: str) -> None:
    (tmp_path / "M300.TXT").write_text(f"P201=0\n{line}\nRET\n")
    done = run("F10 G1 X1\nM300\nX2", folders=Folders(customs=tmp_path))
    assert done.moves == ["L X1"]
    assert done.error is not None
    assert done.error.line == 2


@pytest.mark.req("MILL-M-CUSTOM", "MILL-RUN-DRY-CUSTOM", "MILL-VAR-CUSTOM")
@pytest.mark.parametrize("options", [None, DRY])
def test_codes_of_the_user_are_programs(tmp_path: Path, options: Options | None) -> None:
    (tmp_path / "M300.TXT").write_text("OUT(40)=1\nG91 G1 Z#3\nG90\nGOTO 5\nX99\nN5 M8\nRET\n")
    folders = Folders(customs=tmp_path)
    done = run("F10\nM300 Z-2\nX1", folders=folders, options=options)
    coolant = [] if options else ["coolant 01"]
    assert done.story == ["out 40 1", "L Z-2", *coolant, "L X1 Z-2", "end"]


def test_a_failing_code_of_the_user_stops_the_program(tmp_path: Path) -> None:
    (tmp_path / "m301.txt").write_text("P200=1/0\nRET\n")
    (tmp_path / "M302.TXT").write_text("X1 X2\nRET\n")
    folders = Folders(customs=tmp_path)
    done = run("F10 X1\nM301\nX2", folders=folders)
    assert done.error is not None
    assert (done.error.code, done.error.file.upper(), done.error.line) == ("E210", "M301.TXT", 1)
    assert done.moves == ["L X1"]
    assert errors("M302", folders=folders) == ["E202"]
    assert errors("M301 P5", folders=folders) == ["E206"]


def test_tool_changes_happen_once() -> None:
    done = run("S5 M3\nT2 M6\nT2 M6\nT0\nM6").story
    changes = [s for s in done if s != "SetCell"]
    assert changes == ["M3 S5", "M5 S5", "tool 2", "tool 0", "end"]


@pytest.mark.parametrize("dialect", ["acromill", "rs274ngc"])
def test_the_tool_in_the_spindle_is_known_from_the_last_run(dialect: str) -> None:
    cells = {234: 7.0, 235: 3.0}
    changes = [s for s in run("T3 M6\nT5 M6", cells, dialect=dialect).story if "tool" in s]
    assert changes == ["tool 5"]
    assert "tool 7" in run("M6", cells, dialect=dialect).story


def test_state_is_readable_by_programs() -> None:
    text = "T3 M6 S500 M4 M7 M8 D2 H3 F20 G55\n" + "\n".join(
        f"P{450 + k}=P{n}" for k, n in enumerate([234, 235, 236, 237, 238, 239, 240, 241, 242, 998])
    )
    done = run(text)
    assert [done.p(450 + k) for k in range(10)] == [3, 3, 2, 3, 500, 20, 4, 3, 20, 2]
    assert errors("P240=3") == ["E212"]


# --- the tangential axis --------------------------------------------------------------------

TANGENT = {250_112: 3.0}


@pytest.mark.req("MILL-M595", "MILL-SYS-CTL-TANGAXIS")
def test_the_axis_turns_at_corners_and_along_arcs() -> None:
    done = run("F10 M595\nG1 X1\nY1\nG3 X0 Y2 I0 J1", TANGENT, axes=4)
    assert done.moves == [
        "L X1", "R X1 A90", "L X1 Y1 A90", "A Y2 A180 about 0,1 90",
    ]  # fmt: skip
    turns = [e for e in done.of(Rapid) if isinstance(e, Rapid)]
    assert all(turn.is_inserted for turn in turns)


def test_the_angle_on_arcs_is_that_of_the_path_in_every_work_coordinate_system() -> None:
    """Three quarters of a turn from the right of the centre, its place shifted on both axes."""
    g54 = run("G10 L2 P1 X5 Y-3\nG54\nF10 G0 X1 Y0\nM595\nG3 X0 Y-1 I0 J0", TANGENT, axes=4)
    assert g54.moves == ["R X6 Y-3", "R X6 Y-3 A90", "A X5 Y-4 A360 about 5,-3 270"]
    back = run("G10 L2 P1 X5 Y-3\nG54\nF10 G0 X1 Y0\nM595\nG2 X0 Y1 I0 J0", TANGENT, axes=4)
    assert back.moves == ["R X6 Y-3", "R X6 Y-3 A-90", "A X5 Y-2 A-360 about 5,-3 -270"]


@pytest.mark.parametrize(("on", "off"), [(595, 599), (597, 596), (598, 596)])
def test_the_end_code_of_another_leaves_the_axis_turning(on: int, off: int) -> None:
    done = run(f"F10 M{on}\nX1\nM{off}\nY1", TANGENT, axes=4)
    assert "".join(move[0] for move in done.moves)[-3:] == "LRL"


@pytest.mark.req("MILL-BEY-PERPEPS")
def test_small_changes_of_direction_are_spread_over_the_move() -> None:
    text = "F10 M595\nX1\nX2 Y.1\nX3 Y1"
    done = run(text, {**TANGENT, 250_113: 10.0}, axes=4)
    assert [m[0] for m in done.moves] == ["L", "L", "R", "L"]
    assert done.moves[1] == "L X2 Y0.1 A5.71059"


def test_moves_across_the_plane_keep_the_angle() -> None:
    done = run("F10 M595\nY1\nZ5", TANGENT, axes=4)
    assert done.moves == ["R A90", "L Y1 A90", "L Y1 Z5 A90"]


def test_turns_take_the_shortest_direction() -> None:
    done = run("F10 M595\nX-1\nX-2 Y-1", TANGENT, axes=4)
    assert done.moves[0] == "R A180"
    assert done.moves[2] == "R X-1 A225"


# --- parameters ---------------------------------------------------------------------------


@pytest.mark.parametrize("n", [0, 1, 33, 4096, 6144, 20_487])
def test_card_parameters_are_written_and_read_on_the_card(n: int) -> None:
    done = run(f"P{n}=7\nP200=P{n}+1")
    assert done.machine.parameters[n] == 7
    assert done.p(200) == 8
    assert n not in done.cells.written


def test_the_radius_of_programs_without_d_is_a_setting() -> None:
    done = run("G41 G1 F10 X1\nX2", {100_020: 0.25})
    assert done.moves[-1] == "L X2 Y0.25"


def test_the_start_set_holds_at_the_start() -> None:
    cells = {
        100_010: 1.0, 100_011: 0.0, 100_012: 18.0, 100_013: 91.0, 100_014: 21.0, 100_015: 55.0,
        100_016: 61.0, 100_017: 99.0, 100_018: 1.0, 100_021: 33.0,
    }  # fmt: skip
    from tests.cnc.programs import made

    modal = made("M2", cells).interpreter
    next(modal.entries())
    modal.begin()
    state = modal.modal
    assert (state.motion, state.plane, state.distance, state.unit) == (0, 18, 91, 21)
    assert (state.work, state.path, state.return_level, state.centres) == (2, 61, 99, 1)
    assert state.feed == 33


@pytest.mark.req("MILL-RUN-FEEDDEFAULT")
def test_without_f_the_cut_speed_holds() -> None:
    done = run("X1", {650_002: 12.0})
    assert done.entries[0].pace.feed_upm == 12  # type: ignore[union-attr]
    assert "W218" in done.codes
    done = run("X1", {100_021: 5.0})
    assert done.entries[0].pace.feed_upm == 5  # type: ignore[union-attr]
    assert "W218" not in done.codes


def test_the_end_puts_the_state_back() -> None:
    done = run("G91 G21 G55 G61 G18 F77 D1 H1 G68 X0 Z0 R5 M2", {2001: 3.0})
    modal = done.interpreter.modal
    assert (modal.distance, modal.unit, modal.work, modal.path, modal.plane) == (90, 20, 1, 64, 17)
    assert (modal.length, modal.length_number, modal.radius_number) == (49, 0, 0)
    assert done.interpreter.path.coordinates.is_plain


def test_abort_keeps_the_work_system_and_the_local_shift() -> None:
    done = run("F10 X1")
    interpreter = done.interpreter
    interpreter.modal.work = 3
    interpreter.cells.write(990, 1.5)
    interpreter.abort()
    assert interpreter.modal.work == 3
    assert interpreter.cells.read(990) == 1.5
    assert interpreter.modal.compensation == 40


@pytest.mark.req("MILL-FLOW-REPEAT")
def test_a_program_can_be_run_again_with_the_start_set() -> None:
    done = run("G91 F10\nX1\nM2")
    again = [e.end[0] for e in done.interpreter.entries() if hasattr(e, "end")]
    assert again == [2]
