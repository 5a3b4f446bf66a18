"""The edge node to the byte: a connection as MQTT 3.1.1 and Sparkplug B 3.0 lay it out.

The will is the NDEATH, QoS 1, not retained, with the bdSeq of the birth of the same connection and
without seq; the birth has seq 0, QoS 0, and follows the subscription. bdSeq counts connections.
"""

import select
import socket
from collections.abc import Iterator, Sequence

import pytest
from tests.bridge.bench import GivenFeed, bridged
from tests.bridge.mqtt import node_file
from tests.waiting import LIMIT_S, until

from openacr.bridge.items import Readings
from openacr.bridge.sparkplug import node

NOW_MS = 1_700_000_000_000
TIME = bytes.fromhex("80d095ffbc31")  # that number as a varint
CONNACK = bytes.fromhex("20020000")
DEATH, COMMANDS, BIRTH = (
    b"spBv1.0/shop/%s/mill" % kind for kind in (b"NDEATH", b"NCMD", b"NBIRTH")
)


def bd_seq(number: int, time: bytes = b"") -> bytes:
    """The metric bdSeq: name (1), timestamp (3) in births, type Int64 (4), long value (11)."""
    metric = b"\x0a\x05bdSeq" + time + b"\x20\x04\x58" + bytes([number])
    return b"\x12" + bytes([len(metric)]) + metric


def text(data: bytes) -> bytes:
    return len(data).to_bytes(2, "big") + data


def connect(number: int) -> bytes:
    """CONNECT: a clean session, a will with QoS 1 that is not retained, alive for 10 s."""
    will = b"\x08" + TIME + bd_seq(number)
    return text(b"MQTT") + b"\x04\x0e\x00\x0a" + text(b"") + text(DEATH) + text(will)


class Peer:
    """One connection, packet by packet."""

    def __init__(self, listener: socket.socket) -> None:
        self.socket, _ = listener.accept()
        self.socket.settimeout(LIMIT_S)
        self._file = self.socket.makefile("rb")

    def packet(self) -> tuple[int, bytes]:
        """The first byte and what follows the length."""
        head, size, shift = self._file.read(1)[0], 0, 0
        while (byte := self._file.read(1)[0]) & 0x80:
            size |= (byte & 0x7F) << shift
            shift += 7
        return head, self._file.read(size | byte << shift)

    def state(self, topic: bytes, data: bytes) -> None:
        """A retained PUBLISH with QoS 0, as a broker sends it."""
        rest = text(topic) + data
        self.socket.sendall(b"\x31" + bytes([len(rest)]) + rest)

    @property
    def is_silent(self) -> bool:
        return not select.select([self.socket], [], [], 0.0)[0]

    def close(self) -> None:
        self._file.close()
        self.socket.close()


@pytest.fixture
def listener(monkeypatch: pytest.MonkeyPatch) -> Iterator[socket.socket]:
    monkeypatch.setattr(node, "epoch_ms", lambda: NOW_MS)
    with socket.create_server(("127.0.0.1", 0)) as found:
        found.settimeout(LIMIT_S)
        yield found


def test_will_and_birth_of_a_connection_have_its_number_and_the_next_one_the_next(
    listener: socket.socket,
) -> None:
    port = listener.getsockname()[1]
    with bridged(node_file(port), GivenFeed()):
        for number in range(3):
            peer = Peer(listener)
            assert peer.packet() == (0x10, connect(number))
            peer.socket.sendall(CONNACK)
            head, asked = peer.packet()
            assert (head, asked[2:]) == (0x82, text(COMMANDS) + b"\x01")  # QoS 1
            peer.socket.sendall(b"\x90\x03" + asked[:2] + b"\x01")
            head, birth = peer.packet()
            begin = text(BIRTH) + b"\x08" + TIME + bd_seq(number, b"\x18" + TIME)
            assert head == 0x30  # PUBLISH, QoS 0, not retained
            assert birth.startswith(begin)
            assert birth.endswith(b"\x18\x00")  # seq 0
            peer.close()


def test_a_primary_host_brings_birth_and_death_and_the_next_connection_the_next_number(
    listener: socket.socket, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Subscriptions of NCMD and of both states; NDEATH with QoS 1 and DISCONNECT when it leaves."""
    published: list[None] = []
    give = node.SparkplugSystem.publish

    def publish(self: node.SparkplugSystem, readings: Readings, changed: Sequence[int]) -> None:
        give(self, readings, changed)
        published.append(None)

    def let_pass() -> None:
        begin = len(published)
        until(lambda: len(published) >= begin + 2)  # the first one may have begun before

    monkeypatch.setattr(node.SparkplugSystem, "publish", publish)
    port = listener.getsockname()[1]
    with bridged(node_file(port, 'primary_host = "scada"\n'), GivenFeed()):
        for number in range(3):
            peer = Peer(listener)
            assert peer.packet() == (0x10, connect(number))
            peer.socket.sendall(CONNACK)
            head, asked = peer.packet()
            topics = (COMMANDS, b"spBv1.0/STATE/scada", b"STATE/scada")
            assert (head, asked[2:]) == (0x82, b"".join(text(each) + b"\x01" for each in topics))
            peer.socket.sendall(b"\x90\x05" + asked[:2] + b"\x01\x01\x01")
            let_pass()
            assert peer.is_silent
            at_ms = 1000 + number
            peer.state(topics[1], b'{"online":false,"timestamp":%d}' % at_ms)
            peer.state(b"spBv1.0/STATE/other", b'{"online":true,"timestamp":9000}')
            let_pass()
            assert peer.is_silent
            peer.state(topics[1], b'{"online":true,"timestamp":%d}' % at_ms)
            head, birth = peer.packet()
            assert (head, birth[: len(BIRTH) + 2]) == (0x30, text(BIRTH))
            assert bd_seq(number, b"\x18" + TIME) in birth
            if number == 1:  # the connection is lost: the state that was known counts no more
                peer.close()
                continue
            peer.state(topics[1], b'{"online":false,"timestamp":%d}' % (at_ms - 1))
            let_pass()
            assert peer.is_silent
            peer.state(topics[1], b'{"online":false,"timestamp":%d}' % at_ms)
            head, death = peer.packet()
            name, sent = death[: len(DEATH) + 2], death[len(DEATH) + 4 :]
            assert (head, name, sent) == (0x32, text(DEATH), b"\x08" + TIME + bd_seq(number))
            peer.socket.sendall(b"\x40\x02" + death[len(DEATH) + 2 :][:2])
            assert peer.packet() == (0xE0, b"")
            peer.close()
