"""SDO information: what objects a slave has, by mail."""

from dataclasses import dataclass
from enum import IntEnum
from struct import Struct

from openacr.fieldbus.ethercat.wire.coe import Service, coe
from openacr.fieldbus.ethercat.wire.frames import WireError

_HEAD = Struct("<BxH")
HEAD_SIZE = _HEAD.size
_OBJECT = Struct("<HHBB")
_ENTRY = Struct("<HBBHHH")
_WORD = Struct("<H")
_LONG = Struct("<I")
_INCOMPLETE = 0x80


class Question(IntEnum):
    """The operation of a mail; an answer is one more."""

    LIST = 1
    OBJECT = 3
    ENTRY = 5
    ERROR = 7


class ListKind(IntEnum):
    """Which objects a list has."""

    COUNTS = 0
    ALL = 1
    RECEIVE = 2
    TRANSMIT = 3
    BACKUP = 4
    SETTINGS = 5


class ObjectCode(IntEnum):
    """What an object is."""

    VARIABLE = 7
    ARRAY = 8
    RECORD = 9


@dataclass(frozen=True, slots=True)
class Information:
    """One mail: its operation, how many fragments follow it, and its data."""

    operation: int
    data: bytes
    fragments: int = 0

    def pack(self) -> bytes:
        """The payload of its mail."""
        operation = self.operation | (_INCOMPLETE if self.fragments else 0)
        return coe(Service.INFORMATION, _HEAD.pack(operation, self.fragments) + self.data)

    @classmethod
    def parse(cls, body: bytes) -> "Information":
        """The mail in what follows the head of CoE; WireError if it is too short."""
        if len(body) < HEAD_SIZE:
            raise WireError(f"SDO information of {len(body)} bytes: its head has {HEAD_SIZE}")
        operation, fragments = _HEAD.unpack_from(body)
        return cls(operation & ~_INCOMPLETE, body[HEAD_SIZE:], fragments)


@dataclass(frozen=True, slots=True)
class ObjectDescription:
    """What an object is."""

    index: int
    data_type: int
    highest_subindex: int
    code: int
    name: str

    def pack(self) -> bytes:
        """The data of the answer."""
        head = _OBJECT.pack(self.index, self.data_type, self.highest_subindex, self.code)
        return head + self.name.encode("latin-1", "replace")

    @classmethod
    def parse(cls, data: bytes) -> "ObjectDescription":
        """The description in an answer; WireError if it is too short."""
        if len(data) < _OBJECT.size:
            raise WireError(f"a description of {len(data)} bytes: it has {_OBJECT.size} or more")
        index, data_type, highest, code = _OBJECT.unpack_from(data)
        return cls(index, data_type, highest, code, data[_OBJECT.size :].decode("latin-1"))


@dataclass(frozen=True, slots=True)
class EntryDescription:
    """What a subindex is; `access` as in ETG.1000.6: bits of read, write, mapping."""

    index: int
    subindex: int
    data_type: int
    bits: int
    access: int
    name: str

    def pack(self) -> bytes:
        """The data of the answer."""
        head = _ENTRY.pack(self.index, self.subindex, 0, self.data_type, self.bits, self.access)
        return head + self.name.encode("latin-1", "replace")

    @classmethod
    def parse(cls, data: bytes) -> "EntryDescription":
        """The description in an answer without values; WireError if it is too short."""
        if len(data) < _ENTRY.size:
            raise WireError(f"a description of {len(data)} bytes: it has {_ENTRY.size} or more")
        index, subindex, _, data_type, bits, access = _ENTRY.unpack_from(data)
        return cls(index, subindex, data_type, bits, access, data[_ENTRY.size :].decode("latin-1"))


def ask_list(kind: ListKind) -> bytes:
    """The payload of a mail that asks for a list of objects."""
    return Information(Question.LIST, _WORD.pack(kind)).pack()


def ask_object(index: int) -> bytes:
    """The payload of a mail that asks what an object is."""
    return Information(Question.OBJECT, _WORD.pack(index)).pack()


def ask_entry(index: int, subindex: int) -> bytes:
    """The payload of a mail that asks what a subindex is."""
    return Information(Question.ENTRY, _WORD.pack(index) + bytes([subindex, 0])).pack()


def words_of(data: bytes) -> list[int]:
    """The words of a list; the first is its kind."""
    return [word for (word,) in _WORD.iter_unpack(data[: len(data) & ~1])]


def error_code(data: bytes) -> int:
    """The abort code of an answer of operation ERROR; WireError if it is too short."""
    if len(data) < _LONG.size:
        raise WireError(f"an error of {len(data)} bytes: it has {_LONG.size}")
    code: int = _LONG.unpack_from(data)[0]
    return code
