"""Bytes of a stream that arrived together."""

from dataclasses import dataclass

from openacr.protocol.events import ControlKey
from openacr.protocol.packets import HEADER_IDS

KEYS = bytes(ControlKey)


@dataclass(slots=True)
class Segment:
    """Bytes that arrived together at a tick, and how far they are scanned."""

    data: bytes
    tick: int
    at: int = 0

    @property
    def rest(self) -> bytes:
        """The bytes that are not scanned yet."""
        return self.data[self.at :]

    @property
    def is_scanned(self) -> bool:
        """Whether nothing is left."""
        return self.at >= len(self.data)

    def take_keys(self) -> tuple[list[ControlKey], bool]:
        """Remove the control keys up to the next packet; also whether a packet begins there."""
        rest = self.rest
        packet = next((place for place, byte in enumerate(rest) if byte in HEADER_IDS), len(rest))
        text = rest[:packet]
        keys = [ControlKey(byte) for byte in text if byte in KEYS]
        self.data = self.data[: self.at] + text.translate(None, KEYS) + rest[packet:]
        return keys, packet < len(rest)
