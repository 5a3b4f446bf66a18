"""Values of the OPC UA server: what the library keeps of them, and their bytes."""

import copy
from typing import Any

import pytest
from asyncua import ua
from asyncua.common.utils import Buffer
from asyncua.ua.ua_binary import struct_from_binary, struct_to_binary
from tests.bridge.bench import VALUES

from openacr.bridge.clock import now
from openacr.bridge.items import Item, items_of
from openacr.bridge.load import parse_bridge
from openacr.bridge.opcua.nodes import data_value
from openacr.bridge.rows import Alarm, Value

NOW = now()
ITEMS = {item.name: item for item in items_of((), parse_bridge("[opcua]\n" + VALUES).value)}
CASES: list[tuple[str, Value]] = [
    ("user.pulses", 400.25),
    ("user.gate", True),
    ("line", 12),
    ("program", "plate.nc"),
    ("alarms", (Alarm(34, "X: drive is off", "REFUSE"),)),
    ("feed", None),
]


def shown(name: str, value: Value) -> tuple[Item, Any]:
    item = ITEMS[name]
    return item, data_value(item, value, NOW, is_lost=False)


@pytest.mark.parametrize(("name", "value"), CASES)
def test_a_published_value_is_its_own_copy(name: str, value: Value) -> None:
    _, found = shown(name, value)
    assert copy.deepcopy(found) is found
    assert copy.deepcopy([found])[0] is found


@pytest.mark.parametrize(("name", "value"), CASES)
def test_a_published_value_travels_as_one_of_the_library(name: str, value: Value) -> None:
    _, found = shown(name, value)
    plain = ua.DataValue(found.Value, found.StatusCode, NOW)
    assert struct_to_binary(found) == struct_to_binary(plain)
    read: Any = struct_from_binary(ua.DataValue, Buffer(struct_to_binary(found)))
    assert (read.StatusCode, read.SourceTimestamp) == (found.StatusCode, NOW)
    assert read.Value.Value == found.Value.Value
    sent = ua.DataChangeNotification([ua.MonitoredItemNotification(7, found)])
    assert struct_to_binary(sent) == struct_to_binary(
        ua.DataChangeNotification([ua.MonitoredItemNotification(7, plain)])
    )


def test_good_values_share_their_status_and_others_say_why() -> None:
    assert shown("line", 12)[1].StatusCode.is_good()
    assert shown("line", 12)[1].StatusCode is shown("feed", 1.0)[1].StatusCode
    lost = data_value(ITEMS["line"], None, NOW, is_lost=True)
    assert lost.StatusCode.value == ua.StatusCodes.BadNoCommunication
    assert shown("line", None)[1].StatusCode.value == ua.StatusCodes.BadNoData
