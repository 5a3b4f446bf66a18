"""Bytes of a stream that arrived together."""

import re
from dataclasses import dataclass

from openacr.protocol.events import ControlKey
from openacr.protocol.packets import HEADER_IDS

KEYS = bytes(ControlKey)
_PACKET = re.compile(b"[" + re.escape(bytes(sorted(HEADER_IDS))) + b"]")


@dataclass(slots=True)
class Segment:
    """Bytes that arrived together at a tick, and how far they are scanned."""

    data: bytes
    tick: int
    at: int = 0
    looked: int = 0  # control keys before this place have been taken out

    @property
    def rest(self) -> bytes:
        """The bytes that are not scanned yet."""
        return self.data[self.at :]

    @property
    def left(self) -> int:
        """Count of bytes that are not scanned yet."""
        return len(self.data) - self.at

    @property
    def is_scanned(self) -> bool:
        """Whether nothing is left."""
        return self.at >= len(self.data)

    def take_keys(self) -> tuple[list[ControlKey], bool]:
        """Remove the control keys up to the next packet; also whether a packet begins there.

        No byte is looked at twice, and bytes are copied only where a key was among them.
        """
        begin = max(self.at, self.looked)
        found = _PACKET.search(self.data, begin)
        end = found.start() if found else len(self.data)
        text = self.data[begin:end]
        kept = text.translate(None, KEYS)
        keys = [ControlKey(byte) for byte in text if byte in KEYS] if kept != text else []
        if keys:
            self.data = self.data[:begin] + kept + self.data[end:]
        self.looked = begin + len(kept)
        return keys, found is not None
