"""A serial port as a stream of the card, with the same rules as a connection.

pyserial blocks, so one thread reads and one writes; both only hand bytes to and from the
loop. XON/XOFF is the card's own business, not the driver's: what a host sends is acted on in
`protocol.terminal`; what holds the host back leaves from here, ahead of all output that
waits, but never inside a write, where it could be taken for a byte of a packet. Little
output waits here, so that XOFF acts on nearly all of it.
"""

import asyncio
import logging
import queue
import threading
from collections import deque
from dataclasses import dataclass

import serial

from openacr.channels import StreamKind
from openacr.errors import UserError, reason
from openacr.io.peers import Switchboard
from openacr.protocol.output import SLICE_BYTES
from openacr.protocol.terminal import XOFF, XON

log = logging.getLogger(__name__)

READ_WAIT_S = 0.1
HELD_WAIT_S = 0.01


_PARITIES = (serial.PARITY_NONE, serial.PARITY_ODD, serial.PARITY_NONE, serial.PARITY_EVEN)
BAUD_UNIT = 300
IS_MANUAL = 1 << 15


@dataclass(frozen=True, slots=True)
class LineSettings:
    """The character format and speed of a serial line."""

    baud: int = 38400
    data_bits: int = 8
    parity: str = serial.PARITY_NONE
    stop_bits: int = 1

    @classmethod
    def of(cls, startup_mode: int) -> "LineSettings | None":
        """The settings in COM1/COM2 Startup Mode (P7013, P7029); None: detect the speed.

        Baud rate / 300 in bits 0 to 7, data bits less 5 in 8 and 9, a second stop bit in
        10, parity in 11 and 12, settings valid at all in 15 (UG2, Appendix A).
        """
        baud = BAUD_UNIT * (startup_mode & 0xFF)
        if not startup_mode & IS_MANUAL or not baud:
            return None
        return cls(
            baud=baud,
            data_bits=5 + (startup_mode >> 8 & 3),
            parity=_PARITIES[startup_mode >> 11 & 3],
            stop_bits=1 + (startup_mode >> 10 & 1),
        )


def open_port(path: str, line: LineSettings) -> serial.Serial:
    """Open a serial port; UserError when it fails."""
    try:
        return serial.serial_for_url(
            path,
            baudrate=line.baud,
            bytesize=line.data_bits,
            parity=line.parity,
            stopbits=line.stop_bits,
            timeout=READ_WAIT_S,
        )
    except (serial.SerialException, OSError, ValueError) as failure:
        raise UserError(f"cannot open serial port {path}: {reason(failure)}") from None


class SerialPeer:
    """The remote end of a serial line."""

    kind = StreamKind.SERIAL

    def __init__(
        self, path: str, line: LineSettings, board: Switchboard, loop: asyncio.AbstractEventLoop
    ) -> None:
        self.stream = -1
        self.host = ""
        self._path = path
        self._board = board
        self._loop = loop
        self._port = open_port(path, line)
        self._outgoing: queue.Queue[bytes | None] = queue.Queue()  # None: the end
        self._urgent: deque[int] = deque(maxlen=1)  # the last XON or XOFF, ahead of all that waits
        self._queued = self._sent = 0  # bytes; one counter per thread, so no lock
        self._unheld = threading.Event()
        self._unheld.set()
        self._open = True

    def start(self) -> None:
        """Open a stream of the card and begin to read."""
        if not self._board.joined(self):
            self._port.close()
            raise UserError(f"no stream of the card is free for {self._path}")
        for work in (self._read, self._write):
            threading.Thread(target=work, name=f"{self._path} {work.__name__}", daemon=True).start()

    @property
    def takes_output(self) -> bool:
        """False while a whole slice waits to be written."""
        return self._queued - self._sent < SLICE_BYTES

    def send(self, data: bytes) -> None:
        """Send bytes in one write."""
        self._queued += len(data)
        self._outgoing.put(data)

    def hold(self, held: bool) -> None:
        """Stop or resume reading, and signal this to the host with XOFF or XON."""
        if held != self._unheld.is_set():
            return
        if held:
            self._unheld.clear()
        else:
            self._unheld.set()
        self._urgent.append(XOFF if held else XON)
        if self._outgoing.empty():  # else the writer comes by: it looks after each piece it takes
            self._outgoing.put(b"")

    def close(self) -> None:
        """Free the stream; both threads end within READ_WAIT_S."""
        if not self._open:
            return
        self._open = False
        self._outgoing.put(None)
        self._board.left(self)

    def _read(self) -> None:
        try:
            while self._open:
                if not self._unheld.wait(HELD_WAIT_S):
                    continue
                first = self._port.read(1)
                if first and self._open:
                    data = first + self._port.read(self._port.in_waiting)
                    self._loop.call_soon_threadsafe(self._arrived, data)
        except (serial.SerialException, OSError, TypeError, RuntimeError) as failure:
            self._failed(failure)
        finally:
            self._port.close()

    def _arrived(self, data: bytes) -> None:
        if self._open:
            self._board.received(self, data)

    def _write(self) -> None:
        try:
            while (data := self._outgoing.get()) is not None:
                while self._urgent:
                    self._port.write(bytes((self._urgent.popleft(),)))
                if data:
                    self._port.write(data)
                    self._sent += len(data)
        except (serial.SerialException, OSError, TypeError) as failure:
            self._failed(failure)

    def _failed(self, failure: Exception) -> None:
        """Report a broken line to the loop, unless it is closing anyway."""
        if self._open and not self._loop.is_closed():
            log.warning("serial port %s failed: %s", self._path, failure)
            self._loop.call_soon_threadsafe(self.close)
