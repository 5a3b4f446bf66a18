"""The status over a real UDP socket."""

import asyncio
import re
import socket
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from unittest.mock import Mock

import pytest
from tests.io.fake_card import FakeCard
from tests.io.served import LOOPBACK, serving

from openacr.client import Card, ConnectionLostError, NoReplyError
from openacr.client.status_feed import StatusFeed
from openacr.errors import UserError
from openacr.io.server import CardServer, Guests
from openacr.io.status_port import StatusPort

ON = bytes.fromhex("00000001 0000000A")
WAIT_S = 60.0


@contextmanager
def udp(port: int) -> Iterator[socket.socket]:
    """A host's socket: it sends to the card and hears whatever comes."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as host:
        host.settimeout(WAIT_S)
        host.connect((LOOPBACK, port))
        yield host


def test_a_host_gets_every_word_of_the_fast_status_as_captured_from_real_cards() -> None:
    with serving("--no-journal", "--status-port", "0") as served:
        port = served.status_port
        with udp(port) as host, Card.open(f"{LOOPBACK}:{served.ascii_port}") as card:
            host.send(ON)
            assert host.recv(1000) == bytes(320)  # FSTAT is not set up
            card.command("DIM P(100)")
            assert not card.command("FSTAT PERIOD 1")
            card.command("FSTAT0 (48,2,0)")  # P12290 and so on
            card.command("FSTAT9 (48,1,0)")  # P12289 and so on
            card.command("FSTAT3 (48,16,1)")  # P12304 and so on: PGAIN, as FP32
            for axis in range(8):
                card.command(f"AXIS{axis} RES {100 * axis + 7}")
                card.command(f"AXIS{axis} PGAIN {0.5 * axis - 1.25}")
            card.command("FSTAT ON")
            gains = [card.read(12304 + 256 * axis) for axis in range(8)]
            expected = b"".join((
                struct.pack(">8i", *(card.read(12290 + 256 * axis) for axis in range(8))),
                bytes(64),
                struct.pack(">8f", *gains),
                bytes(160),
                struct.pack(">8i", *(card.read(12289 + 256 * axis) for axis in range(8))),
            ))  # fmt: skip
            assert card.read(12290 + 256 * 7) == 707
            deadline_s = time.monotonic() + WAIT_S
            while (datagram := host.recv(1000)) != expected:
                assert time.monotonic() < deadline_s, datagram.hex(" ", 4)
            assert len(datagram) == 320
            assert host.getpeername()[1] == port  # where all of them came from
            host.send(bytes(8))
            assert card.command("?1") == ["1"]  # the request has been taken by now
            host.settimeout(0.2)
            with pytest.raises(TimeoutError):
                while True:
                    host.recv(1000)
        assert served.end()[0] == 0


def test_the_sender_alone_gets_the_status() -> None:
    async def body() -> None:
        server = CardServer(FakeCard())
        at = await server.listen_status(LOOPBACK, 0)
        stop = asyncio.Event()
        running = asyncio.create_task(server.run(stop))
        with udp(at.port) as host, udp(at.port) as other:
            host.send(ON)
            other.send(ON[:-1])
            other.send(ON + b"\0")
            assert len(await asyncio.to_thread(host.recv, 1000)) == 320
            assert len(await asyncio.to_thread(host.recv, 1000)) == 320
            other.setblocking(False)
            with pytest.raises(BlockingIOError):
                other.recv(1000)
        stop.set()
        await asyncio.wait_for(running, WAIT_S)

    asyncio.run(body())


def test_who_may_not_connect_gets_no_status() -> None:
    class NoHost(Guests):
        def admits(self, host: str) -> bool:
            return False

    async def body() -> None:
        server = CardServer(FakeCard(), allowed=NoHost())
        at = await server.listen_status(LOOPBACK, 0)
        stop = asyncio.Event()
        running = asyncio.create_task(server.run(stop))
        with udp(at.port) as host:
            host.send(ON)
            await asyncio.sleep(0.1)
            host.setblocking(False)
            with pytest.raises(BlockingIOError):
                host.recv(1000)
        stop.set()
        await asyncio.wait_for(running, WAIT_S)

    asyncio.run(body())


def test_a_host_that_is_gone_disturbs_no_other() -> None:
    async def body() -> None:
        server = CardServer(FakeCard())
        at = await server.listen_status(LOOPBACK, 0)
        stop = asyncio.Event()
        running = asyncio.create_task(server.run(stop))
        with udp(at.port) as gone:
            gone.send(ON)
            await asyncio.to_thread(gone.recv, 1000)
        with udp(at.port) as host:
            host.send(ON)
            for _ in range(5):
                assert len(await asyncio.to_thread(host.recv, 1000)) == 320
        stop.set()
        await asyncio.wait_for(running, WAIT_S)

    asyncio.run(body())


class Here:
    """A server to which a host is connected, or not."""

    def __init__(self, connected: set[str]) -> None:
        self.connected = connected

    def admits(self, host: str) -> bool:
        return True

    def hosts(self) -> set[str]:
        return self.connected


@pytest.mark.parametrize(("age_s", "is_connected", "is_ended"), [
    (60.0, False, False), (60.5, False, True), (60.5, True, False),
])  # fmt: skip
def test_a_listener_without_connection_is_cut_off_after_a_minute_with_one_line_in_the_log(
    caplog: pytest.LogCaptureFixture, age_s: float, is_connected: bool, is_ended: bool
) -> None:
    now_s, board = 0.0, Here({"10.0.0.7"} if is_connected else set())
    port = StatusPort(board, lambda: now_s)
    port.connection_made(Mock())
    port.datagram_received(ON, ("10.0.0.7", 4711))
    now_s = age_s
    for _ in range(2):
        port.send_due(lambda: b"")
    assert [record.message for record in caplog.records] == [
        "10.0.0.7:4711 gets no status any more: it asked 60 s ago and has no TCP connection"
    ] * is_ended


def test_too_many_subscribers_are_refused_with_one_warning(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def body() -> None:
        server = CardServer(FakeCard())
        at = await server.listen_status(LOOPBACK, 0)
        stop = asyncio.Event()
        running = asyncio.create_task(server.run(stop))
        hosts = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(19)]
        for host in hosts:
            host.sendto(ON, (LOOPBACK, at.port))
        async with asyncio.timeout(WAIT_S):
            while not warned():
                await asyncio.sleep(0.005)
        stop.set()
        await asyncio.wait_for(running, WAIT_S)
        for host in hosts:
            host.close()

    def warned() -> list[str]:
        return [record.message for record in caplog.records if record.levelname == "WARNING"]

    asyncio.run(body())
    assert len(warned()) == 1
    assert re.fullmatch(r"127\.0\.0\.1:\d+ gets no status: 16 others do", warned()[0])


def test_a_status_port_in_use_is_a_user_error_unless_it_was_not_requested() -> None:
    async def body() -> None:
        with pytest.raises(UserError, match=rf"port {port} on .* is in use.*--status-port"):
            await CardServer(FakeCard()).listen_status(LOOPBACK, port)

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind((LOOPBACK, 0))
        port = taken.getsockname()[1]
        asyncio.run(body())


def test_the_client_reads_the_status_as_it_comes() -> None:
    with serving("--no-journal", "--status-port", "0") as served:
        with Card.open(f"{LOOPBACK}:{served.ascii_port}") as card:
            for line in ("FSTAT PERIOD 1", "FSTAT1 (48,2,0)", "AXIS3 RES -4711", "FSTAT ON"):
                card.command(line)
            with StatusFeed(LOOPBACK, served.status_port) as feed:
                statuses = (next(iter(feed)) for _ in range(100))
                assert any(status.longs(1) == (0, 0, 0, -4711, 0, 0, 0, 0) for status in statuses)
            feed.close()
        assert served.end()[0] == 0


def test_a_status_feed_says_what_is_wrong() -> None:
    for interval_s in (0.009, 60.1):
        with pytest.raises(UserError, match=rf"interval {interval_s} s is not in 0\.01\.\.60"):
            StatusFeed(LOOPBACK, 5003, interval_s=interval_s)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as silent:
        silent.bind((LOOPBACK, 0))
        port = silent.getsockname()[1]
        with (
            StatusFeed(LOOPBACK, port, timeout_s=0.05) as feed,
            pytest.raises(NoReplyError, match=rf"127\.0\.0\.1:{port}/udp: no reply within 0\.05 s"),
        ):
            feed.read()
        assert [silent.recv(100) for _ in range(2)] == [ON, bytes(8)]
    with pytest.raises(ConnectionLostError), StatusFeed(LOOPBACK, port) as feed:
        feed.read()
