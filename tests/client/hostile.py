"""Servers that are no card, on a line with a clock of its own: no test waits for them."""

from collections.abc import Callable, Iterator
from itertools import repeat

from openacr.client import ConnectionLostError
from openacr.client.links import CONNECT_S, ProcessLink
from openacr.controller import Controller

FOR_EVER_S = 20_000.0
Behaviour = Callable[[bytes], Iterator[tuple[float, bytes]]]


class HostileLink(ProcessLink):
    """A card in this process that turns hostile when `behaviour` is set.

    A behaviour gets what was sent last and says what comes: after how many seconds, which bytes.
    """

    def __init__(self, behaviour: Behaviour | None = None) -> None:
        super().__init__(Controller())
        self.behaviour = behaviour
        self.passed_s = 0.0
        self._coming: Iterator[tuple[float, bytes]] = iter(())
        self._next: tuple[float, bytes] | None = None

    def write(self, data: bytes) -> None:
        if self.behaviour is None:
            super().write(data)
            return
        self._coming, self._next = self.behaviour(data), None

    def read(self, timeout_s: float | None) -> bytes:
        if self.behaviour is None:
            return super().read(timeout_s)
        if self._next is None:
            self._next = next(self._coming)
        delay_s, data = self._next
        assert timeout_s is not None or delay_s < FOR_EVER_S, "waits for ever"
        if timeout_s is not None and delay_s > timeout_s:
            self._pass(timeout_s)
            self._next = (delay_s - timeout_s, data)
            return b""
        self._pass(delay_s)
        self._next = None
        if data == CLOSED:
            raise ConnectionLostError("the connection was closed")
        return data

    def _pass(self, seconds: float) -> None:
        self.passed_s += seconds
        assert self.passed_s < FOR_EVER_S, "held for ever"

    def pause(self, seconds: float) -> None:
        self._pass(seconds)

    def now_s(self) -> float:
        return super().now_s() + self.passed_s


CLOSED = b"(closed)"


def silent(sent: bytes) -> Iterator[tuple[float, bytes]]:
    yield from repeat((1e9, b""))


def drips(sent: bytes) -> Iterator[tuple[float, bytes]]:
    """One byte a second, the echo first."""
    yield from ((1.0, bytes((byte,))) for byte in sent.replace(b"\r", b"\r\n"))
    yield from repeat((1.0, b"x"))


def drips_line_ends(sent: bytes) -> Iterator[tuple[float, bytes]]:
    yield (0.0, sent.replace(b"\r", b"\r\n"))
    yield from repeat((0.1, b"\r\n"))


def drips_prompts(sent: bytes) -> Iterator[tuple[float, bytes]]:
    """What may be a prompt, and then goes on just in time."""
    yield (0.0, sent.replace(b"\r", b"\r\n"))
    yield from repeat((0.14, b"SYS> "))


def floods(sent: bytes) -> Iterator[tuple[float, bytes]]:
    yield (0.0, sent.replace(b"\r", b"\r\n"))
    yield from repeat((0.0001, b"x" * 65536))


def floods_slowly(sent: bytes) -> Iterator[tuple[float, bytes]]:
    """A little quicker than the slowest line there may be."""
    yield from repeat((1.0, b"x" * 1100))


def floods_junk(sent: bytes) -> Iterator[tuple[float, bytes]]:
    yield from repeat((0.0001, bytes(range(256)) * 256))


def never_prompts(sent: bytes) -> Iterator[tuple[float, bytes]]:
    """Lines, each before the silence is too long."""
    yield (0.0, sent.replace(b"\r", b"\r\n"))
    yield from repeat((4.9, b"still there\r\n"))


def half_a_packet(sent: bytes) -> Iterator[tuple[float, bytes]]:
    """The repeated request, then data in pieces of nothing that ever fit."""
    yield (0.0, sent + b"\x01\x02\x03")
    yield from repeat((1e9, b""))


def closes(sent: bytes) -> Iterator[tuple[float, bytes]]:
    yield from repeat((0.0, CLOSED))


def is_full(sent: bytes) -> Iterator[tuple[float, bytes]]:
    """Takes no more, as a socket whose far end reads nothing."""
    yield from repeat((CONNECT_S, CLOSED))


SERVERS = (
    silent, drips, drips_line_ends, drips_prompts, floods, floods_slowly, floods_junk,
    never_prompts, half_a_packet, closes, is_full,
)  # fmt: skip
