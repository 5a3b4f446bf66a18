"""The output queue of one stream, divided into the pieces to be sent in one write each.

Hosts evaluate the last piece they received: value and prompt of a line are therefore sent
together, and a packet reply is sent alone. Only a long text is sent in several writes, so
that XOFF and a slow line hold back the rest of it.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from msgspec import Struct

LIMIT_BYTES = 1 << 20
SLICE_BYTES = 4096  # of text in one write; about a second at 38400 baud


class OutputState(Struct, frozen=True):
    """The queue in a snapshot: the bytes of each write, and whether it is a packet."""

    stopped: bool
    dropped_bytes: int
    writes: list[tuple[bytes, bool]]


@dataclass(slots=True)
class Output:
    """A queue of writes; once LIMIT_BYTES wait it drops further output and counts it.

    Accepted output is accepted whole: one listing may be longer than the limit.
    """

    stopped: bool = False  # XOFF received
    dropped_bytes: int = 0
    on_put: Callable[[bytes, bool], None] = lambda _data, _is_packet: None  # accepted output
    _writes: deque[tuple[bytearray, bool]] = field(default_factory=deque)
    _size: int = 0

    def text(self, data: bytes) -> None:
        """Append to the text of the next write."""
        if not self._fits(data):
            return
        self.on_put(data, False)
        if self._writes and not self._writes[-1][1]:
            self._writes[-1][0].extend(data)
        else:
            self._writes.append((bytearray(data), False))

    def packet(self, data: bytes) -> None:
        """Append a packet, which is sent in a write of its own."""
        if self._fits(data):
            self.on_put(data, True)
            self._writes.append((bytearray(data), True))

    def _fits(self, data: bytes) -> bool:
        """Whether there is room for this piece; no piece is ever sent in part."""
        if not data or self._size >= LIMIT_BYTES:
            self.dropped_bytes += len(data)
            return False
        self._size += len(data)
        return True

    def take(self) -> bytes:
        """Return the bytes of the next write; empty if there is no output or XOFF holds it."""
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
        """The queue, for a snapshot."""
        writes = [(bytes(data), alone) for data, alone in self._writes]
        return OutputState(self.stopped, self.dropped_bytes, writes)

    def restore(self, state: OutputState) -> None:
        """Restore what `state` returned."""
        self.stopped, self.dropped_bytes = state.stopped, state.dropped_bytes
        self._writes = deque((bytearray(data), alone) for data, alone in state.writes)
        self._size = sum(len(data) for data, _ in self._writes)
