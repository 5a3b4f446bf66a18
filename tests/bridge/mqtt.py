"""A broker of MQTT in a thread, a subscriber, and Google's protobuf as the judge of payloads."""

import asyncio
import socket
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import paho.mqtt.client as paho
from amqtt.broker import Broker
from amqtt.contexts import Action
from amqtt.plugins.authentication import AnonymousAuthPlugin, BaseAuthPlugin
from amqtt.plugins.base import BaseTopicPlugin
from amqtt.session import Session
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from paho.mqtt.enums import CallbackAPIVersion
from tests.bridge.bench import VALUES
from tests.waiting import LIMIT_S, until

ANONYMOUS = "amqtt.plugins.authentication.AnonymousAuthPlugin"
TEXT, UINT64, UINT32, DOUBLE, FLOAT, BOOL, MESSAGE = 9, 4, 13, 1, 2, 8, 11
FIELDS: dict[str, dict[str, tuple[int, int, str]]] = {
    "PropertyValue": {"type": (1, UINT32, ""), "string_value": (8, TEXT, "")},
    "PropertySet": {"keys": (1, TEXT, "*"), "values": (2, MESSAGE, "*PropertyValue")},
    "Metric": {
        "name": (1, TEXT, ""), "alias": (2, UINT64, ""), "timestamp": (3, UINT64, ""),
        "datatype": (4, UINT32, ""), "is_null": (7, BOOL, ""),
        "properties": (9, MESSAGE, "PropertySet"), "int_value": (10, UINT32, ""),
        "long_value": (11, UINT64, ""), "float_value": (12, FLOAT, ""),
        "double_value": (13, DOUBLE, ""), "boolean_value": (14, BOOL, ""),
        "string_value": (15, TEXT, ""),
    },
    "Payload": {
        "timestamp": (1, UINT64, ""), "metrics": (2, MESSAGE, "*Metric"), "seq": (3, UINT64, ""),
    },
}  # fmt: skip


def _messages() -> dict[str, Any]:
    """The public schema of Sparkplug B, as far as metrics of scalars need it."""
    file = descriptor_pb2.FileDescriptorProto(name="spb.proto", package="spb", syntax="proto2")
    for name, fields in FIELDS.items():
        message = file.message_type.add(name=name)
        for key, (number, kind, other) in fields.items():
            field = message.field.add(name=key, number=number, type=kind)
            field.label = 3 if other.startswith("*") else 1
            if other.strip("*"):
                field.type_name = f".spb.{other.strip('*')}"
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    return {
        name: message_factory.GetMessageClass(pool.FindMessageTypeByName(f"spb.{name}"))
        for name in FIELDS
    }


MESSAGES = _messages()
Payload, Metric = MESSAGES["Payload"], MESSAGES["Metric"]


def value_of(metric: Any) -> Any:
    """The value of a metric as the official library reads it."""
    if metric.is_null:
        return None
    if metric.HasField("long_value"):
        value = metric.long_value
        return value - (1 << 64) if metric.datatype == 4 and value >> 63 else value
    names = ("int_value", "float_value", "double_value", "boolean_value", "string_value")
    return next(getattr(metric, name) for name in names if metric.HasField(name))


def named(payload: Any) -> dict[str, Any]:
    """The values of a payload whose metrics have names: of a birth or a death."""
    return {metric.name: value_of(metric) for metric in payload.metrics}


def node_file(port: int, more: str = "") -> str:
    """The bridge file of an edge node with a broker at a port; `more` keys of its table."""
    table = f'group = "shop"\nport = {port}\n{more}'
    return f'name = "mill"\nrate_hz = 50\n[sparkplug]\n{table}{VALUES}'


class OneUser(BaseAuthPlugin):  # type: ignore[misc]
    """Lets one user in."""

    async def authenticate(self, *, session: Session) -> bool:
        return (session.username, session.password) == ("mill", "hush")


class NoCommands(AnonymousAuthPlugin, BaseTopicPlugin):  # type: ignore[misc]
    """Lets every host in, and none subscribe commands."""

    async def topic_filtering(
        self, *, session: Session | None = None, topic: str | None = None, action: Any = None
    ) -> bool:
        """Whether a session may do this with a topic."""
        return not (action is Action.SUBSCRIBE and "/NCMD/" in (topic or ""))


