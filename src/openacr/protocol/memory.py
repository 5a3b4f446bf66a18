"""Packets that address the card's memory in 32-bit words (UG2 ch. 6).

An FP64 value occupies two words, so conversion code 1 advances two addresses per value;
the other codes advance one. The data always travel as four bytes per value.
"""

import struct
from collections.abc import Sequence
from enum import IntEnum
from typing import ClassVar, Self

from openacr.errors import MapError
from openacr.protocol.host import Host, PacketError, finite, masked
from openacr.protocol.packet import (
    RESERVED_U32,
    U8,
    U32,
    WORD_BYTES,
    Packet,
    Part,
    pack_word,
    register,
)

HEAD_BYTES = 8
WORD_MASK = 0xFFFFFFFF


class Conversion(IntEnum):
    """Conversion code of peek and poke: what is stored in the card's memory."""

    LONG = 0
    FP64 = 1
    FP32 = 2

    @property
    def words(self) -> int:
        """Memory words one value occupies."""
        return 2 if self is Conversion.FP64 else 1

    @property
    def stored(self) -> str:
        """How memory holds one value: its `struct` format."""
        return {Conversion.LONG: "i", Conversion.FP64: "d", Conversion.FP32: "f"}[self]


class VariableKind(IntEnum):
    """Parameter code of the address packet: which local variables of a program."""

    DV = 0
    DA = 1
    SV = 2
    SA = 3
    LV = 4
    LA = 5
    STRING_VARIABLES = 6
    STRING_ARRAYS = 7


def _conversion(code: int) -> Conversion:
    try:
        return Conversion(code)
    except ValueError:
        raise PacketError(f"conversion code {code} is not 0, 1 or 2") from None


def _words(host: Host, address: int, count: int) -> Sequence[int]:
    """Read memory words, 0 where there is no memory."""
    try:
        return host.read_words(address, count)
    except MapError:
        return [0] * count


@register
class Peek(Packet, frozen=True):
    """Read `count` values from an address on."""

    HEADER: ClassVar[bytes] = b"\x00\x90"
    code: U8
    count: U8
    address: U32

    @property
    def conversion(self) -> Conversion:
        """How the words in memory are interpreted; PacketError for an unknown code."""
        return _conversion(self.code)

    def reply_words(self) -> int:
        """One word per value."""
        return self.count

    def act(self, host: Host) -> bytes:
        """Read the words; 0 where there is no memory."""
        conversion = self.conversion
        words = _words(host, self.address, self.count * conversion.words)
        raw = b"".join(struct.pack("<I", word & WORD_MASK) for word in words)
        return self.reply(struct.unpack(f"<{self.count}{conversion.stored}", raw))


@register
class Poke(Packet, frozen=True):
    """Write values from an address on; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x00\x91"
    code: U8
    count: U8
    address: U32
    values: tuple[int | float, ...] = ()

    @classmethod
    def of(cls, conversion: Conversion, address: int, values: tuple[int | float, ...]) -> Self:
        """The packet that writes these values (LONG: integers, else floats)."""
        return cls(conversion, len(values), address, values)

    @classmethod
    def total_length(cls, prefix: bytes) -> int:
        """Length of the head plus one word per value, once the count is received."""
        return HEAD_BYTES + (WORD_BYTES * prefix[3] if len(prefix) > 3 else 0)

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Decode a packet; data are integers for code 0 and IEEE otherwise."""
        if len(data) < HEAD_BYTES or len(data) != cls.total_length(data):
            raise PacketError(f"Poke: {len(data)} bytes do not fit the count")
        code, count, address = struct.unpack_from("<BBI", data, 2)
        kind = "i" if code == Conversion.LONG else "f"
        return cls(code, count, address, struct.unpack_from(f"<{count}{kind}", data, HEAD_BYTES))

    def encode(self) -> bytes:
        """Encode head and data."""
        if len(self.values) != self.count or self.count > 255:
            raise PacketError(f"Poke: {len(self.values)} values, count {self.count}, at most 255")
        whole = self.code == Conversion.LONG
        data = [pack_word(int(v) if whole else float(v)) for v in self.values]
        return (
            self.HEADER + struct.pack("<BBI", self.code, self.count, self.address) + b"".join(data)
        )

    def value_count(self) -> int:
        """The values it writes."""
        return self.count

    @property
    def conversion(self) -> Conversion:
        """How the values are stored in memory; PacketError for an unknown code."""
        return _conversion(self.code)

    def act(self, host: Host) -> bytes:
        """Store the values, unless one is not a number."""
        conversion = self.conversion
        is_whole = conversion is Conversion.LONG
        values = self.values if is_whole else tuple(map(finite, self.values))
        raw = struct.pack(f"<{self.count}{conversion.stored}", *values)
        host.write_words(self.address, struct.unpack(f"<{len(raw) // WORD_BYTES}i", raw))
        return b""

    def explain(self) -> list[Part]:
        """Head and one line per value."""
        data = self.encode()
        parts = [
            Part(data[:2], "header", "Poke"),
            Part(data[2:3], "code", self.code),
            Part(data[3:4], "count", self.count),
            Part(data[4:8], "address", self.address),
        ]
        return parts + [
            Part(data[at : at + WORD_BYTES], f"value {n}", value)
            for n, value in enumerate(self.values)
            for at in (HEAD_BYTES + WORD_BYTES * n,)
        ]


@register
class VariableAddress(Packet, frozen=True):
    """Query the address of the local variables of one kind; 0: the program has none."""

    HEADER: ClassVar[bytes] = b"\x00\x92"
    program: U8
    kind: U8

    def reply_words(self) -> int:
        """The address."""
        return 1

    def act(self, host: Host) -> bytes:
        """Return the address."""
        return self.reply([host.variable_address(self.program, self.kind)])


@register
class MaskMemory(Packet, frozen=True):
    """Clear the bits of `nand_mask`, then set those of `or_mask`, in a word of memory."""

    # The layout prints BYTE for the three fields (erratum); the example has four bytes each.
    HEADER: ClassVar[bytes] = b"\x00\x94"
    address: RESERVED_U32
    nand_mask: U32
    or_mask: U32

    def act(self, host: Host) -> bytes:
        """Mask the word."""
        word = host.read_words(self.address, 1)[0]
        host.write_words(self.address, [masked(word, self.nand_mask, self.or_mask)])
        return b""
