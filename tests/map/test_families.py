"""The modules of rows and flags: each name is the places that the rule of its block gives."""

import ast
from pathlib import Path
from types import ModuleType

import pytest

import openacr
from openacr.map.block import Block, Kind, Span
from openacr.map.families import flag_modules, row_modules
from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.hidden.block import HiddenBlock, places
from openacr.map.layout import HIDDEN_BASE, hidden_bases, slug
from openacr.map.memory import kind_table
from openacr.map.rows import axes, encoders, kernel, masters, moves
from openacr.map.tables import BLOCKS, FLAG_BLOCKS

SOURCES = Path(openacr.__file__).parent
KINDS = kind_table()


def executed(name: str, text: str) -> ModuleType:
    """A module with all its names, those too that nothing reads."""
    module = ModuleType(name)
    exec(text, vars(module))
    return module


ROWS = {name: executed(name, text) for name, text in row_modules(BLOCKS, HIDDEN_BLOCKS)}
WORDS = {name: executed(name, text) for name, text in flag_modules(FLAG_BLOCKS)}


def flags_of(prefix: str) -> ModuleType:
    return WORDS[prefix.lower()]


def as_tuple(row: int | tuple[int, ...]) -> tuple[int, ...]:
    return row if isinstance(row, tuple) else (row,)


@pytest.mark.parametrize("block", [each for each in BLOCKS if each.family], ids=lambda b: b.prefix)
def test_a_parameter_row_is_the_number_of_that_parameter_of_each_object(block: Block) -> None:
    for row in block.rows.values():
        if not row.is_reserved:
            named = getattr(ROWS[block.family], slug(row.ident or row.name).lower())
            assert as_tuple(named) == tuple(base + row.offset for base in block.bases())


@pytest.mark.parametrize("prefix", [block.prefix for block in HIDDEN_BLOCKS])
def test_a_hidden_row_is_its_place_in_the_record_of_each_object(prefix: str) -> None:
    bases = {
        block.prefix: (block, real, whole) for block, real, whole in hidden_bases(HIDDEN_BLOCKS)
    }
    block, real, whole = bases[prefix]
    for fields, first, stride in (
        (block.doubles, real, block.doubles_stride),
        (block.ints, whole, block.ints_stride),
    ):
        for name, offset, size in places(fields):
            module = ROWS[block.family]
            expected = tuple(first + offset + stride * n for n in range(block.count))
            assert as_tuple(getattr(module, slug(name).lower())) == expected
            if size > 1:
                assert getattr(module, f"{slug(name)}_SIZE") == size


def test_float64_rows_come_first_and_integer_rows_follow_them_at_once() -> None:
    bases = list(hidden_bases(HIDDEN_BLOCKS))
    assert bases[0][1] == HIDDEN_BASE
    last, real, _ = bases[-1]
    assert bases[0][2] == 2 * (real + last.count * last.doubles_stride)


@pytest.mark.parametrize(
    ("prefix", "numbers_of_0_7_8_15"),
    [
        ("MF1", (4112, 4119, 4328, 4335)),
        ("AF2", (4168, 4175, 4352, 4359)),
        ("AF5", (4600, 4607, 4608, 4615)),
        ("PF", (4128, 4135, 4136, 4143)),
    ],
)
def test_the_flag_word_of_each_object(prefix: str, numbers_of_0_7_8_15: tuple[int, ...]) -> None:
    word = flags_of(prefix).word
    assert len(word) == 16
    assert tuple(word[n] for n in (0, 7, 8, 15)) == numbers_of_0_7_8_15


def test_words_in_more_than_two_runs_are_listed_run_by_run() -> None:
    assert flags_of("XIOI").word == (4104, 4106, 4108, 4110)
    assert flags_of("CANDI").word[15:17] == (4471, 4488)
    assert len(flags_of("CANDI").word) == 64


