"""Lines of one shape are read alike."""

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from openacr.lang.lexer import LexError, TokenKind, tokens
from openacr.lang.shape import shape, shapes

PIECES = st.sampled_from(
    "1e299 5.E400 "
    'X Y10 12.5 1e5 1E-3 .5 7 123456789 1234567890 2147483648 "text" "a""b" "open REM rem_ '
    "REM XREM REMX 5REM $REM _5REM REM12.5 ' 'REM _REM _a1 GOTO GOTO REM GOSUB _ "
    "& &HFF &B01 &H123456789 ( ) "
    "= - ** : PRINT ? # BIT32 E5 é \u201c".split()
)
LINES = st.lists(st.tuples(PIECES, st.sampled_from(["", " "]))).map(
    lambda parts: "".join(piece + blank for piece, blank in parts)
)


def kinds(line: str) -> list[tuple[TokenKind, object]] | str:
    """What the parser sees but for values."""
    try:
        found = tokens(line)
    except LexError as error:
        return error.text
    plain = (TokenKind.WORD, TokenKind.OPERATOR)
    return [
        (token.kind, token.text if token.kind in plain else type(token.value)) for token in found
    ]


@settings(max_examples=500)
@given(LINES)
@example("#2147483648")  # a float, and #999999999 is not
def test_a_line_and_its_shape_have_the_same_tokens(line: str) -> None:
    assert kinds(line) == kinds(shape(line))


@given(st.lists(LINES))
def test_many_shapes_are_found_at_once(lines: list[str]) -> None:
    assert shapes(lines) == [shape(line) for line in lines]


@pytest.mark.parametrize("place", [0, 199, 200, 401])
def test_a_line_that_is_its_own_shape_leaves_those_of_others_alone(place: int) -> None:
    lines = [f"X {number}" for number in range(402)]
    lines[place] = "REM 20 °C"
    assert shapes(lines) == ["REM 20 °C" if at == place else "X 0" for at in range(402)]
    assert shapes([]) == []


def test_numbers_strings_and_remarks_make_no_difference() -> None:
    one = shape('_L : PRINT "a";P12, 1.5e-3 : REM first')
    assert one == shape('_L : PRINT "bcd";P7, 20.75e-10 : REM')


def test_a_whole_number_and_a_fraction_have_different_shapes() -> None:
    assert shape("X10") != shape("X10.5")
    assert shape("P2147483647=1") != shape("P2147483648=1")
