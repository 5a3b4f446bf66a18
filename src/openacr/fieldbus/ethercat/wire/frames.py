"""Ethernet frames of EtherCAT and the datagrams in them.

A frame visits every slave in turn; each reads from it, writes into it and adds to the working
counter of every datagram that concerns it: 1 for a read, 1 for a write, and for a command that
does both 1 for the read and 2 for the write.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from struct import Struct

from openacr.errors import UserError

ETHERTYPE = 0x88A4
BROADCAST = b"\xff" * 6
MASTER = bytes.fromhex("020000000001")  # locally administered
TO_SLAVES = 1  # the kind of a frame of datagrams
ETHERNET_SIZE = 14
FIRST = ETHERNET_SIZE + 2  # where the first datagram is
SHORTEST_FRAME = 60
LONGEST_FRAME = 1514
LONGEST_DATA = LONGEST_FRAME - FIRST - 12  # of a single datagram
LENGTH_MASK = 0x07FF
CIRCULATING = 0x4000
MORE = 0x8000
RETURNED = 0x02  # bit of the first byte of the source address, which slaves set

# command, index, two words of address, length with its bits, event request
DATAGRAM = Struct("<BBHHHH")
HEADER_SIZE = DATAGRAM.size
COUNTER_SIZE = 2
_WORD = Struct("<H")


class WireError(UserError):
    """Bytes that are not what the standard says."""


class Command(IntEnum):
    """What a datagram asks: by position (A), by station address (F), of all (B), logical (L)."""

    NOP = 0
    APRD = 1
    APWR = 2
    APRW = 3
    FPRD = 4
    FPWR = 5
    FPRW = 6
    BRD = 7
    BWR = 8
    BRW = 9
    LRD = 10
    LWR = 11
    LRW = 12
    ARMW = 13
    FRMW = 14


@dataclass(slots=True)
class Datagram:
    """One datagram: `position` and `offset` are the two words of its address.

    `position` is the auto-increment position, the station address or nothing (broadcast);
    `offset` the register. A logical address is both, the low word first.
    """

    command: int
    position: int
    offset: int
    data: bytes
    index: int = 0
    counter: int = 0
    events: int = 0
    circulated: bool = False

    @property
    def address(self) -> int:
        """The logical address."""
        return self.position | self.offset << 16


def by_position(command: Command, slave: int, register: int, data: bytes) -> Datagram:
    """A datagram for the slave at a position, counted from 0."""
    return Datagram(command, -slave & 0xFFFF, register, data)


def by_station(command: Command, station: int, register: int, data: bytes) -> Datagram:
    """A datagram for the slave with a station address; also for broadcasts, with address 0."""
    return Datagram(command, station, register, data)


def by_logical(command: Command, address: int, data: bytes) -> Datagram:
    """A datagram for a range of the logical address space of 32 bits."""
    return Datagram(command, address & 0xFFFF, address >> 16, data)


def pack(datagrams: Iterable[Datagram], source: bytes = MASTER) -> bytes:
    """A whole frame; WireError without a datagram or if they are too long for a frame."""
    parts = [_packed(datagram) for datagram in datagrams]
    if not parts:
        raise WireError("an EtherCAT frame has at least one datagram")
    for part in parts[:-1]:
        _WORD.pack_into(part, 6, _WORD.unpack_from(part, 6)[0] | MORE)
    body = b"".join(parts)
    if FIRST + len(body) > LONGEST_FRAME:
        most = LONGEST_FRAME - FIRST
        raise WireError(f"datagrams of {len(body)} bytes: a frame has room for {most}")
    head = BROADCAST + source + ETHERTYPE.to_bytes(2, "big")
    frame = head + _WORD.pack(len(body) | TO_SLAVES << 12) + body
    return frame.ljust(SHORTEST_FRAME, b"\0")


def parse(frame: bytes) -> list[Datagram]:
    """The datagrams of a frame; WireError if it is not one of EtherCAT or is cut off."""
    end = end_of(frame)
    found: list[Datagram] = []
    place = FIRST
    more = True
    while more:
        if place + HEADER_SIZE + COUNTER_SIZE > end:
            raise WireError(f"the frame ends in datagram {len(found) + 1}")
        command, index, position, offset, bits, events = DATAGRAM.unpack_from(frame, place)
        start = place + HEADER_SIZE
        place = start + (bits & LENGTH_MASK)
        if place + COUNTER_SIZE > end:
            raise WireError(f"the frame ends in datagram {len(found) + 1}")
        (counter,) = _WORD.unpack_from(frame, place)
        data = bytes(frame[start:place])
        circulated = bool(bits & CIRCULATING)
        found.append(Datagram(command, position, offset, data, index, counter, events, circulated))
        place += COUNTER_SIZE
        more = bool(bits & MORE)
    return found


def end_of(frame: bytes | bytearray) -> int:
    """Where the datagrams of a frame end; WireError if it is no frame of datagrams."""
    if len(frame) < FIRST or int.from_bytes(frame[12:14], "big") != ETHERTYPE:
        raise WireError("no EtherCAT frame: its type is not 0x88A4")
    (head,) = _WORD.unpack_from(frame, ETHERNET_SIZE)
    if head >> 12 != TO_SLAVES:
        raise WireError(f"EtherCAT frame of type {head >> 12}: only type 1 has datagrams")
    end: int = FIRST + (head & LENGTH_MASK)
    if end > len(frame):
        raise WireError(f"the frame has {len(frame)} bytes, its datagrams need {end}")
    return end


def _packed(datagram: Datagram) -> bytearray:
    size = len(datagram.data)
    if size > LONGEST_DATA:
        raise WireError(f"a datagram of {size} bytes: at most {LONGEST_DATA}")
    bits = size | (CIRCULATING if datagram.circulated else 0)
    head = DATAGRAM.pack(
        datagram.command,
        datagram.index,
        datagram.position,
        datagram.offset,
        bits,
        datagram.events,
    )
    return bytearray(head + datagram.data + _WORD.pack(datagram.counter))
