"""Notices as OPC UA events of the Server object: alarms as AlarmConditionType, others as base."""

from copy import copy
from typing import Any

from asyncua import Server, ua
from asyncua.common.event_objects import AlarmCondition, BaseEvent

from openacr.bridge.clock import now
from openacr.bridge.opcua.notices import Notice

NOTHING = ua.NodeId()
STATES = {False: "Inactive", True: "Active"}


class Events:
    """Sends events to hosts that subscribe the events of the server."""

    def __init__(self, server: Server, index: int, machine: str) -> None:
        self._server, self._index, self._machine = server, index, machine
        self._plain: Any = None
        self._alarm: Any = None

    async def open(self) -> None:
        """Make the generators of events."""
        self._plain = await self._server.get_event_generator(BaseEvent())
        condition = AlarmCondition()
        condition.add_property("NodeId", None, ua.VariantType.NodeId)  # the id of the condition
        self._alarm = await self._server.get_event_generator(condition)

    async def send(self, notice: Notice) -> None:
        """Send a notice."""
        generator = self._plain if notice.alarm is None else self._alarm
        generator.event = copy(generator.event)  # ConditionRefresh sends the last one of each
        fields = self._common(notice) if notice.alarm is None else self._condition(notice)
        for name, value in fields.items():
            setattr(generator.event, name, value)
        await generator.trigger(now())

    def _common(self, notice: Notice) -> dict[str, object]:
        return {
            "SourceNode": ua.NodeId(notice.source, self._index),
            "SourceName": self._machine,
            "Message": ua.LocalizedText(notice.text),
            "Severity": notice.severity,
        }

    def _condition(self, notice: Notice) -> dict[str, object]:
        """The state of an alarm; it is acknowledged at the machine, if at all."""
        code = 0 if notice.alarm is None else notice.alarm.code
        source = ua.NodeId(notice.source, self._index)
        return self._common(notice) | {
            "NodeId": ua.NodeId(f"alarms.{notice.text}", self._index),
            "ConditionName": str(code),
            "ConditionClassId": ua.NodeId(ua.ObjectIds.ProcessConditionClassType),
            "ConditionClassName": ua.LocalizedText("ProcessConditionClassType"),
            "BranchId": NOTHING,
            "Retain": notice.is_active,
            "EnabledState": ua.LocalizedText("Enabled"),
            "EnabledState/Id": True,
            "ActiveState": ua.LocalizedText(STATES[notice.is_active]),
            "ActiveState/Id": notice.is_active,
            "AckedState": ua.LocalizedText("Acknowledged"),
            "AckedState/Id": True,
            "Quality": ua.StatusCode(ua.StatusCodes.Good),
            "InputNode": source,
            "SuppressedOrShelved": False,
        }
