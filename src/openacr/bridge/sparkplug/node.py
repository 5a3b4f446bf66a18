"""The edge node: births, data, commands and death on a broker that may come and go."""

import asyncio
import logging
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

import paho.mqtt.client as mqtt
from paho.mqtt.enums import CallbackAPIVersion

from openacr.bridge.clock import epoch_ms
from openacr.bridge.items import Item, Readings
from openacr.bridge.rows import Kind, Value
from openacr.bridge.settings import Sparkplug
from openacr.bridge.setup import Setup
from openacr.bridge.sparkplug.link import encryption, failure, part
from openacr.bridge.sparkplug.payload import DataType, Metric, Payload, PayloadError, decode, encode
from openacr.bridge.sparkplug.primary_host import PrimaryHost
from openacr.errors import UserError

log = logging.getLogger(__name__)
REBIRTH, BD_SEQ = "Node Control/Rebirth", "bdSeq"
FIRST_ALIAS = 1
ROUND = 256  # sequence numbers
KEEP_ALIVE_S = 10  # a broker that is silent longer than 1.5 of it is lost
RETRY_S = (1, 30)  # shortest and longest time between two attempts
CONNECT_S = 5.0
WRITER = "Sparkplug"
SUBSCRIBED = ("commands", "states", "states of 2.2")  # what a broker may refuse, in this order
TYPES = {Kind.NUMBER: DataType.DOUBLE, Kind.COUNT: DataType.INT64, Kind.SWITCH: DataType.BOOLEAN}


