"""Loops, branches and subroutines as programs on a card run them."""

import pytest
from tests.system.terminal import Console

from openacr.controller import Controller


@pytest.fixture
def card() -> Console:
    console = Console()
    console.type("DIM P(20)")
    return console


def run(card: Console, *lines: str) -> str:
    """What a program prints."""
    card.program(0, *lines)
    return card.listen(0, 0.5)


@pytest.mark.req("ACR-CMD-BREAK")
def test_break_leaves_the_innermost_loop_only(card: Console) -> None:
    said = run(
        card,
        "FOR P0=1 TO 2 STEP 1",
        "FOR P1=1 TO 5 STEP 1",
        "IF (P1=3) THEN BREAK",
        "PRINT P0;P1",
        "NEXT",
        "NEXT",
        "P2=0",
        "WHILE (1)",
        "P2=P2+1",
        "IF (P2>4) THEN BREAK",
        "WEND",
        "PRINT P2",
    )
    assert said == "11|12|21|22|5"


@pytest.mark.req("ACR-CMD-END")
def test_end_stops_a_program_before_its_later_lines(card: Console) -> None:
    card.program(0, "DWL 0.1", "PRINT 1", "END", "PRINT 2")
    card.type("PROG0", "LRUN")
    assert card.card.bit[1024]
    card.card.advance(seconds=0.2)
    assert not card.card.bit[1024]
    assert b"1" in (said := card.card.take_output(card.card.console))
    assert b"2" not in said


@pytest.mark.req("ACR-CMD-ENDP")
def test_lines_between_program_and_endp_are_stored_and_later_ones_run(card: Console) -> None:
    assert (
        card.type("PROG0", "PROGRAM", "PRINT 1", "ENDP", "PRINT 2", "LIST")
        == "2|PROGRAM| PRINT 1|ENDP"
    )


@pytest.mark.req("ACR-CMD-FOR")
def test_a_for_loop_counts_its_local_variable_by_its_step(card: Console) -> None:
    card.type("PROG0", "DIM LV(1)")
    assert run(card, "FOR LV0=0 TO 4 STEP 2", "PRINT LV0", "NEXT") == "0|2|4"


@pytest.mark.req("ACR-CMD-WHILE")
def test_a_while_loop_ends_when_its_condition_does(card: Console) -> None:
    assert run(card, "P0=0", "WHILE (P0<3)", "P0=P0+1", "WEND", "PRINT P0") == "3"


@pytest.mark.req("ACR-CMD-GOSUB")
@pytest.mark.parametrize(("call", "routine"), [("GOSUB SUB1", "_SUB1"), ("GOSUB 100", "100 REM")])
def test_gosub_takes_labels_and_line_numbers_and_comes_back(
    card: Console, call: str, routine: str
) -> None:
    assert run(card, "PRINT 1", call, "PRINT 3", "END", routine, "PRINT 2", "RETURN") == "1|2|3"


@pytest.mark.req("ACR-CMD-GOTO")
def test_goto_branches_to_labels_and_line_numbers(card: Console) -> None:
    assert run(card, "GOTO THERE", "PRINT 1", "_THERE", "GOTO 100", "PRINT 2", "100 PRINT 3") == "3"


@pytest.mark.req("ACR-CMD-GOTO")
def test_goto_to_nowhere_is_an_error(card: Console) -> None:
    assert "Label not found: NOWHERE" in run(card, "PRINT 1", "GOTO NOWHERE")


@pytest.mark.req("ACR-CMD-IF-ELSE")
@pytest.mark.parametrize(("value", "said"), [(1, "one"), (2, "two"), (3, "else")])
def test_exactly_one_block_of_an_if_runs(card: Console, value: int, said: str) -> None:
    program = (
        f"P0={value}",
        "IF (P0=1)",
        'PRINT "one"',
        "ELSE IF (P0=2)",
        'PRINT "two"',
        "ELSE",
        'PRINT "else"',
        "ENDIF",
    )
    assert run(card, *program) == said


@pytest.mark.req("ACR-CMD-IF-ELSE")
def test_an_if_without_its_endif_is_an_error(card: Console) -> None:
    assert "ENDIF" in run(card, "IF (1=2)", "PRINT 1").upper()


@pytest.mark.req("ACR-CMD-IF-THEN")
def test_if_then_runs_the_rest_of_its_line_or_nothing_of_it(card: Console) -> None:
    lines = ("IF (1=1) THEN PRINT 1 : PRINT 2", "IF (1=2) THEN PRINT 3 : PRINT 4", "PRINT 5")
    assert run(card, *lines) == "1|2|5"


@pytest.mark.req("ACR-CMD-RETURN")
def test_return_without_gosub_is_an_error(card: Console) -> None:
    said = run(card, "PRINT 1", "RETURN", "PRINT 2")
    assert said.startswith("1|")
    assert "RETURN" in said.upper()
    assert not said.endswith("2")


@pytest.mark.parametrize("prompt", ["SYS", "P03", "PLC1"])
@pytest.mark.parametrize("named", ["PROG2", "PROG 2"])
def test_a_named_program_is_started_and_followed_from_any_prompt(prompt: str, named: str) -> None:
    card = Controller()
    card.send("PROG2\rPROGRAM\rPRINT 7\rDWL 0.1\rPRINT 8\rENDP\r")
    card.send({"SYS": "SYS", "P03": "PROG3", "PLC1": "PLC1"}[prompt] + "\r")
    assert card.send(f"LRUN {named}\r") == f"LRUN {named}\r\n"
    card.advance(seconds=0.2)
    assert card.send("") == f"7\r\n8\r\n{prompt}>"
    card.send(f"LRUN 30 {named}\r")
    card.advance(seconds=0.2)
    assert card.send("") == f"8\r\n{prompt}>", "from a line of it"
    card.send(f"RUN {named}\r")
    assert card.send(f"LISTEN {named}\r") == f"LISTEN {named}\r\n"
    card.advance(seconds=0.2)
    assert card.send("\x1b").endswith(f"8\r\n\r\n{prompt}>")


def test_following_needs_one_program_that_exists() -> None:
    card = Controller()
    for word in ("LRUN", "LISTEN"):
        assert card.send(f"{word}\r") == f"{word}\r\nUnknown command\r\nSYS>"
        assert card.send(f"{word} PLC0\r") == f"{word} PLC0\r\nUnknown command\r\nSYS>"
        assert card.send(f"{word} PROG16\r") == f"{word} PROG16\r\nInvalid argument\r\nSYS>"
    card.send("PLC0\r")
    assert "Not valid at this level" in card.send("LRUN\r")
