"""Options of the communication with a card, and its time-outs."""

from msgspec import Struct

from openacr.channels import EchoMode

SLOWEST_BYTES_PER_S = 1024  # assumed lowest rate: a long reply extends the deadline


class Options(Struct, frozen=True, kw_only=True):
    """Options of the communication with a card.

    `timeout_s`: longest silence while waiting for a reply (None: unlimited, and no deadline).
    `deadline_s`: longest time until a reply is complete, plus a second for every KiB of it
    (None: unlimited). `reconnect_s`: how long to retry after a lost connection (0: no retry).
    `uses_packets`: read parameters with binary packets, exact and up to eight at once; otherwise
    by text.
    """

    timeout_s: float | None = 5.0
    deadline_s: float | None = 60.0
    reconnect_s: float = 10.0
    echo: EchoMode = EchoMode.CHARACTERS
    uses_packets: bool = True


class Patience(Struct, frozen=True):
    """Limits of a reply: longest silence, and the time by which it must be complete."""

    silence_s: float | None
    begin_s: float
    deadline_s: float | None

    def left_s(self, now_s: float, received_bytes: int) -> float | None:
        """How long the next bytes may take; 0 or less when the deadline has passed."""
        if self.silence_s is None or self.deadline_s is None:
            return self.silence_s
        allowed_s = max(self.deadline_s, self.silence_s) + received_bytes / SLOWEST_BYTES_PER_S
        return min(self.silence_s, self.begin_s + allowed_s - now_s)
