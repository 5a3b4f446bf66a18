"""docs/configure.md has every key of configure.toml, with its default."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from msgspec import NODEFAULT, Struct
from msgspec.structs import fields

from openacr.configure import answers

PAGE = (Path(__file__).parents[2] / "docs" / "configure.md").read_text()
TABLES = (
    answers.CardAnswers,
    answers.CanOpen,
    answers.AxisAnswers,
    answers.Gains,
    answers.Drive,
    answers.Limits,
    answers.MasterAnswers,
)


def keys() -> Iterator[tuple[type[Struct], str, object]]:
    for table in TABLES:
        for field in fields(table):
            yield table, field.encode_name, field.default


@pytest.mark.parametrize(("table", "key", "default"), list(keys()))
def test_every_key_is_documented_with_its_default(
    table: type[Struct], key: str, default: object
) -> None:
    lines = [line for line in PAGE.splitlines() if f"`{key}`" in line]
    assert lines, f"{table.__name__}.{key}"
    if default is not NODEFAULT and isinstance(default, bool):
        assert any(f"`{str(default).lower()}`" in line for line in lines)
    elif default is not NODEFAULT and isinstance(default, int | float):
        number = re.escape(f"{default:.6g}".replace("1e-05", "0.00001"))
        assert any(re.search(rf"(?<![\d.]){number}(?![\d])", line) for line in lines)


def test_ends_of_travel_by_position_are_on_as_soon_as_they_are_given() -> None:
    limits = answers.Limits
    assert [
        limits().watches_soft,
        limits(soft=(24, 0)).watches_soft,
        limits(soft=(24, 0), soft_is_enabled=False).watches_soft,
        limits(soft_is_enabled=True).watches_soft,
    ] == [False, True, False, True]
