"""Starting in the middle of a program."""

import pytest
from tests.cnc.programs import CYCLES, Bench, made, shown

from openacr.cnc.replay import Difference, Replay, StartError, start_at

TEXT = "G1 X1 F10\nM3 S100\nG10 L2 P1 X5\nX2\nP150=7\nX3\nX4\nM2"


def story(replay: Replay) -> list[str]:
    return [shown(entry) for entry in replay.entries() if type(entry).__name__ != "Sync"]


@pytest.mark.req("MILL-RUN-STARTLINE", "MILL-RUN-STARTLINE-STATE")
def test_the_skipped_lines_leave_their_state() -> None:
    done = made(TEXT, {150: 0})
    replay = start_at(done.interpreter, 7)
    assert replay.run.modal.feed == 10
    assert story(replay) == [
        "R 0", "R X8", "M3 S100", "coolant 00", "L X8", "L X9", "end",
    ]  # fmt: skip
    assert done.p(150) == 7


def test_nothing_is_written_before_the_start_is_confirmed() -> None:
    done = made(TEXT, {150: 1})
    replay = start_at(done.interpreter, 7)
    assert replay.shadow.written[150] == 7


@pytest.mark.req("MILL-RUN-STARTLINE-BAD")
@pytest.mark.parametrize("line", [0, 9, 1000])
def test_a_line_the_program_does_not_have_is_refused(line: int) -> None:
    with pytest.raises(StartError, match="lines 1 to 8"):
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
    done = made("T3 M6\nS100 M3 M8\nG55 X1 F10\nM14\nX2\nM2", {400_103: 40})
    replay = start_at(done.interpreter, 5)
    names = {difference.name for difference in replay.differences}
    assert names == {
        "tool", "S", "spindle", "coolant", "work system", "output 40", "position",
    }  # fmt: skip
    assert replay.needs_tool
    assert Difference("S", 0.0, 100.0) in replay.differences


def test_the_tool_comes_down_at_the_modal_feed() -> None:
    machine = Bench(where=(0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    done = made("G0 X1 Y1 Z1\nG1 Z-1 F7\nX2\nM2", machine=machine)
    machine.where = (0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    replay = start_at(done.interpreter, 3)
    assert [shown(e) for e in replay.approach()][0:2] == ["R Z5", "R X1 Y1 Z5"]
    assert shown(list(replay.approach())[-1]) == "L X1 Y1 Z-1"


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
    done = made("P5=P5+1\nP300=4\nT P300\nG1 F10 X(P5)\nX9\nM2", {5: 2.0})
    card = done.machine.parameters
    replay = start_at(done.interpreter, 5)
    assert (replay.run.position[0], card) == (3.0, {5: 2.0})
    next(replay.entries())
    assert card == {5: 3.0, 300: 4.0}


def test_a_probe_counts_as_not_tripped() -> None:
    machine = Bench(trip=(9.0,) * 8)
    replay = start_at(made("F10 G31 X1\nY1\nY2", machine=machine).interpreter, 3)
    assert replay.run.position[:2] == (1, 1)


def test_values_of_the_card_are_read_with_a_warning() -> None:
    replay = start_at(made("P200=P5\nX(P200) F10\nX2", {5: 3.0}).interpreter, 3)
    assert replay.run.position[0] == 3
    assert replay.warnings


def test_cycles_may_stand_in_front_of_the_line() -> None:
    replay = start_at(made("G81 X1 Z-1 R0 F10\nX2\nG80 X3" + CYCLES).interpreter, 3)
    assert replay.run.modal.cycle == 81
    assert replay.run.position[:3] == (2, 0, 0)
