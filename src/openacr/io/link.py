"""A byte link from a host to a card: TCP or serial, blocking with time-outs."""

import re
import select
import socket
from typing import Protocol

import serial

from openacr.errors import UserError
from openacr.io.serial_port import LineSettings, open_port

ASCII_PORT = 5002
CONNECT_S = 5.0
READ_BYTES = 65536
HIGHEST_PORT = 65535
_TCP_TARGET = re.compile(r"(?:\[(?P<v6>[^\]]+)\]|(?P<host>[^:/]+))(?::(?P<port>\d+))?$")


class LinkClosedError(Exception):
    """The other end is gone."""


class Link(Protocol):
    """What a terminal or client needs of a connection."""

    name: str

    def fileno(self) -> int:
        """For `select`, where the system has that."""

    def read(self, timeout_s: float) -> bytes:
        """What has arrived; empty when nothing came in time."""

    def write(self, data: bytes) -> None:
        """Send everything."""

    def close(self) -> None:
        """End the connection."""


class TcpLink:
    """A TCP connection."""

    def __init__(self, host: str, port: int) -> None:
        self.name = f"{host}:{port}"
        try:
            self._socket = socket.create_connection((host, port), CONNECT_S)
        except (OSError, OverflowError) as failure:
            raise UserError(f"cannot connect to {self.name}: {failure}") from None
        self._socket.settimeout(None)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def fileno(self) -> int:
        """The socket."""
        return self._socket.fileno()

    def read(self, timeout_s: float) -> bytes:
        """What has arrived; LinkClosedError when the card has closed the connection."""
        if not select.select([self._socket], [], [], timeout_s)[0]:
            return b""
        try:
            data = self._socket.recv(READ_BYTES)
        except OSError as failure:
            raise LinkClosedError(f"{self.name}: {failure}") from None
        if not data:
            raise LinkClosedError(f"{self.name} closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """Send everything."""
        try:
            self._socket.sendall(data)
        except OSError as failure:
            raise LinkClosedError(f"{self.name}: {failure}") from None

    def close(self) -> None:
        """End the connection."""
        self._socket.close()


class SerialLink:
    """A serial port."""

    def __init__(self, path: str, baud: int) -> None:
        self.name = path
        self._port = open_port(path, LineSettings(baud=baud))

    def fileno(self) -> int:
        """The device."""
        number: int = self._port.fileno()
        return number

    def read(self, timeout_s: float) -> bytes:
        """What has arrived; LinkClosedError when the device is gone."""
        try:
            self._port.timeout = timeout_s
            first: bytes = self._port.read(1)
            return first + self._port.read(self._port.in_waiting) if first else b""
        except (serial.SerialException, OSError) as failure:
            raise LinkClosedError(f"{self.name}: {failure}") from None

    def write(self, data: bytes) -> None:
        """Send everything."""
        try:
            self._port.write(data)
        except (serial.SerialException, OSError) as failure:
            raise LinkClosedError(f"{self.name}: {failure}") from None

    def close(self) -> None:
        """Give the port back."""
        self._port.close()


def open_link(target: str, baud: int) -> Link:
    """The link to `HOST[:PORT]` or to a serial port (a path, or COM1 and the like)."""
    if "/" in target or re.fullmatch(r"COM\d+", target, re.IGNORECASE):
        return SerialLink(target, baud)
    found = _TCP_TARGET.fullmatch(target)
    if found is None:
        raise UserError(f"{target!r} is neither HOST, HOST:PORT nor a serial port")
    if (port := int(found["port"] or ASCII_PORT)) > HIGHEST_PORT:
        raise UserError(f"{target}: port {port} is not in 0..{HIGHEST_PORT}")
    return TcpLink(found["v6"] or found["host"], port)
