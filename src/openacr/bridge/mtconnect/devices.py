"""The devices of an agent: the machine, and the agent itself with the source of its values."""

import uuid
from collections.abc import Sequence
from typing import NamedTuple
from xml.etree import ElementTree as ET

from openacr.bridge.moment import AxisName
from openacr.bridge.mtconnect.model import (
    ADAPTER,
    AGENT,
    ASSET_CHANGED,
    CONTROLLER,
    DEVICE,
    PATH,
    SPINDLE,
    SPINDLE_NAME,
    DataItem,
)

AGENT_NAME = "Agent"


class Place(NamedTuple):
    """Where a data item is."""

    device: ET.Element
    component: ET.Element


class Devices:
    """The machine and, as MTConnect asks for since 1.7, the agent."""

    def __init__(
        self, items: Sequence[DataItem], axes: Sequence[AxisName], name: str, uuid_: str
    ) -> None:
        self.machine = _machine(items, axes, name, uuid_ or _uuid(name))
        self.agent = _agent(items, _uuid(f"{name}.agent"))
        self.all = [self.machine, self.agent]
        self.places = {
            row.attrib["id"]: Place(device, component)
            for device in self.all
            for component in device.iter()
            for row in component.findall("DataItems/DataItem")
        }

    def named(self, name: str) -> ET.Element | None:
        """The device with a name or uuid; the machine, if both devices have the name."""
        keys = ("name", "uuid")
        return next((d for d in self.all if name in [d.attrib[key] for key in keys]), None)


def _uuid(name: str) -> str:
    """The uuid that is made of a name, the same at every start."""
    return str(uuid.uuid5(uuid.NAMESPACE_DNS, f"{name}.openacr"))


def _machine(
    items: Sequence[DataItem], axes: Sequence[AxisName], name: str, uuid_: str
) -> ET.Element:
    """The machine with its components and data items."""
    found = ET.Element("Device", {"id": DEVICE, "name": name, "uuid": uuid_})
    ET.SubElement(found, "Description", {"manufacturer": "openacr"})
    _data_items(found, items, DEVICE)
    components = ET.SubElement(found, "Components")
    inside = _inside(components, "Axes", "axes")
    for axis in axes:
        kind = "Rotary" if axis.is_rotary else "Linear"
        one = ET.SubElement(inside, kind, {"id": f"axis_{axis.name}", "name": axis.name})
        _data_items(one, items, axis.name)
    spindle = ET.SubElement(inside, "Rotary", {"id": SPINDLE, "name": SPINDLE_NAME})
    _data_items(spindle, items, SPINDLE)
    control = ET.SubElement(components, "Controller", {"id": CONTROLLER, "name": CONTROLLER})
    _data_items(control, items, CONTROLLER)
    paths = ET.SubElement(control, "Components")
    path = ET.SubElement(paths, "Path", {"id": PATH, "name": PATH})
    _data_items(path, items, PATH)
    return found


def _agent(items: Sequence[DataItem], uuid_: str) -> ET.Element:
    """The agent: its devices, and whether the source of its values answers."""
    found = ET.Element("Agent", {"id": AGENT, "name": AGENT_NAME, "uuid": uuid_})
    _data_items(found, items, AGENT)
    inside = _inside(ET.SubElement(found, "Components"), "Adapters", "adapters")
    adapter = ET.SubElement(inside, "Adapter", {"id": ADAPTER, "name": ADAPTER})
    _data_items(adapter, items, ADAPTER)
    return found


def _inside(components: ET.Element, kind: str, name: str) -> ET.Element:
    """A component that has nothing but components; where these belong."""
    group = ET.SubElement(components, kind, {"id": name, "name": name})
    return ET.SubElement(group, "Components")


def _data_items(component: ET.Element, items: Sequence[DataItem], place: str) -> None:
    rows = ET.SubElement(component, "DataItems")
    for item in items:
        if item.component == place:
            ET.SubElement(rows, "DataItem", _attributes(item))


def _attributes(item: DataItem) -> dict[str, str]:
    found = {"category": item.category, "id": item.id, "name": item.name, "type": item.type}
    if item.sub:
        found["subType"] = item.sub
    if item.units:
        found["units"] = item.units
    if item.type == ASSET_CHANGED:
        found["discrete"] = "true"  # the same asset again is a change of its own
    if item.type == "POSITION":
        found["coordinateSystem"] = "MACHINE"
    return {key: str(value) for key, value in found.items()}
