"""The EEPROM of a slave (SII): who it is, its mailboxes, sync managers and PDOs (ETG.2010)."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import IntEnum
from struct import Struct

from openacr.fieldbus.ethercat.wire.frames import WireError
from openacr.fieldbus.ethercat.wire.managers import SyncUse

_HEAD = Struct("<4HH4xH")  # PDI control and configuration, alias, checksum
_IDENTITY = Struct("<4I")
_MAILBOX = Struct("<5H")
_CATEGORY = Struct("<HH")
_SYNC = Struct("<HHBBBB")
_PDO = Struct("<HBBBBH")
_ENTRY = Struct("<HBBBBH")
_GENERAL = Struct("<4BxB4BBBhBxHH12x")
_CHECKED = 14  # bytes the checksum is of
_CRC_START, _CRC_POLYNOMIAL = 0xFF, 0x07
IDENTITY_WORD = 0x08
ALIAS_WORD = 0x04
MAILBOX_WORD = 0x18
SIZE_WORD = 0x3E
CATEGORIES_WORD = 0x40
LONGEST_WORDS = 0x8000
_VERSION = 1
_KBIT_WORDS = 64


class Category(IntEnum):
    """The kinds of categories."""

    STRINGS = 10
    GENERAL = 30
    FMMU = 40
    SYNC = 41
    TRANSMIT_PDO = 50
    RECEIVE_PDO = 51
    CLOCK = 60
    END = 0xFFFF


@dataclass(frozen=True, slots=True)
class Identity:
    """Who a slave is, as in object 0x1018."""

    vendor: int
    product: int
    revision: int = 0
    serial: int = 0


@dataclass(frozen=True, slots=True)
class Mailboxes:
    """The standard mailboxes: of the master to the slave (out) and back (in)."""

    out_start: int = 0
    out_size: int = 0
    in_start: int = 0
    in_size: int = 0
    protocols: int = 0


@dataclass(frozen=True, slots=True)
class Entry:
    """An object in a PDO; index 0 is a gap."""

    index: int
    subindex: int
    bits: int
    name: str = ""
    data_type: int = 0

    @property
    def mapping(self) -> int:
        """As 0x1600 and 0x1A00 hold it."""
        return self.index << 16 | self.subindex << 8 | self.bits


@dataclass(frozen=True, slots=True)
class Pdo:
    """A PDO, the sync manager that has it by default, and its objects in order."""

    index: int
    entries: tuple[Entry, ...]
    sync: int = 0xFF  # none
    name: str = ""
    is_fixed: bool = False

    @property
    def bits(self) -> int:
        """Its length."""
        return sum(entry.bits for entry in self.entries)


@dataclass(frozen=True, slots=True)
class DefaultSync:
    """A sync manager as the slave wants it."""

    start: int
    size: int
    control: int
    use: int
    enabled: bool = True


@dataclass(frozen=True, slots=True)
class Description:
    """What an EEPROM says."""

    identity: Identity
    alias: int = 0
    mailboxes: Mailboxes = field(default_factory=Mailboxes)
    name: str = ""
    order: str = ""
    group: str = ""
    coe_details: int = 0
    fmmu: tuple[int, ...] = ()
    sync: tuple[DefaultSync, ...] = ()
    receive: tuple[Pdo, ...] = ()  # outputs, 0x16xx
    transmit: tuple[Pdo, ...] = ()  # inputs, 0x1Axx

    def sync_of(self, use: SyncUse) -> int | None:
        """Number of the sync manager of a use; None without one."""
        return next((n for n, sync in enumerate(self.sync) if sync.use == use), None)


def checksum(data: bytes | bytearray) -> int:
    """The checksum of the first 14 bytes: CRC-8 with polynomial 0x07, started with 0xFF."""
    crc = _CRC_START
    for byte in data[:_CHECKED]:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1) ^ _CRC_POLYNOMIAL if crc & 0x80 else crc << 1
            crc &= 0xFF
    return crc


def build(description: Description, size: int = 2048) -> bytes:
    """The EEPROM of a description, filled up to `size` bytes; WireError if it needs more."""
    strings = _Strings()
    one = description
    categories = [
        (Category.GENERAL, _general(one, strings)),
        (Category.FMMU, bytes(one.fmmu)),
        (Category.SYNC, b"".join(_sync(sync) for sync in one.sync)),
        (Category.TRANSMIT_PDO, b"".join(_pdo(pdo, strings) for pdo in one.transmit)),
        (Category.RECEIVE_PDO, b"".join(_pdo(pdo, strings) for pdo in one.receive)),
    ]
    head = bytearray(2 * CATEGORIES_WORD)
    _HEAD.pack_into(head, 0, 0x0005, 0, 0, 0, one.alias, 0)
    head[_CHECKED] = checksum(head)
    who, mail = one.identity, one.mailboxes
    _IDENTITY.pack_into(head, 2 * IDENTITY_WORD, who.vendor, who.product, who.revision, who.serial)
    _MAILBOX.pack_into(
        head,
        2 * MAILBOX_WORD,
        mail.out_start,
        mail.out_size,
        mail.in_start,
        mail.in_size,
        mail.protocols,
    )
    _CATEGORY.pack_into(head, 2 * SIZE_WORD, size // (2 * _KBIT_WORDS) - 1, _VERSION)
    body = b"".join(
        _category(kind, data)
        for kind, data in [(Category.STRINGS, strings.pack()), *categories]
        if data
    )
    whole = bytes(head) + body
    if len(whole) + _CATEGORY.size > size:
        raise WireError(f"the description has {len(whole)} bytes, the EEPROM {size}")
    return whole.ljust(size, b"\xff")


def parse(data: bytes) -> Description:
    """What the bytes of an EEPROM say; WireError if they are cut off or the checksum is wrong."""
    if len(data) < 2 * CATEGORIES_WORD:
        raise WireError(f"an EEPROM of {len(data)} bytes: its head alone has 128")
    if checksum(data) != data[_CHECKED]:
        raise WireError("the checksum of the EEPROM is wrong: it is damaged, or never written")
    found = dict.fromkeys(Category, b"")
    for kind, content in categories_of(data):
        if kind in found:
            found[Category(kind)] += content
    strings = _strings(found[Category.STRINGS])
    general = found[Category.GENERAL].ljust(_GENERAL.size, b"\0")
    group, _, order, name, coe_details = _GENERAL.unpack_from(general)[:5]
    return Description(
        Identity(*_IDENTITY.unpack_from(data, 2 * IDENTITY_WORD)),
        alias=int.from_bytes(data[2 * ALIAS_WORD : 2 * ALIAS_WORD + 2], "little"),
        mailboxes=Mailboxes(*_MAILBOX.unpack_from(data, 2 * MAILBOX_WORD)),
        name=_named(strings, name),
        order=_named(strings, order),
        group=_named(strings, group),
        coe_details=coe_details,
        fmmu=tuple(found[Category.FMMU]),
        sync=tuple(_parsed_sync(found[Category.SYNC])),
        receive=tuple(_parsed_pdos(found[Category.RECEIVE_PDO], strings)),
        transmit=tuple(_parsed_pdos(found[Category.TRANSMIT_PDO], strings)),
    )


def categories_of(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Kind and content of each category; WireError if one is cut off."""
    place = 2 * CATEGORIES_WORD
    while place + _CATEGORY.size <= len(data):
        kind, words = _CATEGORY.unpack_from(data, place)
        if kind == Category.END:
            return
        place += _CATEGORY.size
        if place + 2 * words > len(data):
            raise WireError(f"category {kind} of the EEPROM is cut off")
        yield kind, data[place : place + 2 * words]
        place += 2 * words


