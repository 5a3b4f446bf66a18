"""What the card does with a received packet, and what it answers.

Packets are acted on when first seen, also while commands wait. A packet the card cannot act on
(a parameter, address or group that does not exist, a value that is not a number) changes
nothing; where a reply is due, undefined fields read 0, so that the host stays in step.
"""

import logging

from openacr.errors import CardError, MapError
from openacr.protocol.host import Host, PacketError
from openacr.protocol.packet import Packet

log = logging.getLogger(__name__)


def execute(host: Host, packet: Packet) -> bytes:
    """Act on a packet and give the reply to send, empty when there is none."""
    try:
        return packet.act(host)
    except (MapError, PacketError, CardError) as refused:
        log.debug("%s: %s", packet, refused)
    return b""
