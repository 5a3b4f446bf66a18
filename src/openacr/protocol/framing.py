"""Cuts binary packets out of a byte stream: lengths, MODE conversion, time-out, padding.

A packet may arrive in any number of pieces; when the gap between two bytes exceeds the
time-out of the channel, the bytes received so far are discarded and the next byte begins
new input. Time is an argument: this module reads no clock.

Two kinds of packet have two lengths, which the bytes do not distinguish: SET and CLR on a
DPCB, FOV and ROV of hosts written after the first edition of the manual (`override`).
"""

from dataclasses import dataclass, field
from typing import Annotated

from msgspec import Meta, Struct

from openacr.channels import BinaryMode
from openacr.protocol.escape import Decoder
from openacr.protocol.override import SHORT_BYTES, is_short, lengthened
from openacr.protocol.packets import Packet, PacketError, decode, dpcb_padding, total_length

LONGEST_HEAD = 9  # bytes that determine the length of any packet: all codes of a move
LONGEST_PACKET = 1024  # bytes; longer than any packet


class ReaderState(Struct, frozen=True):
    """The state of an incomplete packet in a snapshot."""

    data: Annotated[bytes, Meta(max_length=LONGEST_PACKET)]
    tick: int
    wanted: Annotated[int, Meta(ge=0, le=LONGEST_PACKET)]
    mode: Annotated[int, Meta(ge=0, le=3)]
    prefixed: bool
    high: bool


@dataclass(slots=True)
class PacketReader:
    """Collects one packet at a time.

    `dpcb` makes SET and CLR four bytes long, `short_overrides` most of FOV and ROV six.
    """

    dpcb: bool = False
    short_overrides: bool = False
    _data: bytearray = field(default_factory=bytearray)
    _decoder: Decoder = field(default_factory=lambda: Decoder(BinaryMode.PLAIN))
    _tick: int = 0
    _is_plain: bool = True  # nothing has to be converted
    _wanted: int = 0  # length in bytes, as far as known from those received

    @property
    def reading(self) -> bool:
        """Whether a packet has started and is not complete."""
        return bool(self._data)

    @property
    def whole_bytes(self) -> int:
        """Count of bytes that may be fed together: 1 if they have to be converted."""
        return self._wanted - len(self._data) if self._is_plain else 1

    def whole_packet(self, data: bytes, at: int) -> bytes:
        """The packet at an index of plain data; empty unless it is certainly complete.

        Hosts send packets whole, thousands per second: these need no collecting.
        """
        if self.dpcb or self.short_overrides:
            return b""
        try:
            length = total_length(data[at : at + LONGEST_HEAD])
        except PacketError:
            return b""
        return data[at : at + length] if at + length <= len(data) else b""

    def start(self, header: int, mode: BinaryMode, tick: int) -> None:
        """Begin a packet with its header byte; the data after it are encoded for `mode`."""
        self._data = bytearray((header,))
        self._decoder = Decoder(mode)
        self._is_plain = not mode.prefixes
        self._tick = tick
        self._wanted = 2

    def continues(self, tick: int, timeout_tk: int) -> bool:
        """Whether a byte at `tick` belongs to the packet that has started.

        After too long a gap it does not: an incomplete packet is discarded.
        """
        if self._data and tick - self._tick > timeout_tk:
            self._data.clear()
        return bool(self._data)

    def feed(self, data: bytes, tick: int) -> Packet | None:
        """The packet completed by at most `whole_bytes` bytes; PacketError for a broken one."""
        self._tick = tick
        if self._is_plain:
            self._data += data
        else:
            value = self._decoder.feed(data[0])
            if value is None:
                return None
            self._data.append(value)
        return self._complete() if len(self._data) >= self._wanted else None

    def _complete(self) -> Packet | None:
        so_far = bytes(self._data)
        if self.short_overrides and is_short(so_far):
            return self._complete_short(so_far)
        try:
            length = total_length(so_far)
        except PacketError:
            self._data.clear()
            raise
        self._wanted = length + (dpcb_padding(so_far) if self.dpcb else 0)
        if len(so_far) < self._wanted:
            return None
        self._data.clear()
        return decode(so_far[:length])

    def _complete_short(self, so_far: bytes) -> Packet | None:
        self._wanted = SHORT_BYTES
        if len(so_far) < self._wanted:
            return None
        self._data.clear()
        return decode(lengthened(so_far))

    # snapshot

    def state(self) -> ReaderState:
        """The state for a snapshot, without the properties of the stream."""
        mode = int(self._decoder.mode)
        pending = self._decoder.prefixed, self._decoder.high
        return ReaderState(bytes(self._data), self._tick, self._wanted, mode, *pending)

    def restore(self, state: ReaderState) -> None:
        """Restore what `state` returned."""
        mode = BinaryMode(state.mode)
        self._data, self._tick = bytearray(state.data), state.tick
        self._wanted = max(state.wanted, len(state.data) + 1)
        self._decoder = Decoder(mode, state.prefixed, state.high)
        self._is_plain = not mode.prefixes
