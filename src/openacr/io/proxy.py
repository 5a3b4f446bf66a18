"""A proxy between hosts and a card that records what they send each other.

It adds nothing and hides nothing. Each connection of a host is a connection to the card; when
one end closes or is lost, so is the other, at once. A host that disappears without closing is
noticed as by a card of this software (TCP keep-alive), and an end that does not read holds the
other one back. If the recording cannot be written any more, it ends, and the machine goes on.
"""

import asyncio
import logging
import socket
from collections.abc import Callable
from typing import TypeAlias

from openacr.errors import reason
from openacr.io.listening import bound_socket
from openacr.io.peers import READ_BYTES, UNKNOWN_HOST, set_options
from openacr.io.recorded_session import SessionRecorder
from openacr.io.server import Address, Guests
from openacr.journal.entries import Entered
from openacr.protocol.web import Opening

log = logging.getLogger(__name__)
CONNECT_S = 5.0
CLOSE_S = 1.0  # for what is still on its path when one end closes
CONNECTIONS = 16


End: TypeAlias = tuple[asyncio.StreamReader, asyncio.StreamWriter]


class Proxy:
    """Listens for hosts, connects each to the card, and records both directions."""

    def __init__(self, card: tuple[str, int], recorder: SessionRecorder, guests: Guests) -> None:
        self._address = card
        self._recorder = recorder
        self._guests = guests
        self._count = 0
        self._open: dict[int, asyncio.Task[None]] = {}
        self._listener: asyncio.Server | None = None

    async def listen(self, host: str, port: int) -> Address:
        """Open the port for hosts (0: any free one); UserError if impossible."""
        sock = bound_socket(host, port, socket.SOCK_STREAM, "--port")
        self._listener = await asyncio.start_server(self._joined, sock=sock, limit=READ_BYTES)
        name = sock.getsockname()
        return Address(name[0], name[1])

    async def close(self) -> None:
        """Stop listening and end all connections."""
        if self._listener is not None:
            self._listener.close()
        for task in list(self._open.values()):
            task.cancel()
        await asyncio.gather(*self._open.values(), return_exceptions=True)

    async def _joined(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        peer = str((writer.get_extra_info("peername") or (UNKNOWN_HOST,))[0])
        task = asyncio.current_task()
        if task is None or not self._guests.admits(peer) or len(self._open) >= CONNECTIONS:
            log.warning("%s refused: not in the allowed networks, or too many connections", peer)
            writer.transport.abort()
            return
        self._count += 1
        number = self._count
        self._open[number] = task
        try:
            await self._serve(number, reader, writer)
        finally:
            writer.transport.abort()
            del self._open[number]

    async def _serve(
        self, number: int, requests: asyncio.StreamReader, host: asyncio.StreamWriter
    ) -> None:
        try:
            async with asyncio.timeout(CONNECT_S):
                answers, card = await asyncio.open_connection(*self._address, limit=READ_BYTES)
        except OSError as failure:
            log.warning(
                "cannot connect to %s:%d: %s", *self._address, reason(failure) or "no answer"
            )
            return
        for end in (host, card):
            set_options(end.get_extra_info("socket"))
            end.transport.set_write_buffer_limits(high=0)  # what one end does not read waits
        self._recorder.note(number, Entered.OPEN)
        try:
            await self._exchange(number, (requests, host), (answers, card))
        finally:
            self._recorder.note(number, Entered.CLOSE)
            card.transport.abort()

    async def _exchange(self, number: int, host: End, card: End) -> None:
        """Pass bytes in both directions until either end closes or is lost."""
        opening = Opening()
        both = [
            asyncio.ensure_future(
                self._pass(number, Entered.BYTES, host[0], card[1], opening.is_web)
            ),
            asyncio.ensure_future(
                self._pass(number, Entered.SENT, card[0], host[1], _is_never_web)
            ),
        ]
        try:
            await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for each in both:
                each.cancel()
            await asyncio.gather(*both, return_exceptions=True)

    async def _pass(
        self,
        number: int,
        what: Entered,
        source: asyncio.StreamReader,
        target: asyncio.StreamWriter,
        is_web: Callable[[bytes], bool],
    ) -> None:
        """Pass on what one end sends; when it closes, close the other one."""
        try:
            while data := await source.read(READ_BYTES):
                if is_web(data):
                    log.warning("a host refused: it speaks HTTP or TLS, as a web page does")
                    return
                self._recorder.note(number, what, data)
                target.write(data)
                await target.drain()
            target.close()
            async with asyncio.timeout(CLOSE_S):
                await target.wait_closed()
        except OSError as failure:  # a time-out, too
            log.info("connection %d: %s", number, reason(failure))


def _is_never_web(_: bytes) -> bool:
    return False
