"""Starting in the middle of a program."""

import pytest
from tests.cnc.programs import CYCLES, Bench, made, shown

from openacr.cnc.canonical import Line, Point
from openacr.cnc.interpreter.replay import Difference, Replay, StartError, start_at

TEXT = "G0 Z1\nG1 X1 F10\nM3 S100\nG10 L2 P1 X5\nX2\nP150=7\nX3\nX4\nM2"


def story(replay: Replay) -> list[str]:
    return [shown(entry) for entry in replay.entries() if type(entry).__name__ != "Sync"]


@pytest.mark.req("MILL-RUN-STARTLINE", "MILL-RUN-STARTLINE-STATE")
def test_the_skipped_lines_leave_their_state() -> None:
    done = made(TEXT, {150: 0})
    replay = start_at(done.interpreter, 8)
    assert replay.run.modal.feed == 10
    assert story(replay) == [
        "R Z1", "R X8 Z1", "M3 S100", "coolant 00", "L X8 Z1", "L X9 Z1", "end",
    ]  # fmt: skip
    assert done.p(150) == 7


def test_nothing_is_written_before_the_start_is_confirmed() -> None:
    done = made(TEXT, {150: 1})
    replay = start_at(done.interpreter, 8)
    assert replay.shadow.written[150] == 7


@pytest.mark.parametrize(("is_on", "x"), [(False, 1.0), (True, 2.0)])
@pytest.mark.parametrize("state", ["INP(5)", "OUT(40)", "BIT(777)"])
def test_states_of_the_card_are_read_as_they_are_now(state: str, is_on: bool, x: float) -> None:
    machine = Bench()
    if is_on:
        machine.bits.add(int(state.strip("INPOUTB()")))
    done = made(
        f"F10 G0 Z1\nIF {state}=1 THEN GOTO 5\nX1\nGOTO 9\nN5 X2\nN9 Y1\nM2", machine=machine
    )
    replay = start_at(done.interpreter, 6)
    assert replay.run.path.program[0] == x
    assert replay.warnings == ["values of the card were read as they are now"]
    assert start_at(made("F10 G0 Z1\nX1\nY1\nM2").interpreter, 3).warnings == []


@pytest.mark.req("MILL-RUN-STARTLINE-BAD")
@pytest.mark.parametrize("line", [0, 10, 1000])
def test_a_line_the_program_does_not_have_is_refused(line: int) -> None:
    with pytest.raises(StartError, match="lines 1 to 9"):
        start_at(made(TEXT).interpreter, line)


def test_a_line_that_is_never_reached_is_refused() -> None:
    text = "F10 X1\nGOTO 5\nX2\nN5 X3\nM2"
    with pytest.raises(StartError, match="never reached"):
        start_at(made(text).interpreter, 3)


def test_a_line_of_a_subroutine_is_refused() -> None:
    text = "F10 GOSUB 5".replace("F10 ", "") + "\nM2\nN5 X3 F10\nX4\nRET"
    with pytest.raises(StartError, match="subroutine"):
        start_at(made(text).interpreter, 4)


def test_differences_name_what_has_to_change() -> None:
    done = made("T3 M6 G0 Z1\nS100 M3 M8\nG55 G1 X1 F10\nM14\nX2\nM2", {400_103: 40})
    replay = start_at(done.interpreter, 5)
    names = {difference.name for difference in replay.differences}
    assert names == {
        "tool", "S", "spindle", "coolant", "work system", "output 40", "position",
    }  # fmt: skip
    assert replay.needs_tool
    assert Difference("S", 0.0, 100.0) in replay.differences


def approach(text: str, line: int, where: Point, level: float | None = None) -> list[str]:
    """The moves and actions in front of a start line, for a tool that is at `where`."""
    machine = Bench()
    done = made(text, machine=machine)
    machine.where = where
    done.interpreter.path.begin(where)
    return [shown(entry) for entry in start_at(done.interpreter, line, level).approach()]


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Point:
    return (x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0)


PART = "G0 Z3\nX1 Y1\nM3 S500 M8\nG0 Z.5\nG1 Z-1 F7\nX2\nY2\nM2"


def test_from_a_cut_the_tool_is_retracted_before_anything_else_moves() -> None:
    assert approach(PART, 7, at(1.6, 1, -1)) == [
        "R X1.6 Y1 Z3",
        "R X2 Y1 Z3",
        "M3 S500",
        "coolant 01",
        "L X2 Y1 Z-1",
    ]


def test_the_tool_comes_down_at_feed_also_where_the_lines_end_with_a_rapid() -> None:
    done = approach(PART, 5, at(5, 5, -1))
    assert [done[0], done[1], done[-1]] == ["R X5 Y5 Z3", "R X1 Y1 Z3", "L X1 Y1 Z0.5"]
    (down,) = [
        entry for entry in start_at(made(PART).interpreter, 6).approach() if isinstance(entry, Line)
    ]
    assert down.pace.feed_upm == 7.0


def test_the_level_is_never_below_the_tool_nor_below_where_it_is_wanted() -> None:
    assert approach(PART, 7, at(5, 5, 9))[:2] == ["R X5 Y5 Z9", "R X2 Y1 Z9"]
    high = "G0 Z3\nG1 F7 Z4\nX2\nX3"
    assert approach(high, 4, at(1, 1, -1))[:2] == ["R X1 Y1 Z4", "R X2 Y1 Z4"]


