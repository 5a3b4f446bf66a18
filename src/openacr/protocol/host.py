"""The interface through which packets act on a card, with shared conversions."""

import math
from collections.abc import Sequence
from typing import Any, Protocol

from openacr.errors import CardError, MapError, OpenacrError
from openacr.kernel.words_cy import wrap32
from openacr.map.memory import long_of


class PacketError(OpenacrError):
    """A packet that cannot be built, or bytes that are not the packet they should be."""


class Host(Protocol):
    """The interface of a card that packets use.

    Unknown numbers raise CardError or MapError, unknown addresses MapError.
    """

    def read_parameter(self, number: int) -> int | float:
        """Read a parameter: an int for LONG parameters, a float for all others."""

    def write_parameter(self, number: int, value: int | float) -> None:
        """Store a value, converted to the type of the parameter."""

    def write_bit(self, number: int, on: bool) -> None:
        """Set or clear a flag."""

    def override(self, masters: Sequence[int], value: float, *, rapid: bool) -> None:
        """Set FOV, or ROV if `rapid`, of these masters."""

    def issue_move(self, move: Any) -> None:
        """Queue a `protocol.move.Move`, itself a packet; CardError when the card refuses it."""

    def read_words(self, address: int, count: int) -> Sequence[int]:
        """Read `count` 32-bit words of memory from an address on."""

    def write_words(self, address: int, words: Sequence[int]) -> None:
        """Store 32-bit words from an address on."""

    def parameter_address(self, number: int) -> int:
        """The address of a parameter; 0 if there is no such parameter."""

    def variable_address(self, program: int, kind: int) -> int:
        """The address of the local variables of one kind; 0 if there are none."""


def value_of(host: Host, number: int) -> int | float:
    """Read a parameter, or 0 if it does not exist: undefined fields of a reply read 0."""
    try:
        return host.read_parameter(number)
    except (MapError, CardError):
        return 0


def long_value_of(host: Host, number: int) -> int:
    """Read a parameter as 32-bit integer, converted as by storing into a LONG parameter."""
    value = value_of(host, number)
    return value if isinstance(value, int) else long_of(value)


def finite(value: float) -> float:
    """Return the value; PacketError for infinities and NaN, which no parameter may have."""
    if not math.isfinite(value):
        raise PacketError(f"{value} is not a number for a card")
    return value


def masked(word: int, nand_mask: int, or_mask: int) -> int:
    """Clear the bits of `nand_mask`, then set those of `or_mask`; returns signed 32-bit."""
    return wrap32((word & ~nand_mask) | or_mask)
