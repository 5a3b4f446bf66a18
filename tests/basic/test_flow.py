"""Program flow as the guide describes it, run for real."""

import pytest
from tests.basic.rig import Rig

SETUP = ("DIM LV(5)", "DIM $V(2,20)")


@pytest.fixture
def rig() -> Rig:
    rig = Rig()
    rig.type(*SETUP)
    return rig


def test_then_with_a_line_number_jumps(rig: Rig) -> None:
    rig.type(
        "10 IF (1) THEN 30",
        "20 PRINT 9",
        "30 PRINT 3",
        "40 GOSUB (50+10) : PRINT 5",
        "50 END",
        "60 PRINT 4",
        "70 RETURN",
    )
    rig.session.listening_to = 0
    rig.executor.run_program(0)
    rig.advance(10)
    assert rig.sent() == "3|4|5|"


def test_conditions_after_a_true_one_are_not_computed(rig: Rig) -> None:
    assert rig.run("IF (1)", "PRINT 1", "ELSEIF (1/0)", "PRINT 2", "ENDIF") == "1|"


def test_limit_and_step_are_computed_once(rig: Rig) -> None:
    lines = ("P1=3", "P2=1", "FOR P0=1 TO P1 STEP P2", "P1=99", "P2=99", "PRINT P0", "NEXT")
    assert rig.run(*lines) == "1|2|3|"


def test_a_loop_may_stand_on_one_line(rig: Rig) -> None:
    assert rig.run("FOR LV0=1 TO 3 : PRINT LV0 : NEXT") == "1|2|3|"


def test_more_than_64_levels_overflow() -> None:
    rig = Rig()
    assert (
        rig.run("_a", "P0=P0+1", "GOSUB a", ticks=2000) == "Error in PROG0 line 40: Stack overflow|"
    )
    assert rig.value("P0") == "65"


def test_goto_out_of_loops_discards_them() -> None:
    rig = Rig()
    assert (
        rig.run(
            "_a",
            "P0=P0+1",
            "FOR P1=1 TO 9",
            "WHILE (1)",
            "IF (P0<200) THEN GOTO a",
            "BREAK",
            "WEND",
            "BREAK",
            "NEXT",
            "PRINT P0",
            ticks=5000,
        )
        == "200|"
    )


def test_goto_within_a_loop_keeps_it() -> None:
    rig = Rig()
    lines = ("FOR P0=1 TO 3", "IF (P0=2)", "GOTO skip", "ENDIF", "PRINT P0", "_skip", "NEXT")
    assert rig.run(*lines) == "1|3|"


def test_a_jump_into_a_loop_body_makes_its_end_an_error() -> None:
    rig = Rig()
    message = "Error in PROG0 line {}: {}|"
    assert rig.run("GOTO b", "FOR P0=1 TO 2", "_b", "NEXT") == message.format(
        50, "NEXT without FOR"
    )
    assert rig.run("GOTO b", "WHILE (1)", "_b", "WEND") == message.format(50, "WEND without WHILE")
    assert rig.run("RETURN") == message.format(20, "RETURN without GOSUB")


def test_a_goto_out_of_a_subroutine_keeps_the_loop_of_its_caller() -> None:
    rig = Rig()
    assert (
        rig.run(
            "FOR P0=1 TO 2", "GOSUB s", "PRINT P0", "NEXT", "END", "_s", "GOTO t", "_t", "RETURN"
        )
        == "1|2|"
    )


def test_return_discards_the_loops_of_the_subroutine() -> None:
    rig = Rig()
    lines = (
        "FOR P0=1 TO 80",
        "GOSUB s",
        "NEXT",
        "PRINT P0",
        "END",
        "_s",
        "FOR P1=1 TO 9",
        "RETURN",
        "NEXT",
    )
    assert rig.run(*lines, ticks=4000) == "81|"


def test_an_error_stops_the_program_at_its_line() -> None:
    rig = Rig()
    assert rig.run("P0=1", "P0=1/0", "PRINT 9") == "Error in PROG0 line 30: Divide by zero|"
    assert rig.memory.I[7168] == 30
    assert not rig.is_running()


def test_a_one_line_if_works_at_a_prompt() -> None:
    rig = Rig()
    assert rig.type("IF (1) THEN PRINT 1 : PRINT 2") == "1|2|"
    assert rig.type("SYS", "IF (0) THEN PRINT 1 : PRINT 2") == ""
    assert rig.type("IF (1) THEN GOTO a") == "Unknown command|"


def test_strings_decide_conditions(rig: Rig) -> None:
    assert (
        rig.run('$V0="yes"', 'IF ($V0+"!"="yes!" AND LEN($V0)=3) THEN PRINT MID$($V0,2)') == "es|"
    )
