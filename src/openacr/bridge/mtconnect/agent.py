"""The agent: answers probe, current, sample and assets, once or as a stream of documents."""

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import suppress
from xml.etree import ElementTree as ET

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Route

from openacr.bridge.clock import epoch_ms, stamp
from openacr.bridge.items import Readings
from openacr.bridge.mtconnect import documents
from openacr.bridge.mtconnect.assets import Asset, Assets
from openacr.bridge.mtconnect.buffer import Buffer, Observation, OutOfRangeError
from openacr.bridge.mtconnect.devices import Devices
from openacr.bridge.mtconnect.model import (
    ADDED,
    AVAILABLE,
    CONNECTION,
    CONNECTIONS,
    OF_AGENT,
    REMOVED,
    data_item,
)
from openacr.bridge.mtconnect.multipart import END, MULTIPART, XML, part
from openacr.bridge.mtconnect.query import RequestError, bounded, integer, selected, switched
from openacr.bridge.rows import Kind, Value
from openacr.bridge.settings import MTConnect
from openacr.bridge.setup import Setup
from openacr.bridge.tools import CuttingTool
from openacr.bridge.web import WebServer

COUNT = 100
HEARTBEAT_MS = 10_000
LONGEST_MS = 3_600_000
Chosen = Sequence[ET.Element]  # the devices of a request


