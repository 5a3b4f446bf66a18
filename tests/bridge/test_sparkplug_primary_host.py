"""The primary host of an edge node: STATE messages of Sparkplug 3.0 and 2.2, through a broker."""

import logging
import threading
import time
from typing import Any

import pytest
from tests.bridge.bench import GivenFeed, bridged
from tests.bridge.mqtt import Metric, RunningBroker, Subscriber, named, node_file
from tests.waiting import until

from openacr.bridge.load import parse_bridge
from openacr.bridge.sparkplug import link, node
from openacr.bridge.sparkplug.primary_host import PrimaryHost
from openacr.errors import SourceError

NEW, OLD = "spBv1.0/STATE/scada", "STATE/scada"


def state(online: str, at_ms: int) -> str:
    return f'{{"online": {online}, "timestamp": {at_ms}}}'


def file(broker: RunningBroker) -> str:
    return node_file(broker.port, 'primary_host = "scada"\n')


def numbers_of(host: Subscriber, kind: str) -> list[int]:
    """The bdSeq of all births or deaths that were seen."""
    return [named(payload)["bdSeq"] for payload in host.of(kind)]


def test_a_node_lives_while_its_host_does_and_refuses_commands_without_it(
    broker: RunningBroker, host: Subscriber, caplog: pytest.LogCaptureFixture
) -> None:
    refused = "sparkplug: a command is refused: the primary host is offline"
    feed = GivenFeed()
    with bridged(file(broker), feed):
        host.state(state("false", 5000))

        def is_refused() -> bool:
            host.command(Metric(name="user/pulses", datatype=10, double_value=1.0))
            return refused in caplog.messages

        until(is_refused)
        assert (host.seen, feed.written) == ([], [])
        host.state(state("true", 6000))
        until(lambda: numbers_of(host, "NBIRTH") == [0])
        host.state(state("false", 6000))
        until(lambda: numbers_of(host, "NDEATH") == [0])
        host.state(state("true", 7000))
        until(lambda: numbers_of(host, "NBIRTH") == [0, 1])
        host.command(Metric(name="user/pulses", datatype=10, double_value=2.0))
        until(lambda: feed.written == [(12290, 2.0, False)])
    until(lambda: numbers_of(host, "NDEATH") == [0, 1])
    assert "sparkplug: the connection to the broker is lost; it is tried again" not in caplog.text


def test_a_host_of_2_2_is_understood(broker: RunningBroker, host: Subscriber) -> None:
    host.state("ONLINE", OLD)
    with bridged(file(broker), GivenFeed()):
        until(lambda: numbers_of(host, "NBIRTH") == [0])
        host.state("OFFLINE", OLD)
        until(lambda: numbers_of(host, "NDEATH") == [0])
        host.state("ONLINE", OLD)
        until(lambda: numbers_of(host, "NBIRTH") == [0, 1])


