"""Descriptions of devices by their makers (ESI, ETG.2000): names, and PDOs with their objects."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as Xml

from openacr.errors import UserError, unreadable
from openacr.fieldbus.ethercat.wire.sii import Entry, Identity, Pdo

MOST_BYTES = 64_000_000
NO_SYNC = 0xFF
ENGLISH = "1033"


@dataclass(frozen=True, slots=True)
class Described:
    """A device of a file: who it is, its name, the PDOs of its outputs and of its inputs."""

    who: Identity
    name: str
    maker: str
    receive: tuple[Pdo, ...]
    transmit: tuple[Pdo, ...]


def read_esi(path: Path) -> list[Described]:
    """The devices of a file; UserError if it cannot be read or is another file."""
    try:
        if path.stat().st_size > MOST_BYTES:
            raise UserError(f"{path}: more than {MOST_BYTES} bytes are no description of devices")
        root = Xml.parse(path).getroot()
    except OSError as failure:
        raise unreadable(path, failure) from None
    except Xml.ParseError as failure:
        raise UserError(f"{path}: not XML: {failure}") from None
    if root.tag != "EtherCATInfo":
        raise UserError(f"{path}: not an ESI file: it begins with {root.tag}, not EtherCATInfo")
    try:
        return list(_devices(root))
    except ValueError as failure:
        raise UserError(f"{path}: {failure}") from None


def described(who: Identity, files: list[Described]) -> Described | None:
    """The description of a device: of its revision, else the newest of the product; or None."""
    same = [one for one in files if (one.who.vendor, one.who.product) == (who.vendor, who.product)]
    exact = [one for one in same if one.who.revision == who.revision]
    return next(iter(exact), max(same, key=lambda one: one.who.revision, default=None))


def _devices(root: Xml.Element) -> Iterator[Described]:
    vendor = _number(root.findtext("Vendor/Id", ""), "Vendor/Id")
    maker = _name(root.find("Vendor"))
    for device in root.iterfind("Descriptions/Devices/Device"):
        kind = device.find("Type")
        if kind is None or kind.get("ProductCode") is None:
            continue  # a part of others, such as a module
        who = Identity(
            vendor,
            _number(kind.get("ProductCode", ""), "ProductCode"),
            _number(kind.get("RevisionNo", "0"), "RevisionNo"),
        )
        yield Described(
            who,
            _name(device) or (kind.text or "").strip(),
            maker,
            tuple(_pdo(each) for each in device.iterfind("RxPdo")),
            tuple(_pdo(each) for each in device.iterfind("TxPdo")),
        )


def _pdo(pdo: Xml.Element) -> Pdo:
    return Pdo(
        _number(pdo.findtext("Index", ""), "Index of a PDO"),
        tuple(_entry(each) for each in pdo.iterfind("Entry")),
        _number(pdo.get("Sm", str(NO_SYNC)), "Sm"),
        _name(pdo),
        pdo.get("Fixed", "0") in ("1", "true"),
    )


def _entry(entry: Xml.Element) -> Entry:
    return Entry(
        _number(entry.findtext("Index", "0"), "Index of an entry"),
        _number(entry.findtext("SubIndex", "0"), "SubIndex"),
        _number(entry.findtext("BitLen", "0"), "BitLen"),
        _name(entry),
    )


def _name(element: Xml.Element | None) -> str:
    """The name in English, else the first there is."""
    names = [] if element is None else element.findall("Name")
    english = [name for name in names if name.get("LcId", ENGLISH) == ENGLISH]
    return next(((name.text or "").strip() for name in (*english, *names)), "")


def _number(text: str, what: str) -> int:
    """A number as these files write it: 123, or #x7B."""
    text = text.strip()
    try:
        return int(text[2:], 16) if text.lower().startswith("#x") else int(text)
    except ValueError:
        raise ValueError(f"{what} is {text!r}, which is no number (123 or #x7B)") from None
