"""The serial port a part program arrives on, and the XON and XOFF that pace its sender."""

import serial

from openacr.errors import UserError, reason
from openacr.mill.config.communications import XON_XOFF, Line

XON, XOFF = b"\x11", b"\x13"


class SerialInput:
    """An open serial port whose sender is released and held back; UserError when it fails."""

    def __init__(self, line: Line, wait_s: float = 0.0) -> None:
        self._port = line.open(wait_s)
        self._name = line.port
        self._sends_xoff = line.handshake == XON_XOFF
        self._has_begun = False
        self.is_held_back = False

    def read(self, most: int) -> bytes:
        """Read what has arrived, at most `most` bytes; the first is waited for."""
        try:
            waiting = self._port.in_waiting
            wanted = max(min(waiting, most), 1)
            return bytes(self._port.read(wanted))
        except (serial.SerialException, OSError) as failure:
            raise self._failed(failure) from None

    def release(self) -> None:
        """Send XON at the beginning, and to a sender that is held back."""
        if self._has_begun and not self.is_held_back:
            return
        self._has_begun, self.is_held_back = True, False
        self._send(XON)

    def hold_back(self) -> None:
        """Send XOFF to a sender that is not held back yet."""
        if self._sends_xoff and not self.is_held_back:
            self.is_held_back = True
            self._send(XOFF)

    def _send(self, character: bytes) -> None:
        if not self._sends_xoff:
            return
        try:
            self._port.write(character)
        except (serial.SerialException, OSError) as failure:
            raise self._failed(failure) from None

    def _failed(self, failure: Exception) -> UserError:
        return UserError(f"{self._name} failed: {reason(failure)}")

    def close(self) -> None:
        """Close the port."""
        self._port.close()