def test_names_others_rely_on() -> None:
    assert axes.current_position[3] == 12288 + 3 * 256
    assert encoders.encoder_position[15:17] == (6144 + 15 * 16, 24576)
    assert (masters.COUNT, moves.COUNT) == (16, 768)
    assert masters.SLAVE_AXIS_SIZE == 16
    assert isinstance(kernel.kinematics, int)  # of a single object: one place
    assert moves.reals[1] - moves.reals[0] == moves.REALS_SIZE
    assert axes.parameters == axes.current_position
    assert flags_of("MF1").IN_MOTION == 16
    assert flags_of("AF1").JOG_LOCKOUT == -2147483648


def test_a_name_with_two_places_in_one_family_is_refused() -> None:
    one = HiddenBlock(prefix="XA", family="things", count=2, doubles=("size",))
    other = HiddenBlock(prefix="XB", family="things", count=2, ints=("size",))
    with pytest.raises(ValueError, match=r"things\.size has two values"):
        list(row_modules((), (one, other)))


def test_a_part_of_a_family_adds_rows_but_no_records() -> None:
    one = HiddenBlock(prefix="XA", family="things", count=2, ints=("size",))
    part = HiddenBlock(prefix="XB", family="things", count=2, ints=("age", "mood"), is_whole=False)
    (_, text), *_ = row_modules((), (one, part))
    first = 2 * HIDDEN_BASE
    assert f"ints = tuple(range({first}, {first + 2}))" in text
    assert f"mood = tuple(range({first + 3}, {first + 7}, 2))" in text


def test_objects_in_runs_of_different_lengths_are_listed_one_after_the_other() -> None:
    block = Block(
        "Things",
        object="T",
        prefix="T",
        family="things",
        spans=(Span(10, 2), Span(50, 1)),
        stride=4,
    )
    block.row(1, "Mood", Kind.LONG)
    (_, text), *_ = row_modules((block,), ())
    assert "mood = tuple(range(11, 19, 4)) + tuple(range(51, 55, 4))" in text


def test_flag_words_with_a_name_of_their_own_have_masks_alone() -> None:
    modules = dict(flag_modules(FLAG_BLOCKS))
    assert "word" not in vars(flags_of("MC1"))
    assert "\nARC_3D = 131072\n" in modules["af2"]


# views


def compiled_sources() -> list[Path]:
    return sorted(SOURCES.rglob("*_cy.py"))


def wanted_view(family: ModuleType, row: str) -> str:
    """The view that shows a row: by its kind, or by the half of the hidden rows it is in."""
    place = as_tuple(getattr(family, row))[0]
    if place >= next(whole for _, _, whole in hidden_bases(HIDDEN_BLOCKS)):
        return "I"
    kinds = KINDS
    for block in BLOCKS:
        if family.__name__ == block.family:
            for each in block.rows.values():
                if slug(each.ident or each.name).lower() == row:
                    return {1: "I", 2: "S", 3: "F"}[kinds[place]]
    return "F"


# Read as what it is not, on purpose: 32 bits of any kind are copied; no bit is set in a 0.0.
AS_BITS = {
    ("S", "fast_status.words"),
    ("I", "axes.backlash_setting"),
    ("I", "axes.rpm_factor"),
}


@pytest.mark.parametrize("path", compiled_sources(), ids=lambda path: path.stem)
def test_every_row_is_read_through_the_view_it_is_kept_in(path: Path) -> None:
    tree = ast.parse(path.read_text())
    families = {
        each.asname or each.name: ROWS[each.name]
        for node in tree.body
        if isinstance(node, ast.ImportFrom) and node.module == "openacr.map.rows"
        for each in node.names
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Subscript) or not isinstance(node.value, ast.Name):
            continue
        for row in ast.walk(node.slice):
            if isinstance(row, ast.Subscript) and isinstance(row.value, ast.Name):
                break  # what is read to find a place has a view of its own
            if isinstance(row, ast.Attribute) and isinstance(row.value, ast.Name):
                name = row.attr
                as_bits = (node.value.id, ast.unparse(row)) in AS_BITS
                if row.value.id in families and name.islower() and not as_bits:
                    wanted = wanted_view(families[row.value.id], name)
                    assert node.value.id == wanted, f"line {node.lineno}: {ast.unparse(node)}"
                break
