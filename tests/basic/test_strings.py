"""String functions."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import openacr.basic.commands.strings  # noqa: F401 - enters the functions
from openacr.basic.language.number_format import double_text
from openacr.basic.language.registry import functions
from openacr.errors import CardError


def call(name: str, *arguments: str | float) -> str | float:
    row = functions[name]
    assert row.apply is not None
    assert row.fewest <= len(arguments) <= len(row.takes)
    result: str | float = row.apply(*arguments)
    assert row.gives_text == isinstance(result, str)
    return result


@pytest.mark.parametrize(
    ("name", "arguments", "result"),
    [
        ("ASC", ("A",), 65),
        ("ASC", ("",), 0),
        ("CHR$", (27,), "\x1b"),
        ("CHR$", (256 + 65,), "A"),
        ("CHR$", (-1,), "\xff"),
        ("LEFT$", ("abc", 2), "ab"),
        ("LEFT$", ("abc", 9), "abc"),
        ("LEFT$", ("abc", 0), ""),
        ("LEFT$", ("abc", -1), ""),
        ("RIGHT$", ("abc", 2), "bc"),
        ("RIGHT$", ("abc", 9), "abc"),
        ("RIGHT$", ("abc", 0), ""),
        ("RIGHT$", ("abc", -3), ""),
        ("MID$", ("abcdef", 2, 3), "bcd"),
        ("MID$", ("abcdef", 4), "def"),
        ("MID$", ("abcdef", 0, 2), "ab"),
        ("MID$", ("abc", 9, 1), ""),
        ("MID$", ("abc", 1, -1), ""),
        ("LEN", ("abc",), 3),
        ("LEN", ("",), 0),
        ("INSTR", ("banana", "an"), 2),
        ("INSTR", (3, "banana", "an"), 4),
        ("INSTR", ("banana", "x"), 0),
        ("INSTR", (5, "banana", ""), 5),
        ("INSTR", ("banana", ""), 1),
        ("INSTR", (9, "banana", "a"), 0),
        ("VAL", ("12",), 12),
        ("VAL", ("  -3.5x",), -3.5),
        ("VAL", ("+.5",), 0.5),
        ("VAL", ("1e3",), 1000),
        ("VAL", ("1e",), 1),
        ("VAL", ("5.",), 5),
        ("VAL", ("&HFF",), 255),
        ("VAL", ("&hFFFFFFFF",), -1),
        ("VAL", ("-&H10",), -16),
        ("VAL", ("abc",), 0),
        ("VAL", ("",), 0),
        ("VAL", ("- 7",), -7),
        ("UCASE$", ("aZ1\xe4",), "AZ1\xe4"),
        ("LCASE$", ("aZ1\xc4",), "az1\xc4"),
        ("SPACE$", (3,), "   "),
        ("SPACE$", (300,), " " * 255),
        ("SPACE$", (-1,), ""),
        ("STRING$", (3, 42), "***"),
        ("STRING$", (2, "xyz"), "xx"),
        ("STRING$", (2, ""), ""),
        ("HEX$", (255,), "FF"),
        ("HEX$", (-1,), "FFFFFFFF"),
        ("HEX$", (4294967295,), "FFFFFFFF"),
        ("HEX$", (0,), "0"),
    ],
)
def test_functions_give_the_documented_results(
    name: str, arguments: tuple[str | float, ...], result: str | float
) -> None:
    assert call(name, *arguments) == result


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("INSTR", (1.0, "a"), "Type mismatch"),
        ("HEX$", (4294967296.0,), "Math error"),
        ("HEX$", (-2147483649.0,), "Math error"),
        ("VAL", ("1e999",), "Math error"),
    ],
)
def test_arguments_of_the_wrong_kind_or_size_are_refused(
    name: str, arguments: tuple[str | float, ...], message: str
) -> None:
    with pytest.raises(CardError, match=message):
        call(name, *arguments)


@given(st.text(st.characters(max_codepoint=255), max_size=30), st.integers(-5, 40))
def test_left_and_the_rest_make_the_whole(text: str, count: int) -> None:
    rest = call("MID$", text, max(count, 0) + 1)
    assert str(call("LEFT$", text, count)) + str(rest) == text


@given(st.floats(-1e14, 1e14))
def test_val_reads_what_str_writes(value: float) -> None:
    assert call("VAL", double_text(value)) == pytest.approx(value, rel=1e-9)
