"""Declare the flags of the card: one 32-bit word of them for each object of a family.

Flag `n` is bit `n % 32` of parameter `4096 + n // 32`; see `openacr.map.block` for packets.
"""

from collections.abc import Iterator

from msgspec import Struct

from openacr.map.block import (
    BITS_PER_WORD,
    RESERVED,
    UNDOCUMENTED,
    Access,
    ManualRef,
    PacketRule,
    Span,
    Speed,
    consecutive,
)


class FlagRow(Struct, frozen=True):
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
        declared = self.rows.get(bit)
        if declared is not None:
            return declared
        access = Access.UNKNOWN if self.rest == UNDOCUMENTED else Access.RESERVED
        return FlagRow(bit, self.rest, self.rest, access, Speed.UNKNOWN, "", "", "", None)

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
