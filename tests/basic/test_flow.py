"""Program flow as the guide describes it, run for real."""

import pytest
from tests.basic.rig import Rig

SETUP = ("DIM LV(5)", "DIM $V(2,20)")


@pytest.fixture
def rig() -> Rig:
    rig = Rig()
    rig.type(*SETUP)
    return rig


@pytest.mark.req("ACR-FLOW-01")
def test_lines_execute_in_order(rig: Rig) -> None:
    assert rig.run("PRINT 1", "PRINT 2 : PRINT 3", "PRINT 4") == "1|2|3|4|"


@pytest.mark.req("ACR-FLOW-02", "ACR-FLOW-04")
def test_a_false_condition_skips_the_rest_of_its_line(rig: Rig) -> None:
    lines = ("IF (BIT 24) THEN P0 = P0+1 : PRINT 5", "PRINT P0")
    assert rig.run(*lines) == "0|"
    rig.memory.set_bit(24, True)
    assert rig.run(*lines) == "5|1|"


@pytest.mark.req("ACR-FLOW-06")
def test_goto_and_gosub_may_follow_then(rig: Rig) -> None:
    assert (
        rig.run(
            "IF (1) THEN GOSUB s : PRINT 2",
            "IF (1) THEN GOTO e",
            "PRINT 9",
            "_s",
            "PRINT 1",
            "RETURN",
            "_e",
            "PRINT 3",
        )
        == "1|2|3|"
    )


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
    rig.pass_ticks(10)
    assert rig.sent() == "3|4|5|"


@pytest.mark.req("ACR-FLOW-07")
@pytest.mark.parametrize(("condition", "printed"), [("1", "then|"), ("0", "else|")])
def test_exactly_one_branch_runs(rig: Rig, condition: str, printed: str) -> None:
    lines = (f"IF ({condition})", 'PRINT "then"', "ELSE", 'PRINT "else"', "ENDIF")
    assert rig.run(*lines) == printed


@pytest.mark.req("ACR-FLOW-09")
def test_gosub_inside_a_branch_returns_into_it(rig: Rig) -> None:
    assert (
        rig.run(
            "IF (1)",
            "GOSUB s",
            "PRINT 2",
            "ELSE",
            "PRINT 9",
            "ENDIF",
            "END",
            "_s",
            "PRINT 1",
            "RETURN",
        )
        == "1|2|"
    )


@pytest.mark.req("ACR-FLOW-10")
def test_goto_leaves_a_branch_for_good(rig: Rig) -> None:
    assert rig.run("IF (1)", "GOTO out", "PRINT 9", "ENDIF", "_out", "PRINT 1") == "1|"


@pytest.mark.req("ACR-FLOW-13", "ACR-FLOW-14")
@pytest.mark.parametrize(("value", "printed"), [(1, "a|"), (2, "b|"), (3, "c|"), (4, "d|")])
def test_the_first_true_condition_wins(rig: Rig, value: int, printed: str) -> None:
    lines = ("IF (P0=1)", 'PRINT "a"', "ELSE IF (P0=2)", 'PRINT "b"', "ELSEIF (P0<=3)", 'PRINT "c"')
    assert rig.run(f"P0={value}", *lines, "ELSE", 'PRINT "d"', "ENDIF") == printed
    assert rig.run(f"P0={value}", *lines, "ENDIF") == (printed if value < 4 else "")


def test_conditions_after_a_true_one_are_not_computed(rig: Rig) -> None:
    assert rig.run("IF (1)", "PRINT 1", "ELSEIF (1/0)", "PRINT 2", "ENDIF") == "1|"


@pytest.mark.req("ACR-FLOW-15")
def test_return_goes_after_the_latest_gosub(rig: Rig) -> None:
    assert (
        rig.run(
            "P0=1",
            "GOSUB s",
            "P0=0",
            "GOSUB s",
            "END",
            "_s",
            "IF (P0) THEN PRINT 1 : RETURN",
            "PRINT 2",
            "GOSUB t",
            "RETURN",
            "_t",
            "PRINT 3",
            "RETURN",
        )
        == "1|2|3|"
    )


@pytest.mark.req("ACR-FLOW-17")
def test_goto_branches_unconditionally(rig: Rig) -> None:
    assert rig.run("GOTO end", "PRINT 9", "_end", "PRINT 1") == "1|"


