"""Tokens: words are letters only, everything else follows from that."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.lang.lexer import LexError, TokenKind, tokens
from openacr.lang.source import Span
from openacr.messages import LINE_TOO_LONG, MATH_ERROR, SYNTAX_ERROR


def values(line: str | bytes) -> list[object]:
    return [token.value for token in tokens(line) if token.kind is not TokenKind.END]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("ACC500 DEC500", ["ACC", 500, "DEC", 500]),
        ("CLR11122 CLR11123", ["CLR", 11122, "CLR", 11123]),
        ("LV0 AXIS12", ["LV", 0, "AXIS", 12]),
        ("x/-400", ["X", "/", "-", 400]),
        ("X1e-05", ["X", 0.00001]),
        ("X1E+3", ["X", 1000.0]),
        ("5 DEC", [5, "DEC"]),
        ("X1ENC", ["X", 1, "ENC"]),
        ("X1E", ["X", 1, "E"]),
        (".5 12.5", [0.5, 12.5]),
        ("&HFF &hffffffff &B101", [255, -1, 5]),
        ("2147483647 2147483648", [2147483647, 2147483648.0]),
        ("2**3<<1<>2<=3>=4", [2, "**", 3, "<<", 1, "<>", 2, "<=", 3, ">=", 4]),
        ('PRINT "a ""b"" c"; $V0', ["PRINT", 'a "b" c', ";", "$V", 0]),
        ('?"open', ["?", "open"]),
        ('?"a""', ["?", 'a"']),
        ("?CHR$(65)", ["?", "CHR$", "(", 65, ")"]),
        ("#DEFINE Led BIT32", ["#", "DEFINE", "LED", "BIT", 32]),
        ("_ HomeFailed", ["HomeFailed"]),
        ("_Label1", ["Label1"]),
        ("GOTO LOOP2", ["GOTO", "LOOP2"]),
        ("gosub _sub1:", ["GOSUB", "sub1", ":"]),
        ("GOTO100", ["GOTO", 100]),
        ("GOTOX", ["GOTOX"]),
        ("PROGRAM0_start", ["PROGRAM", 0, "start"]),
        ("'note", []),
        ("X10 ' note", ["X", 10]),
        ("REM a:b ' \"c", [" a:b ' \"c"]),
        ("REM-----x", ["-----x"]),
        ("REMARK", ["REMARK"]),
        ("", []),
    ],
)
def test_a_line_falls_into_tokens(line: str, expected: list[object]) -> None:
    assert values(line) == expected


def test_a_whole_number_is_a_long_and_anything_else_is_not() -> None:
    assert [type(value) for value in values("12 12.0 1e3 3000000000")] == [int, float, float, float]


def test_tokens_know_where_they_stand() -> None:
    assert [(token.text, token.column) for token in tokens("  SET 32 'x", 7)[:-1]] == [
        ("SET", 3),
        ("32", 7),
    ]
    assert tokens("SET32", 7)[1].span == Span(7, 4, 2)
    assert Span(1, 3, 2).marker("abcd") == "abcd\n  ^^"


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("INH –516", ["INH", "-", 516]),
        (b"INH \x96516", ["INH", "-", 516]),
        ("Z — 4.4", ["Z", "-", 4.4]),
        ("Z − 4.4", ["Z", "-", 4.4]),
        ('PRINT "Y HOMING“', ["PRINT", "Y HOMING"]),
        ("PRINT ”tries”", ["PRINT", "tries"]),
        (b"PRINT \x93hi\x94", ["PRINT", "hi"]),
        ("X10 ‘ note", ["X", 10]),
        (b"X\xa010", ["X", 10]),
        ("X\u00a010", ["X", 10]),
    ],
)
def test_typographic_characters_are_read_as_plain_ones(
    line: str | bytes, expected: list[object]
) -> None:
    assert values(line) == expected


def test_strings_and_remarks_keep_their_dashes_and_apostrophes() -> None:
    assert values(b'PRINT "it\x92s \x96"') == ["PRINT", "it\x92s \x96"]
    assert values(b"REM it\x92s") == [" it\x92s"]


@pytest.mark.parametrize(
    "line", ["X@1", "X10 é", b"\xff", "a & b", "&H", "&B2", "&H123456789", "%"]
)
def test_any_other_character_is_a_syntax_error(line: str | bytes) -> None:
    with pytest.raises(LexError) as caught:
        tokens(line)
    assert caught.value.message is SYNTAX_ERROR


def test_a_syntax_error_says_where_it_is() -> None:
    with pytest.raises(LexError) as caught:
        tokens("SET 32 @", 4)
    assert caught.value.span == Span(4, 8)


def test_a_number_beyond_any_float_is_a_math_error() -> None:
    assert values("X1e308 Y1e-400") == ["X", 1e308, "Y", 0.0]
    with pytest.raises(LexError) as caught:
        tokens("X5 Y1e309", 4)
    assert (caught.value.message, caught.value.span) == (MATH_ERROR, Span(4, 5, 5))


def test_a_line_has_at_most_255_characters() -> None:
    assert len(tokens("'" + "x" * 254)) == 1
    with pytest.raises(LexError) as caught:
        tokens("'" + "x" * 255)
    assert caught.value.message is LINE_TOO_LONG


@given(st.text(st.characters(max_codepoint=255), max_size=80))
def test_every_line_is_read_or_refused_and_typography_vanishes_outside_strings(line: str) -> None:
    data = line.encode("latin-1")
    try:
        found = tokens(data)
    except LexError:
        return
    assert found[-1].kind is TokenKind.END
    outside = [token for token in found if token.kind not in (TokenKind.STRING, TokenKind.REMARK)]
    assert all(token.text.isascii() for token in outside)
    assert [token.column for token in found] == sorted(token.column for token in found)
