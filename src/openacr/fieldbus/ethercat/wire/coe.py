"""CoE: the object dictionary by mail (SDO), its errors and emergencies.

`request` and `reply` classes are the same on both sides: a master packs the one and parses the
other, a slave the reverse.
"""

from dataclasses import dataclass
from enum import IntEnum
from struct import Struct

from openacr.fieldbus.ethercat.wire.frames import WireError

_COE = Struct("<H")
COE_SIZE = _COE.size
_SDO = Struct("<BHB4s")
_SIZE = Struct("<I")
_EMERGENCY = Struct("<HB5s")
SDO_HEAD = COE_SIZE + _SDO.size  # of a mail's payload before the data of an SDO
SEGMENT_HEAD = COE_SIZE + 1
EXPEDITED = 4  # the most bytes of a transfer of one mail without a size
SHORTEST_SEGMENT = 7

_EXPEDITED, _SIZED, _COMPLETE, _TOGGLE, _LAST = 0x02, 0x01, 0x10, 0x10, 0x01


class Service(IntEnum):
    """The service in the head of a CoE mail."""

    EMERGENCY = 1
    REQUEST = 2
    RESPONSE = 3
    TRANSMIT_PDO = 4
    RECEIVE_PDO = 5
    INFORMATION = 8


class Abort(IntEnum):
    """Why an SDO was aborted; `text` says it."""

    TOGGLE = 0x05030000
    TIMEOUT = 0x05040000
    COMMAND = 0x05040001
    NO_MEMORY = 0x05040005
    UNSUPPORTED = 0x06010000
    WRITE_ONLY = 0x06010001
    READ_ONLY = 0x06010002
    SUBINDEX_0 = 0x06010003
    NO_COMPLETE = 0x06010004
    TOO_LARGE_FOR_MAILBOX = 0x06010005
    MAPPED = 0x06010006
    NO_OBJECT = 0x06020000
    NOT_MAPPABLE = 0x06040041
    PDO_LENGTH = 0x06040042
    INCOMPATIBLE = 0x06040043
    DEVICE = 0x06040047
    HARDWARE = 0x06060000
    LENGTH = 0x06070010
    TOO_LONG = 0x06070012
    TOO_SHORT = 0x06070013
    NO_SUBINDEX = 0x06090011
    RANGE = 0x06090030
    TOO_HIGH = 0x06090031
    TOO_LOW = 0x06090032
    MAXIMUM_BELOW_MINIMUM = 0x06090036
    GENERAL = 0x08000000
    TRANSFER = 0x08000020
    LOCAL_CONTROL = 0x08000021
    STATE = 0x08000022
    NO_DICTIONARY = 0x08000023

    @property
    def text(self) -> str:
        """What it means."""
        return _ABORT_TEXTS[self]


_ABORT_TEXTS = {
    Abort.TOGGLE: "toggle bit not changed",
    Abort.TIMEOUT: "SDO protocol timeout",
    Abort.COMMAND: "command specifier not valid",
    Abort.NO_MEMORY: "out of memory",
    Abort.UNSUPPORTED: "unsupported access to an object",
    Abort.WRITE_ONLY: "the object is write-only",
    Abort.READ_ONLY: "the object is read-only",
    Abort.SUBINDEX_0: "subindex cannot be written, subindex 0 must be 0",
    Abort.NO_COMPLETE: "complete access not supported",
    Abort.TOO_LARGE_FOR_MAILBOX: "the object is longer than the mailbox",
    Abort.MAPPED: "the object is mapped to a receive PDO",
    Abort.NO_OBJECT: "the object does not exist",
    Abort.NOT_MAPPABLE: "the object cannot be mapped to the PDO",
    Abort.PDO_LENGTH: "the mapped objects are longer than the PDO",
    Abort.INCOMPATIBLE: "parameter incompatibility",
    Abort.DEVICE: "incompatibility in the device",
    Abort.HARDWARE: "hardware error",
    Abort.LENGTH: "data type or length does not match",
    Abort.TOO_LONG: "the data is too long",
    Abort.TOO_SHORT: "the data is too short",
    Abort.NO_SUBINDEX: "the subindex does not exist",
    Abort.RANGE: "value out of range",
    Abort.TOO_HIGH: "value too high",
    Abort.TOO_LOW: "value too low",
    Abort.MAXIMUM_BELOW_MINIMUM: "the maximum is below the minimum",
    Abort.GENERAL: "general error",
    Abort.TRANSFER: "data cannot be transferred or stored",
    Abort.LOCAL_CONTROL: "data cannot be transferred or stored: local control",
    Abort.STATE: "data cannot be transferred or stored in this state",
    Abort.NO_DICTIONARY: "no object dictionary",
}