def test_the_level_may_be_named_and_the_higher_one_counts() -> None:
    assert approach("G1 F7 X2\nX3", 2, at(1, 1, -1), 2.5) == [
        "R X1 Y1 Z2.5", "R X2 Y1 Z2.5", "M5 S0", "coolant 00", "L X2 Y1 Z-1",
    ]  # fmt: skip
    assert approach(PART, 7, at(5, 5, -1), 2.5)[0] == "R X5 Y5 Z3"
    assert approach(PART, 7, at(5, 5, -1), 3.5)[0] == "R X5 Y5 Z3.5"
    assert approach("G0 Z-3\nG1 Z-4 F7\nX2\nX3", 4, at(1, 1, -9), 0.0)[0] == "R X1 Y1"


@pytest.mark.parametrize(
    "text",
    [
        "G1 F7 X2\nX3",  # no rapid
        "G0 X2\nX3",  # a rapid at the level the tool happens to have
        "G91 G0 Z1\nG90 X2\nX3",  # up from wherever it is
        "G1 Z2 F7\nX2\nX3",  # at feed it may be in the part
    ],
)
def test_without_a_level_the_tool_is_not_moved_over_the_part(text: str) -> None:
    with pytest.raises(StartError, match="its machine position has to be given"):
        approach(text, text.count("\n") + 1, at(1, 1, -1))


def test_along_its_axis_the_tool_moves_without_a_level() -> None:
    assert approach("G1 Z-2 F7\nX5", 2, at(1, 1, -1))[-1] == "L X1 Y1 Z-2"


def test_a_machine_without_a_tool_axis_has_no_level() -> None:
    done = made("G1 F7 X2\nX3", {200_012 + 2000: 0.0})
    assert [shown(entry) for entry in start_at(done.interpreter, 2).approach()][1] == "R X2"


def test_the_tool_axis_is_z_in_every_plane() -> None:
    text = "G18 G0 Z3\nG1 F7 X2 Y5 Z-1\nX3"
    assert approach(text, 3, at(1, 1, -1))[:2] == ["R X1 Y1 Z3", "R X2 Y5 Z3"]


def test_increments_from_an_unknown_place_are_warned_of() -> None:
    done = made("G0 Z1\nG91 F7 X1 Z-2\nG90 Y3\nX3")
    warned = "X: increments were counted from where the machine is now"
    assert start_at(done.interpreter, 4).warnings == [warned]
    done = made("G0 Z1\nG91 F7 X1\nG90 X3\nX4")
    assert start_at(done.interpreter, 4).warnings == []


def test_the_approach_begins_where_the_machine_is_when_the_start_is_agreed_to() -> None:
    machine = Bench()
    replay = start_at(made(PART, machine=machine).interpreter, 7)
    machine.where = at(8, 8, -2)
    assert story(replay)[:2] == ["R X8 Y8 Z3", "R X2 Y1 Z3"]


def test_an_inverted_output_is_compared_as_it_acts() -> None:
    machine = Bench(bits={40})
    cells = {400_101: 40, 400_102: 41, 252_040: 1.0, 252_041: 1.0}
    replay = start_at(made("M12\nM13\nX1 F10\nM2", cells, machine=machine).interpreter, 3)
    assert replay.differences == [Difference("output 40", 0.0, 1.0)]


def test_an_output_that_is_none_makes_no_difference() -> None:
    assert start_at(made("M12\nX1 F10\nM2").interpreter, 2).differences == []


def test_a_tool_that_stays_makes_no_difference() -> None:
    done = made("X0 F10\nX1\nM2", {234: 3.0, 235: 3.0})
    assert not start_at(done.interpreter, 2).needs_tool


def test_variables_of_the_card_are_written_when_the_start_is_confirmed() -> None:
    done = made("P5=P5+1 G0 Z1\nP30=4\nT P30\nG1 F10 X(P5)\nX9\nM2", {5: 2.0})
    card = done.machine.parameters
    replay = start_at(done.interpreter, 5)
    assert (replay.run.position[0], card) == (3.0, {5: 2.0})
    next(replay.entries())
    assert card == {5: 3.0, 30: 4.0}


def test_a_probe_counts_as_not_tripped() -> None:
    machine = Bench(trip=(9.0,) * 8)
    replay = start_at(made("F10 G31 X1\nY1\nY2", machine=machine).interpreter, 3, 1.0)
    assert replay.run.position[:2] == (1, 1)


def test_values_of_the_card_are_read_with_a_warning() -> None:
    replay = start_at(made("P200=P5\nX(P200) F10\nX2", {5: 3.0}).interpreter, 3, 1.0)
    assert replay.run.position[0] == 3
    assert replay.warnings


def test_cycles_may_stand_in_front_of_the_line() -> None:
    replay = start_at(made("G81 X1 Z-1 R0 F10\nX2\nG80 X3" + CYCLES).interpreter, 3)
    assert replay.run.modal.cycle == 81
    assert replay.run.position[:3] == (2, 0, 0)
