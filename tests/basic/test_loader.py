"""What the file loader sends to the card."""

import pytest

from openacr.basic.language.loader import FileLine, file_lines


def texts(source: str) -> list[str]:
    return [line.text for line in file_lines(source)]


def test_prompts_in_front_of_commands_are_dropped() -> None:
    assert texts("SYS>PROG 0\nP00>ATTACH\nPLC3>10 LD 769\n") == ["PROG 0", "ATTACH", "10 LD 769"]


def test_line_ends_of_all_systems_and_blank_lines_keep_their_numbers() -> None:
    assert file_lines("SYS\r\n\r\nPROG 0\rACC 5") == [
        FileLine(1, "SYS"),
        FileLine(3, "PROG 0"),
        FileLine(4, "ACC 5"),
    ]


@pytest.mark.parametrize(
    ("broken", "whole"),
    [
        (
            "WHILE ((NOT BIT 16134) AND (NOT\nBIT 16167)))",
            "WHILE ((NOT BIT 16134) AND (NOT BIT 16167)))",
        ),
        (
            "IF (A AND (XEncoderFault OR\nXEncoderLost))",
            "IF (A AND (XEncoderFault OR XEncoderLost))",
        ),
        ('PRINT "GOING TO RESET\nNETWORK"', 'PRINT "GOING TO RESET NETWORK"'),
        ('INPUT; "Value = ";\n$V0', 'INPUT; "Value = "; $V0'),
        ("X(1\n+2\n+3)", "X(1 +2 +3)"),
    ],
)
def test_lines_broken_at_the_page_width_are_joined(broken: str, whole: str) -> None:
    assert texts("PROGRAM\n" + broken + "\nENDP") == ["PROGRAM", whole, "ENDP"]


@pytest.mark.parametrize(
    "source",
    [
        'PRINT "text";\nP0 = 1',
        "REM (an open remark\nP0 = 1",
        "P0 = 1 : REM (open\nP0 = 1",
        "' don't (join\nP0 = 1",
        'PRINT "open string\nP0 = 1',
        'PRINT "("\nP0 = 1',
        "INPUT $V0\nP0 = 1",
        'INPUT #1, "name"; $V0\nP0 = 1',
    ],
)
def test_complete_lines_are_left_alone(source: str) -> None:
    assert texts(source) == source.split("\n")


def test_a_missing_endp_is_supplied_at_the_end_and_before_a_level_change() -> None:
    assert texts("PROG0\nPROGRAM\nX10\nPROG 1\nPROGRAM\nX20\nENDP\nSYS\nPROG2\nPROGRAM\nX1") == [
        "PROG0", "PROGRAM", "X10", "ENDP",
        "PROG 1", "PROGRAM", "X20", "ENDP",
        "SYS", "PROG2", "PROGRAM", "X1", "ENDP",
    ]  # fmt: skip


def test_program_text_without_program_is_wrapped_from_its_first_program_statement() -> None:
    source = 'PROG0\nATTACH SLAVE0 AXIS0 "ARM"\nACC 10\nARM0\n_LOOP\nARM/10\nGOTO LOOP\n'
    assert texts(source) == [
        "PROG0", 'ATTACH SLAVE0 AXIS0 "ARM"', "ACC 10",
        "PROGRAM", "ARM0", "_LOOP", "ARM/10", "GOTO LOOP", "ENDP",
    ]  # fmt: skip


def test_wrapped_program_text_ends_before_the_next_level_change() -> None:
    assert file_lines("DRIVE ON X\nFOR LV0 = 1 TO 3\nNEXT\nPROG1\nACC 5") == [
        FileLine(1, "PROGRAM"),
        FileLine(1, "DRIVE ON X"),
        FileLine(2, "FOR LV0 = 1 TO 3"),
        FileLine(3, "NEXT"),
        FileLine(4, "ENDP"),
        FileLine(4, "PROG1"),
        FileLine(5, "ACC 5"),
    ]


@pytest.mark.parametrize(
    "source",
    [
        "PROG0\nX10\nY5",
        "IF (BIT 24) THEN X10\nINH 11520",
        "DIM LV(10)",
        "10 X10\n20 GOTO 10",
        'PRINT "IF"',
        "IF (BIT 24) THEN P0 = 1 : GOTO 10",
    ],
)
def test_set_up_commands_alone_stay_commands(source: str) -> None:
    assert texts(source) == source.split("\n")


def test_an_own_endp_closes_wrapped_text() -> None:
    assert texts("_A\nX10\nENDP\nRUN") == ["PROGRAM", "_A", "X10", "ENDP", "RUN"]


def test_lines_with_numbers_are_stored_as_they_are_without_program_around_them() -> None:
    text = "PROG0\n10 _LOOP\n20 PRINT 1 : GOTO LOOP\n30 X10\n"
    assert [line.text for line in file_lines(text)] == text.splitlines()


def test_only_a_prompt_in_front_is_taken_away() -> None:
    assert file_lines('P00> PRINT "P01>" : REM SYS> here') == [
        FileLine(1, 'PRINT "P01>" : REM SYS> here')
    ]


def test_a_parenthesis_that_is_never_closed_leaves_the_following_lines_alone() -> None:
    lines = ["PROGRAM", "P0 = (1 + 2", "P1 = XX", "P2 = (3)", "P3 = ZZ(", "P4 = 1", "ENDP"]
    assert texts("\n".join(lines)) == lines
    lines[4] = "P3 = 4)"
    assert texts("\n".join(lines)) == [lines[0], " ".join(lines[1:5]), *lines[5:]]


def test_a_line_without_end_is_read_as_far_as_a_card_takes_it() -> None:
    long = "PROGRAM " + " " * 100_000 + "IF (" + '"' * 3
    assert texts(f"{long}\nP0 = 1") == [long, "P0 = 1", "ENDP"]