def abort_text(code: int) -> str:
    """What an abort code means; others by their number."""
    try:
        return Abort(code).text
    except ValueError:
        return f"abort code 0x{code:08X}"


def coe(service: Service, body: bytes) -> bytes:
    """The payload of a CoE mail."""
    return _COE.pack(service << 12) + body


def service_of(payload: bytes) -> tuple[int, bytes]:
    """The service of a CoE mail and what follows its head; WireError if it is too short."""
    if len(payload) < COE_SIZE:
        raise WireError(f"a CoE mail of {len(payload)} bytes: its head has {COE_SIZE}")
    return _COE.unpack_from(payload)[0] >> 12, payload[COE_SIZE:]


# -- requests of a master --------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Upload:
    """Reads an object, or all of it from a subindex on."""

    index: int
    subindex: int
    complete: bool = False

    def pack(self) -> bytes:
        """The payload of its mail."""
        command = 0x40 | _COMPLETE * self.complete
        return coe(Service.REQUEST, _SDO.pack(command, self.index, self.subindex, b""))


@dataclass(frozen=True, slots=True)
class Download:
    """Writes an object: `size` bytes, of which the first ones are `data`, segments the rest."""

    index: int
    subindex: int
    data: bytes
    size: int
    complete: bool = False

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.REQUEST, _first(0x20, self))


@dataclass(frozen=True, slots=True)
class UploadNext:
    """Asks for the next segment."""

    toggle: bool

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.REQUEST, bytes([0x60 | _TOGGLE * self.toggle]).ljust(8, b"\0"))


@dataclass(frozen=True, slots=True)
class DownloadNext:
    """Brings the next segment."""

    toggle: bool
    data: bytes
    is_last: bool

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.REQUEST, _segment(self.toggle, self.data, self.is_last))


@dataclass(frozen=True, slots=True)
class Aborted:
    """The end of a transfer by one of the sides."""

    index: int
    subindex: int
    code: int

    def pack(self, service: Service = Service.REQUEST) -> bytes:
        """The payload of its mail."""
        return coe(service, _SDO.pack(0x80, self.index, self.subindex, _SIZE.pack(self.code)))

    @property
    def text(self) -> str:
        """What it means."""
        return abort_text(self.code)


Request = Upload | Download | UploadNext | DownloadNext | Aborted


def parse_request(body: bytes) -> Request:
    """The request in what follows the head of a CoE mail; WireError if it is not one."""
    command, index, subindex, data = _head(body)
    complete = bool(command & _COMPLETE)
    kind = command >> 5
    if kind == 0:
        return DownloadNext(complete, _segment_data(body), bool(command & _LAST))
    if kind == 1:
        size, data = _first_data(command, body)
        return Download(index, subindex, data, size, complete)
    if kind == 2:
        return Upload(index, subindex, complete)
    if kind == 3:
        return UploadNext(complete)
    if kind == 4:
        return Aborted(index, subindex, _SIZE.unpack(data)[0])
    raise WireError(f"SDO command 0x{command:02X} is not one of a master")


# -- replies of a slave ----------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Uploaded:
    """The first part of what an object holds; `size` is all of it."""

    index: int
    subindex: int
    data: bytes
    size: int
    complete: bool = False

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.RESPONSE, _first(0x40, self))


