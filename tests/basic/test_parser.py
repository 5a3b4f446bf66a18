"""How lines are read: the conformance rows on parsing, and their rules."""

import pickle

import pytest
from tests.basic.parsing import parse_line

import openacr.basic.commands  # noqa: F401 - enters the commands
from openacr.basic.language.cursor import StatementError
from openacr.basic.language.nodes import (
    Expr,
    Flag,
    LineTree,
    Local,
    LocalKind,
    Move,
    Number,
    Parameter,
    Statement,
)
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope

AXES = frozenset(("X", "Y"))
ALIASES: dict[str, Expr] = {
    "AxisEnable": Flag(Number(8467)),
    "Time": Parameter(Number(6916)),
    "MyBit": Number(40),
    "hours": Local(LocalKind.LONG, Number(1)),
}
PROMPT = Scope(Level.PROG, axes=AXES, aliases=ALIASES)
STORED = Scope(Level.PROG, stored=True, axes=AXES, aliases=ALIASES)
SYS = Scope(Level.SYS)


def parsed(text: str, scope: Scope = PROMPT) -> LineTree:
    return parse_line(text, scope)


def words(text: str, scope: Scope = PROMPT) -> list[list[str]]:
    """Command names per block, MOVE for the move of a block."""
    return [
        ["MOVE" if isinstance(part, Move) else part.command.name for part in block]
        for block in parsed(text, scope).blocks
    ]


def refusal(text: str, scope: Scope = PROMPT) -> str:
    with pytest.raises(StatementError) as caught:
        parsed(text, scope)
    return caught.value.text


def arguments(text: str, scope: Scope = PROMPT) -> tuple[object, ...]:
    statement = parsed(text, scope).blocks[0][0]
    assert isinstance(statement, Statement)
    return statement.arguments


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ACC 10 DEC 10 STP 10 VEL 5", [["ACC", "DEC", "STP", "VEL"]]),
        ("ACC500 DEC500 STP500", [["ACC", "DEC", "STP"]]),
        ("CLR11122 CLR11123 CLR11124", [["CLR", "CLR", "CLR"]]),
        ("CLR 8467 CLR8499", [["CLR", "CLR"]]),
        ("SET 16144 SET 16145", [["SET", "SET"]]),
        ("X10 Y(P0+1)", [["MOVE"]]),
        ("X10 : Y10", [["MOVE"], ["MOVE"]]),
        ("VEL 5 X10", [["VEL", "MOVE"]]),
        ("X10 VEL 5", [["VEL", "MOVE"]]),
        ("X10 VEL 5 Y3", [["VEL", "MOVE"]]),
        (":", [[], []]),
        ("", [[]]),
        ("BIT32=NOT BIT32", [["LET"]]),
        ("DA0(LV0)=P12290/P12375", [["LET"]]),
        ("Time = P6916", [["LET"]]),
        ("Set 32", [["SET"]]),
    ],
)
def test_a_line_falls_into_blocks_and_commands(text: str, expected: list[list[str]]) -> None:
    assert words(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "CLEAR PROG3", "CLEAR PLC0", "CLEAR DEF", "CLEAR STREAM", "CLEAR P", "CLEAR DIM P(10)",
        "HALT AXIS0 ON", "HALT X5", "DETACH AXIS0", "MEM DEF", "DEF CLEAR VER", "REBOOT VER",
        "VEL LIMIT0", "ACC DEC", "RES ENC0", "LIST VER", "RUN P5=3", "DETACH ALL MEM",
        "SAMP CLEAR DIM", "VER AXIS0", "FSTAT CLEAR VER",
    ],
)  # fmt: skip
def test_a_word_that_a_bare_command_does_not_know_is_no_command(text: str) -> None:
    assert refusal(text) == "Syntax error"


@pytest.mark.parametrize(
    "text", ["CLEAR PROG3", "ERASE DEF", "ESAVE DEF", "ELOAD VER", "BRESET MEM", "CONFIG VER"]
)
def test_a_word_that_a_bare_command_does_not_know_is_no_command_at_sys(text: str) -> None:
    assert refusal(text, SYS) == "Syntax error"
    first = text.split(" ")[0]
    assert words(text.replace(" ", " : "), SYS)[0] == [first]


@pytest.mark.parametrize(
    "text", ["HALT PROG1 PROG2", "NEW PROG1 PLC2", "ACC 5 SYS", "HALT ALL SYS"]
)
def test_a_change_of_level_begins_a_block(text: str) -> None:
    assert refusal(text) == "Syntax error"
    *_, level = text.split(" ")
    assert words(text.replace(f" {level}", f" : {level}"))[1] == [level.rstrip("12")]
    assert words("PROG2 ACC 5") == [["PROG", "ACC"]]


