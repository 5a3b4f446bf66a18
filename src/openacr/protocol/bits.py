"""The three-byte packets that set or clear one flag at once (UG2 ch. 6).

On the DPCB of the ACR8020 a zero byte belongs to every such packet. Some hosts send it
over the network as well: there it counts as padding when it directly follows in the same
segment and is the last byte of it; `terminal` decides that.
"""

from typing import ClassVar

from openacr.protocol.host import Host
from openacr.protocol.packet import U16, Packet, register


class _OneFlag(Packet, frozen=True):
    """Holds the number of a flag."""

    DPCB_PADDING: ClassVar[int] = 1
    bit: U16

    def flags(self) -> tuple[int]:
        """The number of the flag."""
        return (self.bit,)


@register
class SetBit(_OneFlag, frozen=True):
    """Set a flag, not queued; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x1c"

    def act(self, host: Host) -> bytes:
        """Set the flag."""
        host.write_bit(self.bit, True)
        return b""


@register
class ClearBit(_OneFlag, frozen=True):
    """Clear a flag, not queued; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x1d"

    def act(self, host: Host) -> bytes:
        """Clear the flag."""
        host.write_bit(self.bit, False)
        return b""
