"""All binary packets together: find, decode and explain any of them.

Importing this module loads the header table.
"""

from functools import lru_cache

from openacr.protocol import bits, data, memory, move, override, parameter  # noqa: F401
from openacr.protocol.host import PacketError
from openacr.protocol.packet import PACKETS, Packet, Part, Request, packet_class

__all__ = [
    "HEADER_IDS",
    "PACKETS",
    "REQUEST_BYTES",
    "Packet",
    "PacketError",
    "Part",
    "decode",
    "dpcb_padding",
    "explain",
    "request",
    "total_length",
]

REQUEST_BYTES = 4  # of the packets that ask for parameters
HEADER_IDS = frozenset(header[0] for header in PACKETS)  # bytes that begin a packet


def total_length(prefix: bytes) -> int:
    """Length of the packet that starts with `prefix` (at least its header), as far as known."""
    return _known(prefix).total_length(prefix)


def dpcb_padding(prefix: bytes) -> int:
    """Count of zero bytes that follow the packet starting with `prefix` on a DPCB."""
    found = packet_class(prefix)
    return 0 if found is None else found.DPCB_PADDING


def decode(packet: bytes) -> Packet:
    """The packet in exactly these bytes (after any MODE conversion)."""
    return _known(packet).decode(packet)


@lru_cache(maxsize=1024)  # hosts send the same ones thousands of times a second
def request(head: bytes) -> Packet | None:
    """The packet that asks for parameters and is just these bytes; None if they are not one."""
    found = packet_class(head)
    if found is None or not issubclass(found, Request):
        return None
    return found.decode(head) if found.total_length(head) == len(head) else None


def _known(prefix: bytes) -> type[Packet]:
    found = packet_class(prefix)
    if found is None:
        raise PacketError(f"no packet starts with {prefix[:2].hex(' ')}")
    return found


def explain(packet: bytes) -> str:
    """A hex dump of one packet with the meaning of every field."""
    return "\n".join(map(str, decode(packet).explain()))
