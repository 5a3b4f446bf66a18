"""The pieces of docs/machine.md are worlds, and all keys of the schema are in it."""

import re
from pathlib import Path

import msgspec
import pytest

from openacr.plant import schema
from openacr.plant.load import parse_world

TEXT = (Path(__file__).parents[2] / "docs" / "machine.md").read_text()
PIECES = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
TABLES = (
    schema.Axis, schema.Motor, schema.Load, schema.PhaseDrive, schema.IdealDrive, schema.Wire,
    schema.Inputs, schema.Analog, schema.LimitSwitch, schema.HomeSwitch,
)  # fmt: skip


@pytest.mark.parametrize("piece", PIECES)
def test_every_piece_is_a_world(piece: str) -> None:
    assert parse_world(piece).axis


@pytest.mark.parametrize("table", TABLES)
def test_every_key_is_mentioned(table: type[msgspec.Struct]) -> None:
    missing = {name for name in table.__struct_fields__ if not re.search(rf"\b{name}\b", TEXT)}
    assert missing == set()
