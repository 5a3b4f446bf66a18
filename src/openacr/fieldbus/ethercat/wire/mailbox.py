"""Mails: what master and slave exchange beside the process data."""

from dataclasses import dataclass
from enum import IntEnum, IntFlag
from struct import Struct

from openacr.fieldbus.ethercat.wire.frames import WireError

HEADER = Struct("<HHBB")
HEADER_SIZE = HEADER.size
HIGHEST_COUNTER = 7


class MailType(IntEnum):
    """The protocol of a mail."""

    ERROR = 0
    AOE = 1
    EOE = 2
    COE = 3
    FOE = 4
    SOE = 5
    VOE = 15


class Protocol(IntFlag):
    """The protocols a slave speaks, in its EEPROM."""

    AOE = 0x01
    EOE = 0x02
    COE = 0x04
    FOE = 0x08
    SOE = 0x10
    VOE = 0x20


class MailError(IntEnum):
    """The codes of a mail of type ERROR."""

    SYNTAX = 1
    PROTOCOL = 2  # unsupported
    CHANNEL = 3
    SERVICE = 4  # unsupported
    HEADER = 5
    TOO_SHORT = 6
    NO_MEMORY = 7
    SIZE = 8


_ERROR = Struct("<HH")
_REPLY_TO = 1


@dataclass(frozen=True, slots=True)
class Mail:
    """One mail; `counter` runs from 1 to 7 and tells a new mail from a repeated one."""

    kind: int
    payload: bytes
    counter: int = 0
    address: int = 0

    def pack(self) -> bytes:
        """Its bytes."""
        head = HEADER.pack(
            len(self.payload), self.address, 0, self.kind & 0x0F | (self.counter & 7) << 4
        )
        return head + self.payload

    @classmethod
    def parse(cls, data: bytes) -> "Mail":
        """The mail in a mailbox; WireError if the mailbox is shorter than the mail."""
        if len(data) < HEADER_SIZE:
            raise WireError(f"a mail of {len(data)} bytes: its header alone has {HEADER_SIZE}")
        size, address, _, kind = HEADER.unpack_from(data)
        if HEADER_SIZE + size > len(data):
            raise WireError(f"a mail of {size} bytes in a mailbox of {len(data)}")
        payload = bytes(data[HEADER_SIZE : HEADER_SIZE + size])
        return cls(kind & 0x0F, payload, kind >> 4 & 7, address)


def next_counter(counter: int) -> int:
    """The counter of the next mail: 1 to 7, then 1."""
    return counter % HIGHEST_COUNTER + 1


def error_mail(code: MailError, counter: int) -> Mail:
    """The answer to a mail that cannot be served."""
    return Mail(MailType.ERROR, _ERROR.pack(_REPLY_TO, code), counter)


def mail_error(payload: bytes) -> int:
    """The code in a mail of type ERROR; WireError if it is too short."""
    if len(payload) < _ERROR.size:
        raise WireError(f"an error mail of {len(payload)} bytes: it has {_ERROR.size}")
    code: int = _ERROR.unpack_from(payload)[1]
    return code
