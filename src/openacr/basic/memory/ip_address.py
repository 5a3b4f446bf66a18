"""Addresses of the network: four octets, a class, a mask that tells network from host."""

from __future__ import annotations

from msgspec import Struct

from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT

_PRIVATE = ((10, 8), (172 << 4 | 1, 12), (192 << 8 | 168, 16))  # network, its bits
_CLASSES = ((128, "A", 8), (192, "B", 16), (224, "C", 24))  # first octet below, name, bits


class IpAddress(Struct, frozen=True):
    """An address, or a mask."""

    octets: tuple[int, int, int, int]

    @classmethod
    def read(cls, text: str) -> IpAddress:
        """The address as dotted text; `Invalid argument` unless it has four octets 0 to 255."""
        parts = text.strip().split(".")
        if len(parts) != 4 or not all(part.isascii() and part.isdigit() for part in parts):
            raise CardError(INVALID_ARGUMENT)
        first, second, third, fourth = map(int, parts)
        if max(first, second, third, fourth) > 255:
            raise CardError(INVALID_ARGUMENT)
        return cls((first, second, third, fourth))

    def __str__(self) -> str:
        """The address as it is typed."""
        return ".".join(map(str, self.octets))

    @property
    def number(self) -> int:
        """All 32 bits."""
        return int.from_bytes(self.octets, "big")

    @property
    def network_class(self) -> tuple[str, int] | None:
        """Class and network bits by the first octet; None for what is no host's address."""
        found = (item for item in _CLASSES if self.octets[0] < item[0])
        _, name, bits = next(found, (0, "", 0))
        return (name, bits) if name else None

    @property
    def is_mask(self) -> bool:
        """Whether no one bit follows a zero bit."""
        zeros = self.number ^ 0xFFFFFFFF
        return zeros & zeros + 1 == 0

    @property
    def is_private(self) -> bool:
        """Whether the address belongs to a range for private networks."""
        return any(self.number >> 32 - bits == network for network, bits in _PRIVATE)

    def subnet(self, mask: IpAddress) -> str:
        """The octets of the network: those the mask has bits for."""
        used = [(octet & bits, bits) for octet, bits in zip(self.octets, mask.octets, strict=True)]
        return ".".join(str(octet) for octet, bits in used if bits)

    def host(self, mask: IpAddress) -> int:
        """The number of the host in its network."""
        return self.number & ~mask.number & 0xFFFFFFFF

    def shares_network(self, other: IpAddress, mask: IpAddress) -> bool:
        """Whether two hosts reach each other without a router."""
        return (self.number ^ other.number) & mask.number == 0

    def check_host(self, mask: IpAddress) -> None:
        """A host has no octet 255, and its part outside the mask is not zero."""
        if 255 in self.octets or not self.host(mask):
            raise CardError(INVALID_ARGUMENT)
