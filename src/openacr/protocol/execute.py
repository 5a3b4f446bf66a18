"""What the card does with a received packet, and what it answers.

Packets are acted on when first seen, also while commands wait. A packet nobody can act on
(a parameter, address or group that does not exist, a value that is no number) changes
nothing; where a reply is due, undefined fields read 0, so that the host stays in step.
"""

import logging
import math
import struct
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from openacr.errors import CardError, MapError
from openacr.kernel.words_cy import wrap32
from openacr.map.memory import long_of
from openacr.protocol.bits import ClearBit, SetBit
from openacr.protocol.data import DataRequest
from openacr.protocol.memory import Conversion, MaskMemory, Peek, Poke, VariableAddress
from openacr.protocol.move import Move
from openacr.protocol.override import FeedrateOverride, RapidOverride
from openacr.protocol.packet import Packet, PacketError
from openacr.protocol.parameter import (
    GetIeee,
    GetLong,
    MaskParameter,
    ParameterAddress,
    SetIeee,
    SetLong,
)

log = logging.getLogger(__name__)
WORD_MASK = 0xFFFFFFFF


class Host(Protocol):
    """The card as packets see it.

    Unknown numbers raise CardError or MapError, unknown addresses MapError.
    """

    def read_parameter(self, number: int) -> int | float:
        """An int for LONG parameters, a float for all others."""

    def write_parameter(self, number: int, value: int | float) -> None:
        """Store a value; the parameter's type decides how."""

    def write_bit(self, number: int, on: bool) -> None:
        """Set or clear a flag."""

    def override(self, masters: Sequence[int], value: float, *, rapid: bool) -> None:
        """Set FOV, or ROV if `rapid`, of these masters."""

    def issue_move(self, move: Move) -> None:
        """Queue a move; CardError when the card refuses it."""

    def read_words(self, address: int, count: int) -> Sequence[int]:
        """That many 32-bit words of memory."""

    def write_words(self, address: int, words: Sequence[int]) -> None:
        """Store 32-bit words."""

    def parameter_address(self, number: int) -> int:
        """Where a parameter lies; 0 when there is none of that number."""

    def variable_address(self, program: int, kind: int) -> int:
        """Where the local variables of one kind lie; 0 when there are none."""


def execute(host: Host, packet: Packet) -> bytes:
    """Act on a packet and give the reply to send, empty when there is none."""
    handler = _HANDLERS[type(packet)]
    try:
        return handler(host, packet) or b""
    except (MapError, PacketError, CardError) as refused:
        log.debug("%s: %s", packet, refused)
    return b""


def _value(host: Host, number: int) -> int | float:
    """A parameter, or 0 where the map has none."""
    try:
        return host.read_parameter(number)
    except (MapError, CardError):
        return 0


def _long(value: int | float) -> int:
    """A value as 32-bit integer, as a store into a LONG parameter would make it."""
    return value if isinstance(value, int) else long_of(value)


def _finite(value: float) -> float:
    if not math.isfinite(value):
        raise PacketError(f"{value} is no number for a card")
    return value


def _data(host: Host, packet: DataRequest) -> bytes:
    return packet.reply([_value(host, number) for number in packet.parameters()])


def _get_long(host: Host, packet: GetLong) -> bytes:
    return packet.reply([_long(_value(host, packet.parameter))])


def _get_ieee(host: Host, packet: GetIeee) -> bytes:
    return packet.reply([float(_value(host, packet.parameter))])


def _set_long(host: Host, packet: SetLong) -> None:
    host.write_parameter(packet.parameter, packet.value)


def _set_ieee(host: Host, packet: SetIeee) -> None:
    host.write_parameter(packet.parameter, _finite(packet.value))


def _masked(word: int, nand_mask: int, or_mask: int) -> int:
    """Clear the bits of `nand_mask`, then set those of `or_mask`; as signed 32-bit."""
    return wrap32((word & ~nand_mask) | or_mask)


def _mask_parameter(host: Host, packet: MaskParameter) -> None:
    value = host.read_parameter(packet.parameter)
    if not isinstance(value, int):
        raise PacketError(f"P{packet.parameter} is not a LONG parameter")
    host.write_parameter(packet.parameter, _masked(value, packet.nand_mask, packet.or_mask))


def _mask_memory(host: Host, packet: MaskMemory) -> None:
    word = host.read_words(packet.address, 1)[0]
    host.write_words(packet.address, [_masked(word, packet.nand_mask, packet.or_mask)])


def _words(host: Host, address: int, count: int) -> Sequence[int]:
    """Memory words, 0 where there is no memory."""
    try:
        return host.read_words(address, count)
    except MapError:
        return [0] * count


def _peek(host: Host, packet: Peek) -> bytes:
    conversion = packet.conversion
    words = _words(host, packet.address, packet.count * conversion.words)
    raw = b"".join(struct.pack("<I", word & WORD_MASK) for word in words)
    return packet.reply(struct.unpack(f"<{packet.count}{_STORED[conversion]}", raw))


def _poke(host: Host, packet: Poke) -> None:
    conversion = packet.conversion
    values = packet.values
    if conversion is not Conversion.LONG:
        values = tuple(map(_finite, values))
    raw = struct.pack(f"<{packet.count}{_STORED[conversion]}", *values)
    host.write_words(packet.address, struct.unpack(f"<{len(raw) // 4}i", raw))


_STORED = {Conversion.LONG: "i", Conversion.FP64: "d", Conversion.FP32: "f"}


def _parameter_address(host: Host, packet: ParameterAddress) -> bytes:
    return packet.reply([host.parameter_address(packet.parameter)])


def _variable_address(host: Host, packet: VariableAddress) -> bytes:
    return packet.reply([host.variable_address(packet.program, packet.kind)])


def _set(host: Host, packet: SetBit) -> None:
    host.write_bit(packet.bit, True)


def _clear(host: Host, packet: ClearBit) -> None:
    host.write_bit(packet.bit, False)


def _fov(host: Host, packet: FeedrateOverride) -> None:
    host.override(packet.masters(), _finite(packet.value), rapid=False)


def _rov(host: Host, packet: RapidOverride) -> None:
    host.override(packet.masters(), _finite(packet.value), rapid=True)


def _move(host: Host, packet: Move) -> None:
    for value in packet.values():
        _finite(value)
    host.issue_move(packet)


_HANDLERS: dict[type[Packet], Callable[[Host, Any], bytes | None]] = {
    DataRequest: _data,
    GetLong: _get_long,
    GetIeee: _get_ieee,
    SetLong: _set_long,
    SetIeee: _set_ieee,
    MaskParameter: _mask_parameter,
    MaskMemory: _mask_memory,
    Peek: _peek,
    Poke: _poke,
    ParameterAddress: _parameter_address,
    VariableAddress: _variable_address,
    SetBit: _set,
    ClearBit: _clear,
    FeedrateOverride: _fov,
    RapidOverride: _rov,
    Move: _move,
}
