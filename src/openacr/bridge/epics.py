"""EPICS process variables over Channel Access: one for each value."""

import asyncio
import os
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from caproto import (
    AccessRights,
    AlarmSeverity,
    AlarmStatus,
    ChannelChar,
    ChannelDouble,
    ChannelEnum,
    ChannelInteger,
    ChannelString,
    Forbidden,
)
from caproto.asyncio.server import Context

from openacr.bridge.items import Item, Readings
from openacr.bridge.library_logs import in_one_line, leave_out
from openacr.bridge.newest import Newest
from openacr.bridge.rows import Kind, Unit, Value
from openacr.bridge.settings import Chosen, Epics
from openacr.bridge.setup import Setup
from openacr.errors import UserError, reason

WRITER = "EPICS"
LONGEST_TEXT = 400
LONGEST_TEXTS = {Kind.TEXT: LONGEST_TEXT, Kind.ALARMS: LONGEST_TEXT, Kind.TOOLS: 16_000}
SWITCH = ("off", "on")
BIGGEST = (1 << 31) - 1
UNITS = {
    Unit.MM: "mm", Unit.MM_PER_S: "mm/s", Unit.DEGREE: "deg", Unit.RPM: "rpm",
    Unit.PERCENT: "%", Unit.SECOND: "s",
}  # fmt: skip
READY_S = 60.0
LIBRARY_LOG, WRITE_LOG = "caproto.ctx", "caproto.circ"
Put = Callable[[object], Awaitable[None]]


class Guarded:
    """A channel that hosts read; with `put` they may write, and it decides."""

    put: Put | None = None

    def check_access(self, hostname: str, username: str) -> AccessRights:
        """The rights of a host."""
        return AccessRights.READ if self.put is None else AccessRights.READ | AccessRights.WRITE

    async def verify_value(self, data: Any) -> Any:
        """Have a written value carried out first; its error refuses it."""
        if self.put is not None:
            await self.put(data)
        return data


class Number(Guarded, ChannelDouble):  # type: ignore[misc]
    """A number with its unit."""


class Count(Guarded, ChannelInteger):  # type: ignore[misc]
    """A whole number."""


class Switch(Guarded, ChannelEnum):  # type: ignore[misc]
    """Off or on."""


class Word(Guarded, ChannelString):  # type: ignore[misc]
    """A text of up to 40 characters."""


class Text(Guarded, ChannelChar):  # type: ignore[misc]
    """A longer text, as an array of characters."""


