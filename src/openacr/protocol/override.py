"""Feedrate and rapid feedrate override of several masters at once (UG2 ch. 6).

Eight bytes in all. The first edition prints six where the mask in byte 1 is enough: the two
bytes of the 16 master mask are there only behind a zero. It also starts its ROV examples
with the FOV header. The later guide corrects both (errata) and lets byte 1 be set in eight
bytes, so a card accepts one of the two forms: the later one, unless `machine.toml` says
`short_override_packets = true`.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar, Self

from openacr.protocol.packet import F32, U8, U16, Packet, PacketError, register

MASTERS = 16
SHORT_BYTES = 6
MASK_16_AT, MASK_16_BYTES = 2, 2


@dataclass(frozen=True, slots=True)
class _Override(Packet):
    """Mask of masters 0-7, mask of masters 0-15, value."""

    masters_0_7: U8
    masters_0_15: U16
    value: F32

    @classmethod
    def of(cls, masters: Iterable[int], value: float) -> Self:
        """The packet for these masters, in the short mask as far as that reaches."""
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
@dataclass(frozen=True, slots=True)
class FeedrateOverride(_Override):
    """FOV: set the feedrate override of the selected masters at once."""

    HEADER: ClassVar[bytes] = b"\x07"


@register
@dataclass(frozen=True, slots=True)
class RapidOverride(_Override):
    """ROV: set the rapid feedrate override of the selected masters at once."""

    HEADER: ClassVar[bytes] = b"\x1f"


def is_short(start: bytes) -> bool:
    """Whether the first edition ends the packet that starts so behind six bytes."""
    return start[:1] in (FeedrateOverride.HEADER, RapidOverride.HEADER) and start[1] != 0


def lengthened(packet: bytes) -> bytes:
    """The eight bytes of a packet of six."""
    return packet[:MASK_16_AT] + bytes(MASK_16_BYTES) + packet[MASK_16_AT:]
