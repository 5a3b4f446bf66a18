"""What one stream still has to send, kept in the pieces that one write each should carry.

Hosts look at the last piece they received: value and prompt of a line therefore leave
together, and a packet reply leaves alone.
"""

from collections import deque
from dataclasses import dataclass, field

LIMIT_BYTES = 1 << 20


@dataclass(slots=True)
class Output:
    """A bounded queue of writes; what does not fit is dropped whole and counted."""

    stopped: bool = False  # XOFF received
    dropped_bytes: int = 0
    _writes: deque[tuple[bytearray, bool]] = field(default_factory=deque)
    _size: int = 0

    def text(self, data: bytes) -> None:
        """Append to the text that leaves with the next write."""
        if not self._fits(data):
            return
        if self._writes and not self._writes[-1][1]:
            self._writes[-1][0].extend(data)
        else:
            self._writes.append((bytearray(data), False))

    def packet(self, data: bytes) -> None:
        """Append one write of its own."""
        if self._fits(data):
            self._writes.append((bytearray(data), True))

    def _fits(self, data: bytes) -> bool:
        """Room for this piece; nothing is ever sent in part."""
        if not data or self._size + len(data) > LIMIT_BYTES:
            self.dropped_bytes += len(data)
            return False
        self._size += len(data)
        return True

    def take(self) -> bytes:
        """The bytes of the next write; none while there is nothing or XOFF holds."""
        if self.stopped or not self._writes:
            return b""
        data, _ = self._writes.popleft()
        self._size -= len(data)
        return bytes(data)
