"""The memory behaves as P and BIT do on the card."""

import math
import struct
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from openacr.errors import CardError, StoreError
from openacr.map import parameters
from openacr.map.kinds_cy import kind_of
from openacr.map.memory import Memory, kind_table
from openacr.map.numbers import (
    HEAP_BYTE_BASE,
    HEAP_BYTES,
    KIND_FP32,
    KIND_FP64,
    KIND_LONG,
    KIND_NONE,
    MEMORY_BYTES,
    PUBLIC_COUNT,
    USER_BASE,
)
from openacr.map.rows import system
from openacr.messages import INVALID_BIT, INVALID_PARAMETER, UNDEFINED_VARIABLE

POSITION, GAIN = 12288, 12304
MEMORY = Memory()


def f32(value: float) -> float:
    return float(struct.unpack("<f", struct.pack("<f", value))[0])


@pytest.mark.parametrize(
    ("written", "kept"),
    [
        (3.99, 3),
        (-3.99, -3),
        (2**31, -(2**31)),
        (-(2**31) - 1, 2**31 - 1),
        (2**32 + 5.5, 5),
        (1e300, 0),
        (math.nan, 0),
        (-math.inf, 0),
    ],
)
def test_long_parameters_truncate_and_wrap(written: float, kept: int) -> None:
    memory = Memory()
    memory.write(POSITION, written)
    assert memory.read(POSITION) == kept


@pytest.mark.parametrize(
    ("written", "kept"), [(0.1, f32(0.1)), (1e300, math.inf), (-1e300, -math.inf), (7, 7.0)]
)
def test_float_parameters_round_to_single_precision(written: float, kept: float) -> None:
    memory = Memory()
    memory.write(GAIN, written)
    assert memory.read(GAIN) == kept


@given(st.integers(-(2**31), 2**31 - 1))
def test_a_long_comes_back_as_written(value: int) -> None:
    MEMORY.write(POSITION, value)
    assert MEMORY.read(POSITION) == value


@given(st.floats(width=32, allow_nan=False))
def test_a_single_comes_back_as_written(value: float) -> None:
    MEMORY.write(GAIN, value)
    assert MEMORY.read(GAIN) == value


@given(st.integers(-(2**31), 2**31 - 1))
def test_the_flags_of_a_word_are_its_bits(value: int) -> None:
    MEMORY.write(4097, value)
    assert [MEMORY.bit(32 + n) for n in range(32)] == [bool(value >> n & 1) for n in range(32)]


@given(st.integers(0, 17663), st.booleans())
def test_a_flag_comes_back_as_set_and_moves_no_other(number: int, on: bool) -> None:
    word = 4096 + number // 32
    others = 0xFFFFFFFF - (1 << number % 32)
    before = MEMORY.I[word] & others
    MEMORY.set_bit(number, on)
    assert MEMORY.bit(number) is on
    assert MEMORY.I[word] & others == before


def test_user_variables_exist_as_far_as_dimensioned() -> None:
    memory = Memory()
    with pytest.raises(CardError) as refused:
        memory.read(0)
    assert refused.value.message is UNDEFINED_VARIABLE
    memory.I[system.p_count] = 10
    memory.write(9, 0.1)
    assert memory.read(9) == 0.1
    with pytest.raises(CardError):
        memory.write(10, 1)


@pytest.mark.parametrize("number", [-1, 4440, 5000, 8256, 39424, 40960, 10**9])
def test_numbers_without_a_parameter_are_refused(number: int) -> None:
    with pytest.raises(CardError) as refused:
        Memory().read(number)
    assert refused.value.message is INVALID_PARAMETER
    with pytest.raises(CardError):
        Memory().write(number, 1)


@pytest.mark.parametrize("number", [-1, 17664])
def test_flags_beyond_the_last_are_refused(number: int) -> None:
    for use in (Memory().bit, lambda n: Memory().set_bit(n, True)):
        with pytest.raises(CardError) as refused:
            use(number)
        assert refused.value.message is INVALID_BIT


def test_every_parameter_has_the_kind_its_table_says() -> None:
    codes = {"LONG": KIND_LONG, "FP32": KIND_FP32, "FP64": KIND_FP64}
    expected = bytearray(PUBLIC_COUNT)
    for number, found in parameters().items():
        expected[number] = codes[found.kind.value]
    assert kind_table() == bytes(expected)
    view = Memory().I
    assert bytes(kind_of(view, n) for n in range(PUBLIC_COUNT)) == bytes(expected)
    assert kind_of(view, -1) == kind_of(view, PUBLIC_COUNT) == KIND_NONE


def test_power_up_values_are_those_of_the_tables() -> None:
    memory = Memory()
    for number, found in parameters().items():
        if number >= 4096:
            value = f32(found.default) if found.kind.value == "FP32" else found.default
            assert memory.read(number) == value, number


@pytest.mark.parametrize(
    ("number", "value"),
    [
        (12304, f32(0.002441406)),
        (12328 + 256 * 15, 10),
        (12329, -10),
        (8201, 1),
        (8216 + 256 * 15, 1),
        (8220, 1),
        (6402, f32(3276.8)),
        (6410, 10),
        (12375, 1),
        (12349, 10),
        (8211, 5),
        (12401, 10),
        (8229, 5),
        (6656, 1),
        (6980, 50),
        (7040, 80200000),
        (7042, 11806),
        (7043, 15),
        (33024, 1),
        (33040, 0),
    ],
)
def test_documented_defaults(number: int, value: float) -> None:
    assert Memory().read(number) == value


def test_a_snapshot_brings_everything_back() -> None:
    memory = Memory()
    memory.write(POSITION, 77)
    memory.F[USER_BASE] = 1.5
    memory.I[HEAP_BYTE_BASE // 4] = -9
    kept, digest = memory.snapshot(), memory.digest()
    memory.power_up()
    assert (memory.read(POSITION), memory.digest() == digest) == (0, False)
    memory.restore(kept)
    assert (memory.read(POSITION), memory.F[USER_BASE]) == (77, 1.5)
    assert memory.I[HEAP_BYTE_BASE // 4] == -9
    assert memory.digest() == digest


def test_a_snapshot_of_another_layout_is_refused() -> None:
    with pytest.raises(StoreError, match="3 bytes"):
        Memory().restore(b"abc")


def test_equal_cards_have_equal_digests_and_a_single_bit_shows() -> None:
    one, other = Memory(), Memory()
    assert one.digest() == other.digest()
    other.set_bit(17663, True)
    assert one.digest() != other.digest()


def test_the_views_share_one_buffer() -> None:
    memory = Memory()
    memory.S[GAIN] = 1.0
    assert memory.I[GAIN] == 0x3F800000
    assert len(memory.F) * 8 == len(memory.I) * 4 == len(memory.S) * 4 == MEMORY_BYTES
    assert HEAP_BYTE_BASE + HEAP_BYTES == MEMORY_BYTES


def test_the_memory_needs_no_tables() -> None:
    code = (
        "import sys; from openacr.map.memory import Memory; Memory();"
        "sys.exit('openacr.map.tables' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