class _Strings:
    """The texts of an EEPROM, each once; texts are numbered from 1, 0 is no text."""

    def __init__(self) -> None:
        self._texts: list[bytes] = []

    def number(self, text: str) -> int:
        coded = text.encode("latin-1", "replace")[:255]
        if not coded:
            return 0
        if coded not in self._texts:
            self._texts.append(coded)
        return self._texts.index(coded) + 1

    def pack(self) -> bytes:
        parts = (bytes([len(text)]) + text for text in self._texts)
        return bytes([len(self._texts)]) + b"".join(parts) if self._texts else b""


def _category(kind: Category, data: bytes) -> bytes:
    data += bytes(len(data) & 1)
    return _CATEGORY.pack(kind, len(data) // 2) + data


def _general(one: Description, strings: _Strings) -> bytes:
    name = strings.number(one.name)  # first: masters print text 1
    order, group = strings.number(one.order), strings.number(one.group)
    ports = 0x0011  # two of MII
    return _GENERAL.pack(
        group, 0, order, name, one.coe_details, 0, 0, 0, 0, 0, 0, 0, group, ports, 0
    )


def _sync(sync: DefaultSync) -> bytes:
    return _SYNC.pack(sync.start, sync.size, sync.control, 0, int(sync.enabled), sync.use)


def _pdo(pdo: Pdo, strings: _Strings) -> bytes:
    flags = 0x0010 if pdo.is_fixed else 0
    name = strings.number(pdo.name)
    head = _PDO.pack(pdo.index, len(pdo.entries), pdo.sync, 0, name, flags)
    return head + b"".join(
        _ENTRY.pack(
            entry.index,
            entry.subindex,
            strings.number(entry.name),
            entry.data_type & 0xFF,
            entry.bits,
            0,
        )
        for entry in pdo.entries
    )


def _strings(data: bytes) -> list[str]:
    texts: list[str] = []
    place = 1
    for _ in range(data[0] if data else 0):
        if place >= len(data):
            break
        size = data[place]
        texts.append(data[place + 1 : place + 1 + size].decode("latin-1"))
        place += 1 + size
    return texts


def _named(strings: list[str], number: int) -> str:
    return strings[number - 1] if 1 <= number <= len(strings) else ""


def _parsed_sync(data: bytes) -> Iterator[DefaultSync]:
    whole = len(data) // _SYNC.size * _SYNC.size
    for start, size, control, _, enable, use in _SYNC.iter_unpack(data[:whole]):
        yield DefaultSync(start, size, control, use, bool(enable & 1))


def _parsed_pdos(data: bytes, strings: list[str]) -> Iterator[Pdo]:
    place = 0
    while place + _PDO.size <= len(data):
        index, count, sync, _, name, flags = _PDO.unpack_from(data, place)
        place += _PDO.size
        entries: list[Entry] = []
        for _ in range(count):
            if place + _ENTRY.size > len(data):
                raise WireError(f"PDO 0x{index:04X} of the EEPROM is cut off")
            object_, subindex, text, kind, bits, _ = _ENTRY.unpack_from(data, place)
            entries.append(Entry(object_, subindex, bits, _named(strings, text), kind))
            place += _ENTRY.size
        fixed = bool(flags & 0x0010)
        yield Pdo(index, tuple(entries), sync, _named(strings, name), fixed)
