"""The three-byte packets that set or clear one flag at once (UG2 ch. 6).

On the DPCB of the ACR8020 a zero byte belongs to every such packet. Some hosts send it
over the network as well: there it counts as padding when it directly follows in the same
segment and nothing else does; `framing` decides that.
"""

from dataclasses import dataclass
from typing import ClassVar

from openacr.protocol.packet import U16, Packet, register


@register
@dataclass(frozen=True, slots=True)
class SetBit(Packet):
    """Set a flag, not queued; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x1c"
    bit: U16


@register
@dataclass(frozen=True, slots=True)
class ClearBit(Packet):
    """Clear a flag, not queued; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x1d"
    bit: U16
