"""The client over sockets and serial lines: our server, and hosts that behave badly."""

import asyncio
import errno
import os
import socket
import sys
import threading
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import cast

import pytest
from tests.client.cards import AXIS
from tests.io.served import Served, serving

from openacr.channels import EchoMode
from openacr.client import (
    AsyncCard,
    Card,
    ConnectionLostError,
    Level,
    Options,
    RefusedError,
    async_links,
    links,
)
from openacr.client.async_links import AsyncProcessLink, AsyncTcpLink, ThreadLink, for_asyncio
from openacr.client.links import ProcessLink, SerialLink, TcpLink, link_to
from openacr.client.values import next_due_s
from openacr.controller import Controller
from openacr.errors import UserError
from openacr.protocol.data import DataRequest

LOOPBACK = "127.0.0.1"
PROGRAM = 'PROGRAM\nPRINT "one"\nDWL 0.3\nPRINT "two"\nENDP\n'


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    """One card for all tests of this module."""
    with serving() as served:
        yield served


@pytest.fixture
def target(served: Served) -> str:
    return f"{LOOPBACK}:{served.ascii_port}"


def runs(scenario: Callable[[AsyncCard], Awaitable[None]], target: str | Controller) -> None:
    async def body() -> None:
        async with await AsyncCard.open(target) as card:
            await scenario(card)

    asyncio.run(body())


@pytest.mark.parametrize("echo", [1, 4])
def test_values_commands_and_errors_over_tcp(target: str, echo: int) -> None:
    with Card.open(target, Options(echo=EchoMode(echo))) as card:
        assert card.command("VER")[0].startswith("ACR9000")
        card.p["axis3.ppu"] = 300
        assert card.read_many(["axis3.ppu", 6916])[0] == 300
        with pytest.raises(RefusedError, match="Unknown command"):
            card.command("foo")
        assert card.ask("1") == 1


def test_an_axis_moves_in_real_time(target: str) -> None:
    with Card.open(target) as card:
        for line in AXIS:
            card.command(line)
        card.pause(0.1)
        assert not card.bit["master0.in motion"]
        card.command("X10")
        assert card.bit["master0.in motion"]
        assert card.wait(lambda: not card.master(0).is_in_motion, timeout_s=5)
        assert card.axis(0).current_position == 10000
        card.go(Level())
        for line in ("DRIVE OFF AXIS0", "DETACH ALL"):
            card.command(line)


def test_asyncio_does_the_same_over_tcp(target: str) -> None:
    async def scenario(card: AsyncCard) -> None:
        assert card.name == target
        assert await card.ask("1+1") == 2
        await card.write("axis2.ppu", 250)
        axis = card.axis(2)
        assert await axis.ppu == 250
        assert not await axis.is_jogging
        assert not await card.master(0).is_in_motion
        await card.write_bit(40, True)
        assert await card.read_bits([40, 41]) == [True, False]
        with pytest.raises(RefusedError):
            await card.command("X1")
        async for sample in card.watch([6916, "axis2.ppu"], every_s=0.01):
            assert sample[1] == 250
            break
        await card.write_bit(40, False)

    runs(scenario, target)


def test_asyncio_stores_and_follows_programs(target: str) -> None:
    async def scenario(card: AsyncCard) -> None:
        await card.command("DIM PROG6(2000)")
        level = Level.program(6)
        await card.download(PROGRAM, to=level)
        assert (await card.upload(level)).count("PRINT") == 2
        heard = [text async for text in card.listen(6, run=True)]
        assert "".join(heard) == "one\ntwo\n"
        await card.run(6)
        await card.halt(6)

    runs(scenario, target)


def test_tasks_share_a_card(target: str) -> None:
    async def scenario(card: AsyncCard) -> None:
        answers = await asyncio.gather(*(card.ask(f"{n}+1") for n in range(20)))
        assert answers == [n + 1 for n in range(20)]

    runs(scenario, target)


def test_a_cancelled_request_does_not_disturb_the_next_one(target: str) -> None:
    async def scenario(card: AsyncCard) -> None:
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(card.command("DWL 0.3 : ?1"), 0.05)
        assert await card.command("?2") == ["2"]

    runs(scenario, target)


def test_threads_share_a_card(target: str) -> None:
    with Card.open(target) as card:
        found: list[float] = []
        work = [
            threading.Thread(target=lambda n=n: found.append(card.ask(f"{n}"))) for n in range(10)
        ]
        for thread in work:
            thread.start()
        for thread in work:
            thread.join()
        assert sorted(found) == list(range(10))


def test_asyncio_and_a_card_in_this_process() -> None:
    async def scenario(card: AsyncCard) -> None:
        assert await card.ask("3") == 3
        begin_s = card.now_s()
        await card.command("DWL 2")
        assert card.now_s() - begin_s == pytest.approx(2, abs=0.05)
        await card.kill_all()
        await card.clear_kills()
        assert await card.wait(lambda: card.read_bit(516), timeout_s=0.1) is False

    runs(scenario, Controller())


