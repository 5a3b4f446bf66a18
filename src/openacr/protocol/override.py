"""Feedrate and rapid feedrate override of several masters at once (UG2 ch. 6).

Eight bytes in all. The first edition prints six where the mask in byte 1 suffices: the two
bytes of the 16 master mask are present only after a zero. It also starts its ROV examples
with the FOV header. The later guide corrects both (errata) and lets byte 1 be set in eight
bytes, so a card accepts one of the two forms: the later one, unless `machine.toml` sets
`short_override_packets = true`.

Six bytes that are taken for the beginning of eight have the first two bytes of the next packet
as the upper half of their value, which is then negative or almost zero in all but a few
cases: not an override, so it is refused and those two bytes are read again (`belongs_to_next`).
"""

import struct
from collections.abc import Iterable
from typing import ClassVar, Self

from openacr.protocol.host import Host, PacketError, finite
from openacr.protocol.packet import F32, U8, U16, Packet, register

MASTERS = 16
SHORT_BYTES = 6
MASK_16_AT, MASK_16_BYTES = 2, 2
LEAST_OVERRIDE, LARGEST_OVERRIDE = 1e-4, 1e4  # besides 0


class Override(Packet, frozen=True):
    """Mask of masters 0-7, mask of masters 0-15, value."""

    masters_0_7: U8
    masters_0_15: U16
    value: F32

    @classmethod
    def of(cls, masters: Iterable[int], value: float) -> Self:
        """Build the packet for these masters, with the short mask where it suffices."""
        mask = 0
        for master in masters:
            if not 0 <= master < MASTERS:
                raise PacketError(f"master {master} is not in 0..{MASTERS - 1}")
            mask |= 1 << master
        return cls(mask, 0, value) if mask < 0x100 else cls(0, mask, value)

    def masters(self) -> list[int]:
        """The masters selected by either mask."""
        mask = self.masters_0_7 | self.masters_0_15
        return [master for master in range(MASTERS) if mask >> master & 1]


@register
class FeedrateOverride(Override, frozen=True):
    """FOV: set the feedrate override of the selected masters at once."""

    HEADER: ClassVar[bytes] = b"\x07"

    def act(self, host: Host) -> bytes:
        """Set it, unless the value is not a number."""
        host.override(self.masters(), finite(self.value), rapid=False)
        return b""


@register
class RapidOverride(Override, frozen=True):
    """ROV: set the rapid feedrate override of the selected masters at once."""

    HEADER: ClassVar[bytes] = b"\x1f"

    def act(self, host: Host) -> bytes:
        """Set it, unless the value is not a number."""
        host.override(self.masters(), finite(self.value), rapid=True)
        return b""


def is_short(start: bytes) -> bool:
    """Whether the packet that starts so has six bytes in the first edition."""
    return start[:1] in (FeedrateOverride.HEADER, RapidOverride.HEADER) and start[1] != 0


def lengthened(packet: bytes) -> bytes:
    """The eight-byte form of a six-byte packet."""
    return packet[:MASK_16_AT] + bytes(MASK_16_BYTES) + packet[MASK_16_AT:]


def is_override(value: float) -> bool:
    """Whether a value can be meant as an override: 0, or a ratio a machine can follow."""
    return value == 0.0 or LEAST_OVERRIDE <= value <= LARGEST_OVERRIDE


def belongs_to_next(packet: bytes) -> bytes | None:
    """The bytes of an override that are not its own; None where its value is an override.

    Two bytes where the first six are a packet of the first edition, else nothing: it is broken.
    """
    if is_override(_value(packet, SHORT_BYTES - MASK_16_AT)):
        return None
    is_first_edition = is_short(packet) and is_override(_value(packet, MASK_16_AT))
    return packet[SHORT_BYTES:] if is_first_edition else b""


def _value(packet: bytes, at: int) -> float:
    value: float = struct.unpack_from("<f", packet, at)[0]
    return value
