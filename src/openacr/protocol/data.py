"""Data packets: up to eight parameters selected by group code, index and mask (UG2 ch. 6).

The parameter of a mask bit follows from the numbering of the map, not from a list:
each group starts at 256 * code, and the next mask bit is the next object (or word).
"""

from functools import lru_cache
from typing import ClassVar

from msgspec import Struct

from openacr.protocol.host import Host, PacketError, value_of
from openacr.protocol.packet import U8, Request, register

FIELDS = 8
UPPER_HALF = 0x80  # index bit: objects 8 to 15 of the groups with a stride of 16


class Group(Struct, frozen=True):
    """One group code: how index and mask bit become a parameter number."""

    code: int
    name: str
    stride: int  # parameter numbers from one mask bit to the next
    step: int = 1  # parameter numbers from one index to the next
    split: bool = False  # index bit 7 selects the objects 8 to 15

    def parameter(self, index: int, bit: int) -> int:
        """The parameter selected by mask bit `bit` of group index `index`."""
        base = 256 * self.code + self.stride * bit
        if not self.split:
            return base + self.step * index
        upper = FIELDS * self.stride if index & UPPER_HALF else 0
        return base + upper + (index & ~UPPER_HALF)


GROUPS = {
    group.code: group
    for group in (
        Group(0x10, "flag words", stride=1, step=8),
        Group(0x18, "encoders and steppers 0-15", stride=16, split=True),
        Group(0x19, "DAC and ADC 0-15", stride=16, split=True),
        Group(0x1A, "PLC, timers and counters", stride=16, split=True),
        Group(0x1B, "miscellaneous", stride=1, step=8),
        Group(0x1C, "programs", stride=16, split=True),
        Group(0x1D, "FSTAT setup", stride=16, split=True),
        Group(0x20, "masters 0-7", stride=256),
        Group(0x28, "masters 8-15", stride=256),
        Group(0x30, "axes 0-7", stride=256),
        Group(0x38, "axes 8-15", stride=256),
        Group(0x40, "commutators", stride=256),
        Group(0x50, "logging", stride=1, step=8),
        Group(0x60, "encoders and steppers 16-23", stride=16, split=True),
    )
}

# One table prints 0x21 and 0x31 for the second halves (errata): 256 * code only fits 0x28
# and 0x38, which all others have. Hosts written from that table are also accepted.
GROUPS |= {0x21: GROUPS[0x28], 0x31: GROUPS[0x38]}


@register
class DataRequest(Request, frozen=True):
    """Read up to eight parameters; answered at any time, also while commands wait."""

    HEADER: ClassVar[bytes] = b"\x00"
    group: U8
    index: U8
    mask: U8

    def reply_words(self) -> int:
        """One word per set bit of the mask."""
        return self.mask.bit_count()

    def act(self, host: Host) -> bytes:
        """Read the parameters; 0 where there is none."""
        return self.reply([value_of(host, number) for number in _numbers(self)])

    def parameters(self) -> tuple[int, ...]:
        """The requested parameter numbers, lowest mask bit first."""
        return _numbers(self)


@lru_cache(maxsize=4096)
def _numbers(request: DataRequest) -> tuple[int, ...]:
    group = GROUPS.get(request.group)
    if group is None:
        raise PacketError(f"there is no packet group 0x{request.group:02X}")
    bits = (bit for bit in range(FIELDS) if request.mask >> bit & 1)
    return tuple(group.parameter(request.index, bit) for bit in bits)


def locate(parameter: int) -> DataRequest | None:
    """The data packet that reads one parameter; None when no group reaches it."""
    for group in GROUPS.values():
        if 256 * group.code <= parameter < 256 * group.code + _span(group):
            return _request(group, parameter - 256 * group.code)
    return None


def _span(group: Group) -> int:
    """Parameter numbers a group can reach."""
    if group.split:
        return 2 * FIELDS * group.stride
    return FIELDS * group.stride if group.step == 1 else 256 * group.step


def _request(group: Group, offset: int) -> DataRequest:
    if group.split:
        number, index = divmod(offset, group.stride)
        upper = UPPER_HALF if number >= FIELDS else 0
        return DataRequest(group.code, index | upper, 1 << number % FIELDS)
    if group.step == 1:
        return DataRequest(group.code, offset % group.stride, 1 << offset // group.stride)
    return DataRequest(group.code, offset // group.step, 1 << offset % group.step)