@contextmanager
def relay(port: int) -> Iterator[tuple[int, Callable[[], None]]]:
    """A port that leads to the card until the connection is cut."""
    listener = socket.create_server((LOOPBACK, 0))
    sockets: list[socket.socket] = []

    def pump(source: socket.socket, sink: socket.socket) -> None:
        try:
            while data := source.recv(4096):
                sink.sendall(data)
        except OSError:
            pass
        for end in (source, sink):
            end.close()

    def serve() -> None:
        while True:
            try:
                near, _ = listener.accept()
            except OSError:
                return
            far = socket.create_connection((LOOPBACK, port))
            sockets.extend((near, far))
            for pair in ((near, far), (far, near)):
                threading.Thread(target=pump, args=pair, daemon=True).start()

    def cut() -> None:
        while sockets:
            end = sockets.pop()
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    threading.Thread(target=serve, daemon=True).start()
    try:
        yield listener.getsockname()[1], cut
    finally:
        listener.shutdown(socket.SHUT_RDWR)
        listener.close()
        cut()


def test_a_cut_connection_comes_back_at_the_same_level(served: Served) -> None:
    with relay(served.ascii_port) as (port, cut), Card.open(f"{LOOPBACK}:{port}") as card:
        card.go(Level.program(4))
        cut()
        assert card.ask("5") == 5
        assert card.level == Level.program(4)
        cut()
        with pytest.raises(ConnectionLostError):
            card.command("SET 50")
        card.write_bit(50, True)
        assert card.bit[50]


EIGHTY = [12288 + 256 * axis + row for axis in range(8) for row in range(10)]


def test_a_subscription_survives_a_cut(served: Served) -> None:
    with relay(served.ascii_port) as (port, cut), Card.open(f"{LOOPBACK}:{port}") as card:
        for number, values in enumerate(card.watch(EIGHTY, every_s=0.01)):
            assert len(values) == 80
            if number == 3:
                cut()
            if number == 6:
                break


def test_a_subscription_keeps_its_rate_whatever_the_host_does_between() -> None:
    with Card.open(Controller()) as card:
        times_s = []
        for _ in card.watch(EIGHTY, every_s=0.02):
            times_s.append(card.now_s())
            card.pause(0.011)
            if len(times_s) == 12:
                break
    gaps_s = [b - a for a, b in pairwise(times_s)]
    assert gaps_s == pytest.approx([0.02] * 11, abs=0.003)
    assert times_s[-1] - times_s[0] == pytest.approx(0.22, abs=0.003)


@pytest.mark.parametrize(
    ("now_s", "due_s"), [(10.0, 10.5), (10.4, 10.5), (10.5, 11.0), (13.7, 14.0), (9.0, 10.5)]
)
def test_what_comes_late_does_not_shift_what_follows(now_s: float, due_s: float) -> None:
    assert next_due_s(10.0, 0.5, now_s) == due_s
    assert next_due_s(10.0, 0.0, now_s) == 10.0


def test_asyncio_reconnects_as_well(served: Served) -> None:
    async def body(port: int, cut: Callable[[], None]) -> None:
        async with await AsyncCard.open(f"{LOOPBACK}:{port}") as card:
            await card.go(Level.program(2))
            cut()
            assert await card.ask("6") == 6
            assert card.level == Level.program(2)

    with relay(served.ascii_port) as (port, cut):
        asyncio.run(body(port, cut))


def test_no_card_there_is_reported_at_once() -> None:
    with socket.create_server((LOOPBACK, 0)) as taken:
        port = taken.getsockname()[1]
    said = f"^cannot connect to {LOOPBACK}:{port}: .+ \\(10061: no card listens at"
    with pytest.raises(ConnectionLostError, match=said):
        Card.open(f"{LOOPBACK}:{port}")
    with pytest.raises(ConnectionLostError, match=said):
        asyncio.run(AsyncCard.open(f"{LOOPBACK}:{port}"))
    with pytest.raises(ConnectionLostError, match="cannot open serial port"):
        Card.open("/dev/no-such-port")


def test_reading_that_is_cancelled_as_bytes_arrive_ends() -> None:
    async def run() -> None:
        with socket.create_server((LOOPBACK, 0)) as card:
            link = AsyncTcpLink(TcpLink(LOOPBACK, card.getsockname()[1]))
            await link.open()
            reader, _ = link._connected()

            async def read_on() -> None:
                while True:
                    await link.read(60.0)

            reading = asyncio.ensure_future(read_on())
            await asyncio.sleep(0)
            reader.feed_data(b"SYS>")
            await asyncio.sleep(0)  # the bytes are being handed over
            reading.cancel()
            await asyncio.wait([reading], timeout=60.0)
            assert reading.cancelled()
            await link.close()

    asyncio.run(run())