def test_a_host_that_flaps_causes_no_flood(
    broker: RunningBroker, host: Subscriber, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a death the node is away for a while."""
    monkeypatch.setattr(node, "RETRY_S", (1, 1))  # the broker fails where one comes and goes faster
    begin_s = time.monotonic()
    with bridged(file(broker), GivenFeed()):
        for at_ms in range(100):
            host.state(state("true", at_ms))
            until(lambda: at_ms or host.of("NBIRTH"))  # noqa: B023 - at once
            host.state(state("false", at_ms))
        host.state(state("true", 100))
        until(lambda: len(host.of("NBIRTH")) > 1)
    kinds = [topic.split("/")[2] for topic, _ in host.seen if "NDATA" not in topic]
    assert kinds[:2] == ["NBIRTH", "NDEATH"]
    births = numbers_of(host, "NBIRTH")
    assert births == list(range(len(births)))
    assert len(births) - 1 <= (time.monotonic() - begin_s) / node.RETRY_S[0]


def test_the_bridge_ends_in_the_pause_after_a_death(
    broker: RunningBroker,
    host: Subscriber,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The pause is cut short, and no other connection is begun."""
    connected: list[None] = []
    connect = node.SparkplugSystem._connect

    def noted(self: node.SparkplugSystem) -> None:
        connected.append(None)
        connect(self)

    monkeypatch.setattr(node.SparkplugSystem, "_connect", noted)
    monkeypatch.setattr(node, "RETRY_S", (3600, 3600))
    host.state(state("true", 0))
    with bridged(file(broker), GivenFeed()):
        host.await_first("NBIRTH")
        host.state(state("false", 0))
        host.await_first("NDEATH")
    assert numbers_of(host, "NDEATH") == [0]
    assert len(connected) == 1
    assert [each for each in caplog.messages if "has not ended" in each] == []


def test_a_departure_under_way_is_completed_before_the_end(
    broker: RunningBroker, host: Subscriber, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A second goodbye that began beside the first one would send a second death."""
    begun: list[bool] = []  # whether another goodbye was under way
    busy, second = threading.Lock(), threading.Event()
    part = link.part

    def slow(*words: Any) -> None:
        begun.append(not busy.acquire(blocking=False))
        if len(begun) == 1:
            second.wait(0.5)
        else:
            second.set()
        part(*words)
        if not begun[-1]:
            busy.release()

    monkeypatch.setattr(node, "part", slow)
    host.state(state("true", 0))
    with bridged(file(broker), GivenFeed()):
        host.await_first("NBIRTH")
        host.state(state("false", 0))
        until(lambda: begun)
    assert begun == [False, False]
    host.await_first("NDEATH")  # the broker passes it on after the bridge has ended
    assert numbers_of(host, "NDEATH") == [0]


def test_a_broker_that_lets_no_states_through_is_reported(caplog: pytest.LogCaptureFixture) -> None:
    refused = "sparkplug: the broker refuses the subscription of"
    with (
        RunningBroker(plugin="tests.bridge.mqtt.NoStates") as running,
        bridged(file(running), GivenFeed()),
    ):
        until(lambda: len([each for each in caplog.messages if refused in each]) >= 2)
    said = [each.rpartition(":")[0] for each in caplog.messages if refused in each]
    assert said == [f"{refused} states", f"{refused} states of 2.2"]


# --- what states say ------------------------------------------------------------------


def heard(*states: tuple[str, bytes]) -> list[bool]:
    """Whether the host is online after each of the messages."""
    host, found = PrimaryHost("scada"), []
    for topic, data in states:
        host.hear(topic, data)
        found.append(host.is_online)
    return found


def test_states_count_in_the_order_of_their_timestamps() -> None:
    given = [("true", 20), ("false", 19), ("false", 20), ("true", 19), ("true", 20), ("false", 21)]
    messages = [(NEW, state(*each).encode()) for each in given]
    assert heard(*messages) == [True, True, False, False, True, False]


def test_the_end_of_a_connection_forgets_the_state_and_keeps_its_time() -> None:
    host = PrimaryHost("scada")
    host.hear(NEW, state("true", 20).encode())
    host.forget()
    assert not host.is_online
    host.hear(NEW, state("true", 19).encode())
    assert not host.is_online
    host.hear(NEW, state("true", 20).encode())
    assert host.is_online


def test_a_word_of_2_2_counts_until_there_is_a_state_of_3_0() -> None:
    off = state("false", 0).encode()
    assert heard((OLD, b"ONLINE"), (NEW, off), (OLD, b"ONLINE")) == [True, False, False]


def test_messages_of_other_topics_change_nothing(caplog: pytest.LogCaptureFixture) -> None:
    on = state("true", 9000).encode()
    names = ("STATE/other", "STATE/scada/x", "spBv1.0/STATE/other", "spBv1.0/STATE/SCADA", "x")
    assert heard(*[(name, data) for name in names for data in (on, b"ONLINE")]) == [False] * 10
    assert heard(("STATE/other", b"ONLINE"), (NEW, state("true", 0).encode())) == [False, True]
    assert caplog.messages == []


DAMAGED = [
    b"", b"ONLINE", b"{", b"[]", b"null", b'{"online": true}', b'{"timestamp": 30}', b"\xff{}",
    b'{"online": 1, "timestamp": 30}', b'{"online": "true", "timestamp": 30}',
    b'{"online": true, "timestamp": -1}', b'{"online": true, "timestamp": "30"}',
    b'{"online": true, "timestamp": true}', b'{"online": "\xff", "timestamp": 30}',
    b'{"online": true, "timestamp": 1e400}', b'{"a":' * 100_000,
]  # fmt: skip


@pytest.mark.parametrize("data", DAMAGED, ids=range(len(DAMAGED)))
def test_a_damaged_state_changes_nothing_and_is_reported_once(
    data: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    messages = [(NEW, data)] * 3 + [(NEW, state("true", 20).encode())] + [(NEW, data)] * 3
    assert heard(*messages) == [False] * 3 + [True] * 4
    assert len(caplog.messages) == 2
    assert all("a state of the primary host is damaged" in each for each in caplog.messages)


@pytest.mark.parametrize("data", [b"", b"online", b"ONLINE ", b"\xff", b'{"online": true}'])
def test_other_words_of_2_2_change_nothing(data: bytes, caplog: pytest.LogCaptureFixture) -> None:
    assert heard((OLD, data), (OLD, b"ONLINE"), (OLD, data)) == [False, True, True]
    said = "sparkplug: a state of the primary host is neither ONLINE nor OFFLINE"
    assert caplog.messages == [said, said]


def test_further_keys_of_a_state_are_skipped() -> None:
    assert heard((NEW, b'{"timestamp": 0, "more": [1], "online": true}')) == [True]


def test_an_older_state_is_reported_with_both_times(caplog: pytest.LogCaptureFixture) -> None:
    heard((NEW, state("true", 20).encode()), (NEW, state("false", 19).encode()))
    said = "sparkplug: a state of the primary host is older than the last one: 19, 20"
    assert caplog.messages == [said]


@pytest.mark.parametrize("name", ["", "a/b", "+", "#", "x" * 61])
def test_a_name_that_is_no_level_of_a_topic_is_refused(name: str) -> None:
    with pytest.raises(SourceError, match=r"sparkplug\.primary_host"):
        parse_bridge(f'[sparkplug]\nprimary_host = "{name}"\n')
