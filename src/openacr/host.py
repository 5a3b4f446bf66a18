"""The interface of a card that the servers use: byte streams and ticks."""

from typing import Protocol

from openacr.channels import StreamKind


class CardHost(Protocol):
    """A card that hosts can talk to; every method returns at once."""

    @property
    def period_s(self) -> float:
        """Seconds of card time per tick."""

    def open_stream(self, kind: StreamKind) -> int:
        """Open a stream for a new connection; NoFreeStreamError if all are in use."""

    def close_stream(self, stream: int) -> None:
        """Close the stream of an ended connection; motion and programs continue."""

    def receive(self, stream: int, data: bytes) -> None:
        """Process bytes that arrived together at the present tick."""

    def accepts_input(self, stream: int) -> bool:
        """False while the sender should be held back."""

    def replying(self, stream: int) -> bool:
        """True while received input is being processed and is not blocked."""

    def take_output(self, stream: int) -> bytes:
        """Return the bytes of the next write, empty when there is nothing to send."""

    def advance(self, ticks: int) -> None:
        """Let card time pass."""

    def fast_status(self) -> bytes:
        """The datagram of the status service: 80 words of FSTAT, high byte first."""
