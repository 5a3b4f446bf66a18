"""Many hosts on real sockets, one card."""

import asyncio
import socket
from collections import Counter
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress

import pytest
from tests.io.fake_card import FakeCard
from tests.io.served import LOOPBACK

from openacr.channels import StreamKind
from openacr.errors import UserError
from openacr.io import peers
from openacr.io.bounded_log import LINES
from openacr.io.peers import SEND_LIMIT_BYTES, TcpPeer
from openacr.io.server import Address, CardServer, Guests
from openacr.protocol import terminal

GET = bytes.fromhex("00 30 02 01")
WAIT_S = 60.0


class Host:
    """One connection of a test."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.reader, self.writer = reader, writer

    async def until(self, end: bytes) -> bytes:
        return await asyncio.wait_for(self.reader.readuntil(end), WAIT_S)

    async def ask(self, data: bytes, end: bytes = b"SYS>") -> bytes:
        self.writer.write(data)
        return await self.until(end)

    async def close(self) -> None:
        self.writer.close()
        await self.writer.wait_closed()


class Bench:
    """A running server with its card."""

    def __init__(self, card: FakeCard, server: CardServer, ascii_at: Address, binary_at: Address):
        self.card, self.server = card, server
        self.ascii_at, self.binary_at = ascii_at, binary_at
        self.hosts: list[Host] = []

    async def connect(self, binary: bool = False) -> Host:
        at = self.binary_at if binary else self.ascii_at
        host = Host(*await asyncio.open_connection(at.host, at.port))
        self.hosts.append(host)
        return host


@asynccontextmanager
async def serving(
    streams: int = 16, speed: float = 1.0, allowed: Guests | None = None
) -> AsyncIterator[Bench]:
    card = FakeCard(streams)
    server = CardServer(card, speed=speed, allowed=allowed)
    ascii_at = await server.listen(StreamKind.TERMINAL, LOOPBACK, 0)
    binary_at = await server.listen(StreamKind.PACKETS, LOOPBACK, 0)
    stop = asyncio.Event()
    running = asyncio.create_task(server.run(stop))
    bench = Bench(card, server, ascii_at, binary_at)
    try:
        yield bench
    finally:
        stop.set()
        await asyncio.wait_for(running, WAIT_S)
        for host in bench.hosts:
            host.writer.close()


def serve(test: Callable[[Bench], Awaitable[None]], streams: int = 16, speed: float = 1.0) -> None:
    async def body() -> None:
        async with serving(streams, speed) as bench:
            await test(bench)

    asyncio.run(body())


def test_a_line_is_echoed_and_answered_without_a_greeting() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        assert await host.ask(b"LEN 12\r") == b"LEN 12\r\n6\r\nSYS>"

    serve(body)


def test_value_and_prompt_arrive_in_one_piece() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        await host.ask(b"LEN", b"LEN")
        await host.ask(b"\r", b"\r\n")
        assert await asyncio.wait_for(host.reader.read(100), WAIT_S) == b"3\r\nSYS>"

    serve(body)


def test_text_and_packets_alternate_on_one_connection() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        await host.ask(b"LEN ", b"LEN ")
        host.writer.write(GET)
        assert (await asyncio.wait_for(host.reader.readexactly(8), WAIT_S))[:4] == GET
        assert await host.ask(b"12\r") == b"12\r\n6\r\nSYS>"

    serve(body)


def test_the_binary_port_answers_packets_only() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect(binary=True)
        host.writer.write(b"LEN 12\r\x18" + GET)
        assert (await asyncio.wait_for(host.reader.readexactly(8), WAIT_S))[:4] == GET
        assert bench.card.controls == []

    serve(body)


def test_connections_do_not_see_each_other() -> None:
    async def body(bench: Bench) -> None:
        one, other = await bench.connect(), await bench.connect()
        await one.ask(b"LEN half", b"LEN half")
        assert await other.ask(b"LEN\r") == b"LEN\r\n3\r\nSYS>"
        assert await one.ask(b"\r") == b"\r\n8\r\nSYS>"

    serve(body)


def test_a_blocked_line_delays_no_other_and_is_answered_in_time() -> None:
    async def body(bench: Bench) -> None:
        one, other = await bench.connect(), await bench.connect()
        one.writer.write(b"SLEEP 200\rLEN\r")
        started = bench.card.tick
        assert await other.ask(b"LEN\r") == b"LEN\r\n3\r\nSYS>"
        assert bench.card.tick < started + 150
        await one.until(b"ok\r\nSYS>")
        assert await one.until(b"SYS>") == b"3\r\nSYS>"

    serve(body)


def test_an_answer_that_needs_a_few_ticks_is_fetched_at_once() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        for _ in range(20):
            assert await host.ask(b"SLEEP 2\r") == b"SLEEP 2\r\nok\r\nSYS>"

    serve(body)


def test_a_closed_connection_frees_its_stream_and_the_card_goes_on() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        await host.ask(b"LEN\r")
        host.writer.write(b"SLEEP 100000\r")
        await host.close()
        async with asyncio.timeout(WAIT_S):
            while bench.card.streams:
                await asyncio.sleep(0.005)
        before = bench.card.tick
        assert await (await bench.connect()).ask(b"LEN\r")
        assert bench.card.tick >= before

    serve(body)


def test_a_reset_connection_frees_its_stream() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        await host.ask(b"LEN\r")
        host.writer.transport.abort()
        async with asyncio.timeout(WAIT_S):
            while bench.card.streams:
                await asyncio.sleep(0.005)

    serve(body)


def test_sixteen_connections_are_served_and_the_next_is_closed() -> None:
    async def body(bench: Bench) -> None:
        hosts = [await bench.connect() for _ in range(16)]
        answers = await asyncio.gather(*(host.ask(b"LEN\r") for host in hosts))
        assert set(answers) == {b"LEN\r\n3\r\nSYS>"}
        extra = await bench.connect()
        with pytest.raises((asyncio.IncompleteReadError, ConnectionError)):
            await extra.ask(b"LEN\r")
        assert await hosts[0].ask(b"LEN\r")

    serve(body)


def test_a_card_without_free_streams_refuses_the_connection() -> None:
    async def body(bench: Bench) -> None:
        first, second = await bench.connect(), await bench.connect()
        with pytest.raises((asyncio.IncompleteReadError, ConnectionError)):
            await second.ask(b"LEN\r")
        assert await first.ask(b"LEN\r")

    serve(body, streams=1)


def test_a_peer_that_does_not_read_disturbs_no_other_and_memory_stays_bounded() -> None:
    async def body(bench: Bench) -> None:
        slow, other = await bench.connect(), await bench.connect()
        slow.reader._transport.pause_reading()  # type: ignore[attr-defined]
        for _ in range(40):
            slow.writer.write(b"SPAM 5000\r")
            answer = await other.ask(b"LEN\r")
            assert answer == b"LEN\r\n3\r\nSYS>"
        waiting = [stream.terminal.output._size for stream in bench.card.streams.values()]
        assert 1 << 20 <= max(waiting) < (1 << 20) + 100
        assert min(waiting) == 0

    serve(body)


def test_an_answer_longer_than_what_is_kept_for_a_connection_arrives_whole() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        answer = await read_to_prompt(host, b"SPAM 9000\r")
        assert answer == b"SPAM 9000\r\n" + (b"x" * 98 + b"\r\n") * 9000 + b"SYS>"

    serve(body)


def test_a_reader_that_pauses_gets_all_of_a_long_answer_later() -> None:
    async def body(bench: Bench) -> None:
        slow, other = await bench.connect(), await bench.connect()
        slow.reader._transport.pause_reading()  # type: ignore[attr-defined]
        slow.writer.write(b"SPAM 9000\r")
        for _ in range(20):
            assert await other.ask(b"LEN\r") == b"LEN\r\n3\r\nSYS>"
        slow.reader._transport.resume_reading()  # type: ignore[attr-defined]
        answer = await read_to_prompt(slow, b"")
        assert len(answer) == len(b"SPAM 9000\r\n") + 100 * 9000 + len(b"SYS>")

    serve(body)


def test_what_a_connection_does_not_read_waits_in_the_card_with_one_warning(
    caplog: pytest.LogCaptureFixture,
) -> None:
    peer, transport = TcpPeer(StreamKind.TERMINAL, CardServer(FakeCard())), Stuck()
    peer.connection_made(transport)
    transport.unread = SEND_LIMIT_BYTES - 1
    assert peer.takes_output
    assert not caplog.records
    transport.unread = SEND_LIMIT_BYTES
    assert not peer.takes_output
    assert not peer.takes_output
    assert [record.message for record in caplog.records] == [
        "10.0.0.7:4711 does not read what it is sent; its output waits"
    ]
    transport.unread = 0
    assert peer.takes_output
    transport.socket.close()


class Stuck(asyncio.Transport):
    """A connection whose far end reads when the test says so."""

    def __init__(self) -> None:
        super().__init__()
        self.socket = socket.socket()
        self.unread = 0

    def get_extra_info(self, name: str, default: object = None) -> object:
        return ("10.0.0.7", 4711) if name == "peername" else self.socket

    def get_write_buffer_size(self) -> int:
        return self.unread

    def is_closing(self) -> bool:
        return False


async def read_to_prompt(host: Host, line: bytes) -> bytes:
    """What comes back for a line, prompt included, however long."""
    host.writer.write(line)
    seen = bytearray()
    async with asyncio.timeout(WAIT_S):
        while not seen.endswith(b"\nSYS>"):
            seen += await host.reader.read(65536)
    return bytes(seen)


def test_a_flood_of_lines_is_held_back_and_fully_answered() -> None:
    async def body(bench: Bench) -> None:
        flood, other = await bench.connect(), await bench.connect()
        flood.writer.write(b"SLEEP 100\r" + b"A\r" * 50_000)
        for _ in range(20):
            assert await other.ask(b"LEN\r") == b"LEN\r\n3\r\nSYS>"
        answered = 0
        async with asyncio.timeout(30):
            while answered < 50_001:
                answered += (await flood.reader.read(65536)).count(b">")
        assert answered == 50_001

    serve(body)


def test_card_time_follows_the_clock_at_the_chosen_speed() -> None:
    async def body(bench: Bench) -> None:
        host = await bench.connect()
        loop = asyncio.get_running_loop()

        async def measured() -> tuple[float, float]:
            """Seconds of the clock, and of the card at four times its speed."""
            first = int((await host.ask(b"TICK\r")).split()[1])
            began = loop.time()
            await asyncio.sleep(0.3)
            last = int((await host.ask(b"TICK\r")).split()[1])
            return loop.time() - began, (last - first) * bench.card.period_s / 4

        async with asyncio.timeout(WAIT_S):  # a loaded computer lets a card be late
            while True:
                elapsed_s, card_s = await measured()
                if card_s == pytest.approx(elapsed_s, rel=0.1):
                    break
        assert bench.server.report().observations > 50

    serve(body, speed=4)


def test_stopping_closes_every_connection() -> None:
    async def body() -> None:
        async with serving() as bench:
            host = await bench.connect()
            await host.ask(b"LEN\r")
        assert await asyncio.wait_for(host.reader.read(10), WAIT_S) == b""
        assert bench.card.streams == {}

    asyncio.run(body())


def test_a_port_in_use_is_a_user_error_with_a_hint() -> None:
    async def body() -> None:
        with socket.create_server((LOOPBACK, 0)) as taken:
            port = taken.getsockname()[1]
            with pytest.raises(UserError, match=rf"port {port} .* in use.*--ascii-port"):
                await CardServer(FakeCard()).listen(StreamKind.TERMINAL, LOOPBACK, port)

    asyncio.run(body())


@pytest.mark.parametrize(("host", "port"), [("no.such.host.invalid", 0), (LOOPBACK, 70000)])
def test_an_impossible_address_is_a_user_error(host: str, port: int) -> None:
    async def body() -> None:
        with pytest.raises(UserError):
            await CardServer(FakeCard()).listen(StreamKind.TERMINAL, host, port)

    asyncio.run(body())


def test_addresses_know_whether_others_can_reach_them() -> None:
    assert Address("127.0.0.1", 5002).is_loopback
    assert str(Address("127.0.0.1", 5002)) == "127.0.0.1:5002"
    assert not Address("0.0.0.0", 5002).is_loopback
    assert str(Address("::1", 5002)) == "[::1]:5002"


@pytest.mark.parametrize(
    ("networks", "host", "is_admitted"),
    [
        ("192.168.10.0/24", "192.168.10.7", True),
        ("192.168.10.0/24", "192.168.11.7", False),
        ("192.168.10.0/24", "127.0.0.1", True),
        ("192.168.10.0/24", "::1", True),
        ("192.168.10.0/24", "::ffff:192.168.10.9", True),
        ("10.0.0.7,fd00::/8", "10.0.0.7", True),
        ("10.0.0.7,fd00::/8", "10.0.0.8", False),
        ("10.0.0.7,fd00::/8", "fd00::5%eth0", True),
    ],
)
def test_guests_come_from_the_networks_named(networks: str, host: str, is_admitted: bool) -> None:
    assert Guests.of(networks).admits(host) is is_admitted


WEB = (
    b"POST /x HTTP/1.1\r\nHost: 127.0.0.1:5002\r\n\r\n\x18\r\nLEN 12\r\n",
    b"GET /chat HTTP/1.1\r\nUpgrade: websocket\r\n\r\n\x18",
    b"OPTIONS / HTTP/1.1\r\nAccess-Control-Request-Method: PUT\r\n\r\n\x18",
    b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\x18\x30\x02\x01",
)


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("size", [2, 3, 1024])
@pytest.mark.parametrize("request_bytes", WEB, ids=["POST", "WebSocket", "preflight", "https"])
def test_a_connection_of_a_web_page_is_closed_before_anything_is_executed(
    request_bytes: bytes, size: int, binary: bool, caplog: pytest.LogCaptureFixture
) -> None:
    async def body(bench: Bench) -> None:
        page = await bench.connect(binary)
        page.writer.transport.get_extra_info("socket").setsockopt(
            socket.IPPROTO_TCP, socket.TCP_NODELAY, 1
        )
        seen = b""
        with suppress(ConnectionError):
            for at in range(0, len(request_bytes), size):
                page.writer.write(request_bytes[at : at + size])
                await page.writer.drain()
                await asyncio.sleep(0)
            seen = await asyncio.wait_for(page.reader.read(), WAIT_S)
        assert b">" not in seen  # at most the echo of the request line
        assert bench.card.controls == []
        async with asyncio.timeout(WAIT_S):
            while bench.card.streams:
                await asyncio.sleep(0.001)
        assert await (await bench.connect()).ask(b"LEN\r") == b"LEN\r\n3\r\nSYS>"

    serve(body)
    warnings = [record.message for record in caplog.records if record.levelname == "WARNING"]
    # on a loaded computer the card may be late, too
    refused = [each for each in warnings if "cannot keep real time" not in each]
    assert len(refused) == 1
    assert refused[0].endswith(" refused: it speaks HTTP or TLS, as a web page does")


def test_a_stranger_is_turned_away_before_the_card_hears_of_it() -> None:
    class NoHost(Guests):
        def admits(self, host: str) -> bool:
            return False

    async def body() -> None:
        async with serving(allowed=NoHost()) as bench:
            stranger = await bench.connect()
            with suppress(ConnectionResetError):
                assert await asyncio.wait_for(stranger.reader.read(), WAIT_S) == b""
            assert bench.card.next_id == 0

    asyncio.run(body())


def test_a_host_that_comes_again_and_again_cannot_fill_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def body(bench: Bench) -> None:
        await (await bench.connect()).ask(b"LEN 12\r")  # the server runs
        for _ in range(20):
            bench.server.refused("10.0.0.7:1", "all streams are taken")
            terminal.log.warning("an override of %g was refused", 7.0)
            peers.log.warning("%s does not read what it is sent", "10.0.0.7:1")

    serve(body)
    kinds = Counter(str(record.msg).split(" ")[1] for record in caplog.records)
    assert kinds == {"refused:": LINES, "override": LINES, "does": LINES}
