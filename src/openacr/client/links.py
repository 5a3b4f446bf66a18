"""Links to a card: TCP, a serial line, or a card in the same process; blocking.

`now_s` is the clock that time-outs and pauses use: the wall clock, or card time for a card
in this process, whose time passes only while a caller waits.
"""

import re
import socket
import time
from typing import TYPE_CHECKING, Protocol, TypeAlias

from openacr.channels import ASCII_PORT, StreamKind
from openacr.client.causes import NO_DRIVER, cannot_connect
from openacr.client.errors import ConnectionLostError
from openacr.errors import NoFreeStreamError, UserError, reason

if TYPE_CHECKING:
    import serial

DEFAULT_BAUD = 38400
CONNECT_S = 5.0
READ_BYTES = 65536
STEP_S = 0.001
HIGHEST_PORT = 65535
_WINDOWS_PORT = re.compile(r"(?:\\\\\.\\)?COM\d+", re.IGNORECASE)  # COM3, \\.\COM12
_TCP_TARGET = re.compile(r"(?:\[(?P<v6>[^\]]+)\]|(?P<host>[^:/]+))(?::(?P<port>\d+))?$")


class Host(Protocol):
    """A card in this process: the part of `openacr.Controller` that a link uses."""

    @property
    def period_s(self) -> float:
        """Seconds of card time per tick."""

    @property
    def lived_tk(self) -> int:
        """Ticks since the card was created."""

    def open_stream(self, kind: StreamKind) -> int:
        """Open a stream for a new connection."""

    def close_stream(self, stream: int) -> None:
        """Close the stream of an ended connection."""

    def receive(self, stream: int, data: bytes) -> None:
        """Process bytes that arrived together."""

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""

    def take_output(self, stream: int) -> bytes:
        """Return the bytes of the next write, empty when there is nothing to send."""

    def advance(self, ticks: int) -> None:
        """Let card time pass."""


class Link(Protocol):
    """A connection to a card; every method raises ConnectionLostError when it is broken."""

    name: str
    kind: StreamKind

    def open(self) -> None:
        """Connect."""

    def read(self, timeout_s: float | None) -> bytes:
        """Return the bytes that have arrived; empty when none came in time."""

    def write(self, data: bytes) -> None:
        """Send everything."""

    def pause(self, seconds: float) -> None:
        """Let time pass."""

    def now_s(self) -> float:
        """The clock of the link [s]."""

    def close(self) -> None:
        """Disconnect; no effect when not connected."""