class SparkplugSystem:
    """One machine as an edge node. Data are sent by report of what has changed."""

    name = "sparkplug"

    def __init__(self, setup: Setup, settings: Sparkplug) -> None:
        self._setup, self._settings, self._items = setup, settings, setup.items
        self._readings: Readings = ()
        self._changed: set[int] = set()
        self._seq = self._bd_seq = 0
        self._is_linked = self._is_born = False
        self._sent: mqtt.MQTTMessageInfo | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._writes: set[asyncio.Task[None]] = set()
        host = settings.primary_host
        self._host = None if host is None else PrimaryHost(host)
        self._leaving: asyncio.Task[None] | None = None
        self._ended = asyncio.Event()
        self._attempts = -1
        self._is_said = False
        self._encryption = encryption(settings, setup.folder) if settings.tls else None
        self._client = self._made()

    def _made(self) -> mqtt.Client:
        settings = self._settings
        client = mqtt.Client(CallbackAPIVersion.VERSION2, client_id=settings.client_id or "")
        client.connect_timeout = CONNECT_S
        client.reconnect_delay_set(*RETRY_S)
        if settings.user is not None:
            client.username_pw_set(settings.user, self._setup.secret)
        if self._encryption is not None:
            client.tls_set_context(self._encryption)
        client.on_pre_connect = self._before_connect
        client.on_connect = self._on_connect
        client.on_subscribe = self._on_subscribe
        client.on_connect_fail = self._on_connect_fail
        client.on_disconnect = self._on_disconnect
        client.on_message = self._on_message
        return client

    def topic(self, kind: str) -> str:
        """The topic of a message: NBIRTH, NDATA, NDEATH or NCMD."""
        return f"spBv1.0/{self._settings.group}/{kind}/{self._setup.machine}"

    async def open(self) -> str:
        """Begin to connect; a broker that is away is tried again until the end."""
        self._loop = asyncio.get_running_loop()
        self._connect()
        settings = self._settings
        return f"mqtt{'s' if settings.tls else ''}://{settings.address}:{settings.port}"

    def _connect(self) -> None:
        self._client.connect_async(self._settings.address, self._settings.port, KEEP_ALIVE_S)
        self._client.loop_start()

    # --- in the thread of the client --------------------------------------------------

    def _before_connect(self, client: mqtt.Client, _data: object) -> None:
        """Every connection has a number; the broker tells of its end with the same one."""
        self._attempts += 1
        self._bd_seq = self._attempts % ROUND
        client.will_set(self.topic("NDEATH"), encode(self._death()), qos=1)

    def _on_connect(
        self, client: mqtt.Client, _data: object, _flags: object, code: Any, _more: object
    ) -> None:
        if code.is_failure:
            self._say(f"the broker refuses the connection: {code}")
            return
        self._is_said = False
        log.info("sparkplug: connected to %s", self._settings.address)
        states = () if self._host is None else self._host.topics
        client.subscribe([(topic, 1) for topic in (self.topic("NCMD"), *states)])

    def _on_subscribe(
        self, _client: mqtt.Client, _data: object, _id: int, codes: list[Any], _more: object
    ) -> None:
        """The birth comes after the subscription: a host may answer it with a command."""
        for what, code in zip(SUBSCRIBED, codes, strict=False):
            if code.is_failure:
                log.warning("sparkplug: the broker refuses the subscription of %s: %s", what, code)
        self._soon(self._link)

    def _on_connect_fail(self, _client: mqtt.Client, _data: object) -> None:
        """Say why; paho calls this while it handles the error of the attempt."""
        place = f"{self._settings.address}:{self._settings.port}"
        self._say(failure(place, sys.exc_info()[1]))

    def _on_disconnect(
        self, _client: mqtt.Client, _data: object, _flags: object, code: Any, _more: object
    ) -> None:
        if code.is_failure:
            self._say("the connection to the broker is lost")
        self._soon(self._bury)

    def _on_message(self, _client: mqtt.Client, _data: object, message: mqtt.MQTTMessage) -> None:
        topic, data = message.topic, bytes(message.payload)
        if topic == self.topic("NCMD"):
            self._soon(self._command, data)
        elif self._host is not None:
            self._soon(self._hear, self._host, topic, data)

    def _say(self, text: str) -> None:
        """Say once why there is no connection, however often it is tried."""
        if not self._is_said:
            self._is_said = True
            log.warning("sparkplug: %s; it is tried again", text)

    def _soon(self, do: Callable[..., None], *words: object) -> None:
        loop = self._loop
        if loop is not None and not loop.is_closed():
            loop.call_soon_threadsafe(do, *words)

    # --- in the loop ------------------------------------------------------------------

    def _link(self) -> None:
        """A connection is ready; its birth is sent when there are values, and a host for them."""
        self._is_linked = True
        self._begin()

    def _begin(self) -> None:
        """The first birth of a connection, once all it waits for is there."""
        is_wanted = self._host is None or self._host.is_online
        if self._is_linked and not self._is_born and self._readings and is_wanted:
            self._bear()

    def _bury(self) -> None:
        self._is_linked = self._is_born = False
        if self._host is not None:
            self._host.forget()

    def _hear(self, host: PrimaryHost, topic: str, data: bytes) -> None:
        """The primary host has a state: with it the node is born, without it the node leaves."""
        host.hear(topic, data)
        if host.is_online:
            self._begin()
        elif self._is_born:
            log.info("sparkplug: the primary host is offline")
            self._bury()
            self._leaving = asyncio.ensure_future(self._leave())

    async def _leave(self) -> None:
        """Say goodbye and connect anew: the next birth needs a will with its number.

        The pause bounds what a host that comes and goes can cause.
        """
        await self._goodbye()
        with suppress(TimeoutError):
            async with asyncio.timeout(RETRY_S[0]):
                await self._ended.wait()
        if not self._ended.is_set():
            self._client = self._made()
            self._connect()

    def _bear(self) -> None:
        """Send all metrics with their names; from then on what changes."""
        self._is_born = True
        now_ms = epoch_ms()
        self._seq, self._changed = 0, set()
        metrics = [
            Metric(self._bd_seq, DataType.INT64, BD_SEQ, timestamp_ms=now_ms),
            Metric(False, DataType.BOOLEAN, REBIRTH, timestamp_ms=now_ms),
        ]
        for place, item in enumerate(self._items):
            shown = _scalar(self._readings[place])
            kind, alias = _type_of(item), FIRST_ALIAS + place
            metrics.append(Metric(shown, kind, metric_name(item), alias, now_ms, str(item.unit)))
        self._send("NBIRTH", metrics, now_ms)

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        """Send what has changed; while the last message is on its path, it waits."""
        self._readings = readings
        self._changed.update(changed)
        if not self._is_born:
            self._begin()
            return
        if not self._changed or (self._sent is not None and not self._sent.is_published()):
            return
        places, self._changed, now_ms = sorted(self._changed), set(), epoch_ms()
        metrics = [
            Metric(
                _scalar(readings[place]), _type_of(self._items[place]),
                alias=FIRST_ALIAS + place, timestamp_ms=now_ms,
            )
            for place in places
        ]  # fmt: skip
        self._seq = (self._seq + 1) % ROUND
        self._send("NDATA", metrics, now_ms)

    def _send(self, kind: str, metrics: Sequence[Metric], now_ms: int) -> None:
        data = encode(Payload(tuple(metrics), now_ms, self._seq))
        self._sent = self._client.publish(self.topic(kind), data, qos=0)

    def _death(self) -> Payload:
        return Payload((Metric(self._bd_seq, DataType.INT64, BD_SEQ),), epoch_ms())

    # --- commands ---------------------------------------------------------------------

    def _command(self, data: bytes) -> None:
        """Carry a command out: a birth again, or values the file lists."""
        if self._host is not None and not self._is_born:
            log.warning("sparkplug: a command is refused: the primary host is offline")
            return
        try:
            metrics = decode(data).metrics
        except PayloadError as error:
            log.warning("sparkplug: a command is damaged: %s", error)
            return
        for metric in metrics:
            if metric.name == REBIRTH:
                if metric.value is True and self._is_born:
                    self._bear()
                continue
            task = asyncio.ensure_future(self._write(metric))
            self._writes.add(task)
            task.add_done_callback(self._writes.discard)

    async def _write(self, metric: Metric) -> None:
        item = self._named(metric)
        if item is None:
            log.warning("sparkplug: there is no metric %r", metric.name or metric.alias)
            return
        try:
            await self._setup.writer.write(item, metric.value, WRITER)
        except UserError as error:
            log.warning("sparkplug: a command is refused: %s", error)

    def _named(self, metric: Metric) -> Item | None:
        """The value a command means, by name or alias."""
        if metric.name:
            return next((each for each in self._items if metric_name(each) == metric.name), None)
        place = -1 if metric.alias is None else metric.alias - FIRST_ALIAS
        return self._items[place] if 0 <= place < len(self._items) else None

    async def close(self) -> None:
        """End: writes are given up, a departure under way is completed."""
        self._ended.set()
        for task in list(self._writes):
            task.cancel()
        if self._leaving is not None:
            await self._leaving
        await self._goodbye()

    async def _goodbye(self) -> None:
        death = encode(self._death())
        await asyncio.to_thread(part, self._client, self.topic("NDEATH"), death)


def metric_name(item: Item) -> str:
    """The name of a metric: `feed`, `X/actual`, `user/gate`."""
    return item.name.replace(".", "/")


def _type_of(item: Item) -> DataType:
    return TYPES.get(item.row.kind, DataType.STRING)


def _scalar(value: Value) -> float | int | bool | str | None:
    """A value as one metric: alarms and tools are a line each."""
    return "\n".join(map(str, value)) if isinstance(value, tuple) else value
