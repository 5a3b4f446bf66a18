"""Find out what a parameter or flag is: by number, by name, by object and name.

The tables load at the first question, so that importing the map stays cheap.
"""

import re
from collections.abc import Iterable
from functools import cache
from typing import TypeVar

from msgspec import Struct

from openacr.errors import MapError
from openacr.map.block import (
    BITS_PER_WORD,
    FLAG_WORD_BASE,
    RESERVED,
    UNDOCUMENTED,
    Access,
    Block,
    Kind,
    Packet,
    Row,
    Speed,
)
from openacr.map.flag_block import FlagBlock, FlagRow


class Parameter(Struct, frozen=True):
    """Everything known about one parameter; `index` tells which of several objects."""

    number: int
    name: str
    kind: Kind
    access: Access
    object: str
    index: int | None
    section: str
    packet: Packet | None
    description: str
    unit: str
    default: float
    ref: str
    erratum: str


class Flag(Struct, frozen=True):
    """Everything known about one flag; `printed` is the manual's own name for it."""

    number: int
    name: str
    printed: str
    access: Access
    speed: Speed
    parameter: int
    bit: int
    object: str
    index: int | None
    section: str
    description: str
    ref: str
    erratum: str

    @property
    def mask(self) -> int:
        """The flag's bit in its parameter, as a signed 32-bit number."""
        return 1 << self.bit if self.bit < BITS_PER_WORD - 1 else -(1 << self.bit)


_T = TypeVar("_T")
_Record = TypeVar("_Record", Parameter, Flag)


@cache
def parameters() -> dict[int, Parameter]:
    """All parameters by number."""
    return {number: parameter(number) for number in sorted({*_rows(), *_flag_words()})}


@cache
def flags() -> dict[int, Flag]:
    """All flags by number."""
    return {found.number: found for word in sorted(_flag_words()) for found in flags_of(word)}


@cache
def parameter(number: int) -> Parameter:
    """The parameter with this number; MapError if there is none."""
    if number in _flag_words():
        return _word_parameter(number)
    try:
        block, row, index = _rows()[number]
    except KeyError:
        raise MapError(f"there is no parameter P{number}") from None
    return _parameter(block, row, index, number)


@cache
def flag(number: int) -> Flag:
    """The flag with this number; MapError if there is none."""
    word, bit = divmod(number, BITS_PER_WORD)
    if FLAG_WORD_BASE + word not in _flag_words():
        raise MapError(f"there is no flag BIT{number}")
    return _flag(FLAG_WORD_BASE + word, bit)


def flags_of(number: int) -> list[Flag]:
    """The 32 flags of a flag word; nothing for any other parameter."""
    if number not in _flag_words():
        return []
    first = (number - FLAG_WORD_BASE) * BITS_PER_WORD
    return [flag(n) for n in range(first, first + BITS_PER_WORD)]


@cache
def parameter_names() -> dict[int, str]:
    """The names of the parameters that the manual describes, by number; built without the rows."""
    found = {n: _parameter_name(block, row, index) for n, (block, row, index) in _rows().items()}
    reserved = {n for n, (_, row, _) in _rows().items() if row.access is Access.RESERVED}
    for number, (words, position, _) in _flag_words().items():
        found[number] = words.word_title(position)
        if words.word_access is Access.RESERVED:
            reserved.add(number)
    return {
        n: name for n, name in sorted(found.items()) if n not in reserved and is_described(name)
    }


@cache
def flag_names() -> dict[int, str]:
    """The names of the flags that the manual describes, by number; built without the rows."""
    found = {}
    for word, (block, position, _) in sorted(_flag_words().items()):
        first = (word - FLAG_WORD_BASE) * BITS_PER_WORD
        for bit, row in sorted(block.rows.items()):
            name = _flag_name(block, row, position)
            if row.access is not Access.RESERVED and is_described(name):
                found[first + bit] = name
    return found


def is_described(name: str) -> bool:
    """Whether the manual says what a parameter or flag of this name is."""
    return name not in (RESERVED, UNDOCUMENTED)


@cache
def packet_groups() -> dict[tuple[int, int], tuple[int | None, ...]]:
    """Parameter numbers of the eight mask bits of every packet group code and index."""
    groups: dict[tuple[int, int], list[int | None]] = {}
    for found in parameters().values():
        if found.packet:
            key = (found.packet.code, found.packet.group_index)
            fields = groups.setdefault(key, [None] * 8)
            fields[found.packet.mask.bit_length() - 1] = found.number
    return {key: tuple(fields) for key, fields in groups.items()}


def find_parameter(text: str) -> list[Parameter]:
    """Parameters meant by `12291`, `P12291`, `following error` or `axis2.following_error`."""
    number = re.fullmatch(r"P?\s*(\d+)", text.strip(), re.IGNORECASE)
    if number:
        return [parameter(int(number[1]))]
    return _by_name(text, parameters(), "parameter")


def find_flag(text: str) -> list[Flag]:
    """Flags meant by `516`, `BIT516`, `in motion` or `master 2 in motion`."""
    number = re.fullmatch(r"(?:BIT)?\s*(\d+)", text.strip(), re.IGNORECASE)
    if number:
        return [flag(int(number[1]))]
    return _by_name(text, flags(), "flag")