class TcpLink:
    """A TCP connection to the card's terminal port."""

    kind = StreamKind.TERMINAL
    now_s, pause = staticmethod(time.monotonic), staticmethod(time.sleep)

    def __init__(self, host: str, port: int = ASCII_PORT) -> None:
        self.name = f"{host}:{port}"
        self.address = (host, port)
        self._socket: socket.socket | None = None

    def open(self) -> None:
        """Connect."""
        try:
            self._socket = socket.create_connection(self.address, CONNECT_S)
        except (OSError, OverflowError) as failure:
            raise cannot_connect(self.name, failure) from None
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def read(self, timeout_s: float | None) -> bytes:
        """What has arrived."""
        link = self._connected()
        link.settimeout(timeout_s)
        try:
            data = link.recv(READ_BYTES)
        except (TimeoutError, BlockingIOError):
            return b""
        except OSError as failure:
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None
        if not data:
            raise ConnectionLostError(f"{self.name} has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """Send everything."""
        link = self._connected()
        link.settimeout(CONNECT_S)
        try:
            link.sendall(data)
        except OSError as failure:
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None

    def fileno(self) -> int:
        """For `select`."""
        return self._connected().fileno()

    def _connected(self) -> socket.socket:
        if self._socket is None:
            raise ConnectionLostError(f"{self.name} is not connected")
        return self._socket

    def close(self) -> None:
        """Disconnect."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


class SerialLink:
    """A serial line; XON and XOFF of the card hold the sender back."""

    kind = StreamKind.SERIAL
    now_s, pause = staticmethod(time.monotonic), staticmethod(time.sleep)

    def __init__(self, path: str, baud: int = DEFAULT_BAUD) -> None:
        self.name = path
        self.baud = baud
        self._port: serial.Serial | None = None

    def open(self) -> None:
        """Open the port."""
        import serial

        try:
            self._port = serial.serial_for_url(
                self.name, baudrate=self.baud, xonxoff=True, write_timeout=CONNECT_S
            )
        except (serial.SerialException, OSError, ValueError) as failure:
            raise ConnectionLostError(
                f"cannot open serial port {self.name}: {reason(failure)} ({NO_DRIVER})"
            ) from None

    def read(self, timeout_s: float | None) -> bytes:
        """What has arrived."""
        port = self._connected()
        try:
            port.timeout = timeout_s
            first: bytes = port.read(1)
            return first + port.read(port.in_waiting) if first else b""
        except OSError as failure:  # also what pyserial raises
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None

    def write(self, data: bytes) -> None:
        """Send everything."""
        try:
            self._connected().write(data)
        except OSError as failure:
            raise ConnectionLostError(f"{self.name}: {reason(failure)}") from None

    def fileno(self) -> int:
        """For `select`, where the system supports it."""
        number: int = self._connected().fileno()
        return number

    def _connected(self) -> "serial.Serial":
        if self._port is None:
            raise ConnectionLostError(f"{self.name} is not open")
        return self._port

    def close(self) -> None:
        """Release the port."""
        if self._port is not None:
            self._port.close()
            self._port = None


class ProcessLink:
    """A card in this process; its time passes while an answer is awaited."""

    kind = StreamKind.TERMINAL

    def __init__(self, card: Host) -> None:
        self.name = "the card in this process"
        self._card = card
        self._stream: int | None = None
        self._passed_tk = 0

    def open(self) -> None:
        """Take a stream of the card."""
        try:
            self._stream = self._card.open_stream(self.kind)
        except NoFreeStreamError as failure:
            raise ConnectionLostError(str(failure)) from None

    def read(self, timeout_s: float | None) -> bytes:
        """Return the output of the card, advancing its time until there is some."""
        stream = self._connected()
        left_tk = None if timeout_s is None else self._ticks(timeout_s)
        while not (data := self._card.take_output(stream)):
            if left_tk is not None and left_tk <= 0:
                return b""
            step_tk = self._ticks(STEP_S)
            self._advance(step_tk)
            left_tk = None if left_tk is None else left_tk - step_tk
        while more := self._card.take_output(stream):  # as a socket delivers what has arrived
            data += more
        return data

    def write(self, data: bytes) -> None:
        """Send bytes to the card; as on a wire, time passes while it accepts no more."""
        stream = self._connected()
        for _ in range(self._ticks(CONNECT_S)):
            if self._card.accepts_input(stream):
                break
            self._advance(1)
        self._card.receive(stream, data)

    def _connected(self) -> int:
        if self._stream is None:
            raise ConnectionLostError(f"{self.name} is not connected")
        return self._stream

    def _ticks(self, seconds: float) -> int:
        return max(1, round(seconds / self._card.period_s))

    def _advance(self, ticks: int) -> None:
        before_tk = self._card.lived_tk
        self._card.advance(ticks)
        self._passed_tk += self._card.lived_tk - before_tk  # a watch ends it early

    def pause(self, seconds: float) -> None:
        """Let card time pass."""
        self._advance(self._ticks(seconds))

    def now_s(self) -> float:
        """Card time that this link has let pass since it was created [s]."""
        return self._passed_tk * self._card.period_s

    def close(self) -> None:
        """Free the stream."""
        if self._stream is not None:
            self._card.close_stream(self._stream)
            self._stream = None


Wire: TypeAlias = TcpLink | SerialLink


def link_to(target: "str | Host", baud: int = DEFAULT_BAUD) -> Link:
    """The link to `HOST[:PORT]`, to a serial port (a path, or COM1), or to a card."""
    return wire_to(target, baud) if isinstance(target, str) else ProcessLink(target)


def wire_to(target: str, baud: int = DEFAULT_BAUD) -> Wire:
    """The link to `HOST[:PORT]` or to a serial port (a path, or COM1)."""
    if "/" in target or _WINDOWS_PORT.fullmatch(target):
        return SerialLink(target, baud)
    found = _TCP_TARGET.fullmatch(target)
    if found is None:
        raise UserError(f"{target!r} is neither HOST, HOST:PORT nor a serial port")
    if (port := int(found["port"] or ASCII_PORT)) > HIGHEST_PORT:
        raise UserError(f"{target}: port {port} is not in 0..{HIGHEST_PORT}")
    return TcpLink(found["v6"] or found["host"], port)
