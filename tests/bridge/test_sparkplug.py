"""The edge node of Sparkplug B, seen by paho through a broker, read by Google's protobuf."""

import threading
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.bridge.bench import GivenFeed, bridged, show_line
from tests.bridge.mqtt import Metric, Payload, RunningBroker, Subscriber, named, node_file, value_of
from tests.waiting import LIMIT_S, until

from openacr.bridge.items import Readings, items_of
from openacr.bridge.load import parse_bridge
from openacr.bridge.sparkplug import payload as spb
from openacr.bridge.sparkplug.node import SparkplugSystem
from openacr.bridge.sparkplug.payload import DataType, PayloadError, decode, encode
from openacr.errors import SourceError


def test_a_birth_has_every_value_and_data_have_what_changes(
    broker: RunningBroker, host: Subscriber
) -> None:
    feed = GivenFeed()
    with bridged(node_file(broker.port), feed):
        birth = host.await_first("NBIRTH")
        assert birth.seq == 0
        found = named(birth)
        assert (found.pop("bdSeq"), found.pop("Node Control/Rebirth")) == (0, False)
        names = [i.name.replace(".", "/") for i in items_of(feed.axes)]
        assert list(found) == [*names, "user/pulses", "user/gate"]
        expected = {
            "execution": "ACTIVE", "line": 12, "tool": 3, "feed": 2.0, "time_left": None,
            "spindle_on": True,
            "tools": "T3 diameter 6 mm, length 50.25 mm, flat\nT12 length -7.5 mm, ball",
            "alarms": "34 X: drive is off", "Y/actual": -2.0,
            "user/pulses": 400.0, "user/gate": True,
        }  # fmt: skip
        assert {name: found[name] for name in expected} == expected
        kinds = {metric.name: metric.datatype for metric in birth.metrics}
        assert [kinds[n] for n in ("feed", "line", "flood", "program")] == [10, 4, 11, 12]
        units = {m.name: [v.string_value for v in m.properties.values] for m in birth.metrics}
        assert (units["feed"], units["line"]) == (["MILLIMETER/SECOND"], [])
        assert all(abs(m.timestamp - birth.timestamp) == 0 for m in birth.metrics)
        aliases = {m.name: m.alias for m in birth.metrics}
        assert feed.moment.run is not None
        run = replace(feed.moment.run, line=-7, feed_upm=60.0)
        feed.moment = replace(feed.moment, run=run)
        data = host.await_first("NDATA")
        assert data.seq == 1
        changed = {m.alias: value_of(m) for m in data.metrics}
        assert changed == {aliases["line"]: -7, aliases["feed"]: 1.0}
        assert {m.name for m in data.metrics} == {""}
        feed.lose()
        lost = host.await_first("NDATA", 2)
        values = {m.alias: value_of(m) for m in lost.metrics}
        assert (values[aliases["available"]], values[aliases["line"]]) == (False, None)
        assert lost.seq == 2
    assert value_of(host.await_first("NDEATH").metrics[0]) == 0


def test_a_host_asks_for_another_birth_and_writes_what_the_file_lists(
    broker: RunningBroker, host: Subscriber
) -> None:
    feed = GivenFeed()
    with bridged(node_file(broker.port), feed):
        birth = host.await_first("NBIRTH")
        aliases = {m.name: m.alias for m in birth.metrics}
        host.command(Metric(name="Node Control/Rebirth", datatype=11, boolean_value=False))
        host.command(Metric(name="user/pulses", datatype=10, double_value=1.0))
        until(lambda: feed.written == [(12290, 1.0, False)])
        show_line(feed, 13)
        assert host.await_first("NDATA").seq == 1
        host.command(Metric(name="Node Control/Rebirth", datatype=11, boolean_value=True))
        again = host.await_first("NBIRTH", 2)
        found = named(again)
        assert (again.seq, found["bdSeq"], found["line"]) == (0, 0, 13)
        host.send(b"\xff\xff\xff")
        host.command(Metric(name="user/pulses", datatype=10, double_value=1000.5))
        host.command(Metric(name="line", datatype=4, long_value=3))
        host.command(Metric(name="nothing", datatype=4, long_value=3))
        host.command(Metric(alias=999, datatype=4, long_value=3))
        host.command(Metric(name="user/pulses", datatype=3, int_value=(1 << 32) - 5))
        host.command(Metric(alias=aliases["user/gate"], datatype=11, boolean_value=True))
        until(lambda: len(feed.written) >= 3)
        assert feed.written[1:] == [(12290, -5.0, False), (2, 1.0, True)]