def test_switches_and_objects_are_complete_without_arguments() -> None:
    assert words("TARC ON X5") == [["TARC ON", "MOVE"]]
    assert words("TANG OFF X5") == [["TANG OFF", "MOVE"]]
    assert words("ENC0 RES ENC1 RES") == [["ENC # RES", "ENC # RES"]]
    assert words("AXIS0 REN AXIS1 REN") == [["REN", "REN"]]
    assert words("JOG OFF X Y ACC 5") == [["JOG OFF", "ACC"]]


def test_flags_may_be_negated_and_limited_in_time() -> None:
    bit, timeout = arguments("INH AxisEnable(0.5)")
    assert (bit.number, bit.clear, timeout) == (Number(8467), False, (Number(0.5),))  # type: ignore[attr-defined]
    assert arguments("INH -516")[0].clear  # type: ignore[attr-defined]
    assert arguments("INH -0")[0].clear  # type: ignore[attr-defined]
    assert arguments("INH -BIT0") == arguments("INH -0")
    assert arguments("INH +0") == arguments("INH 0")
    assert arguments("INH +AxisEnable(0.5)") == arguments("INH AxisEnable(0.5)")
    assert arguments("CLR +24 +25") == arguments("CLR 24 25")
    assert refusal("SET -24") == "Syntax error"
    assert refusal("INH + -24") == "Syntax error"


def test_then_with_a_number_is_a_goto() -> None:
    _, then = arguments("IF (P0) THEN 100 : SET 32", STORED)
    (goto,), (set_,) = then.blocks  # type: ignore[attr-defined]
    assert (goto.command.name, goto.arguments) == ("GOTO", (Number(100),))
    assert set_.command.name == "SET"


def test_a_condition_is_one_expression_up_to_then() -> None:
    assert words("IF (P0) AND (P1) THEN P2=1", STORED) == [["IF"]]
    assert words("WHILE (BIT10=0) : REM wait", STORED) == [["WHILE"], []]


def test_unknown_words_have_two_messages() -> None:
    assert refusal("FOO 1") == "Unknown command"
    assert refusal("Z10") == "Unknown command"
    assert refusal("P0 = FOO") == "Undefined symbol"
    assert refusal("PPU Z 10") == "Undefined symbol"
    assert refusal("MOV AXIS0 5") == "Undefined symbol"


@pytest.mark.parametrize(
    "text",
    [
        "FBVEL", "X", "X(1,2)", "X10+5", "P0=", "P0=(1", "P0=1)", "SET", "LV0", "X10 5", "P0=1 2",
        "=1", "LET P0=1 2", "P0=SIN 30", "DWL", "INH", "IHPOS P1", "MASK P4097 (1)",
    ],
)  # fmt: skip
def test_malformed_statements_are_refused(text: str) -> None:
    assert refusal(text) in ("Syntax error", "Unknown command")


@pytest.mark.parametrize(
    "text",
    [
        'P0="a"', "$V0=1", 'P0=1+"a"', 'P0="a"="b"+1', 'P0=SIN("a")', "P0=LEN(1)", 'P0=NOT "a"',
        '$V0="a"*"b"',
    ],
)  # fmt: skip
def test_strings_and_numbers_do_not_mix(text: str) -> None:
    assert refusal(text) == "Type mismatch"


@pytest.mark.parametrize(
    "text",
    [
        "ACC 5", "HLIM X3", "X10", "PPU X 1", "FBVEL", "WHILE (P0)", "GOTO a", "_label", "IF (P0)",
        "ENDIF", "HLIM", "NEXT",
    ],
)  # fmt: skip
def test_what_is_not_valid_at_sys_is_an_unknown_command_there(text: str) -> None:
    assert refusal(text, SYS) == "Unknown command"


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("PPU AXIS0 4000", "PPU"),
        ("AXIS3 HLIM 3", "HLIM"),
        ("SET 32", "SET"),
        ("P0=1", "LET"),
        ("DWL 1", "DWL"),
        ("IF (P0) THEN SET 32", "IF"),
        ("MASTER0 VEL 5", "VEL"),
    ],
)
def test_named_objects_are_valid_at_sys(text: str, command: str) -> None:
    assert words(text, SYS) == [[command]]


@pytest.mark.parametrize(
    "text",
    [
        "WHILE (P0)", "WEND", "IF (P0)", "ENDIF", "GOTO a", "_label", "FOR LV0=1 TO 2", "RETURN",
        "BREAK", "END",
    ],
)  # fmt: skip
def test_flow_is_for_programs_only(text: str) -> None:
    assert refusal(text) == "Not valid at this level"


def test_an_error_says_where_it_is() -> None:
    with pytest.raises(StatementError) as caught:
        parse_line("SET 32 : FOO", PROMPT, 7)
    assert (caught.value.span.line, caught.value.span.column, caught.value.span.length) == (
        7,
        10,
        3,
    )


def test_trees_survive_pickling() -> None:
    line = parsed("IF (P0 > SIN(30)) THEN SET 32 : X10 Y/5", STORED)
    assert pickle.loads(pickle.dumps(line)) == line
