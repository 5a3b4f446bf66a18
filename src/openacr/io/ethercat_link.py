"""Frames of EtherCAT on a network interface, through a raw socket of Linux."""

import contextlib
import select
import socket
import time

from openacr.errors import UserError
from openacr.fieldbus.ethercat.wire.frames import ETHERTYPE, FIRST

RETURN_S = 0.01  # a frame takes at most to come back
_LONGEST = 2048
_ON_ITS_WAY_OUT = 4  # of the kind of a packet: one that this computer has sent


class RawLink:
    """The devices at a network interface; UserError if it cannot be opened."""

    def __init__(self, interface: str, return_s: float = RETURN_S) -> None:
        if not hasattr(socket, "AF_PACKET"):
            raise UserError("EtherCAT needs the raw sockets of Linux")
        self.name = interface
        self._return_s = return_s
        try:
            self._socket = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(ETHERTYPE))
        except PermissionError:
            hint = "run as root, or give Python the right: setcap cap_net_raw+ep"
            raise UserError(f"{interface}: raw frames are not permitted ({hint})") from None
        try:
            self._socket.bind((interface, ETHERTYPE))
        except OSError as failure:
            self._socket.close()
            known = ", ".join(name for _, name in socket.if_nameindex())
            raise UserError(f"{interface}: {failure.strerror} (interfaces: {known})") from None
        self._socket.setblocking(False)

    def exchange(self, frame: bytes) -> bytes | None:
        """Send a frame; as it comes back, None if it does not in time."""
        self._drop_late()
        try:
            self._socket.send(frame)
        except OSError:
            return None  # no link, or the interface is down: lost like any other
        deadline_s = time.monotonic() + self._return_s
        while (left_s := deadline_s - time.monotonic()) > 0.0:
            if not select.select([self._socket], [], [], left_s)[0]:
                return None
            with contextlib.suppress(OSError):
                data, address = self._socket.recvfrom(_LONGEST)
                if address[2] != _ON_ITS_WAY_OUT and data[FIRST + 1] == frame[FIRST + 1]:
                    return data
        return None

    def fileno(self) -> int:
        """Number of the socket, for the real-time loop."""
        return self._socket.fileno()

    def now_s(self) -> float:
        """Seconds of a clock that never goes back."""
        return time.monotonic()

    def pause(self, seconds: float) -> None:
        """Let time pass."""
        time.sleep(seconds)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def _drop_late(self) -> None:
        """Take away frames that came after their time."""
        with contextlib.suppress(OSError):
            while True:
                self._socket.recv(_LONGEST)
