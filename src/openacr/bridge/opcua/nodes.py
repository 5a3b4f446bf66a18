"""Values as nodes: where each is, its browse name, its type, and the value it shows."""

from datetime import datetime
from typing import NamedTuple, Self

from asyncua import ua

from openacr.bridge.items import Item
from openacr.bridge.rows import Kind, Unit, Value

# Folders and browse names of OPC 40001-1 (Machinery) and OPC 40501-1 (Machine Tools), by row. All
# other rows are of the channel, under their own names.
CHANNEL = ("Monitoring", "Channel")
PLACES = {
    "available": (("Monitoring", "MachineTool"), "Available"),
    "mode": (("Monitoring", "MachineTool"), "OperationMode"),
    "emergency_stop": (("Monitoring", "MachineTool"), "EmergencyStop"),
    "feed_override": (CHANNEL, "FeedOverride"),
    "rapid_override": (CHANNEL, "RapidOverride"),
    "spindle_speed": (("Monitoring", "Spindle"), "CommandedSpeed"),
    "spindle_override": (("Monitoring", "Spindle"), "Override"),
    "spindle_on": (("Monitoring", "Spindle"), "IsRotating"),
    "execution": (("Production", "ActiveProgram"), "State"),
    "program": (("Production", "ActiveProgram"), "Name"),
    "line": (("Production", "ActiveProgram"), "Line"),
    "block": (("Production", "ActiveProgram"), "Block"),
    "run_time": (("Production", "ActiveProgram"), "RunTime"),
    "time_left": (("Production", "ActiveProgram"), "RemainingTime"),
    "parts": (("Production",), "PartsProduced"),
    "tool": (("Equipment", "Tools"), "ToolInSpindle"),
    "tools": (("Equipment", "Tools"), "ToolTable"),
    "message": (("Notification",), "Message"),
    "alarms": (("Notification",), "Alarms"),
}
TYPES = {
    Kind.NUMBER: ua.VariantType.Double,
    Kind.COUNT: ua.VariantType.Int64,
    Kind.SWITCH: ua.VariantType.Boolean,
    Kind.TEXT: ua.VariantType.String,
    Kind.WORD: ua.VariantType.String,
    Kind.ALARMS: ua.VariantType.String,
    Kind.TOOLS: ua.VariantType.String,
}
GOOD = ua.StatusCode(ua.StatusCodes.Good)
UNECE = "http://www.opcfoundation.org/UA/units/un/cefact"
CODES = {  # units of UNECE Recommendation 20: code, and how it is shown
    Unit.MM: ("MMT", "mm"),
    Unit.MM_PER_S: ("C16", "mm/s"),
    Unit.DEGREE: ("DD", "°"),
    Unit.RPM: ("RPM", "r/min"),
    Unit.PERCENT: ("P1", "%"),
    Unit.SECOND: ("SEC", "s"),
}


class Reading(ua.DataValue):  # type: ignore[misc]
    """A value with its time, never changed once it is made.

    The library keeps a deep copy of every value for each item a host has subscribed, to compare the
    next one with it. A copy of what never changes is the thing itself; making one took four fifths
    of the time of a subscribed value.
    """

    __slots__ = ()

    def __deepcopy__(self, memo: object) -> Self:
        return self


class Place(NamedTuple):
    """Folders from the object of the machine, and the browse name inside the last one."""

    folders: tuple[str, ...]
    name: str


def place_of(item: Item) -> Place:
    """Where a value is."""
    own = "".join(word.capitalize() for word in item.row.name.split("_"))
    if item.chosen is not None:
        return Place(("Monitoring", "User"), item.row.name)
    if item.axis is not None:
        return Place(("Monitoring", "Axes", item.axis.name), own)
    folders, name = PLACES.get(item.row.name, (CHANNEL, own))
    return Place(folders, name)


def units_of(item: Item) -> ua.EUInformation | None:
    """The engineering unit of a value; a chosen one has its text alone."""
    if not item.unit:
        return None
    if item.chosen is not None:
        return ua.EUInformation(UnitId=-1, DisplayName=ua.LocalizedText(item.unit))
    code, shown = CODES[Unit(item.unit)]
    return ua.EUInformation(
        NamespaceUri=UNECE,
        UnitId=int.from_bytes(code.encode(), "big"),
        DisplayName=ua.LocalizedText(shown),
    )


def data_value(item: Item, value: Value, now: datetime, *, is_lost: bool) -> Reading:
    """A value with its time; one that is not known is bad: lost, or without data."""
    kind = TYPES[item.row.kind]
    if value is None:
        codes = ua.StatusCodes
        bad = ua.StatusCode(codes.BadNoCommunication if is_lost else codes.BadNoData)
        return Reading(ua.Variant(None), bad, now)
    if isinstance(value, tuple):
        texts = [str(each) for each in value]
        return Reading(ua.Variant(texts, kind, is_array=True), GOOD, now)
    return Reading(ua.Variant(value, kind, is_array=False), GOOD, now)
