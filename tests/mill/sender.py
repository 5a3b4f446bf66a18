"""The far end of a serial line, for tests: a pseudo-terminal stands for it."""

import fcntl
import os
import sys
import termios
import time

LIMIT_S = 60.0
FULL_LINE = 4095  # bytes that a pseudo-terminal keeps


class Sender:
    """The far end of a serial line."""

    def __init__(self, *, is_read: bool = False) -> None:
        """`is_read`: what arrives is read at once, and is not seen to arrive."""
        self._is_read = is_read
        self._master, slave = os.openpty()
        self.port = os.ttyname(slave)
        self._slave = slave
        os.set_blocking(self._master, False)
        self.heard = b""

    def send(self, text: str | bytes) -> None:
        """Send and wait for the kernel, which hands bytes on in its own time."""
        data = text.encode() if isinstance(text, str) else text
        while data:
            arrived = self._waiting()
            try:
                sent = os.write(self._master, data)
            except BlockingIOError:
                time.sleep(0.001)
                continue
            data = data[sent:]
            for _ in range(0 if self._is_read else 1000):
                if self._waiting() >= min(arrived + sent, FULL_LINE):
                    break
                time.sleep(0.001)

    def _waiting(self) -> int:
        """Bytes that the near end can read."""
        return int.from_bytes(fcntl.ioctl(self._slave, termios.FIONREAD, bytes(4)), sys.byteorder)

    def listen(self) -> bytes:
        """What came back since the beginning."""
        try:
            self.heard += os.read(self._master, 100)
        except BlockingIOError:
            pass
        return self.heard

    def hears(self, wanted: bytes) -> bool:
        """Whether this comes back and nothing else; the kernel hands it on in its own time."""
        end_s = time.monotonic() + LIMIT_S
        while self.listen() != wanted and time.monotonic() < end_s:
            time.sleep(0.001)
        return self.heard == wanted

    def close(self) -> None:
        for end in (self._master, self._slave):
            os.close(end)

    def hang_up(self) -> None:
        """End the line from afar: the near end fails."""
        os.close(self._master)
        self._master = os.open(os.devnull, os.O_RDONLY)
