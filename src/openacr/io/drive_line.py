"""A serial port that leads to drives; no call waits."""

import contextlib
import time

import serial

from openacr.errors import UserError, reason
from openacr.io.serial_port import LineSettings, open_port

_FAILURES: tuple[type[Exception], ...] = (serial.SerialException, OSError)
with contextlib.suppress(ImportError):  # pyserial passes on what Unix reports of a port
    import termios

    _FAILURES += (termios.error,)


class DriveLine:
    """A serial port, opened when it is first used."""

    def __init__(self, path: str) -> None:
        self.path = path
        self._port: serial.Serial | None = None

    def open(self, baud: int) -> None:
        """Open it with this speed, or set the speed; UserError if it cannot be opened."""
        if self._port is None:
            self._port = open_port(self.path, LineSettings(baud=baud))
            self._port.timeout = self._port.write_timeout = 0
        elif self._port.baudrate != baud:
            try:
                self._port.baudrate = baud
            except _FAILURES as failure:
                raise self._gone(failure) from None

    def send(self, data: bytes) -> None:
        """Forget what has arrived and send; UserError if the port is gone or takes nothing."""
        if self._port is None:
            raise UserError(f"serial port {self.path} is not open")
        try:
            self._port.reset_input_buffer()
            written = self._port.write(data)
        except _FAILURES as failure:
            raise self._gone(failure) from None
        if written is not None and written < len(data):
            raise self._gone(OSError("it takes no bytes"))

    def take(self) -> bytes:
        """What has arrived since the last call; UserError if the port is gone."""
        if self._port is None:
            return b""
        try:
            return bytes(self._port.read(self._port.in_waiting))
        except _FAILURES as failure:
            raise self._gone(failure) from None

    def now_s(self) -> float:
        """Seconds of a clock that never goes back."""
        return time.monotonic()

    def close(self) -> None:
        """Close the port; the next use opens it again."""
        port, self._port = self._port, None
        if port is not None:
            with contextlib.suppress(*_FAILURES):
                port.close()

    def _gone(self, failure: Exception) -> UserError:
        self.close()
        why = failure if isinstance(failure, OSError) else OSError(*failure.args)
        return UserError(f"serial port {self.path} failed: {reason(why)}")
