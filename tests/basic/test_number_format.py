"""Numbers as the card prints them."""

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.basic.language.number_format import (
    NumberKind,
    UsingFormat,
    bit_text,
    double_text,
    long_text,
    number_text,
    single_text,
)
from openacr.errors import CardError


def using_text(picture: str, value: float) -> str:
    return UsingFormat.parse(picture).text(value)


def single(value: float) -> float:
    return float(struct.unpack("<f", struct.pack("<f", value))[0])


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (4000.0, "4000"),
        (-1.0, "-1"),
        (0.0, "0"),
        (-0.0, "0"),
        (0.1 + 0.2, "0.3"),
        (1 / 3, "0.3333333333"),
        (-2 / 3, "-0.6666666667"),
        (437.25, "437.25"),
        (123456789012.0, "123456789012"),
        (999999999999999.0, "999999999999999"),
        (1e15, "1E+15"),
        (1234567890123456.0, "1.23456789E+15"),
        (-1e100, "-1E+100"),
        (0.0001, "0.0001"),
        (0.00009999999999999, "0.0001"),
        (0.00001, "1E-05"),
        (1.25e-5, "1.25E-05"),
        (999999999999999.9, "1E+15"),
        (1e-300, "1E-300"),
        (math.nan, "NAN"),
        (-math.inf, "-INF"),
    ],
)
def test_fp64_values_print_with_ten_digits(value: float, text: str) -> None:
    assert double_text(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (10 / 4096, "0.002441406"),
        (0.0001, "0.0001"),
        (0.0002, "0.0002"),
        (4.9, "4.9"),
        (0.1, "0.1"),
        (20000.0, "20000"),
        (3276.8, "3276.8"),
        (16777216.0, "16777220"),
        (-0.00001, "-1E-05"),
        (1e15, "1E+15"),
        (3.4028234e38, "3.402823E+38"),
        (-0.0, "0"),
        (math.inf, "INF"),
    ],
)
def test_fp32_values_print_with_seven_digits(value: float, text: str) -> None:
    assert single_text(single(value)) == text


def test_flags_and_longs_print_as_whole_numbers() -> None:
    assert (bit_text(True), bit_text(False)) == ("-1", "0")
    assert long_text(-2147483648) == "-2147483648"
    assert [number_text(1.0, kind) for kind in NumberKind] == ["1", "1", "1", "-1"]


def digits_of(text: str) -> str:
    return text.split("E")[0].replace("-", "").replace(".", "").strip("0")


@given(st.floats(-1e308, 1e308))
def test_fp64_text_reads_back_within_ten_digits(value: float) -> None:
    text = double_text(value)
    assert math.isclose(float(text), value, rel_tol=5.1e-10, abs_tol=5e-324)
    if value != int(value):
        assert len(digits_of(text)) <= 10


@given(st.floats(width=32, allow_nan=False, allow_infinity=False, allow_subnormal=False))
def test_fp32_text_reads_back_within_seven_digits(value: float) -> None:
    text = single_text(value)
    assert math.isclose(float(text), value, rel_tol=5.1e-7)
    assert len(digits_of(text)) <= 7


@given(st.integers(-999999, 999999), st.integers(-4, 0))
def test_six_digit_decimals_survive_fp32(mantissa: int, exponent: int) -> None:
    value = mantissa * 10.0**exponent
    assert float(single_text(single(value))) == pytest.approx(value, rel=1e-15)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_exponent_form_belongs_to_the_rounded_size(value: float) -> None:
    text = double_text(value)
    size = abs(float(text))
    assert ("E" in text) == (size != 0 and not 1e-4 <= size < 1e15)


@pytest.mark.parametrize(
    ("picture", "value", "text"),
    [
        ("##", 5, " 5"),
        ("##", 12, "12"),
        ("##", 123, "**"),
        ("##", -5, "-5"),
        ("##", -12, "**"),
        ("##", 2.5, " 3"),
        ("##", -0.4, " 0"),
        ("###.##", 3.14159, "  3.14"),
        ("###.##", -3.145, " -3.15"),
        ("+##.#", 3.0, " +3.0"),
        ("+##.#", -3.0, " -3.0"),
        ("0##", 7, "007"),
        ("+0##", -7, "-007"),
        ("0##.#", 1.25, "001.3"),
        (".##", 0.5, ".50"),
        (".##", 1.5, "***"),
        ("##.", 4, " 4."),
        ("###", 1e300, "***"),
        ("###", math.inf, "***"),
    ],
)
def test_using_fits_numbers_into_the_picture(picture: str, value: float, text: str) -> None:
    assert using_text(picture, value) == text


@pytest.mark.parametrize("picture", ["", "+", ".", "+.", "#.#.#", "abc", "#+", "##0"])
def test_a_picture_without_digits_or_with_other_characters_is_refused(picture: str) -> None:
    with pytest.raises(CardError, match="Invalid argument"):
        using_text(picture, 1.0)


@given(
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from(["#", "##.##", "+###.#", "0####", ".###"]),
)
def test_a_using_field_always_has_the_width_of_its_picture(value: float, picture: str) -> None:
    assert len(using_text(picture, value)) == len(picture)
