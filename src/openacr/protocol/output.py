"""What one stream still has to send, kept in the pieces that one write each should carry.

Hosts look at the last piece they received: value and prompt of a line therefore leave
together, and a packet reply leaves alone. Only a long text leaves in several writes, so
that XOFF and a slow line hold back what is left of it.
"""

from collections import deque
from dataclasses import dataclass, field

from msgspec import Struct

LIMIT_BYTES = 1 << 20
SLICE_BYTES = 4096  # of text in one write; about a second at 38400 baud


class OutputState(Struct, frozen=True):
    """What a snapshot keeps: bytes of each write, and whether it is a packet of its own."""

    stopped: bool
    dropped_bytes: int
    writes: list[tuple[bytes, bool]]


@dataclass(slots=True)
class Output:
    """A queue of writes that takes no more, and counts what it drops, once LIMIT_BYTES wait.

    What it does take it takes whole: one listing may be longer than the limit.
    """

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
        if not data or self._size >= LIMIT_BYTES:
            self.dropped_bytes += len(data)
            return False
        self._size += len(data)
        return True

    def take(self) -> bytes:
        """The bytes of the next write; none while there is nothing or XOFF holds."""
        if self.stopped or not self._writes:
            return b""
        first, is_packet = self._writes[0]
        data = bytes(first if is_packet else first[:SLICE_BYTES])
        if len(data) == len(first):
            self._writes.popleft()
        else:
            del first[:SLICE_BYTES]
        self._size -= len(data)
        return data

    def state(self) -> OutputState:
        """Everything, for a snapshot."""
        writes = [(bytes(data), alone) for data, alone in self._writes]
        return OutputState(self.stopped, self.dropped_bytes, writes)

    def restore(self, state: OutputState) -> None:
        """Take over what `state` returned."""
        self.stopped, self.dropped_bytes = state.stopped, state.dropped_bytes
        self._writes = deque((bytearray(data), alone) for data, alone in state.writes)
        self._size = sum(len(data) for data, _ in self._writes)