class MTConnectSystem:
    """The agent of one machine, whose data items are the values of the bridge."""

    name = "mtconnect"

    def __init__(self, setup: Setup, settings: MTConnect) -> None:
        items, machine = setup.items, setup.machine
        rows = [*map(data_item, items), REMOVED, *OF_AGENT]
        self._available = next(k for k, item in enumerate(items) if item.name == "available")
        self._tools = next(k for k, item in enumerate(items) if item.row.kind is Kind.TOOLS)
        self._tool = next(k for k, item in enumerate(items) if item.name == "tool")
        self._removed, self._connection = rows.index(REMOVED), rows.index(CONNECTION)
        self._assets = Assets(machine)
        self._instance, self._began = epoch_ms() // 1000, stamp()
        self._buffer = Buffer(rows, settings.buffer, self._began)
        axes = list(dict.fromkeys(item.axis for item in items if item.axis is not None))
        self._devices = Devices(rows, axes, machine, settings.uuid or "")
        self._uuid = self._devices.machine.attrib["uuid"]
        known = ((rows.index(AVAILABLE), True), (rows.index(ADDED), self._uuid))
        self._buffer.put(known, self._began)
        self._news = asyncio.Event()
        self._web = WebServer(
            self.name, settings, setup.secret, [Route("/{path:path}", self._answer)]
        )

    async def open(self) -> str:
        """Listen; the address of the agent."""
        return f"{await self._web.open()}/probe"

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        """Note what has changed; streams that wait are woken."""
        before, now = self._buffer.next, stamp()
        others = (place for place in changed if place != self._tools)
        self._buffer.put(((place, readings[place]) for place in others), now)
        if self._available in changed:
            connection = CONNECTIONS[bool(readings[self._available])]
            self._buffer.put([(self._connection, connection)], now)
        if not {self._tools, self._tool}.isdisjoint(changed):
            self._note_tools(readings[self._tools], readings[self._tool], now)
        if self._buffer.next != before:
            news, self._news = self._news, asyncio.Event()
            news.set()

    def _note_tools(self, tools: Value, in_spindle: Value, now: str) -> None:
        """Note what has changed in the tool table; unknown, its assets are kept as they were."""
        if not isinstance(tools, tuple):
            self._buffer.put([(self._tools, None), (self._removed, None)], now)
            return
        table = [each for each in tools if isinstance(each, CuttingTool)]
        number = in_spindle if isinstance(in_spindle, int) else None
        found = self._assets.update(table, number, now)
        for name in found.removed:
            self._buffer.note_asset(self._removed, name, now)
        if self._buffer.value(self._tools) in found.removed:
            self._buffer.put([(self._tools, None)], now)
        for name in found.changed:
            self._buffer.note_asset(self._tools, name, now)

    async def close(self) -> None:
        """End streams and server."""
        self._web.is_ending.set()
        self._news.set()
        await self._web.close()

    # --- requests ---------------------------------------------------------------------

    async def _answer(self, request: Request) -> Response:
        try:
            return self._answered(request)
        except RequestError as error:
            return self._refused(error.code, str(error), error.status)
        except OutOfRangeError as error:
            return self._refused("OUT_OF_RANGE", str(error), 404)

    def _refused(self, code: str, text: str, status: int) -> Response:
        header = self._header() | self._kept()
        body = documents.document("MTConnectError", header, documents.errors(code, text))
        return Response(body, status, media_type=XML)

    def _answered(self, request: Request) -> Response:
        words = [word for word in request.path_params["path"].split("/") if word]
        devices = self._devices.all
        if words and words[0] not in (*REQUESTS, *ASSETS):
            devices = [self._device(words[0])]
            words = words[1:]
        if words and words[0] in ASSETS and len(words) < 3:
            return self._of_tools(words[1:], devices, request.query_params)
        asked = words[0] if words else "probe"
        if len(words) > 1 or asked not in REQUESTS:
            raise RequestError("UNSUPPORTED", f"The following path is invalid: {request.url.path}")
        return REQUESTS[asked](self, devices, request.query_params)

    def _device(self, name: str) -> ET.Element:
        if (found := self._devices.named(name)) is None:
            raise RequestError("NO_DEVICE", f"Could not find the device '{name}'", 404)
        return found

    def probe(self, devices: Chosen, _query: Mapping[str, str]) -> Response:
        """The devices with their components and data items."""
        body = ET.Element("Devices")
        body.extend(devices)
        header = self._header() | self._changed() | self._kept() | self._counted()
        counts = {Assets.type: self._assets.count}
        found = documents.document("MTConnectDevices", header, body, counts=counts)
        return Response(found, media_type=XML)

    def current(self, devices: Chosen, query: Mapping[str, str]) -> Response:
        """The newest observation of each data item, once or at an interval."""
        at = integer(query, "at")
        interval_ms = bounded(query, "interval", 0, LONGEST_MS)
        wanted = self._wanted(devices, query)
        if interval_ms is None:
            return Response(self._stream(self._state(at, wanted)), media_type=XML)
        if at is not None:
            raise RequestError("INVALID_REQUEST", "'at' and 'interval' exclude each other")
        parts = self._currents(interval_ms / 1000.0, wanted)
        return StreamingResponse(parts, media_type=MULTIPART)

    def sample(self, devices: Chosen, query: Mapping[str, str]) -> Response:
        """Observations by their sequence numbers, once or as they come."""
        begin = integer(query, "from")
        if begin is not None and begin < 0:
            raise RequestError("INVALID_REQUEST", "'from' cannot be negative")
        count = bounded(query, "count", -self._buffer.size, self._buffer.size)
        if count == 0:
            raise RequestError("INVALID_REQUEST", "'count' cannot be 0")
        interval_ms = bounded(query, "interval", 0, LONGEST_MS)
        beat_ms = bounded(query, "heartbeat", 1, LONGEST_MS)
        wanted = self._wanted(devices, query)
        begin = begin or None  # 0: from the first one
        found, following = self._buffer.part(begin, count or COUNT, wanted)
        if interval_ms is None:
            return Response(self._stream(found, following), media_type=XML)
        if count is not None and count < 0:
            raise RequestError("INVALID_REQUEST", "'count' of a stream cannot be negative")
        parts = self._samples(
            begin or self._buffer.first, count or COUNT, wanted,
            interval_s=interval_ms / 1000.0, beat_s=(beat_ms or HEARTBEAT_MS) / 1000.0,
        )  # fmt: skip
        return StreamingResponse(parts, media_type=MULTIPART)

    def _of_tools(self, names: list[str], devices: Chosen, query: Mapping[str, str]) -> Response:
        """The assets with these ids, separated by semicolons, or the newest ones."""
        if names:
            found = [self._asset(name) for name in names[0].split(";")]
        else:
            count = bounded(query, "count", 1, Assets.size) or COUNT
            with_removed = switched(query, "removed")
            if "device" in query:
                devices = [self._device(query["device"])]
            is_type = query.get("type", Assets.type) == Assets.type
            is_wanted = is_type and self._devices.machine in devices
            found = self._assets.newest(count, with_removed=with_removed) if is_wanted else []
        body = documents.assets(found, self._uuid)
        header = self._header() | self._changed() | self._counted()
        return Response(documents.document("MTConnectAssets", header, body), media_type=XML)

    def _asset(self, name: str) -> Asset:
        if (found := self._assets.named(name)) is None:
            raise RequestError("ASSET_NOT_FOUND", f"Could not find the asset '{name}'", 404)
        return found

    # --- parts of answers -------------------------------------------------------------

    # The attributes of a header: each document has those that its schema lists.
    def _header(self) -> dict[str, object]:
        return {
            "creationTime": stamp(),
            "sender": "openacr",
            "instanceId": self._instance,
            "version": f"{documents.VERSION}.0.0",
        }

    def _changed(self) -> dict[str, object]:
        return {"deviceModelChangeTime": self._began}

    def _kept(self) -> dict[str, object]:
        return {"bufferSize": self._buffer.size}

    def _counted(self) -> dict[str, object]:
        return {"assetBufferSize": Assets.size, "assetCount": self._assets.count}

    def _state(self, at: int | None, wanted: frozenset[str] | None) -> list[Observation]:
        found = self._buffer.state(at)
        return [each for each in found if wanted is None or each.item.id in wanted]

    def _stream(self, found: Sequence[Observation], following: int | None = None) -> bytes:
        buffer = self._buffer
        header = {
            **self._header(),
            **self._changed(),
            **self._kept(),
            "firstSequence": buffer.first,
            "lastSequence": buffer.last,
            "nextSequence": buffer.next if following is None else following,
        }
        body = documents.streams(found, self._devices.places)
        return documents.document("MTConnectStreams", header, body)

    def _wanted(self, devices: Chosen, query: Mapping[str, str]) -> frozenset[str] | None:
        """The ids of the data items an XPath selects, or those inside what it selects."""
        path = query.get("path")
        if path is None:
            return None if devices == self._devices.all else documents.ids_of(devices)
        return selected(devices, path)

    # --- streams ----------------------------------------------------------------------

    async def _currents(
        self, interval_s: float, wanted: frozenset[str] | None
    ) -> AsyncIterator[bytes]:
        while not self._web.is_ending.is_set():
            yield part(self._stream(self._state(None, wanted)))
            with suppress(TimeoutError):
                async with asyncio.timeout(max(interval_s, LEAST_S)):
                    await self._web.is_ending.wait()
        yield END

    async def _samples(
        self,
        begin: int,
        count: int,
        wanted: frozenset[str] | None,
        *,
        interval_s: float,
        beat_s: float,
    ) -> AsyncIterator[bytes]:
        """New observations at most once in an interval; without any, a heartbeat."""
        clock = asyncio.get_running_loop().time
        sent_s = clock() - beat_s  # the first document is sent at once
        while not self._web.is_ending.is_set():
            try:
                found, following = self._buffer.part(begin, count, wanted)
            except OutOfRangeError as error:  # read too slowly: what was next is gone
                yield part(bytes(self._refused("OUT_OF_RANGE", str(error), 404).body))
                break
            begin = following
            if found or clock() >= sent_s + beat_s:
                yield part(self._stream(found, following))
                sent_s = clock()
            if found:
                await self._rest(sent_s + max(interval_s, LEAST_S))
            if begin == self._buffer.next:
                await self._await_news(sent_s + beat_s)
        yield END

    async def _rest(self, until_s: float) -> None:
        with suppress(TimeoutError):
            async with asyncio.timeout_at(until_s):
                await self._web.is_ending.wait()

    async def _await_news(self, until_s: float) -> None:
        with suppress(TimeoutError):
            async with asyncio.timeout_at(until_s):
                await self._news.wait()


LEAST_S = 0.005
ASSETS = ("asset", "assets")
REQUESTS: dict[str, Callable[[MTConnectSystem, Chosen, Mapping[str, str]], Response]] = {
    "probe": MTConnectSystem.probe,
    "current": MTConnectSystem.current,
    "sample": MTConnectSystem.sample,
}
