"""What the servers need of a card: streams of bytes and ticks of time."""

from typing import Protocol

from openacr.channels import StreamKind


class CardHost(Protocol):
    """A card that hosts can talk to; every method returns at once."""

    @property
    def period_s(self) -> float:
        """Seconds of card time per tick."""

    def open_stream(self, kind: StreamKind) -> int:
        """A stream for a new connection; NoFreeStreamError when all are taken."""

    def close_stream(self, stream: int) -> None:
        """The connection ended; motion and programs go on."""

    def receive(self, stream: int, data: bytes) -> None:
        """Bytes that arrived together, at the present tick."""

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""

    def replying(self, stream: int) -> bool:
        """True while something received is on its way to an answer and not blocked."""

    def take_output(self, stream: int) -> bytes:
        """The bytes of the next write, none when there is nothing to send."""

    def advance(self, ticks: int) -> None:
        """Let card time pass."""

    def fast_status(self) -> bytes:
        """The datagram of the status service: 80 words of FSTAT, high byte first."""
