"""Parameters and flags are found by number, by name, by object and name."""

import pytest

from openacr.errors import MapError
from openacr.map import (
    find_flag,
    find_parameter,
    flag,
    flag_names,
    flags,
    flags_of,
    parameter,
    parameter_names,
    parameters,
)
from openacr.map.explain import has_meaning
from openacr.map.tables import BLOCKS, FLAG_BLOCKS


@pytest.mark.parametrize("text", ["12291", "P12291", "p12291", " P 12291 "])
def test_a_number_names_one_parameter(text: str) -> None:
    assert find_parameter(text) == [parameter(12291)]


@pytest.mark.parametrize("text", ["580", "BIT580", "bit580", "bit 580"])
def test_a_number_names_one_flag(text: str) -> None:
    assert find_flag(text) == [flag(580)]


def test_a_name_finds_it_on_every_axis() -> None:
    assert [found.number for found in find_parameter("following error")] == [
        12291 + 256 * axis for axis in range(16)
    ]


@pytest.mark.parametrize("text", ["axis 2 following error", "axis2.following_error"])
def test_object_and_name_find_one(text: str) -> None:
    assert [found.number for found in find_parameter(text)] == [12803]
    assert [found.number for found in find_flag("master 2 in motion")] == [580]


def test_words_of_a_name_find_all_that_contain_them() -> None:
    names = {found.name for found in find_flag("axis 0 jog")}
    assert {"Jog Active", "Jog Forward", "Jog Home Request"} <= names


def test_reserved_rows_are_not_found_by_name() -> None:
    with pytest.raises(MapError):
        find_parameter("reserved")


def test_a_near_miss_suggests_the_name() -> None:
    with pytest.raises(MapError, match="perhaps Following Error"):
        find_parameter("folowing eror")


def test_an_unknown_number_is_named_in_the_refusal() -> None:
    with pytest.raises(MapError, match="P4440"):
        parameter(4440)
    with pytest.raises(MapError, match="BIT99999"):
        find_flag("BIT99999")


def test_flags_of_a_word() -> None:
    assert [found.number for found in flags_of(4112)] == list(range(512, 544))
    assert flags_of(12288) == []


def test_a_record_tells_everything() -> None:
    found = parameter(12375 + 512)
    assert (found.name, found.object, found.index) == ("PPU", "AXIS", 2)
    assert (found.kind, found.unit, found.default) == ("FP32", "pulse/unit", 1)


@pytest.mark.parametrize("number", [-1, 17664])
def test_numbers_next_to_the_flags_are_refused(number: int) -> None:
    assert {flag(0).bit, flag(17663).bit} == {0, 31}
    with pytest.raises(MapError, match=f"BIT{number}$"):
        flag(number)


def test_one_record_is_the_record_of_the_table() -> None:
    for number in (0, 516, 17663):
        assert flag(number) is flags()[number]
    for number in (0, 4096, 12291):  # a global variable, a flag word, a row of an axis
        assert parameter(number) is parameters()[number]


def test_every_number_is_declared_once() -> None:
    rows = sum(len(block.rows) * len(list(block.bases())) for block in BLOCKS)
    words = sum(block.count for block in FLAG_BLOCKS)
    assert len(parameters()) == rows + words
    assert len(flags()) == 32 * words


def test_names_without_rows_are_those_of_the_rows_that_are_described() -> None:
    for names, rows in ((parameter_names(), parameters()), (flag_names(), flags())):
        described = {n: row.name for n, row in rows.items() if has_meaning(row)}
        assert list(names.items()) == list(described.items())
