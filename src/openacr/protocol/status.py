"""The fast status over UDP: its subscribers and its datagrams.

The manuals do not describe this service; captures of real cards do. A host sends two words to
port 5003, enable and interval in milliseconds; `0, 0` ends it. The card sends datagrams of 80
words from that port to the address and port the request came from: the eight words of FSTAT0,
then those of FSTAT1 and so on. All words are of 32 bits, high byte first, LONG or FP32 as
FSTAT holds them, and zero before FSTAT is set up.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Self, TypeAlias

from msgspec import Struct

STATUS_PORT = 5003
GROUPS, WORDS = 10, 8
_REQUEST = struct.Struct(">II")
_DATAGRAM = struct.Struct(f">{GROUPS * WORDS}i")
STATUS_BYTES = _DATAGRAM.size

SUBSCRIBERS = 16
SHORTEST_MS, LONGEST_MS = 10, 60_000
LIFE_S = 60.0

Endpoint: TypeAlias = tuple[str, int] | tuple[str, int, int, int]  # of IPv4, IPv6


class StatusRequest(Struct, frozen=True):
    """A request to send the status at an interval in milliseconds, or to stop."""

    is_on: bool
    interval_ms: int = 0

    @classmethod
    def decode(cls, data: bytes) -> Self | None:
        """The request in a datagram; None if it is something else."""
        if len(data) != _REQUEST.size:
            return None
        enable, interval_ms = _REQUEST.unpack(data)
        return cls(enable != 0, interval_ms)

    def encode(self) -> bytes:
        """The bytes of the datagram."""
        return _REQUEST.pack(int(self.is_on), self.interval_ms)


class FastStatus(Struct, frozen=True):
    """The eight words of each of the ten groups."""

    words: tuple[int, ...] = (0,) * (GROUPS * WORDS)

    @classmethod
    def decode(cls, datagram: bytes) -> Self | None:
        """The status in a datagram; None if it is not a status."""
        return cls(_DATAGRAM.unpack(datagram)) if len(datagram) == STATUS_BYTES else None

    def encode(self) -> bytes:
        """The bytes of the datagram."""
        return _DATAGRAM.pack(*self.words)

    def longs(self, group: int) -> tuple[int, ...]:
        """The words of FSTAT0 to FSTAT9 as LONG."""
        return self.words[WORDS * group : WORDS * (group + 1)]

    def floats(self, group: int) -> tuple[float, ...]:
        """The words of FSTAT0 to FSTAT9 as FP32."""
        return struct.unpack(f"={WORDS}f", struct.pack(f"={WORDS}i", *self.longs(group)))


@dataclass(slots=True)
class _Subscription:
    interval_s: float
    due_s: float
    asked_s: float


@dataclass(slots=True)
class Subscribers:
    """The hosts subscribed to the status and their due times, in seconds of any clock.

    Addresses of datagrams can be forged. So nothing is sent in return for a request itself, the
    rate and the number of subscribers are limited, and a subscription ends LIFE_S after its
    latest request, unless the host is known by a connection.
    """

    _found: dict[Endpoint, _Subscription] = field(default_factory=dict)
    _expired: list[Endpoint] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self._found)

    def take(self, request: StatusRequest, sender: Endpoint, now_s: float) -> bool:
        """Begin, renew or end a subscription; False when there are too many."""
        if not request.is_on:
            self._found.pop(sender, None)
            return True
        interval_s = min(max(request.interval_ms, SHORTEST_MS), LONGEST_MS) / 1000
        if (known := self._found.get(sender)) is not None:
            known.due_s += interval_s - known.interval_s
            known.interval_s, known.asked_s = interval_s, now_s
            return True
        if len(self._found) >= SUBSCRIBERS:
            return False
        self._found[sender] = _Subscription(interval_s, now_s + interval_s, now_s)
        return True

    def due(self, now_s: float, connected: set[str]) -> Iterator[Endpoint]:
        """The hosts to send a datagram now; missed intervals are skipped."""
        for endpoint, each in list(self._found.items()):
            if endpoint[0] in connected:
                each.asked_s = now_s
            if now_s - each.asked_s > LIFE_S:
                del self._found[endpoint]
                self._expired.append(endpoint)
            elif now_s >= each.due_s:
                missed = (now_s - each.due_s) // each.interval_s
                each.due_s += (missed + 1) * each.interval_s
                yield endpoint

    def take_expired(self) -> list[Endpoint]:
        """The hosts whose subscriptions have expired since the last call."""
        expired, self._expired = self._expired, []
        return expired
