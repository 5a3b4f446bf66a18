"""The basic data types of an object dictionary (ETG.1000.6, CiA 301)."""

from enum import IntEnum
from struct import Struct
from typing import Final

from openacr.errors import UserError


class DataType(IntEnum):
    """Numbers of data types."""

    BOOLEAN = 0x0001
    INTEGER8 = 0x0002
    INTEGER16 = 0x0003
    INTEGER32 = 0x0004
    UNSIGNED8 = 0x0005
    UNSIGNED16 = 0x0006
    UNSIGNED32 = 0x0007
    REAL32 = 0x0008
    VISIBLE_STRING = 0x0009
    OCTET_STRING = 0x000A
    REAL64 = 0x0011
    INTEGER64 = 0x0015
    UNSIGNED64 = 0x001B
    PDO_MAPPING = 0x0021
    IDENTITY = 0x0023

    @property
    def bits(self) -> int:
        """Its length; 0 where the value says it."""
        return 1 if self is DataType.BOOLEAN else _bytes(self) * 8

    @property
    def byte_count(self) -> int:
        """How many bytes an SDO has; 0 where the value says it."""
        return _bytes(self)


_FORMATS: Final = {
    DataType.BOOLEAN: Struct("<?"),
    DataType.INTEGER8: Struct("<b"),
    DataType.INTEGER16: Struct("<h"),
    DataType.INTEGER32: Struct("<i"),
    DataType.UNSIGNED8: Struct("<B"),
    DataType.UNSIGNED16: Struct("<H"),
    DataType.UNSIGNED32: Struct("<I"),
    DataType.REAL32: Struct("<f"),
    DataType.REAL64: Struct("<d"),
    DataType.INTEGER64: Struct("<q"),
    DataType.UNSIGNED64: Struct("<Q"),
}
_REALS = (DataType.REAL32, DataType.REAL64)


def _bytes(kind: DataType) -> int:
    form = _FORMATS.get(kind)
    return 0 if form is None else form.size


def limits(kind: DataType) -> tuple[int, int]:
    """The lowest and highest value of an integer type."""
    if kind is DataType.BOOLEAN:
        return 0, 1
    bits = kind.bits
    if kind.name.startswith("UNSIGNED"):
        return 0, (1 << bits) - 1
    return -(1 << bits - 1), (1 << bits - 1) - 1


def encode(kind: DataType, value: float | str | bytes) -> bytes:
    """The bytes of a value; UserError if the type cannot hold it."""
    if isinstance(value, str):
        return value.encode("latin-1", "replace")
    if isinstance(value, bytes):
        return value
    form = _FORMATS.get(kind)
    if form is None:
        raise UserError(f"{value}: {kind.name} takes a text")
    if kind in _REALS:
        return form.pack(value)
    low, high = limits(kind)
    if value != int(value) or not low <= value <= high:
        raise UserError(f"{value}: {kind.name} takes whole numbers from {low} to {high}")
    return form.pack(int(value))


def decode(kind: DataType, data: bytes) -> int | float | str | bytes:
    """The value of bytes; UserError if there are fewer than the type has."""
    if kind is DataType.VISIBLE_STRING:
        return data.partition(b"\0")[0].decode("latin-1")
    form = _FORMATS.get(kind)
    if form is None:
        return data
    if len(data) < form.size:
        raise UserError(f"{kind.name} needs {form.size} bytes, there are {len(data)}")
    value: int | float = form.unpack_from(data)[0]
    return int(value) if kind is DataType.BOOLEAN else value