@dataclass(frozen=True, slots=True)
class Segment:
    """The next part."""

    toggle: bool
    data: bytes
    is_last: bool

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.RESPONSE, _segment(self.toggle, self.data, self.is_last))


@dataclass(frozen=True, slots=True)
class Downloaded:
    """The object was written, or its first part was received."""

    index: int
    subindex: int
    complete: bool = False

    def pack(self) -> bytes:
        """The payload of its mail."""
        command = 0x60 | _COMPLETE * self.complete
        return coe(Service.RESPONSE, _SDO.pack(command, self.index, self.subindex, b""))


@dataclass(frozen=True, slots=True)
class DownloadedNext:
    """A segment was received."""

    toggle: bool

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.RESPONSE, bytes([0x20 | _TOGGLE * self.toggle]).ljust(8, b"\0"))


Reply = Uploaded | Segment | Downloaded | DownloadedNext | Aborted


def parse_reply(body: bytes) -> Reply:
    """The reply in what follows the head of a CoE mail; WireError if it is not one."""
    command, index, subindex, data = _head(body)
    complete = bool(command & _COMPLETE)
    kind = command >> 5
    if kind == 0:
        return Segment(complete, _segment_data(body), bool(command & _LAST))
    if kind == 1:
        return DownloadedNext(complete)
    if kind == 2:
        size, data = _first_data(command, body)
        return Uploaded(index, subindex, data, size, complete)
    if kind == 3:
        return Downloaded(index, subindex, complete)
    if kind == 4:
        return Aborted(index, subindex, _SIZE.unpack(data)[0])
    raise WireError(f"SDO command 0x{command:02X} is not one of a slave")


# -- emergencies -----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Emergency:
    """An error of the device, by mail: its code, the error register, bytes of the maker."""

    code: int
    register: int
    data: bytes = b""

    def pack(self) -> bytes:
        """The payload of its mail."""
        return coe(Service.EMERGENCY, _EMERGENCY.pack(self.code, self.register, self.data))

    @classmethod
    def parse(cls, body: bytes) -> "Emergency":
        """The emergency in what follows the head of a CoE mail; WireError if it is too short."""
        if len(body) < _EMERGENCY.size:
            raise WireError(f"an emergency of {len(body)} bytes: it has {_EMERGENCY.size}")
        return cls(*_EMERGENCY.unpack_from(body))


# -- parts of them ---------------------------------------------------------------------------


def _head(body: bytes) -> tuple[int, int, int, bytes]:
    if len(body) < _SDO.size:
        raise WireError(f"an SDO of {len(body)} bytes: it has at least {_SDO.size}")
    command, index, subindex, data = _SDO.unpack_from(body)
    return command, index, subindex, data


def _first_data(command: int, body: bytes) -> tuple[int, bytes]:
    if command & _EXPEDITED:
        unused = command >> 2 & 3 if command & _SIZED else 0
        data = body[4 : 8 - unused]
        return len(data), data
    size: int = _SIZE.unpack_from(body, 4)[0]
    return size, body[_SDO.size :][:size]


def _first(command: int, part: "Download | Uploaded") -> bytes:
    """The first part of a transfer: up to four bytes go in the head, more after it."""
    command |= _SIZED | _COMPLETE * part.complete
    if part.size == len(part.data) and 0 < part.size <= EXPEDITED:
        command |= _EXPEDITED | (EXPEDITED - part.size) << 2
        return _SDO.pack(command, part.index, part.subindex, part.data)
    return _SDO.pack(command, part.index, part.subindex, _SIZE.pack(part.size)) + part.data


def _segment(toggle: bool, data: bytes, is_last: bool) -> bytes:
    unused = max(0, SHORTEST_SEGMENT - len(data))
    command = _TOGGLE * toggle | unused << 1 | _LAST * is_last
    return bytes([command]) + data + bytes(unused)


def _segment_data(body: bytes) -> bytes:
    data = body[1:]
    return data[: len(data) - (body[0] >> 1 & 7)] if len(data) == SHORTEST_SEGMENT else data
