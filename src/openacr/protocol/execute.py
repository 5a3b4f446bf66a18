"""Execute a received packet and return its reply.

Packets are executed on arrival, also while commands wait. A packet the card cannot execute
(a parameter, address or group that does not exist, a value that is not a number) changes
nothing; where a reply is due, undefined fields read 0, so that the host stays in step.
"""

import logging

from openacr.errors import CardError, MapError
from openacr.protocol.host import Host, PacketError
from openacr.protocol.packet import Packet

log = logging.getLogger(__name__)


def execute(host: Host, packet: Packet) -> bytes:
    """Execute a packet and return the reply to send, empty if it has none."""
    try:
        return packet.act(host)
    except (MapError, PacketError, CardError) as refused:
        log.debug("%s: %s", packet, refused)
    return b""