def test_a_connection_has_one_birth_after_its_subscription_however_late_the_broker_answers(
    broker: RunningBroker, host: Subscriber, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Values are published between the answer of the broker and the client taking it."""
    taken = SparkplugSystem._on_connect
    published = threading.Semaphore(0)
    give = SparkplugSystem.publish

    def publish(self: SparkplugSystem, readings: Readings, changed: Sequence[int]) -> None:
        give(self, readings, changed)
        published.release()

    def late(self: SparkplugSystem, *words: Any) -> None:
        while published.acquire(blocking=False):
            pass
        for _ in range(2):  # the first one may have begun before
            assert published.acquire(timeout=LIMIT_S)
        early.append(self._is_born)
        taken(self, *words)

    early: list[bool] = []
    monkeypatch.setattr(SparkplugSystem, "publish", publish)
    monkeypatch.setattr(SparkplugSystem, "_on_connect", late)
    feed = GivenFeed()
    with bridged(node_file(broker.port), feed):
        host.await_first("NBIRTH")
        show_line(feed, 13)
        assert host.await_first("NDATA").seq == 1
        assert [topic.split("/")[2] for topic, _ in host.seen[:2]] == ["NBIRTH", "NDATA"]
    assert early == [False]


def test_a_broker_that_lets_no_commands_through_is_said_and_gets_the_values(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with (
        RunningBroker(plugin="tests.bridge.mqtt.NoCommands") as broker,
        Subscriber(broker.port) as host,
        bridged(node_file(broker.port), GivenFeed()),
    ):
        assert host.await_first("NBIRTH").seq == 0
    said = "sparkplug: the broker refuses the subscription of commands: Unspecified error"
    assert said in caplog.messages


def test_a_broker_that_goes_and_comes_back_gets_a_new_birth_with_the_next_number(
    broker: RunningBroker,
) -> None:
    feed = GivenFeed()
    first = Subscriber(broker.port)
    with bridged(node_file(broker.port), feed):
        first.await_first("NBIRTH")
        first.close()
        broker.stop()
        show_line(feed, 55)
        broker.start()
        second = Subscriber(broker.port)

        def births() -> list[dict[str, Any]]:
            """The births with the new line; another one is asked for until there is one."""
            found = [birth for birth in map(named, second.of("NBIRTH")) if birth["line"] == 55]
            if not found:
                second.command(Metric(name="Node Control/Rebirth", datatype=11, boolean_value=True))
            return found

        until(births)
        assert births()[0]["bdSeq"] >= 1
        second.close()


def test_a_broker_that_is_away_at_the_start_is_no_failure() -> None:
    with bridged(node_file(1), GivenFeed()) as bridge:
        assert bridge.places == ["sparkplug mqtt://127.0.0.1:1"]


def test_a_broker_with_a_password_gets_it(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("hush\n")
    (tmp_path / "wrong").write_text("loud\n")
    more = 'user = "mill"\npassword_file = "wrong"\n'
    with (
        RunningBroker(plugin="tests.bridge.mqtt.OneUser") as broker,
        Subscriber(broker.port, change=lambda c: c.username_pw_set("mill", "hush")) as host,
    ):
        with bridged(node_file(broker.port, more), GivenFeed(), tmp_path):
            pass
        assert host.of("NBIRTH") == []
        right = node_file(broker.port, more.replace("wrong", "secret"))
        with bridged(right, GivenFeed(), tmp_path):
            host.await_first("NBIRTH")


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ('password_file = "s"\n', "password_file needs a user"),
        (
            'address = "192.0.2.1"\nuser = "u"\npassword_file = "s"\n',
            "the password would reach 192.0.2.1 in clear text",
        ),
        ('authority = "a.pem"\n', "certificates need tls = true"),
        ('tls = true\ncertificate = "a"\n', "certificate and private_key are given together"),
        ('group = "a/b"\n', "sparkplug.group"),
    ],
)
def test_what_does_not_fit_together_is_refused(keys: str, said: str) -> None:
    with pytest.raises(SourceError, match=said):
        parse_bridge("[sparkplug]\n" + keys)
    parse_bridge(
        '[sparkplug]\ntls = true\naddress = "192.0.2.1"\nuser = "u"\npassword_file = "s"\n'
    )


# --- payloads -------------------------------------------------------------------------


@pytest.mark.parametrize(
    "value",
    [0, 1, -1, 127, 128, 1 << 62, -(1 << 63), 0.0, -1.5, 1e300, True, False, "", "é\n", None],
)
def test_a_payload_is_what_the_official_library_reads(
    value: int | float | bool | str | None,
) -> None:
    kind = {int: 4, float: 10, bool: 11, str: 12}.get(type(value), 4)
    metric = spb.Metric(value, DataType(kind), "X/actual", 300, 1_700_000_000_123, "mm")
    data = encode(spb.Payload((metric,), 5, 255))
    found = Payload.FromString(data)
    assert (found.timestamp, found.seq, len(found.metrics)) == (5, 255, 1)
    (read,) = found.metrics
    assert (read.name, read.alias, read.timestamp) == ("X/actual", 300, 1_700_000_000_123)
    assert (read.datatype, value_of(read)) == (kind, value)
    assert list(read.properties.keys) == ["engUnit"]
    assert read.properties.values[0].string_value == "mm"
    assert (
        found.SerializeToString()
        == Payload.FromString(found.SerializeToString()).SerializeToString()
    )
    back = decode(data)
    assert (back.timestamp_ms, back.seq, back.metrics[0].value) == (5, 255, value)


@pytest.mark.parametrize(
    ("metric", "value"),
    [
        (Metric(name="a", datatype=1, int_value=255), -1),
        (Metric(name="a", datatype=2, int_value=40000), -25536),
        (Metric(name="a", datatype=3, int_value=1 << 31), -(1 << 31)),
        (Metric(name="a", datatype=7, int_value=1 << 31), 1 << 31),
        (Metric(name="a", datatype=4, long_value=(1 << 64) - 2), -2),
        (Metric(name="a", datatype=8, long_value=(1 << 64) - 2), (1 << 64) - 2),
        (Metric(name="a", datatype=9, float_value=0.5), 0.5),
        (Metric(name="a", is_null=True), None),
        (Metric(name="a"), None),
    ],
)
def test_commands_are_read_as_the_official_library_writes_them(
    metric: object, value: object
) -> None:
    (found,) = decode(Payload(metrics=[metric], seq=3).SerializeToString()).metrics
    assert (found.name, found.value) == ("a", value)
    assert type(found.value) is type(value)


@pytest.mark.parametrize(
    "data",
    [
        b"\x08", b"\x12\x05a", b"\x13", b"\x08" + b"\xff" * 10 + b"\x01", b"\x12\x02\x0a\xff",
        b"\x12\x03\x0a\x01\xff", b"\x12\x02\x08\x01", b"\x12\x02\x78\x01",
        b"\x00" * ((1 << 20) + 1),
        b"\x12\x03\x6a\x01\x00",
    ],
)  # fmt: skip
def test_bytes_that_are_no_payload_are_refused(data: bytes) -> None:
    with pytest.raises(PayloadError):
        decode(data)


def test_what_the_schema_has_beside_metrics_is_skipped() -> None:
    data = b"\x22\x02id" + b"\x2a\x01\x00" + b"\x31" + b"\0" * 8 + b"\x3d" + b"\0" * 4
    assert decode(data + encode(spb.Payload((), 1, 2))) == spb.Payload((), 1, 2)