@pytest.mark.parametrize("is_async", [False, True])
def test_a_card_that_reads_no_more_is_given_up(
    monkeypatch: pytest.MonkeyPatch, is_async: bool
) -> None:
    monkeypatch.setattr(links, "CONNECT_S", 0.2)
    monkeypatch.setattr(async_links, "CONNECT_S", 0.2)
    flood = b"x" * (1 << 24)

    async def fill(link: AsyncTcpLink) -> None:
        await link.open()
        with pytest.raises(ConnectionLostError, match=f"{LOOPBACK}:{port} accepts no more data"):
            await link.write(flood)
        await asyncio.wait_for(link.close(), 60.0)

    with socket.create_server((LOOPBACK, 0)) as deaf:
        port = deaf.getsockname()[1]
        link = TcpLink(LOOPBACK, port)
        if is_async:
            asyncio.run(fill(AsyncTcpLink(link)))
        else:
            link.open()
            with pytest.raises(ConnectionLostError, match=f"{LOOPBACK}:{port}: timed out"):
                link.write(flood)
            link.close()


@pytest.mark.skipif(sys.platform == "win32", reason="terminals of POSIX")
def test_a_serial_line_carries_text_and_packets() -> None:
    import pty
    import tty

    near, far = pty.openpty()
    tty.setraw(near)
    tty.setraw(far)
    # One end is the card's, the other end is ours: two lines joined by a thread.
    near_2, far_2 = pty.openpty()
    tty.setraw(near_2)
    tty.setraw(far_2)

    def pump(source: int, sink: int) -> None:
        try:
            while data := os.read(source, 1000):
                os.write(sink, data)
        except OSError:
            pass

    for pair in ((near, near_2), (near_2, near)):
        threading.Thread(target=pump, args=pair, daemon=True).start()
    with serving("--serial", os.ttyname(far)) as served:
        with Card.open(os.ttyname(far_2)) as card:
            assert card.command("STREAM") == ["COM1"]
            assert card.command("MODE") == ["1"]
            card.p[4097] = 0x12130411
            assert card.read_many([4097, "axis0.ppu"]) == [0x12130411, 1]
            card.command("MODE 0")  # now 0x11 and 0x13 of a packet would be taken for XON, XOFF
        with Card.open(os.ttyname(far_2)) as card:
            assert card.read_many([4097, "axis0.ppu"]) == [0x12130411, 1]
            card.p[4097] = 0
            card.command("MODE 1")

        async def scenario(card: AsyncCard) -> None:
            assert await card.read("axis0.ppu") == 1

        runs(scenario, os.ttyname(far_2))
        assert served.end()[0] == 0
    for end in (near, far, near_2, far_2):
        os.close(end)


def test_targets_name_their_links() -> None:
    tcp = link_to("[::1]:77")
    assert isinstance(tcp, TcpLink)
    assert tcp.address == ("::1", 77)
    assert isinstance(link_to("card"), TcpLink)
    assert link_to("card").name == "card:5002"
    assert isinstance(link_to("COM3"), SerialLink)
    assert isinstance(link_to(Controller()), ProcessLink)
    for target in ("a:b:c", "", "host:port"):
        with pytest.raises(UserError, match="neither HOST"):
            link_to(target)
    with pytest.raises(UserError, match="port 70000 is not in"):
        link_to("card:70000")


def test_every_link_has_its_form_for_asyncio() -> None:
    assert isinstance(for_asyncio(TcpLink("a")), AsyncTcpLink)
    assert isinstance(for_asyncio(SerialLink("/dev/x")), ThreadLink)
    assert isinstance(for_asyncio(ProcessLink(Controller())), AsyncProcessLink)


def test_all_that_a_card_in_this_process_has_answered_is_read_at_once() -> None:
    link = ProcessLink(Controller())
    link.open()
    requests = [DataRequest(0x10, index, 1).encode() for index in (0, 1)]
    link.write(b"".join(requests))
    assert [link.read(1.0), link.read(0.0)] == [b"".join(each + bytes(4) for each in requests), b""]


def test_an_error_of_a_socket_is_reported_in_words() -> None:
    class Broken:
        def settimeout(self, seconds: float | None) -> None:
            pass

        def recv(self, size: int) -> bytes:
            raise ConnectionResetError(errno.ECONNRESET, os.strerror(errno.ECONNRESET))

        sendall = recv

    link = TcpLink("10.0.0.7")
    link._socket = cast(socket.socket, Broken())
    expected = f"10.0.0.7:5002: {os.strerror(errno.ECONNRESET)}"
    with pytest.raises(ConnectionLostError) as lost:
        link.read(1.0)
    assert str(lost.value) == expected
    with pytest.raises(ConnectionLostError) as lost:
        link.write(b"x")
    assert str(lost.value) == expected
