"""Packets that read, write and mask one parameter by its number (UG2 ch. 6)."""

from typing import ClassVar

from openacr.protocol.host import Host, PacketError, finite, long_value_of, masked, value_of
from openacr.protocol.packet import F32, I32, U16, U32, Packet, Request, register


class _OneParameter(Packet, frozen=True):
    """A packet that begins with the number of a parameter."""

    parameter: U16

    def parameters(self) -> tuple[int]:
        """The number of the parameter."""
        return (self.parameter,)


@register
class GetLong(_OneParameter, Request, frozen=True):
    """Read one parameter as a 32-bit integer."""

    HEADER: ClassVar[bytes] = b"\x00\x88"

    def reply_words(self) -> int:
        """The value as LONG."""
        return 1

    def act(self, host: Host) -> bytes:
        """Read it; 0 where there is none."""
        return self.reply([long_value_of(host, self.parameter)])


@register
class SetLong(_OneParameter, frozen=True):
    """Write one parameter as a 32-bit integer; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x00\x89"
    value: I32

    def act(self, host: Host) -> bytes:
        """Store the value."""
        host.write_parameter(self.parameter, self.value)
        return b""


@register
class GetIeee(_OneParameter, Request, frozen=True):
    """Read one parameter as an IEEE single."""

    HEADER: ClassVar[bytes] = b"\x00\x8a"

    def reply_words(self) -> int:
        """The value as IEEE single."""
        return 1

    def act(self, host: Host) -> bytes:
        """Read it; 0 where there is none."""
        return self.reply([float(value_of(host, self.parameter))])


@register
class SetIeee(_OneParameter, frozen=True):
    """Write one parameter as an IEEE single; the card sends nothing back."""

    HEADER: ClassVar[bytes] = b"\x00\x8b"
    value: F32

    def act(self, host: Host) -> bytes:
        """Store the value, unless it is not a number."""
        host.write_parameter(self.parameter, finite(self.value))
        return b""


@register
class ParameterAddress(_OneParameter, Request, frozen=True):
    """Query the memory address of a parameter; 0: there is no such parameter."""

    HEADER: ClassVar[bytes] = b"\x00\x93"

    def reply_words(self) -> int:
        """The address."""
        return 1

    def act(self, host: Host) -> bytes:
        """Return the address."""
        return self.reply([host.parameter_address(self.parameter)])


@register
class MaskParameter(_OneParameter, frozen=True):
    """Clear the bits of `nand_mask`, then set those of `or_mask`, in a LONG parameter."""

    # The printed example starts with 00 94 (erratum); the layout and the later guide have 95.
    HEADER: ClassVar[bytes] = b"\x00\x95"
    nand_mask: U32
    or_mask: U32

    def act(self, host: Host) -> bytes:
        """Mask the parameter; PacketError if it is not LONG."""
        value = host.read_parameter(self.parameter)
        if not isinstance(value, int):
            raise PacketError(f"P{self.parameter} is not a LONG parameter")
        host.write_parameter(self.parameter, masked(value, self.nand_mask, self.or_mask))
        return b""
