"""The pieces of docs/machine.md are worlds, and all keys of the schema are in it."""

import re
from pathlib import Path

import msgspec
import pytest

from openacr.plant.describe import schema
from openacr.plant.describe.body_schema import Body, Sign
from openacr.plant.describe.load import parse_world
from openacr.plant.devices.kinds import LIBRARY

TEXT = (Path(__file__).parents[2] / "docs" / "machine.md").read_text()
PIECES = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
TABLES = (
    schema.Axis, schema.Motor, schema.Load, schema.PhaseDrive, schema.IdealDrive, schema.Wire,
    schema.Inputs, schema.Analog, schema.LimitSwitch, schema.HomeSwitch,
    schema.DeviceTable, Body, Sign,
)  # fmt: skip


@pytest.mark.parametrize("piece", PIECES)
def test_every_piece_is_a_world(piece: str) -> None:
    world = parse_world(piece)
    assert world.axis or world.device


def test_every_kind_of_device_is_listed_with_its_commands_signals_and_settings() -> None:
    listed = dict(re.findall(r"^\| `([a-z-]+)` \| (.*) \|$", TEXT, re.MULTILINE))
    for kind, found in LIBRARY.items():
        columns = [
            re.sub(r" \(V\)", "", column).split(", ") for column in listed[kind].split(" | ")
        ]
        settings = [name for name in found.__struct_fields__ if not name.startswith("_")]
        assert columns == [list(found.COMMANDS), list(found.SIGNALS), settings], kind


@pytest.mark.parametrize("table", TABLES)
def test_every_key_is_mentioned(table: type[msgspec.Struct]) -> None:
    missing = {name for name in table.__struct_fields__ if not re.search(rf"\b{name}\b", TEXT)}
    assert missing == set()
