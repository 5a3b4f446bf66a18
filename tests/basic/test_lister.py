"""LIST: stored lines in one spelling."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.basic.parsing import parse_line

import openacr.basic.commands
import openacr.basic.commands.strings  # noqa: F401 - both enter their words
from openacr.basic.language.lister import Lister, literal
from openacr.basic.language.loader import file_lines
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.basic.memory.program_store import StoredLine
from openacr.lang.lexer import TokenKind, tokens

STORED = Scope(Level.PROG, stored=True)
ALIASES = ("Time", "hours", "XFault", "Enable")


def listed(text: str) -> str:
    return Lister(ALIASES).line(tokens(text))


def stored(*texts: str, first: int = 10) -> list[StoredLine]:
    return [
        StoredLine(first + 10 * place, text, Scope(), 0, (tuple(tokens(text)), None))
        for place, text in enumerate(texts)
    ]


LINES = [
    ("x10", "X10"),
    ("x / 0.2", "X/0.2"),
    ("x/-400", "X/-400"),
    ("X(p0+1)", "X(P0+1)"),
    ("X-97 y -57.5 Z - 4.4", "X-97 Y-57.5 Z-4.4"),
    ("X1e-05", "X1E-05"),
    ("set 16152", "SET 16152"),
    ("SET16152", "SET 16152"),
    ("set bit 32", "SET BIT 32"),
    ("clr8467 CLR 8499", "CLR 8467 CLR 8499"),
    ("if (bit 24)", "IF (BIT 24)"),
    ("while(not bit16134)", "WHILE (NOT BIT 16134)"),
    ("if (p0 > 4000) then gosub 100 : p0 = p0-1", "IF (P0 > 4000) THEN GOSUB 100 : P0 = P0-1"),
    ("for lv0=1 to 10 step 2", "FOR LV0 = 1 TO 10 STEP 2"),
    ("goto Loop2", "GOTO Loop2"),
    ("gosub _Sub", "GOSUB Sub"),
    ("_ HomeFailed", "_HomeFailed"),
    ("_Safe : REM Just a marker label", "_Safe : REM Just a marker label"),
    ("dwl1", "DWL 1"),
    ("inh -516", "INH -516"),
    ("inh Enable(0.5)", "INH Enable(0.5)"),
    ("Time = p6916", "Time = P6916"),
    ("P0=hours MOD 24", "P0 = hours MOD 24"),
    ('print "A=";p0;" B"', 'PRINT "A=";P0;" B"'),
    ('PRINT "say ""x"""', 'PRINT "say ""x"""'),
    ('print #1, "text"', 'PRINT #1,"text"'),
    ("print", "PRINT"),
    ('print using "##";lv0', 'PRINT USING "##";LV0'),
    ("$v0=ucase$($v1)+\"x\"", '$V0 = UCASE$($V1)+"x"'),
    ("la0(lv0+1)=p12290/p12375", "LA0(LV0+1) = P12290/P12375"),
    ("p0 = 2**-1", "P0 = 2**-1"),
    ("p0=1<<3", "P0 = 1 << 3"),
    ("rem: Any Text, 'kept' : X", "REM: Any Text, 'kept' : X"),
    ("REM-----line", "REM-----line"),
    ("p0=1:rem  note", "P0 = 1 : REM  note"),
    (":x1:::", ": X1 : : :"),
    ("P0=&HFF", "P0 = 255"),
    ("P0=1.50", "P0 = 1.5"),
    ("P0=5.0", "P0 = 5"),
    ("dim $v(10,80)", "DIM $V(10,80)"),
    ("dim lv10", "DIM LV10"),
    ('open "COM1:38400,n,8,1" as #1', 'OPEN "COM1:38400,n,8,1" AS #1'),
    ("close #1", "CLOSE #1"),
    ("run prog0", "RUN PROG0"),
    ("halt all", "HALT ALL"),
    ("#define Foo bit5", "#DEFINE Foo BIT 5"),
    ("#define Foo 05", "#DEFINE Foo 5"),
    ("#define Foo - 5 : rem", "#DEFINE Foo -5 : REM"),
    ("#define Axis2at p5", "#DEFINE Axis2at P5"),
    ("#define Foo:x1", "#DEFINE Foo : X1"),
]  # fmt: skip


