"""Sync managers and FMMUs: the rows of registers that share memory and map logical addresses."""

from dataclasses import dataclass
from enum import IntEnum
from struct import Struct

_SYNC = Struct("<HHBBBB")
_FMMU = Struct("<IHBBHBBB3x")
SYNC_SIZE = _SYNC.size
FMMU_SIZE = _FMMU.size

MAILBOX_MODE = 0x02  # of control: handshake, otherwise three buffers
MODE_MASK = 0x03
WRITTEN_BY_MASTER = 0x04
DIRECTION_MASK = 0x0C
WATCHED = 0x40  # its writes feed the watchdog
FULL = 0x08  # of status, in mailbox mode
ENABLED = 0x01  # of activate
REPEAT = 0x02  # of activate: the master asks for its last mail again
STATUS_PLACE, ACTIVATE_PLACE, PDI_PLACE = 5, 6, 7  # within its registers

# Control bytes that are usual.
MAILBOX_OUT_CONTROL = 0x26
MAILBOX_IN_CONTROL = 0x22
OUTPUTS_CONTROL = 0x64
INPUTS_CONTROL = 0x20


class SyncUse(IntEnum):
    """What a sync manager is for, in the EEPROM and in object 0x1C00."""

    UNUSED = 0
    MAILBOX_OUT = 1
    MAILBOX_IN = 2
    OUTPUTS = 3
    INPUTS = 4


@dataclass(frozen=True, slots=True)
class SyncManager:
    """The eight bytes of a sync manager."""

    start: int
    size: int
    control: int
    status: int = 0
    activate: int = ENABLED
    pdi: int = 0

    @property
    def is_enabled(self) -> bool:
        """Whether it is on."""
        return bool(self.activate & ENABLED)

    def pack(self) -> bytes:
        """Its registers."""
        return _SYNC.pack(self.start, self.size, self.control, self.status, self.activate, self.pdi)

    @classmethod
    def parse(cls, data: bytes | bytearray | memoryview, place: int = 0) -> "SyncManager":
        """The sync manager whose registers are at a place of `data`."""
        return cls(*_SYNC.unpack_from(data, place))


READS = 0x01
WRITES = 0x02


@dataclass(frozen=True, slots=True)
class Fmmu:
    """Maps bits of the logical address space to memory of the slave.

    `size` bytes from `logical`: from bit `first_bit` of the first to bit `last_bit` of the last;
    in the slave from bit `bit` of the byte at `physical`.
    """

    logical: int
    size: int
    physical: int
    kind: int
    first_bit: int = 0
    last_bit: int = 7
    bit: int = 0
    activate: int = 1

    @property
    def is_bytes(self) -> bool:
        """Whether it maps whole bytes."""
        return self.first_bit == 0 and self.last_bit == 7 and self.bit == 0

    def pack(self) -> bytes:
        """Its registers."""
        return _FMMU.pack(
            self.logical,
            self.size,
            self.first_bit,
            self.last_bit,
            self.physical,
            self.bit,
            self.kind,
            self.activate,
        )

    @classmethod
    def parse(cls, data: bytes | bytearray | memoryview, place: int = 0) -> "Fmmu":
        """The FMMU whose registers are at a place of `data`."""
        logical, size, first, last, physical, bit, kind, activate = _FMMU.unpack_from(data, place)
        return cls(logical, size, physical, kind, first & 7, last & 7, bit & 7, activate & 1)
