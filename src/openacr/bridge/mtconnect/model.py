"""Values as data items of MTConnect: ids, types, categories, and the component each belongs to."""

from dataclasses import dataclass
from enum import StrEnum

from openacr.bridge.items import Item
from openacr.bridge.rows import Kind, Standard, Value

UNAVAILABLE = "UNAVAILABLE"
OWN = "x"  # prefix of the types that the standard does not have
DEVICE, CONTROLLER, PATH, SPINDLE = "device", "controller", "path", "spindle"
AGENT, ADAPTER = "agent", "adapter"
CUTTING_TOOL = "CuttingTool"  # the type of all assets
ASSET_CHANGED, ASSET_REMOVED = "ASSET_CHANGED", "ASSET_REMOVED"
OF_DEVICE = frozenset({"AVAILABILITY", ASSET_CHANGED, ASSET_REMOVED})
OF_CONTROLLER = frozenset({"EMERGENCY_STOP", "CONTROLLER_MODE", "SYSTEM", "MESSAGE"})
OF_SPINDLE = frozenset({"spindle_speed", "spindle_override", "spindle_on"})
SPINDLE_NAME = "S"


class Category(StrEnum):
    """The categories of data items."""

    SAMPLE = "SAMPLE"
    EVENT = "EVENT"
    CONDITION = "CONDITION"


@dataclass(frozen=True, slots=True)
class DataItem:
    """One data item of the device."""

    id: str
    name: str
    meaning: str
    category: Category
    type: str  # PATH_FEEDRATE; x:TO_GO for one of our own
    sub: str
    units: str
    component: str  # its id; of an axis the letter

    @property
    def element(self) -> str:
        """The name of its element in a stream."""
        prefix, _, name = self.type.rpartition(":")
        camel = "".join(word.capitalize() for word in name.split("_"))
        return f"{prefix}:{camel}" if prefix else camel

    def text(self, value: Value) -> str:
        """A value as the text of its element."""
        if value is None:
            return UNAVAILABLE
        if self.type == "AVAILABILITY":
            return "AVAILABLE" if value else UNAVAILABLE
        if isinstance(value, bool):
            return "ON" if value else "OFF"
        return f"{value:.9g}" if isinstance(value, float) else str(value)


def _event(name: str, meaning: str, kind: str, component: str) -> DataItem:
    """An event that is no value of the table."""
    return DataItem(name, name, meaning, Category.EVENT, kind, "", "", component)


REMOVED = _event(
    "tools_removed", "tool that was removed from the tool table", ASSET_REMOVED, DEVICE
)
AVAILABLE = _event("agent_available", "the agent answers", "AVAILABILITY", AGENT)
ADDED = _event("device_added", "uuid of the machine", "DEVICE_ADDED", AGENT)
CONNECTION = _event(
    "connection", "whether the machine answers the agent", "CONNECTION_STATUS", ADAPTER
)
OF_AGENT = (
    AVAILABLE,
    ADDED,
    _event("device_removed", "no device is ever removed", "DEVICE_REMOVED", AGENT),
    _event("device_changed", "no device is ever changed", "DEVICE_CHANGED", AGENT),
    CONNECTION,
)
CONNECTIONS = {True: "ESTABLISHED", False: "CLOSED"}


def data_item(item: Item) -> DataItem:
    """The data item of a value."""
    standard = item.row.standard or Standard(f"{OWN}:{item.row.name.upper()}")
    is_turned = item.axis is not None and item.axis.is_rotary
    kind = "ANGLE" if is_turned and standard.type == "POSITION" else standard.type
    return DataItem(
        id=item.name.replace(".", "_"),
        name=item.name,
        meaning=item.row.meaning,
        category=_category(item.row.kind, is_event=standard.is_event),
        type=kind,
        sub=standard.sub,
        units=item.unit if item.chosen is None else "",
        component=_component(item, kind),
    )


def _category(kind: Kind, *, is_event: bool) -> Category:
    if kind is Kind.ALARMS:
        return Category.CONDITION
    return Category.SAMPLE if kind is Kind.NUMBER and not is_event else Category.EVENT


def _component(item: Item, kind: str) -> str:
    if item.axis is not None:
        return item.axis.name
    if item.chosen is not None or kind in OF_CONTROLLER:
        return CONTROLLER
    if item.row.name in OF_SPINDLE:
        return SPINDLE
    return DEVICE if kind in OF_DEVICE else PATH
