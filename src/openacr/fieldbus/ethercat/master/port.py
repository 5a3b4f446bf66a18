"""Datagrams out, datagrams back: a segment as a master sees it through one network port.

What carries frames (a network interface, a segment in the same process) is a `Link`.
"""

from typing import Protocol

from openacr.errors import UserError
from openacr.fieldbus.ethercat.wire.frames import (
    Command,
    Datagram,
    WireError,
    by_station,
    pack,
    parse,
)

TRIES = 50  # of what is not cyclic: half a second of lost frames


class BusError(UserError):
    """The bus, or a device on it, does not do what was asked."""


class Link(Protocol):
    """What carries frames to the devices and back."""

    name: str

    def exchange(self, frame: bytes) -> bytes | None:
        """Send a frame; as it comes back, None if it does not in time."""

    def now_s(self) -> float:
        """Seconds of a clock that never goes back."""

    def pause(self, seconds: float) -> None:
        """Let time pass."""


class Port:
    """Asks the devices of a segment."""

    def __init__(self, link: Link) -> None:
        self.link = link
        self._index = 0
        self.lost = 0  # frames

    def once(self, datagrams: list[Datagram]) -> list[Datagram] | None:
        """Send datagrams in one frame; None if it is lost, damaged, or another one comes back."""
        self._index = self._index % 255 + 1
        for datagram in datagrams:
            datagram.index, datagram.counter = self._index, 0
        answer = self.link.exchange(pack(datagrams))
        try:
            back = parse(answer) if answer is not None else []
        except WireError:
            back = []
        if not _answers(datagrams, back):
            self.lost += 1
            return None
        return back

    def ask(self, datagram: Datagram) -> Datagram:
        """Send a datagram until it comes back; BusError if it never does."""
        for _ in range(TRIES):
            if back := self.once([datagram]):
                return back[0]
        hint = "is the cable in, and has the first device power?"
        raise BusError(f"no frame comes back on {self.link.name}: {hint}")

    def read(self, station: int, register: int, size: int) -> bytes:
        """Read registers of a device; BusError if it does not answer."""
        return self._asked(by_station(Command.FPRD, station, register, bytes(size))).data

    def word(self, station: int, register: int) -> int:
        """Read a word."""
        return int.from_bytes(self.read(station, register, 2), "little")

    def write(self, station: int, register: int, data: bytes) -> None:
        """Write registers of a device; BusError if it does not answer."""
        self._asked(by_station(Command.FPWR, station, register, data))

    def write_word(self, station: int, register: int, value: int) -> None:
        """Write a word."""
        self.write(station, register, value.to_bytes(2, "little"))

    def _asked(self, datagram: Datagram) -> Datagram:
        for _ in range(TRIES):
            back = self.ask(datagram)
            if back.counter == 1:
                return back
        raise BusError(
            f"device {datagram.position - FIRST_STATION} does not answer at register"
            f" 0x{datagram.offset:04X}: has it power?"
        )


FIRST_STATION = 0x1000  # of the device at position 0


def _answers(sent: list[Datagram], back: list[Datagram]) -> bool:
    return len(sent) == len(back) and all(
        (one.command, one.index, len(one.data)) == (two.command, two.index, len(two.data))
        for one, two in zip(sent, back, strict=True)
    )
