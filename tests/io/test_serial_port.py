"""A serial line over a pseudo terminal."""

import asyncio
import os
import select
import sys
import threading
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import pytest
from tests.io.fake_card import FakeCard

from openacr.errors import UserError
from openacr.io.serial_port import LineSettings
from openacr.io.server import CardServer
from openacr.protocol.terminal import XOFF, XON

if sys.platform == "win32":
    pytest.skip("pseudo terminals are a POSIX thing", allow_module_level=True)

import pty
import tty


def read_until(fd: int, end: bytes, timeout_s: float = 60.0) -> bytes:
    seen, deadline = b"", time.monotonic() + timeout_s
    while end not in seen and time.monotonic() < deadline:
        if select.select([fd], [], [], 0.1)[0]:
            seen += os.read(fd, 1000)
    return seen


@asynccontextmanager
async def served(card: FakeCard) -> AsyncIterator[tuple[int, int]]:
    """A card on a pseudo terminal: our end of the line, and that of the card."""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    server, stop = CardServer(card), asyncio.Event()
    server.open_serial(os.ttyname(theirs), LineSettings())
    running = asyncio.create_task(server.run(stop))
    yield ours, theirs
    stop.set()
    await asyncio.wait_for(running, 60)
    assert card.streams == {}
    for end in (ours, theirs):
        with suppress(OSError):  # a test may have closed it
            os.close(end)


def test_a_serial_line_is_a_stream_like_any_other() -> None:
    async def body() -> None:
        async with served(card) as (ours, theirs):
            os.write(ours, b"LEN 12\r")
            answer = await asyncio.to_thread(read_until, ours, b"SYS>")
            assert answer == b"LEN 12\r\n6\r\nSYS>"
            os.write(ours, b"\x00\x30#B#A")  # serial lines start in MODE 1
            assert (await asyncio.to_thread(read_until, ours, b"\x00"))[:5] == b"\x000#B#"
            os.close(ours)
            os.close(theirs)

    card = FakeCard()
    asyncio.run(body())


def test_an_answer_longer_than_a_serial_line_is_given_together_arrives_whole() -> None:
    async def body() -> None:
        async with served(card) as (ours, _):
            os.write(ours, b"SPAM 3000\r")
            answer = await asyncio.to_thread(read_until, ours, b"SYS>", 20.0)
            assert answer == b"SPAM 3000\r\n" + (b"x" * 98 + b"\r\n") * 3000 + b"SYS>"

    card = FakeCard()
    asyncio.run(body())


def test_xoff_of_a_host_stops_a_long_answer_within_two_slices() -> None:
    async def body() -> None:
        async with served(card) as (ours, _):
            os.write(ours, b"SPAM 3000\r")  # 300 kB: more than the pseudo terminal takes
            output = next(iter(card.streams.values())).terminal.output
            while not output._size:
                await asyncio.sleep(0.001)
            assert output._size > 200_000  # waits in the card, where XOFF can stop it
            os.write(ours, b"\x13")
            while not output.stopped:
                await asyncio.sleep(0.001)
            held = output._size
            seen = await asyncio.to_thread(read_until, ours, b"SYS>", 0.3)
            assert output._size == held
            assert len(seen) + held == len(b"SPAM 3000\r\n") + 300_000 + len(b"SYS>")
            os.write(ours, b"\x11")
            rest = await asyncio.to_thread(read_until, ours, b"SYS>", 20.0)
            assert len(rest) == held

    card = FakeCard()
    asyncio.run(body())


def test_a_line_that_breaks_frees_its_stream_and_the_card_goes_on() -> None:
    async def body() -> None:
        async with served(card) as (ours, theirs):
            os.close(theirs)
            os.close(ours)
            async with asyncio.timeout(5):
                while card.streams:
                    await asyncio.sleep(0.01)
            tick = card.tick
            await asyncio.sleep(0.05)
            assert card.tick > tick

    card = FakeCard()
    asyncio.run(body())


def test_a_host_that_sends_too_much_is_asked_to_wait_and_loses_nothing() -> None:
    lines = 25_000  # 100 000 bytes: more than waits for a line that is being executed

    def flood(fd: int) -> None:
        """As a host with XON/XOFF does: send, but nothing after XOFF until XON."""
        rest = memoryview(b"SLEEP 99999999\r" + b"LEN\r" * lines)
        while rest:
            may_send.wait()
            rest = rest[os.write(fd, rest[:512]) :]

    def listen(fd: int) -> bytes:
        seen, deadline = b"", time.monotonic() + 60.0
        while seen.count(b"SYS>") < lines + 1 and time.monotonic() < deadline:
            part = os.read(fd, 65536)
            for byte in part:
                if byte == XOFF:
                    may_send.clear()
                    card.wake()
                elif byte == XON:
                    may_send.set()
            seen += part
        return seen

    async def body() -> None:
        async with served(card) as (ours, _):
            writing = asyncio.create_task(asyncio.to_thread(flood, ours))
            seen = await asyncio.to_thread(listen, ours)
            await asyncio.wait_for(writing, 60)
            assert (seen.count(bytes((XOFF,))), seen.count(bytes((XON,)))) == (1, 1)
            assert seen.index(XOFF) < seen.index(XON)
            assert seen.count(b"3\r\nSYS>") == lines

    card = FakeCard()
    may_send = threading.Event()
    may_send.set()
    asyncio.run(body())


def test_a_port_that_is_not_there_is_a_user_error() -> None:
    async def body() -> None:
        with pytest.raises(UserError, match="no-such-port"):
            CardServer(FakeCard()).open_serial("/dev/no-such-port", LineSettings())

    asyncio.run(body())


@pytest.mark.parametrize(
    ("word", "line"),
    [
        (0x8320, LineSettings(9600, 8, "N", 1)),
        (0x8000 | 3 << 11 | 1 << 10 | 2 << 8 | 64, LineSettings(19200, 7, "E", 2)),
        (0x8000 | 1 << 11 | 3 << 8 | 128, LineSettings(38400, 8, "O", 1)),
        (0x0320, None),
        (0x8300, None),
    ],
)
def test_the_startup_mode_of_a_port_says_how_its_line_is_set(
    word: int, line: LineSettings | None
) -> None:
    assert LineSettings.of(word) == line
