"""Common parts of all binary packets: fields, header table, replies and hex explanation.

A packet is a frozen struct whose annotations are its wire layout; `act` is its effect on
the card. Decoding, encoding, the length of an incomplete packet and the explanation of a hex
dump are derived from the annotations, so a new packet is one class in one file.
Every reply of the card is the request repeated, followed by four-byte words (UG2 ch. 6).
"""

import struct
from abc import ABCMeta, abstractmethod
from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Annotated, ClassVar, Self, TypeVar, get_type_hints

from msgspec import Struct, StructMeta

from openacr.protocol.host import Host, PacketError

WORD_BYTES = 4


class Wire(Struct, frozen=True):
    """The wire form of one field: a `struct` format, low byte first."""

    format: str

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return struct.calcsize("<" + self.format)


U8 = Annotated[int, Wire("B")]
U16 = Annotated[int, Wire("H")]
I32 = Annotated[int, Wire("i")]
U32 = Annotated[int, Wire("I")]
F32 = Annotated[float, Wire("f")]
RESERVED_U32 = Annotated[int, Wire("2xI")]  # after two reserved bytes


class Part(Struct, frozen=True):
    """One line of an explained hex dump: the bytes, name and value of a field."""

    data: bytes
    name: str
    value: object

    def __str__(self) -> str:
        return f"{self.data.hex(' ').upper():<24}{self.name} = {self.value}"


class PacketMeta(StructMeta, ABCMeta):
    """Structs with abstract methods."""


class Packet(Struct, metaclass=PacketMeta, frozen=True):
    """Base of all packets a host can send."""

    HEADER: ClassVar[bytes]
    DPCB_PADDING: ClassVar[int] = 0  # zero bytes that follow it on a DPCB

    @classmethod
    def total_length(cls, prefix: bytes) -> int:
        """Length of the packet as far as known from `prefix`; more bytes may increase it."""
        return _form(cls).length

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """The packet in exactly these bytes."""
        form = _form(cls)
        if len(data) != form.length:
            raise PacketError(f"{cls.__name__}: {len(data)} bytes, {form.length} wanted")
        return cls(*form.fields.unpack_from(data, len(cls.HEADER)))

    def encode(self) -> bytes:
        """The bytes a host sends, before any MODE conversion."""
        form = _form(type(self))
        try:
            return self.HEADER + form.fields.pack(*[getattr(self, name) for name in form.names])
        except (struct.error, OverflowError) as wrong:
            raise PacketError(f"{self}: {wrong}") from None

    @abstractmethod
    def act(self, host: Host) -> bytes:
        """Execute the packet on a card and return the reply, empty if it has none.

        MapError, CardError or PacketError if impossible: then nothing has changed.
        """

    def parameters(self) -> Iterable[int]:
        """The parameters that the packet names by number."""
        return ()

    def flags(self) -> Iterable[int]:
        """The flags that the packet names by number."""
        return ()

    def reply_words(self) -> int:
        """Four-byte words after the repeated request; 0 when the card sends nothing."""
        return 0

    def value_count(self) -> int:
        """Values that the packet reads or pokes."""
        return self.reply_words()

    def reply(self, values: Sequence[int | float]) -> bytes:
        """Build the reply: the request repeated, then integers as LONG, floats as IEEE."""
        return self.encode() + b"".join(map(pack_word, values))

    def explain(self) -> list[Part]:
        """The fields of the packet one by one, for hex dumps and documentation."""
        data = self.encode()
        at = len(self.HEADER)
        parts = [Part(data[:at], "header", type(self).__name__)]
        for name, wire in wires(type(self)):
            value = getattr(self, name)
            parts.append(Part(data[at : at + wire.size], name.replace("_", " "), value))
            at += wire.size
        return parts


class Request(Packet, frozen=True):
    """Base of the packets that ask for parameters; their fields are whole numbers.

    Hosts send the same ones thousands of times a second.
    """

    def encode(self) -> bytes:
        """The bytes a host sends, before any MODE conversion."""
        return _encoded(self)


@lru_cache(maxsize=1024)
def _encoded(request: Request) -> bytes:
    return Packet.encode(request)


_WIRES: dict[type[Packet], tuple[tuple[str, Wire], ...]] = {}


def wires(packet: type[Packet]) -> tuple[tuple[str, Wire], ...]:
    """Name and wire form of every field of a packet class, in wire order."""
    if packet not in _WIRES:
        hints = get_type_hints(packet, include_extras=True)
        _WIRES[packet] = tuple(
            (name, mark)
            for name in packet.__struct_fields__
            for mark in getattr(hints[name], "__metadata__", ())
            if isinstance(mark, Wire)
        )
    return _WIRES[packet]


class _Form(Struct, frozen=True):
    """The wire layout of a packet class, computed once."""

    names: tuple[str, ...]
    fields: struct.Struct
    length: int


_FORMS: dict[type[Packet], _Form] = {}


def _form(packet: type[Packet]) -> _Form:
    form = _FORMS.get(packet)
    if form is None:
        found = wires(packet)
        fields = struct.Struct("<" + "".join(wire.format for _, wire in found))
        names = tuple(name for name, _ in found)
        form = _FORMS[packet] = _Form(names, fields, len(packet.HEADER) + fields.size)
    return form


_pack_long, _pack_ieee = struct.Struct("<I").pack, struct.Struct("<f").pack


def pack_word(value: int | float) -> bytes:
    """One reply word: an integer wraps to 32 bits, a float saturates to IEEE infinity."""
    if isinstance(value, int):
        return _pack_long(value & 0xFFFFFFFF)
    try:
        return _pack_ieee(value)
    except OverflowError:
        return _pack_ieee(float("inf") if value > 0 else float("-inf"))


PACKETS: dict[bytes, type[Packet]] = {}
P = TypeVar("P", bound=type[Packet])


def register(packet: P) -> P:
    """Enter a packet class into the header table; ValueError if its header is taken."""
    if packet.HEADER in PACKETS:
        raise ValueError(f"two packets start with {packet.HEADER.hex(' ')}")
    PACKETS[packet.HEADER] = packet
    return packet


def packet_class(prefix: bytes) -> type[Packet] | None:
    """The class of packets that start with `prefix`; None if no header matches (yet)."""
    return PACKETS.get(prefix[:2]) or PACKETS.get(prefix[:1])
