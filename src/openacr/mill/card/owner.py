"""Ownership of a machine: one program at a time drives it.

Programs of one store are kept apart by a lock beside it, which ends with its process. For
those of other stores and computers the owner increments a variable of the card while it runs: a
value that does not change was left by a program that has ended. Ownership is claimed by one
line that compares and writes, which the card executes atomically, and read back after a delay:
of two hosts that start together only one reads its own number.
"""

from pathlib import Path
from random import SystemRandom

from openacr.client import Card
from openacr.cnc.occupied import HEARTBEAT
from openacr.errors import UserError
from openacr.locks import FileLock
from openacr.sysvar.driven import machine_lock

BEAT_S, LISTEN_S, SETTLE_S = 0.5, 1.6, 0.1
TAKEN = "another program drives this machine: wait until it ends, or end it"
BEATS, OWNERS = 1 << 10, 1 << 20  # a value is owner * BEATS + beat: 30 bits


class Owner:
    """Ownership of a machine until `release`; UserError while another program has it."""

    def __init__(
        self, card: Card, store: Path | None, *, program: int = 0, listen_s: float = LISTEN_S
    ) -> None:
        self._card = card
        self._program = program
        self._number = SystemRandom().randrange(1, OWNERS)
        self._beat = 0
        self._due_s = 0.0
        self._lock = None if store is None else FileLock(machine_lock(store), TAKEN)
        try:
            self.found = self._require_silence(listen_s)  # left by a program that has ended
            self._claim()
        except BaseException:
            self._unlock()
            raise

    def _require_silence(self, listen_s: float) -> int:
        before = self._read()
        if before:
            self._card.pause(listen_s)
            if self._read() != before:
                raise UserError(TAKEN)
        return before

    def _claim(self) -> None:
        self._exchange(self.found, self._value)
        self._card.pause(SETTLE_S)  # longer than the card takes between compare and write
        if not self.is_ours():
            raise UserError(TAKEN)

    @property
    def _value(self) -> int:
        return self._number * BEATS + self._beat % BEATS

    def _read(self) -> int:
        return int(self._card.ask(f"P{HEARTBEAT}"))

    def _exchange(self, old: int, new: int) -> None:
        line = f"IF (P{HEARTBEAT}={old}) THEN P{HEARTBEAT}={new}"
        self._card.command(line, program=self._program)

    def is_ours(self) -> bool:
        """Whether this program still owns the machine."""
        return self._read() // BEATS == self._number

    def beat(self, now_s: float) -> bool:
        """Increment the heartbeat when due; False when another program has taken the machine."""
        if now_s < self._due_s:
            return True
        self._due_s = now_s + BEAT_S
        before = self._read()
        if before and before // BEATS != self._number:
            return False
        self._beat += 1  # 0 is no other owner: the card was reset, which the next poll reports
        self._exchange(before, self._value)
        return True

    def release(self, *, left: int = 0) -> None:
        """Give up the machine; `left` is the final value of the variable."""
        try:
            before = self._read()
            if before // BEATS == self._number:
                self._exchange(before, left)
        finally:
            self._unlock()

    def forget(self) -> None:
        """Release the lock of the store without sending anything to the card."""
        self._unlock()

    def _unlock(self) -> None:
        if self._lock is not None:
            self._lock.release()
            self._lock = None
