"""Declare the numbered objects of the card: state the rule of a family, then its rows.

A `Block` is a family of equal objects (axes, masters, encoders...) whose parameters lie a
fixed stride apart; a `FlagBlock` is a family of 32-bit flag words. Numbers, packet
addresses and flag numbers are never written down per object, they follow from the rule:

- row `offset` of object `n` is parameter `base + stride * n + offset`;
- flag `n` is bit `n % 32` of parameter `4096 + n // 32`;
- the binary protocol fetches eight parameters with one packet: a group code, an index and
  a mask with one bit for each of the eight. Which eight belong together depends on the
  code, see `consecutive`, `sixteen_apart` and `objects_apart`.

Where a manual prints another number than its own rule gives, the row says so in `erratum`.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum, StrEnum

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


@dataclass(frozen=True, slots=True)
class Packet:
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


@dataclass(frozen=True, slots=True)
class Span:
    """A run of objects (or flag words): number of the first, how many."""

    first: int
    count: int


@dataclass(frozen=True, slots=True)
class Row:
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


@dataclass(frozen=True, slots=True)
class FlagRow:
    """One flag of every word of a flag block."""

    bit: int
    name: str
    printed: str
    access: Access
    speed: Speed
    doc: str
    ident: str
    erratum: str
    erratum_at: int | None

    @property
    def is_reserved(self) -> bool:
        """Printed as Reserved or Spare: exists in the map, has no meaning."""
        return self.access is Access.RESERVED

    @property
    def mask(self) -> int:
        """The bit as a signed 32-bit number, as a LONG parameter shows it."""
        return 1 << self.bit if self.bit < BITS_PER_WORD - 1 else -(1 << self.bit)


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


class FlagBlock:
    """A family of flag words: one word of 32 flags for each object.

    Bits without a row are called `rest`; names may contain `{n}`, the number of the
    object, and `{io}`, the number of the flag among all flags of its object. Where one
    word serves several kinds of object, `parts` gives the first bit of each.
    """

    def __init__(
        self,
        title: str,
        *,
        object: str,
        prefix: str,
        spans: tuple[Span, ...],
        word_name: str,
        group: str | tuple[str, ...] = "",
        ident: str = "",
        packet: PacketRule | None = None,
        ref: ManualRef = ManualRef.FLAG_TABLES,
        first_index: int | None = 0,
        words_per_object: int = 1,
        named: int | None = None,
        parts: tuple[tuple[int, str], ...] = (),
        rest: str = RESERVED,
        word_access: Access = Access.UNKNOWN,
        word_doc: str = "",
        word_erratum: str = "",
        word_erratum_from: int = 0,
    ) -> None:
        self.title, self.object, self.prefix = title, object, prefix
        self.spans, self.word_name, self.ident = spans, word_name, ident
        self.groups = group if isinstance(group, tuple) else (group or title,) * len(spans)
        self.packet, self.ref = packet, ref
        self.first_index, self.words_per_object = first_index, words_per_object
        self.named = self.count if named is None else named
        self.parts = parts or ((0, object),)
        self.rest, self.word_access = rest, word_access
        self.word_doc, self.word_erratum = word_doc, word_erratum
        self.word_erratum_from = word_erratum_from
        self.rows: dict[int, FlagRow] = {}

    @property
    def count(self) -> int:
        """How many words the family has."""
        return sum(span.count for span in self.spans)

    def row(
        self,
        bit: int,
        name: str,
        access: Access = Access.UNKNOWN,
        doc: str = "",
        speed: Speed = Speed.UNKNOWN,
        *,
        printed: str = "",
        ident: str = "",
        erratum: str = "",
        erratum_at: int | None = None,
    ) -> None:
        """Declare one flag; `printed` is the manual's name where ours says more."""
        if bit in self.rows or not 0 <= bit < BITS_PER_WORD:
            raise ValueError(f"{self.title}: bit {bit} is declared twice or is not 0 to 31")
        self.rows[bit] = FlagRow(
            bit, name, printed or name, access, speed, doc, ident, erratum, erratum_at
        )

    def inferred(self, bit: int, name: str, access: Access, doc: str) -> None:
        """Declare a flag that exists but has no name in the manual's table."""
        self.row(bit, name, access, doc=doc, printed=self.rest)

    def reserved(self, *bits: int) -> None:
        """Declare flags that are printed as Reserved."""
        for bit in bits:
            self.row(bit, RESERVED, Access.RESERVED)

    def places(self) -> Iterator[tuple[int, int, str]]:
        """Position in the family, parameter number and heading of each word."""
        position = 0
        for span, group in zip(self.spans, self.groups, strict=True):
            for number in range(span.first, span.first + span.count):
                yield position, number, f"Flag Parameters: {group}"
                position += 1

    def index_of(self, position: int) -> int | None:
        """Number of the object the word at `position` of the family belongs to."""
        if self.first_index is None:
            return None
        return self.first_index + position // self.words_per_object

    def io_of(self, position: int) -> int:
        """Number of the word's first flag among all flags of its object."""
        return BITS_PER_WORD * (position % self.words_per_object)

    def word_title(self, position: int) -> str:
        """Name of the word as a parameter."""
        first = self.io_of(position)
        last = first + BITS_PER_WORD - 1
        return self.word_name.format(n=self.index_of(position), first=first, last=last)

    def flag(self, bit: int) -> FlagRow:
        """The declared flag, or the row that stands for all undeclared ones."""
        access = Access.UNKNOWN if self.rest == UNDOCUMENTED else Access.RESERVED
        rest = FlagRow(bit, self.rest, self.rest, access, Speed.UNKNOWN, "", "", "", None)
        return self.rows.get(bit, rest)

    def object_of(self, bit: int) -> str:
        """Kind of object a flag belongs to."""
        return next(name for first, name in reversed(self.parts) if bit >= first)


def reserved_words(title: str, span: Span) -> FlagBlock:
    """Flag words that are printed as Reserved altogether."""
    return FlagBlock(
        title,
        object="",
        prefix="",
        spans=(span,),
        word_name=RESERVED,
        packet=consecutive(0x10),
        first_index=None,
        word_access=Access.RESERVED,
    )