@pytest.mark.parametrize(("typed", "shown"), LINES)
def test_lines_are_written_in_one_spelling(typed: str, shown: str) -> None:
    assert listed(typed) == shown


def meaning(text: str) -> list[tuple[TokenKind, object]]:
    return [(token.kind, token.value) for token in tokens(text) if token.kind is not TokenKind.END]


@pytest.mark.parametrize("typed", [typed for typed, _ in LINES])
def test_a_listed_line_reads_back_as_the_same_tokens(typed: str) -> None:
    assert meaning(listed(typed)) == meaning(typed)
    assert listed(listed(typed)) == listed(typed)


FILES = sorted(Path(__file__).parents[2].glob("examples/*/*.8k"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_every_line_of_the_examples_reads_back_as_the_same_tokens(path: Path) -> None:
    defined = [line.split() for line in path.parent.joinpath("setup.8k").read_text().splitlines()]
    lister = Lister([words[1] for words in defined if words[:1] == ["#DEFINE"]])
    lines = [line.text for line in file_lines(path.read_bytes().decode("latin-1"))]
    assert lines
    for line in lines:
        shown = lister.line(tokens(line))
        assert meaning(shown) == meaning(line)
        assert lister.line(tokens(shown)) == shown


WORDS = st.sampled_from(
    ["X10", "Y/5", "SET 32", "CLR BIT 5", "P0 = P1+2", "DWL 0.25", "INH -516", "GOTO Loop",
     "IF (BIT 5) THEN X1", "PRINT \"a\";P0", "ENDIF", "BIT 32 = NOT BIT 32", "_Label", "SQRT(4)"]
)  # fmt: skip


@given(st.lists(WORDS, min_size=1, max_size=5), st.sampled_from([" : ", ":", " "]))
def test_any_sequence_of_statements_reads_back_as_the_same_tokens(
    parts: list[str], separator: str
) -> None:
    text = separator.join(parts)
    assert meaning(listed(text)) == meaning(text)


def test_a_new_alias_is_listed_apart_from_its_value() -> None:
    shown = listed("#define level 5")
    assert parse_line(shown, STORED) == parse_line("#DEFINE level 5", STORED)


@given(st.one_of(st.integers(0, 2**40), st.floats(0, allow_nan=False, allow_infinity=False)))
def test_literals_keep_their_value(value: float) -> None:
    (token, _) = tokens(literal(value))
    assert token.value == value


FREE_FORM = (
    "PROGRAM", "hlim x3", "set 16152", "if (bit 24)", "x/25", "else", "y5", "endif",
    "while (not bit 16134)", "wend", "endp",
)  # fmt: skip


def test_a_downloaded_program_is_indented_by_its_blocks() -> None:
    assert list(Lister().program(stored(*FREE_FORM))) == [
        "PROGRAM",
        " HLIM X3",
        " SET 16152",
        " IF (BIT 24)",
        "  X/25",
        " ELSE",
        "  Y5",
        "  ENDIF",
        " WHILE (NOT BIT 16134)",
        " WEND",
        "ENDP",
    ]


def test_line_numbers_of_free_form_text_are_shown_on_demand() -> None:
    assert list(Lister().program(stored("PROGRAM", "X1", "ENDP"), numbers=True)) == [
        "10 PROGRAM",
        "20  X1",
        "30 ENDP",
    ]


def test_numbered_programs_always_show_their_numbers() -> None:
    lines = stored("for lv0=1 to 3", "x(lv0)", "if (bit 1) then x0", "else if (bit 2)", "next")
    assert list(Lister().program(lines)) == [
        "10 FOR LV0 = 1 TO 3",
        "20  X(LV0)",
        "30  IF (BIT 1) THEN X0",
        "40 ELSE IF (BIT 2)",
        "50 NEXT",
    ]


def test_an_if_after_else_and_a_colon_is_a_level_of_its_own() -> None:
    lines = stored("PROGRAM", "IF (P0)", "ELSE : IF (P1)", "X1", "ENDIF", "ENDIF", "ENDP")
    assert list(Lister().program(lines)) == [
        "PROGRAM",
        " IF (P0)",
        " ELSE : IF (P1)",
        "   X1",
        "   ENDIF",
        "  ENDIF",
        "ENDP",
    ]
