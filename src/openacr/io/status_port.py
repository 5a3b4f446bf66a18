"""The UDP port of the fast status (`protocol.status`)."""

import asyncio
import logging
import socket
from collections.abc import Callable
from typing import Protocol, cast

from openacr.protocol.status import LIFE_S, Endpoint, StatusRequest, Subscribers

log = logging.getLogger(__name__)


class StatusBoard(Protocol):
    """The interface of the server that the port uses."""

    def admits(self, host: str) -> bool:
        """Whether a host may send requests at all."""

    def hosts(self) -> set[str]:
        """The addresses of the hosts that are connected."""


class StatusPort(asyncio.DatagramProtocol):
    """Sends the status to its subscribers only."""

    def __init__(self, board: StatusBoard, now_s: Callable[[], float]) -> None:
        self._board = board
        self._now_s = now_s
        self._transport: asyncio.DatagramTransport | None = None
        self._subscribers = Subscribers()
        self._is_warned = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Keep the socket."""
        self._transport = cast(asyncio.DatagramTransport, transport)  # not all are instances of it

    def datagram_received(self, data: bytes, addr: Endpoint) -> None:
        """Process a request; any other datagram is ignored."""
        request = StatusRequest.decode(data)
        if request is None or not self._board.admits(addr[0]):
            return
        taken = self._subscribers.take(request, addr, self._now_s())
        if not taken and not self._is_warned:
            self._is_warned = True
            log.warning("%s:%d gets no status: %d others do", addr[0], addr[1], len(self))

    def __len__(self) -> int:
        return len(self._subscribers)

    def error_received(self, exc: Exception) -> None:
        """Ignore that a receiver is gone; its subscription expires."""

    def send_due(self, status: Callable[[], bytes]) -> None:
        """Send the status to all subscribers that are due."""
        if self._transport is None or not len(self):
            return
        for endpoint in self._subscribers.due(self._now_s(), self._board.hosts()):
            self._transport.sendto(status(), endpoint)
        for endpoint in self._subscribers.take_expired():
            log.warning(
                "%s:%d gets no status any more: it asked %d s ago and has no TCP connection",
                endpoint[0], endpoint[1], LIFE_S,
            )  # fmt: skip

    def close(self) -> None:
        """Release the port."""
        if self._transport is not None:
            self._transport.close()


async def open_status_port(
    board: StatusBoard, now_s: Callable[[], float], sock: socket.socket
) -> StatusPort:
    """Serve a bound UDP socket."""
    sock.setblocking(False)
    loop = asyncio.get_running_loop()
    _, port = await loop.create_datagram_endpoint(lambda: StatusPort(board, now_s), sock=sock)
    return port