@cache
def _rows() -> dict[int, tuple[Block, Row, int]]:
    """By number: the block and the row that declare a parameter, and which of its objects it is."""
    from openacr.map.tables import BLOCKS

    found: dict[int, tuple[Block, Row, int]] = {}
    for block in BLOCKS:
        for index, base in enumerate(block.bases()):
            for row in block.rows.values():
                _enter(found, base + row.offset, (block, row, index))
    return found


@cache
def _flag_words() -> dict[int, tuple[FlagBlock, int, str]]:
    """By number: the family of a flag word, its position in the family and its section."""
    from openacr.map.tables import FLAG_BLOCKS

    found: dict[int, tuple[FlagBlock, int, str]] = {}
    for block in FLAG_BLOCKS:
        for position, number, section in block.places():
            _enter(found, number, (block, position, section))
    return found


def _enter(found: dict[int, _T], number: int, declared: _T) -> None:
    if number in found:
        raise ValueError(f"P{number} is declared twice")
    found[number] = declared


def _parameter_name(block: Block, row: Row, index: int) -> str:
    return RESERVED if index >= block.named else row.name


def _flag_name(block: FlagBlock, row: FlagRow, position: int) -> str:
    if position >= block.named and row.name != UNDOCUMENTED:
        return RESERVED
    if "{" not in row.name:
        return row.name
    return row.name.format(n=block.index_of(position), io=block.io_of(position) + row.bit)


def _parameter(block: Block, row: Row, index: int, number: int) -> Parameter:
    unnamed = index >= block.named
    erratum = row.erratum if row.erratum_at in (None, index) else ""
    return Parameter(
        number=number,
        name=_parameter_name(block, row, index),
        kind=row.kind,
        access=Access.RESERVED if unnamed else row.access,
        object=block.object,
        index=index if block.indexed else None,
        section=block.section_of(index) if block.section_of else row.section,
        packet=block.packet(number) if block.packet else None,
        description="" if unnamed else row.doc,
        unit=row.unit,
        default=row.default_of(index),
        ref=block.ref.value,
        erratum=erratum or (block.packet_erratum if index >= 8 else ""),
    )


def _word_parameter(number: int) -> Parameter:
    block, position, section = _flag_words()[number]
    first = (number - FLAG_WORD_BASE) * BITS_PER_WORD
    holds = f"Holds BIT{first} to BIT{first + BITS_PER_WORD - 1}."
    return Parameter(
        number=number,
        name=block.word_title(position),
        kind=Kind.LONG,
        access=block.word_access,
        object=block.object,
        index=block.index_of(position),
        section=section,
        packet=block.packet(number) if block.packet else None,
        description=f"{holds} {block.word_doc}".rstrip(),
        unit="",
        default=0,
        ref=block.ref.value,
        erratum=block.word_erratum if position >= block.word_erratum_from else "",
    )


def _flag(word: int, bit: int) -> Flag:
    block, position, _ = _flag_words()[word]
    row = block.flag(bit)
    unnamed = position >= block.named and row.name != UNDOCUMENTED
    index = block.index_of(position)
    io = block.io_of(position) + bit
    return Flag(
        number=(word - FLAG_WORD_BASE) * BITS_PER_WORD + bit,
        name=_flag_name(block, row, position),
        printed=RESERVED if unnamed else row.printed.format(n=index, io=io),
        access=Access.RESERVED if unnamed else row.access,
        speed=Speed.UNKNOWN if unnamed else row.speed,
        parameter=word,
        bit=bit,
        object=block.object_of(bit),
        index=index,
        section=block.title,
        description="" if unnamed else row.doc,
        ref=block.ref.value,
        erratum=row.erratum if row.erratum_at in (None, index) else "",
    )


def _by_name(text: str, records: dict[int, _Record], what: str) -> list[_Record]:
    """Records whose name is `text`, else those that contain all its words."""
    wanted = _words(text)
    if not wanted:
        raise MapError(f"no {what} is named {text!r}")
    named = [record for record in records.values() if _has_meaning(record)]
    exact = [record for record in named if _is_called(record, wanted)]
    found = exact or [record for record in named if _mentions(record, wanted)]
    if found:
        return found
    raise MapError(f"no {what} is named {text!r}" + _hint(wanted, named))


def _has_meaning(record: Parameter | Flag) -> bool:
    return record.access is not Access.RESERVED and record.name != UNDOCUMENTED


def _is_called(record: Parameter | Flag, wanted: list[str]) -> bool:
    name = _words(record.name)
    return wanted in (name, _place(record) + name)


def _mentions(record: Parameter | Flag, wanted: list[str]) -> bool:
    return set(wanted) <= {*_place(record), *_words(record.name)}


def _hint(wanted: list[str], records: Iterable[Parameter | Flag]) -> str:
    from difflib import get_close_matches

    names = {record.name.lower(): record.name for record in records}
    close = get_close_matches(" ".join(wanted), names, n=3, cutoff=0.5)
    return f"; perhaps {', '.join(names[match] for match in close)}?" if close else ""


def _words(text: str) -> list[str]:
    """Lower-case words and numbers: `axis2.following_error` has four."""
    return re.findall(r"[a-z]+|\d+", text.lower())


def _place(record: Parameter | Flag) -> list[str]:
    return _words(record.object) + ([] if record.index is None else [str(record.index)])
