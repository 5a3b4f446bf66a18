"""How lines are read: the conformance rows on parsing, and their rules."""

import pickle

import pytest
from tests.basic.parsing import parse_line

import openacr.basic.commands  # noqa: F401 - enters the commands
from openacr.basic.language.cursor import StatementError
from openacr.basic.language.grammar import AxisItem, TargetItem
from openacr.basic.language.nodes import (
    AxisRef,
    Binary,
    Expr,
    Flag,
    LineTree,
    Local,
    LocalKind,
    Move,
    Number,
    Op,
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


def targets(text: str) -> list[TargetItem]:
    move = parsed(text).blocks[0][-1]
    assert isinstance(move, Move)
    return [item for part in move.parts for item in part.arguments[0]]  # type: ignore[attr-defined]


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


def test_targets_of_one_block_are_one_move() -> None:
    assert targets("X10 Y(P0+1)") == [
        TargetItem(AxisRef("X"), (Number(10),), False),
        TargetItem(AxisRef("Y"), (Binary(Op.PLUS, Parameter(Number(0)), Number(1)),), False),
    ]
    assert targets("VEL 5 X10") == targets("X10 VEL 5")
    assert [item.axis.name for item in targets("X1 VEL 5 Y2")] == ["X", "Y"]


@pytest.mark.parametrize(
    ("text", "value"), [("X/25", 25), ("X / 0.2", 0.2), ("X/-400", -400), ("x/-400", -400)]
)
def test_a_slash_makes_a_target_incremental(text: str, value: float) -> None:
    assert targets(text) == [TargetItem(AxisRef("X"), (Number(value),), True)]


def test_an_exponent_belongs_to_the_target() -> None:
    assert targets("X1e-05") == [TargetItem(AxisRef("X"), (Number(0.00001),), False)]


def test_the_prefix_names_the_axis() -> None:
    prefixed = parsed("AXIS0 PPU 4000").blocks[0][0]
    assert isinstance(prefixed, Statement)
    assert prefixed.command.name == "PPU"
    assert prefixed.arguments == arguments("PPU AXIS0 4000")
    assert prefixed.arguments == ((AxisItem(AxisRef("AXIS", Number(0)), Number(4000)),),)


def test_an_empty_block_may_stand_before_a_command() -> None:
    assert words(":AXIS0 PPU 4000", SYS) == [[], ["PPU"]]


def test_several_axes_take_their_values_greedily() -> None:
    (axes,) = arguments("EXC AXIS0 4 AXIS1 4")
    assert [item.axis.number for item in axes] == [Number(0), Number(1)]  # type: ignore[attr-defined]
    (axes,) = arguments("IPB X0.05 Y(3,-1)")
    assert [item.argument for item in axes] == [  # type: ignore[attr-defined]
        (Number(0.05),),
        (Number(3), Number(-1)),
    ]
    assert arguments("AXIS0 SLM (24,0)")[0][0].argument == (Number(24), Number(0))  # type: ignore[index]
    assert words("PPU X 2000 Y 2000 ACC 5") == [["PPU", "ACC"]]


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


@pytest.mark.parametrize(
    "text", ["SET 32", "SET BIT32", "SET BIT 32", "SET(32)", "SET32", "SET +32", "SET +BIT32"]
)
def test_all_forms_of_a_flag_mean_the_same(text: str) -> None:
    assert arguments(text) == arguments("SET 32")


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


def test_ihpos_takes_a_signed_parameter_and_a_pair() -> None:
    assert arguments("IHPOS -P6160 (40000,5.5)") == (
        (Number(6160), True),
        (Number(40000), Number(5.5)),
    )
    assert arguments("IHPOS +P6160 (40000,5.5)") == arguments("IHPOS P6160 (40000,5.5)")


@pytest.mark.req("ACR-FLOW-03")
def test_everything_after_then_is_conditional() -> None:
    _, then = arguments("IF (P0 > 4000) THEN GOSUB 100 : P0 = P0-1", STORED)
    assert [[part.command.name for part in block] for block in then.blocks] == [  # type: ignore[attr-defined]
        ["GOSUB"],
        ["LET"],
    ]


def test_then_with_a_number_is_a_goto() -> None:
    _, then = arguments("IF (P0) THEN 100 : SET 32", STORED)
    (goto,), (set_,) = then.blocks  # type: ignore[attr-defined]
    assert (goto.command.name, goto.arguments) == ("GOTO", (Number(100),))
    assert set_.command.name == "SET"


def test_else_if_is_elseif() -> None:
    assert words("ELSE IF (P32779 = 1)", STORED) == [["ELSEIF"]]
    assert words("ELSEIF (P32779 = 1)", STORED) == [["ELSEIF"]]
    assert words("ELSE", STORED) == [["ELSE"]]


@pytest.mark.req("ACR-FLOW-05")
@pytest.mark.parametrize("text", ["IF A=1 THEN X10", "IF P0=1 THEN P1=1", "WHILE P0"])
def test_a_condition_begins_with_a_parenthesis(text: str) -> None:
    assert refusal(text, STORED) == "Syntax error"


def test_a_condition_is_one_expression_up_to_then() -> None:
    assert words("IF (P0) AND (P1) THEN P2=1", STORED) == [["IF"]]
    assert words("WHILE (BIT10=0) : REM wait", STORED) == [["WHILE"], []]


@pytest.mark.req("ACR-LABEL-02")
def test_labels_stand_alone_or_before_a_colon() -> None:
    assert parsed("_ HomeFailed", STORED).label == "HomeFailed"
    assert parsed("_Label1", STORED).label == "Label1"
    assert parsed("_" + "a" * 32, STORED).label == "a" * 32
    assert refusal("_" + "a" * 33, STORED) == "Syntax error"
    assert refusal("_a-b", STORED) == "Syntax error"
    assert refusal("_a b", STORED) == "Syntax error"


def test_remarks_follow_statements_with_or_without_a_colon() -> None:
    assert parsed("SET 32 REM on").remark == " on"
    assert parsed("SET 32 : REM on").remark == " on"
    assert parsed(":REM ARE 2 SLAVES ON THE NETWORK").remark == " ARE 2 SLAVES ON THE NETWORK"
    assert parsed("'note").is_empty


def test_unknown_words_have_two_messages() -> None:
    assert refusal("FOO 1") == "Unknown command"
    assert refusal("Z10") == "Unknown command"
    assert refusal("P0 = FOO") == "Undefined symbol"
    assert refusal("PPU Z 10") == "Undefined symbol"
    assert refusal("MOV AXIS0 5") == "Undefined symbol"


@pytest.mark.parametrize(
    "text",
    [
        "FBVEL",
        "X",
        "X(1,2)",
        "X10+5",
        "P0=",
        "P0=(1",
        "P0=1)",
        "SET",
        "LV0",
        "X10 5",
        "P0=1 2",
        "=1",
        "LET P0=1 2",
        "P0=SIN 30",
        "DWL",
        "INH",
        "IHPOS P1",
        "MASK P4097 (1)",
    ],
)
def test_malformed_statements_are_refused(text: str) -> None:
    assert refusal(text) in ("Syntax error", "Unknown command")


def test_functions_need_parentheses() -> None:
    assert refusal("P0=SIN 30") == "Syntax error"


@pytest.mark.parametrize(
    "text",
    [
        'P0="a"',
        "$V0=1",
        'P0=1+"a"',
        'P0="a"="b"+1',
        'P0=SIN("a")',
        "P0=LEN(1)",
        'P0=NOT "a"',
        '$V0="a"*"b"',
    ],
)
def test_strings_and_numbers_do_not_mix(text: str) -> None:
    assert refusal(text) == "Type mismatch"


@pytest.mark.parametrize(
    "text",
    [
        "ACC 5",
        "HLIM X3",
        "X10",
        "PPU X 1",
        "FBVEL",
        "WHILE (P0)",
        "GOTO a",
        "_label",
        "IF (P0)",
        "ENDIF",
        "HLIM",
        "NEXT",
    ],
)
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
        "WHILE (P0)",
        "WEND",
        "IF (P0)",
        "ENDIF",
        "GOTO a",
        "_label",
        "FOR LV0=1 TO 2",
        "RETURN",
        "BREAK",
        "END",
    ],
)
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


def test_aliases_are_case_sensitive_and_keywords_are_not() -> None:
    assert words("hours=hours MOD 24") == [["LET"]]
    assert refusal("Hours=1") == "Unknown command"
    assert words("bit32=not Bit32 and 1") == [["LET"]]


def test_trees_survive_pickling() -> None:
    line = parsed("IF (P0 > SIN(30)) THEN SET 32 : X10 Y/5", STORED)
    assert pickle.loads(pickle.dumps(line)) == line
