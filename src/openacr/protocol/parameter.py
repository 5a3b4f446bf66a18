"""Packets that read, write and mask one parameter by its number (UG2 ch. 6)."""

from dataclasses import dataclass
from typing import ClassVar

from openacr.protocol.packet import F32, I32, U16, U32, Packet, register


@register
@dataclass(frozen=True, slots=True)
class GetLong(Packet):
    """Read one parameter as a 32-bit integer."""

    HEADER: ClassVar[bytes] = b"\x00\x88"
    parameter: U16

    def reply_words(self) -> int:
        """The value as LONG."""
        return 1


@register
@dataclass(frozen=True, slots=True)
class SetLong(Packet):
    """Write one parameter as a 32-bit integer; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x00\x89"
    parameter: U16
    value: I32


@register
@dataclass(frozen=True, slots=True)
class GetIeee(Packet):
    """Read one parameter as an IEEE single."""

    HEADER: ClassVar[bytes] = b"\x00\x8a"
    parameter: U16

    def reply_words(self) -> int:
        """The value as IEEE single."""
        return 1


@register
@dataclass(frozen=True, slots=True)
class SetIeee(Packet):
    """Write one parameter as an IEEE single; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x00\x8b"
    parameter: U16
    value: F32


@register
@dataclass(frozen=True, slots=True)
class ParameterAddress(Packet):
    """Ask for the memory address of a parameter; 0 means there is no such parameter."""

    HEADER: ClassVar[bytes] = b"\x00\x93"
    parameter: U16

    def reply_words(self) -> int:
        """The address."""
        return 1


@register
@dataclass(frozen=True, slots=True)
class MaskParameter(Packet):
    """Clear the bits of `nand_mask`, then set those of `or_mask`, in a LONG parameter."""

    # The printed example starts with 00 94 (erratum); the layout and the later guide have 95.
    HEADER: ClassVar[bytes] = b"\x00\x95"
    parameter: U16
    nand_mask: U32
    or_mask: U32
