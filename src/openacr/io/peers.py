"""The remote ends of the card's streams: TCP connections (serial ports: `serial_port`).

The server never waits for a peer that does not read. Once SEND_LIMIT_BYTES are queued here, the
rest stays in the card (`protocol.output` limits it), with one warning per connection. A
flooding peer is held back by not reading from it, and every read is small, so that the
others get their turn.
"""

import asyncio
import logging
import socket
from collections.abc import Callable
from typing import Protocol

from openacr.channels import StreamKind
from openacr.protocol.web import Opening

log = logging.getLogger(__name__)

SEND_LIMIT_BYTES = 1 << 18
READ_BYTES = 1024
UNKNOWN_HOST = "0.0.0.0"  # of a connection that is gone already
KEEPALIVE_IDLE_S, KEEPALIVE_INTERVAL_S, KEEPALIVE_PROBES = 30, 10, 3


class Peer(Protocol):
    """One remote end, with its stream of the card."""

    kind: StreamKind
    stream: int
    host: str  # its address; empty for a serial line

    @property
    def takes_output(self) -> bool:
        """False while its queue is so long that further output should stay in the card."""

    def send(self, data: bytes) -> None:
        """Send bytes in one write."""

    def hold(self, held: bool) -> None:
        """Stop or resume reading."""

    def close(self) -> None:
        """End the connection."""


class Switchboard(Protocol):
    """What a peer reports to."""

    def admits(self, host: str) -> bool:
        """Whether a host may connect at all."""

    def refused(self, name: str, why: str) -> None:
        """A connection was turned away."""

    def joined(self, peer: Peer) -> bool:
        """Give the peer a stream; False when no stream is free."""

    def received(self, peer: Peer, data: bytes) -> None:
        """Bytes arrived."""

    def left(self, peer: Peer) -> None:
        """The connection ended."""


class TcpPeer(asyncio.BufferedProtocol):
    """One TCP connection."""

    def __init__(self, kind: StreamKind, board: Switchboard) -> None:
        self.kind = kind
        self.stream = -1
        self.host = ""
        self._board = board
        self._buffer = bytearray(READ_BYTES)
        self._transport: asyncio.Transport | None = None
        self._held = self._joined = False
        self._was_full = False
        self._name = ""
        self._opening = Opening()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Set the socket up and ask for a stream; nothing is sent (no greeting)."""
        if not isinstance(transport, asyncio.Transport):
            return
        self._transport = transport
        host, port, *_ = transport.get_extra_info("peername") or (UNKNOWN_HOST, 0)
        self.host, self._name = host, f"{host}:{port}"
        set_options(transport.get_extra_info("socket"))
        is_welcome = self._board.admits(host)
        self._joined = is_welcome and self._board.joined(self)
        if self._joined:
            log.info("%s connected (%s)", self._name, self.kind.value)
        elif not is_welcome:
            self._board.refused(self._name, "not in the allowed networks")
            transport.abort()
        else:
            self._board.refused(self._name, "all streams are taken")
            transport.abort()

    def get_buffer(self, sizehint: int) -> bytearray:
        """Read in small pieces, for the sake of the other connections."""
        return self._buffer

    def buffer_updated(self, nbytes: int) -> None:
        """Hand over what arrived together, unless it comes from a web page."""
        data = bytes(self._buffer[:nbytes])
        if not self._joined or self._transport is None or self._transport.is_closing():
            return
        if self._opening.is_web(data):
            self._board.refused(self._name, "it speaks HTTP or TLS, as a web page does")
            self._transport.abort()
        else:
            self._board.received(self, data)

    def connection_lost(self, exc: Exception | None) -> None:
        """Free the stream."""
        self._transport = None
        if self._joined:
            self._joined = False
            log.info("%s disconnected", self._name)
            self._board.left(self)

    @property
    def takes_output(self) -> bool:
        """False while the peer has too much unread."""
        if self._transport is None:
            return False
        is_full = self._transport.get_write_buffer_size() >= SEND_LIMIT_BYTES
        if is_full and not self._was_full:
            self._was_full = True
            log.warning("%s does not read what it is sent; its output waits", self._name)
        return not is_full

    def send(self, data: bytes) -> None:
        """One write."""
        if self._transport is not None and not self._transport.is_closing():
            self._transport.write(data)

    def hold(self, held: bool) -> None:
        """Stop or resume reading."""
        if self._transport is None or held == self._held:
            return
        self._held = held
        change: Callable[[], None] = (
            self._transport.pause_reading if held else self._transport.resume_reading
        )
        change()

    def close(self) -> None:
        """End the connection; buffered output for a peer that reads is still sent."""
        if self._transport is None:
            return
        if self._transport.get_write_buffer_size():
            self._transport.abort()
        else:
            self._transport.close()


def set_options(sock: socket.socket) -> None:
    """Send small replies without delay; detect peers that disappear without closing."""
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in (
        ("TCP_KEEPIDLE", KEEPALIVE_IDLE_S),
        ("TCP_KEEPINTVL", KEEPALIVE_INTERVAL_S),
        ("TCP_KEEPCNT", KEEPALIVE_PROBES),
    ):
        if hasattr(socket, name):  # not every system has all three
            sock.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