class NoStates(AnonymousAuthPlugin, BaseTopicPlugin):  # type: ignore[misc]
    """Lets every host in, and none subscribe the states of others."""

    async def topic_filtering(
        self, *, session: Session | None = None, topic: str | None = None, action: Any = None
    ) -> bool:
        """Whether a session may do this with a topic."""
        return not (action is Action.SUBSCRIBE and "STATE/" in (topic or ""))


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])


class RunningBroker(AbstractContextManager["RunningBroker"]):
    """A broker that can end and come again at its port."""

    def __init__(self, *, plugin: str = ANONYMOUS, certificate: tuple[Path, Path] | None = None):
        self.port = free_port()
        listener: dict[str, Any] = {"type": "tcp", "bind": f"127.0.0.1:{self.port}"}
        if certificate is not None:
            listener |= {
                "ssl": True, "certfile": str(certificate[0]), "keyfile": str(certificate[1]),
            }  # fmt: skip
        self._config = {"listeners": {"default": listener}, "plugins": {plugin: {}}}
        self.start()

    def start(self) -> None:
        self._is_up, self._over = threading.Event(), asyncio.Event()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=lambda: self._loop.run_until_complete(self._run()))
        self._thread.start()
        assert self._is_up.wait(LIMIT_S)

    def __exit__(self, *_: object) -> None:
        self.stop()

    async def _run(self) -> None:
        broker = Broker(self._config)
        await broker.start()
        self._is_up.set()
        await self._over.wait()
        await broker.shutdown()
        tasks = [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def stop(self) -> None:
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._over.set)
            self._thread.join(LIMIT_S)
            assert not self._thread.is_alive()
            self._loop.close()


class Subscriber(AbstractContextManager["Subscriber"]):
    """A host application: it sees all messages and sends commands."""

    def __init__(self, port: int, *, change: Callable[[paho.Client], None] = lambda _c: None):
        self.seen: list[tuple[str, Any]] = []
        self._is_ready = threading.Event()
        self.client = paho.Client(CallbackAPIVersion.VERSION2)
        change(self.client)
        self.client.on_message = self._take
        self.client.on_subscribe = lambda *_: self._is_ready.set()
        self.client.on_connect = self._connected
        self.client.connect("127.0.0.1", port, 60)
        self.client.loop_start()
        assert self._is_ready.wait(LIMIT_S)

    def __exit__(self, *_: object) -> None:
        self.close()

    def _connected(self, *_: object) -> None:
        self.client.subscribe("spBv1.0/#", qos=1)

    def _take(self, _client: paho.Client, _data: object, message: paho.MQTTMessage) -> None:
        if "/NCMD/" in message.topic or "/STATE/" in message.topic:  # what hosts have sent
            return
        self.seen.append((message.topic, Payload.FromString(message.payload)))

    def of(self, kind: str) -> list[Any]:
        """The payloads of a kind of message."""
        return [payload for topic, payload in list(self.seen) if topic.split("/")[2] == kind]

    def command(self, *metrics: Any) -> None:
        data = Payload(metrics=metrics).SerializeToString()
        self.client.publish("spBv1.0/shop/NCMD/mill", data, qos=1).wait_for_publish(LIMIT_S)

    def send(self, data: bytes) -> None:
        self.client.publish("spBv1.0/shop/NCMD/mill", data, qos=1).wait_for_publish(LIMIT_S)

    def state(self, data: bytes | str, topic: str = "spBv1.0/STATE/scada") -> None:
        """Leave a state of a host at the broker."""
        self.client.publish(topic, data, qos=1, retain=True).wait_for_publish(LIMIT_S)

    def await_first(self, kind: str, count: int = 1) -> Any:
        """The payload of a kind that comes as the given one."""
        until(lambda: len(self.of(kind)) >= count)
        return self.of(kind)[count - 1]

    def close(self) -> None:
        self.client.disconnect()
        self.client.loop_stop()