@pytest.mark.req("ACR-FLOW-19", "ACR-FLOW-20")
@pytest.mark.parametrize(
    ("head", "printed"),
    [
        ("FOR LV0=1 TO 3", "1|2|3|end4|"),
        ("FOR LV0=1 TO 6 STEP 2", "1|3|5|end7|"),
        ("FOR LV0=3 TO 1", "end3|"),
        ("FOR P0=0 TO 1 STEP 0.5", "0|0.5|1|end1.5|"),
        ("FOR LV(0+1)=1 TO 1+1", "1|2|end3|"),
    ],
)
def test_for_counts_up_to_its_limit(rig: Rig, head: str, printed: str) -> None:
    variable = head.split("=")[0].removeprefix("FOR ")
    lines = (head, f"PRINT {variable}", "NEXT", f'PRINT "end";{variable}')
    assert rig.run(*lines) == printed


@pytest.mark.req("ACR-FLOW-22")
def test_a_negative_step_counts_down_and_a_zero_one_is_refused(rig: Rig) -> None:
    assert rig.run("FOR LV0=3 TO 1 STEP -1", "PRINT LV0", "NEXT LV0") == "3|2|1|"
    assert rig.run("FOR LV0=1 TO 3 STEP 0", "NEXT") == "Error in PROG0 line 20: Invalid argument|"


def test_limit_and_step_are_computed_once(rig: Rig) -> None:
    lines = ("P1=3", "P2=1", "FOR P0=1 TO P1 STEP P2", "P1=99", "P2=99", "PRINT P0", "NEXT")
    assert rig.run(*lines) == "1|2|3|"


def test_a_loop_may_stand_on_one_line(rig: Rig) -> None:
    assert rig.run("FOR LV0=1 TO 3 : PRINT LV0 : NEXT") == "1|2|3|"


@pytest.mark.req("ACR-FLOW-21")
def test_break_leaves_the_innermost_loop(rig: Rig) -> None:
    assert (
        rig.run(
            "FOR LV0=1 TO 2",
            "FOR LV1=1 TO 9",
            "IF (LV1=2)",
            "BREAK",
            "ENDIF",
            "PRINT LV0*10+LV1",
            "NEXT",
            "NEXT",
            "WHILE (1)",
            "P0=P0+1",
            "IF (P0>3) THEN BREAK",
            "WEND",
            "PRINT P0",
        )
        == "11|21|4|"
    )


@pytest.mark.req("ACR-FLOW-23")
def test_the_published_for_example_stops_on_its_input() -> None:
    rig = Rig()
    lines = (
        "DIM LV(1)",
        "FOR LV0 = 0 TO 499 STEP 1",
        "PRINT LV0",
        "IF (BIT 24) THEN BREAK",
        "NEXT",
    )
    assert rig.run(*lines, ticks=2000).count("|") == 500
    rig.memory.set_bit(24, True)
    assert rig.run(*lines, ticks=100) == "0|"


@pytest.mark.req("ACR-FLOW-24", "ACR-FLOW-25")
def test_while_tests_before_each_pass(rig: Rig) -> None:
    assert rig.run("WHILE (0)", "PRINT 9", "WEND", "PRINT 1") == "1|"
    assert rig.run("WHILE (P6176 < 1500)", "P6176=P6176+500", "WEND", "PRINT P6176") == "1500|"


@pytest.mark.req("ACR-FLOW-26")
def test_ten_levels_nest() -> None:
    rig = Rig()
    heads = [f"FOR P{n}=1 TO 1" if n % 2 else f"IF (P{n + 20}=0)" for n in range(12)]
    tails = ["NEXT" if n % 2 else "ENDIF" for n in reversed(range(12))]
    assert rig.run(*heads, 'PRINT "deep"', *tails) == "deep|"


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


@pytest.mark.req("ACR-LABEL-06")
def test_jumps_to_nowhere_name_their_target() -> None:
    rig = Rig()
    assert (
        rig.run("PRINT 1", "GOTO nowhere") == "1|Error in PROG0 line 30: Label not found: nowhere|"
    )
    assert rig.run("GOTO Start", "_START") == "Error in PROG0 line 20: Label not found: Start|"
    assert rig.run("GOSUB 100") == "Error in PROG0 line 20: Line not found: 100|"
    assert rig.run("GOSUB (50+51)") == "Error in PROG0 line 20: Line not found: 101|"


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
