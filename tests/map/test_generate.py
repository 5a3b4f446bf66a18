"""The generated files are current and no two places of the map overlap."""

from functools import cache
from hashlib import blake2b
from itertools import pairwise

import pytest

from openacr.map import numbers
from openacr.map.fingerprint import LAYOUT
from openacr.map.generate import FOLDER, generated_files, left_over, numbers_text, of_names
from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.hidden.block import HiddenBlock
from openacr.map.layout import hidden_constants, slug
from openacr.map.names import every_name
from openacr.map.names_read import names_in
from openacr.map.rows import axes
from openacr.map.words import af1, mf1

NAMES = every_name()


@cache
def files() -> dict[str, str]:
    """For these all sources are read."""
    return generated_files()


def test_generated_files_are_current() -> None:
    stale = [name for name, text in files().items() if (FOLDER / name).read_text() != text]
    assert stale == [], "run python -m openacr.map.generate"


def test_no_generated_file_is_left_of_a_family_that_is_gone() -> None:
    assert left_over(files()) == []


def test_only_names_that_are_read_are_written() -> None:
    source = """
from openacr.map import numbers as at
from openacr.map.numbers import AX_BASE
from openacr.map.rows import axes as rows, masters
from openacr.map.words import mf1

I[at.AX_STRIDE] = I[rows.velocity[0]] & mf1.IN_MOTION | I[other.hold[0]]
"""
    read = set(names_in(source))
    assert read == {"numbers.AX_BASE", "numbers.AX_STRIDE", "axes.velocity", "mf1.IN_MOTION"}
    chapter = "# Axis Parameters\nAX_BASE = 12288\nAX_STRIDE = 256\n"
    assert numbers_text(read).endswith(f'"""\n\n{chapter}')
    rows = "velocity = 1\nvelocity_limit = 2\nCOUNT = 16\n"
    assert of_names(read, "axes", f'"""Places."""\n\n{rows}') == '"""Places."""\n\nvelocity = 1\n'
    assert of_names(read, "masters", rows) == ""


def test_a_module_whose_names_are_read_by_nothing_is_left_over() -> None:
    assert left_over(set(files()) - {"rows/axes.py"}) == [FOLDER / "rows/axes.py"]


def test_the_fingerprint_of_the_layout_is_that_of_all_names() -> None:
    assert len(NAMES) > 1800
    assert blake2b(repr(sorted(NAMES.items())).encode(), digest_size=8).hexdigest() == LAYOUT


def hidden_bytes() -> list[tuple[int, int, str]]:
    """First byte, end and name of every run of hidden rows."""
    runs = []
    for block in HIDDEN_BLOCKS:
        for fields, letter, size in ((block.doubles, "F", 8), (block.ints, "I", 4)):
            if fields:
                base = NAMES[f"{block.prefix}{letter}_BASE"] * size
                stride = NAMES[f"{block.prefix}{letter}_STRIDE"] * size
                runs.append((base, base + stride * block.count, f"{block.prefix}{letter}"))
    return sorted(runs)


def test_hidden_rows_lie_between_user_variables_and_heap_without_overlap() -> None:
    runs = hidden_bytes()
    assert numbers.USER_BASE * 8 == numbers.PUBLIC_COUNT * 4
    assert runs[0][0] == (numbers.USER_BASE + numbers.USER_COUNT) * 8
    for (_, end, _), (start, _, name) in pairwise(runs):
        assert start == end, name
    assert 0 <= numbers.HEAP_BYTE_BASE - runs[-1][1] < 8
    assert numbers.HEAP_BYTE_BASE % 8 == 0


def test_a_hidden_block_names_base_stride_fields_and_sizes() -> None:
    block = HiddenBlock(
        prefix="TH", family="threads", count=3, doubles=("a", ("queue", 4), "b"), ints=("pc",)
    )
    named = dict(hidden_constants([block]))
    assert (named["TH_COUNT"], named["THF_STRIDE"], named["THI_STRIDE"]) == (3, 6, 1)
    assert (named["THF_A"], named["THF_QUEUE"], named["THF_B"]) == (0, 1, 5)
    assert named["THF_QUEUE_SIZE"] == 4
    assert named["THI_BASE"] == 2 * (named["THF_BASE"] + 18)


@pytest.mark.parametrize(
    ("name", "constant"),
    [
        ("Current Position", "CURRENT_POSITION"),
        ("FOV/ROV Lock Active", "FOV_ROV_LOCK_ACTIVE"),
        ("Don't use capture Register", "DONT_USE_CAPTURE_REGISTER"),
        ("Number Of Digital Inputs (Bytes)", "NUMBER_OF_DIGITAL_INPUTS_BYTES"),
    ],
)
def test_names_become_constants(name: str, constant: str) -> None:
    assert slug(name) == constant


def test_names_others_rely_on() -> None:
    assert (axes.parameters[0], axes.PARAMETERS_SIZE, axes.COUNT) == (12288, 256, 16)
    assert (numbers.AX_CURRENT_POSITION, numbers.AX_FILTER1_A0) == (0, 57)
    assert numbers.ENC_HIGH_BASE == 24576
    assert numbers.P_GLOBAL_SYSTEM_CLOCK == 6916
    assert (mf1.IN_MOTION, af1.JOG_LOCKOUT) == (16, -2147483648)
    assert (numbers.W_INPUTS, numbers.W_FIFO, numbers.W_MISC_CONTROL_1) == (4096, 4152, 4272)


@pytest.mark.parametrize(
    ("low", "high", "numbers_of_0_7_8_15"),
    [
        (numbers.MF1_WORD, numbers.MF1_WORD_HIGH, (4112, 4119, 4328, 4335)),
        (numbers.AF2_WORD, numbers.AF2_WORD_HIGH, (4168, 4175, 4352, 4359)),
        (numbers.AF5_WORD, numbers.AF5_WORD_HIGH, (4600, 4607, 4608, 4615)),
        (numbers.PF_WORD, numbers.PF_WORD_HIGH, (4128, 4135, 4136, 4143)),
    ],
)
def test_flag_word_of_an_object(
    low: int, high: int, numbers_of_0_7_8_15: tuple[int, int, int, int]
) -> None:
    assert (low, low + 7, high + 8, high + 15) == numbers_of_0_7_8_15
