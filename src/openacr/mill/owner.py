"""One program at a time drives a machine.

Programs of one store are kept apart by a lock beside it, which ends with its process. For
those of other stores and computers the card has a variable that the owner counts on as long
as it looks: one that stands still was left by a program that is gone.
"""

from pathlib import Path

from openacr.client import Card
from openacr.errors import UserError
from openacr.store.lock import FileLock

HEARTBEAT = 96  # variable of the card; 0 where nobody drives it
BEAT_S, LISTEN_S = 0.5, 1.6
TAKEN = "another program drives this machine: wait for its end, or end it"
SUFFIX = "-machine"


class Owner:
    """The ownership of a machine, until `release`; refused while another program has it."""

    def __init__(self, card: Card, store: Path | None) -> None:
        self._card = card
        self._beats = 1
        self._due_s = 0.0
        named = None if store is None else store.with_name(store.name + SUFFIX)
        self._lock = None if named is None else FileLock(named, TAKEN)
        try:
            self._require_silence()
        except BaseException:
            self._unlock()
            raise

    def _require_silence(self) -> None:
        before = self._card.read(HEARTBEAT)
        if before:
            self._card.pause(LISTEN_S)
            if self._card.read(HEARTBEAT) != before:
                raise UserError(TAKEN)

    def keep(self, now_s: float) -> None:
        """Count on when it is time to."""
        if now_s >= self._due_s:
            self._due_s = now_s + BEAT_S
            self._card.write(HEARTBEAT, self._beats)
            self._beats += 1

    def release(self, *, tells_card: bool = True) -> None:
        """Let others have the machine; a card that is out of reach is not told."""
        try:
            if tells_card:
                self._card.write(HEARTBEAT, 0)
        finally:
            self._unlock()

    def _unlock(self) -> None:
        if self._lock is not None:
            self._lock.release()
            self._lock = None
