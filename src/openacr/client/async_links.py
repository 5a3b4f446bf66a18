"""Links to a card for asyncio: TCP natively, any blocking link in a thread."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Protocol, TypeVar

from openacr.channels import StreamKind
from openacr.client.causes import cannot_connect
from openacr.client.errors import ConnectionLostError
from openacr.client.links import CONNECT_S, READ_BYTES, Link, ProcessLink, TcpLink
from openacr.errors import reason

T = TypeVar("T")


class AsyncLink(Protocol):
    """As `links.Link`, for asyncio."""

    name: str
    kind: StreamKind

    async def open(self) -> None:
        """Connect."""

    async def read(self, timeout_s: float | None) -> bytes:
        """Return the bytes that have arrived; empty when none came in time."""

    async def write(self, data: bytes) -> None:
        """Send everything."""

    async def pause(self, seconds: float) -> None:
        """Let time pass."""

    def now_s(self) -> float:
        """The clock of the link [s]."""

    async def close(self) -> None:
        """Disconnect."""


class AsyncTcpLink:
    """A TCP connection to the card's terminal port."""

    kind = StreamKind.TERMINAL

    def __init__(self, link: TcpLink) -> None:
        self.name = link.name
        self._address = link.address
        self._streams: tuple[asyncio.StreamReader, asyncio.StreamWriter] | None = None

    async def open(self) -> None:
        """Connect; asyncio sets TCP_NODELAY itself."""
        try:
            async with asyncio.timeout(CONNECT_S):
                self._streams = await asyncio.open_connection(*self._address)
        except (OSError, OverflowError) as failure:
            raise cannot_connect(self.name, failure) from None

    async def read(self, timeout_s: float | None) -> bytes:
        """What has arrived."""
        reader, _ = self._connected()
        try:
            async with asyncio.timeout(timeout_s):
                data = await reader.read(READ_BYTES)
        except TimeoutError:
            return b""
        except OSError as failure:
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None
        if not data:
            raise ConnectionLostError(f"{self.name} has closed the connection")
        return data

    async def write(self, data: bytes) -> None:
        """Send everything."""
        _, writer = self._connected()
        try:
            writer.write(data)
            async with asyncio.timeout(CONNECT_S):
                await writer.drain()
        except TimeoutError:
            raise ConnectionLostError(f"{self.name} accepts no more data") from None
        except OSError as failure:
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None

    def _connected(self) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
        if self._streams is None:
            raise ConnectionLostError(f"{self.name} is not connected")
        return self._streams

    async def pause(self, seconds: float) -> None:
        """Let time pass."""
        await asyncio.sleep(seconds)

    def now_s(self) -> float:
        """The clock of the loop."""
        return asyncio.get_running_loop().time()

    async def close(self) -> None:
        """Disconnect."""
        if self._streams is not None:
            _, writer = self._streams
            self._streams = None
            if writer.transport.get_write_buffer_size():
                writer.transport.abort()  # otherwise it would wait for a card that no longer reads
            writer.close()
            with suppress(OSError):
                await writer.wait_closed()


class AsyncProcessLink:
    """A card in this process; other tasks run between its steps."""

    def __init__(self, link: ProcessLink) -> None:
        self.name, self.kind, self.now_s = link.name, link.kind, link.now_s
        self._link = link

    async def open(self) -> None:
        """Take a stream of the card."""
        self._link.open()

    async def read(self, timeout_s: float | None) -> bytes:
        """Return the output of the card."""
        await asyncio.sleep(0)
        return self._link.read(timeout_s)

    async def write(self, data: bytes) -> None:
        """Send bytes to the card."""
        self._link.write(data)

    async def pause(self, seconds: float) -> None:
        """Let card time pass."""
        await asyncio.sleep(0)
        self._link.pause(seconds)

    async def close(self) -> None:
        """Free the stream."""
        self._link.close()


class ThreadLink:
    """A blocking link whose calls run one at a time in a thread of its own."""

    def __init__(self, link: Link) -> None:
        self.name, self.kind, self.now_s = link.name, link.kind, link.now_s
        self._link = link
        self._thread: ThreadPoolExecutor | None = None

    async def open(self) -> None:
        """Connect."""
        await self._run(self._link.open)

    async def read(self, timeout_s: float | None) -> bytes:
        """What has arrived."""
        return await self._run(lambda: self._link.read(timeout_s))

    async def write(self, data: bytes) -> None:
        """Send everything."""
        await self._run(lambda: self._link.write(data))

    async def pause(self, seconds: float) -> None:
        """Let time pass."""
        await asyncio.sleep(seconds)

    async def close(self) -> None:
        """Disconnect and end the thread."""
        await self._run(self._link.close)
        if self._thread is not None:
            self._thread.shutdown(wait=False)
            self._thread = None

    async def _run(self, work: Callable[[], T]) -> T:
        if self._thread is None:
            self._thread = ThreadPoolExecutor(1, thread_name_prefix=self.name)
        return await asyncio.get_running_loop().run_in_executor(self._thread, work)


def for_asyncio(link: Link) -> AsyncLink:
    """The asyncio form of a link to the card."""
    if isinstance(link, TcpLink):
        return AsyncTcpLink(link)
    if isinstance(link, ProcessLink):
        return AsyncProcessLink(link)
    return ThreadLink(link)