class EpicsSystem:
    """The values as process variables of one server."""

    name = "epics"

    def __init__(self, setup: Setup, settings: Epics) -> None:
        self._setup, self._settings, self._items = setup, settings, setup.items
        self._channels = [channel_of(item) for item in setup.items]
        for place, item in enumerate(setup.items):
            if item.chosen is not None and item.chosen.write:
                self._channels[place].put = self._put_of(place)
        self._newest = Newest(self._write)
        self._task: asyncio.Task[None] | None = None

    def _put_of(self, place: int) -> Put:
        item = self._items[place]

        async def put(data: object) -> None:
            try:
                await self._setup.writer.write(item, written(data), WRITER)
            except UserError:
                self._newest.again([place])  # its state is not that of a failed write
                raise

        return put

    async def open(self) -> str:
        """Listen for searches and connections."""
        settings = self._settings
        # Beacons are for this address, not for every network of the computer.
        os.environ.setdefault("EPICS_CAS_AUTO_BEACON_ADDR_LIST", "NO")
        os.environ.setdefault("EPICS_CAS_BEACON_ADDR_LIST", settings.address)
        in_one_line(WRITE_LOG, UserError, Forbidden)
        leave_out(LIBRARY_LOG, ConnectionRefusedError)  # no repeater waits for beacons here
        prefix = settings.prefix or f"{self._setup.machine}:"
        names = [f"{prefix}{item.name.replace('.', ':')}" for item in self._items]
        context = Context(dict(zip(names, self._channels, strict=True)), [settings.address])
        context.ca_server_port = settings.port
        is_ready = asyncio.Event()

        async def ready(_library: object) -> None:
            is_ready.set()

        self._task = asyncio.create_task(context.run(startup_hook=ready))
        waiting = asyncio.create_task(is_ready.wait())
        both = (self._task, waiting)
        await asyncio.wait(both, timeout=READY_S, return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()
        if not is_ready.is_set():
            failure = self._task.exception() if self._task.done() else TimeoutError("too slow")
            place = f"{settings.address}:{settings.port}"
            why = reason(failure) if isinstance(failure, Exception) else "it has ended"
            raise UserError(f"epics: cannot listen on {place}: {why.lower()}")
        self._newest.start()
        return f"{settings.address}:{settings.port} {prefix}"

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        """Hand over what has changed."""
        self._newest.put(readings, changed)

    async def _write(self, readings: Readings, places: list[int]) -> None:
        for place in places:
            item, channel = self._items[place], self._channels[place]
            value = shown(item, readings[place])
            is_known = value is not None
            await channel.write(
                value if is_known else EMPTY[item.row.kind],
                verify_value=False,
                status=AlarmStatus.NO_ALARM if is_known else AlarmStatus.UDF,
                severity=AlarmSeverity.NO_ALARM if is_known else AlarmSeverity.INVALID_ALARM,
            )

    async def close(self) -> None:
        """End the server."""
        await self._newest.stop()
        if self._task is not None:
            self._task.cancel()
            with suppress(asyncio.CancelledError):
                await self._task


EMPTY: dict[Kind, Any] = {
    Kind.NUMBER: 0.0, Kind.COUNT: 0, Kind.SWITCH: SWITCH[0], Kind.TEXT: "", Kind.WORD: "",
    Kind.ALARMS: "", Kind.TOOLS: "",
}  # fmt: skip


def channel_of(item: Item) -> Any:
    """The channel of a value, which is not known yet."""
    kind = item.row.kind
    if kind is Kind.SWITCH:
        return Switch(value=SWITCH[0], enum_strings=SWITCH)
    if kind is Kind.WORD:
        return Word(value="", string_encoding="utf-8")
    if (longest := LONGEST_TEXTS.get(kind)) is not None:
        return Text(value="", max_length=longest, string_encoding="utf-8")
    if kind is Kind.COUNT:
        return Count(value=0)
    unit = item.unit if item.chosen is not None else UNITS.get(Unit(item.unit), "")
    return Number(value=0.0, precision=4, units=unit, **limits_of(item.chosen))


def limits_of(chosen: Chosen | None) -> dict[str, float]:
    """The limits for displays and, of a value that may be written, for controls."""
    if chosen is None or chosen.low is None or chosen.high is None:
        return {}
    found = {"lower_disp_limit": chosen.low, "upper_disp_limit": chosen.high}
    if chosen.write:
        found |= {"lower_ctrl_limit": chosen.low, "upper_ctrl_limit": chosen.high}
    return found


def written(data: Any) -> object:
    """The value a host has written: a number of numpy or Python, or the word of a switch."""
    values = np.asarray(data).reshape(-1).tolist()
    value = values[0] if len(values) == 1 else values
    return SWITCH.index(value) if value in SWITCH else value


def shown(item: Item, value: Value) -> Any:
    """A value as its channel holds it; None where it is not known or does not fit."""
    if isinstance(value, bool):
        return SWITCH[value]
    if item.row.kind is Kind.COUNT and isinstance(value, int):
        return value if abs(value) <= BIGGEST else None
    if isinstance(value, tuple):
        value = "; ".join(map(str, value))
    if isinstance(value, str):
        longest = LONGEST_TEXTS.get(item.row.kind, LONGEST_TEXT)
        return value.encode()[: longest - 1].decode(errors="ignore")
    return value
