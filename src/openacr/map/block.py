"""Declare the numbered objects of the card: state the rule of a family, then its rows.

A `Block` is a family of equal objects (axes, masters, encoders...) whose parameters lie a
fixed stride apart; a `FlagBlock` (flag_block.py) is a family of 32-bit flag words. Numbers, packet
addresses and flag numbers are never written down per object, they follow from the rule:

- row `offset` of object `n` is parameter `base + stride * n + offset`;
- flag `n` is bit `n % 32` of parameter `4096 + n // 32`;
- the binary protocol fetches eight parameters with one packet: a group code, an index and
  a mask with one bit for each of the eight. Which eight belong together depends on the
  code, see `consecutive`, `sixteen_apart` and `objects_apart`.

Where a manual prints another number than its own rule gives, the row says so in `erratum`.
"""

from collections.abc import Callable, Iterable, Iterator
from enum import Enum, StrEnum

from msgspec import Struct

from openacr.units import WORDS, words_of

FLAG_WORD_BASE = 4096
FLAG_LAST = 17663
BITS_PER_WORD = 32
RESERVED = "Reserved"
UNDOCUMENTED = "Undocumented"


class Kind(StrEnum):
    """How a parameter is stored."""

    LONG = "LONG"
    FP32 = "FP32"
    FP64 = "FP64"


class Access(StrEnum):
    """What the manual lets a user do; the card itself stores every write."""

    READ = "r"
    WRITE = "w"
    READ_WRITE = "rw"
    RESERVED = "reserved"
    UNKNOWN = "unknown"


class Speed(StrEnum):
    """How often the card updates a flag: each servo period or in the slow scan."""

    FAST = "fast"
    SLOW = "slow"
    UNKNOWN = ""


class ManualRef(Enum):
    """Where a table is printed."""

    USER_GUIDE = "User's Guide Part 2, Appendix A"
    FLAG_TABLES = "User's Guide Part 2, Appendix B"
    PACKETS = "User's Guide Part 2, chapter 6"
    PROGRAMMERS_GUIDE = "ACR Programmer's Guide"
    KNOWLEDGE_BASE = "Parker knowledge base"


LONG, FP32, FP64 = Kind.LONG, Kind.FP32, Kind.FP64
R, W, RW = Access.READ, Access.WRITE, Access.READ_WRITE
NS = Access.UNKNOWN  # not stated
FAST, SLOW = Speed.FAST, Speed.SLOW


class Packet(Struct, frozen=True):
    """Address of a parameter in the binary protocol: group code, index and mask bit."""

    code: int
    group_index: int
    mask: int


PacketRule = Callable[[int], Packet]


def consecutive(code: int) -> PacketRule:
    """Eight neighbouring parameters form a group; the numbers start at 256 * code."""

    def address(number: int) -> Packet:
        index, position = divmod(number - 256 * code, 8)
        return Packet(code, index, 1 << position)

    return address


def sixteen_apart(number: int) -> Packet:
    """The same parameter of eight objects 16 numbers apart; index bit 7: objects 8 to 15."""
    upper_half = number & 0x80
    return Packet(number >> 8, upper_half | number & 0x0F, 1 << (number >> 4 & 7))


def objects_apart(number: int) -> Packet:
    """The same parameter of eight objects 256 numbers apart."""
    return Packet(number >> 11 << 3, number & 0xFF, 1 << (number >> 8 & 7))


class Span(Struct, frozen=True):
    """A run of objects (or flag words): number of the first, how many."""

    first: int
    count: int


class Row(Struct, frozen=True):
    """One parameter of every object of a block."""

    offset: int
    name: str
    kind: Kind
    access: Access
    section: str
    doc: str
    unit: str
    default: float | tuple[float, ...]
    ident: str
    erratum: str
    erratum_at: int | None

    @property
    def is_reserved(self) -> bool:
        """Printed as Reserved: exists in the map, has no meaning."""
        return self.access is Access.RESERVED

    def default_of(self, index: int) -> float:
        """Power-up value in object `index`."""
        return self.default[index] if isinstance(self.default, tuple) else self.default


class Block:
    """A family of objects with the same parameters.

    `named` counts the objects whose rows have a meaning; further ones are reserved.
    """

    def __init__(
        self,
        title: str,
        *,
        object: str,
        prefix: str,
        family: str = "",
        spans: tuple[Span, ...],
        stride: int = 0,
        packet: PacketRule | None = None,
        packet_erratum: str = "",
        ref: ManualRef = ManualRef.USER_GUIDE,
        section_of: Callable[[int], str] | None = None,
        named: int | None = None,
        indexed: bool = True,
    ) -> None:
        self.title, self.object, self.prefix = title, object, prefix
        self.family = family
        self.spans, self.stride, self.packet, self.ref = spans, stride, packet, ref
        self.packet_erratum = packet_erratum
        self.section_of, self.indexed = section_of, indexed
        self.named = self.count if named is None else named
        self.rows: dict[int, Row] = {}
        self._section = title

    @property
    def count(self) -> int:
        """How many objects the family has."""
        return sum(span.count for span in self.spans)

    def section(self, title: str) -> None:
        """Head the following rows, as the manual's table does."""
        self._section = title

    def row(
        self,
        offset: int,
        name: str,
        kind: Kind,
        access: Access = Access.UNKNOWN,
        unit: str = "",
        doc: str = "",
        *,
        default: float | tuple[float, ...] = 0,
        ident: str = "",
        erratum: str = "",
        erratum_at: int | None = None,
    ) -> None:
        """Declare one parameter; an erratum may concern only object `erratum_at`."""
        if offset in self.rows:
            raise ValueError(f"{self.title}: offset {offset:#x} is declared twice")
        if unknown := set(words_of(unit)) - set(WORDS):
            raise ValueError(f"{self.title}: {name} has no unit {', '.join(unknown)}")
        self.rows[offset] = Row(
            offset, name, kind, access, self._section, doc, unit, default, ident, erratum,
            erratum_at,
        )  # fmt: skip

    def reserved(self, kind: Kind, offsets: Iterable[int]) -> None:
        """Declare parameters that are printed as Reserved."""
        for offset in offsets:
            self.row(offset, RESERVED, kind, Access.RESERVED)

    def bases(self) -> Iterator[int]:
        """Number of the first parameter of each object."""
        for span in self.spans:
            for position in range(span.count):
                yield span.first + self.stride * position
