"""Write the journal of a card while it runs.

A card in real time has no milliseconds to spare for a fingerprint of its memory or for a
compressed snapshot: only a copy is taken in the tick, the rest is done in a thread.
Inputs are written together whenever time advances, so a process that is killed loses the last tick.
"""

from __future__ import annotations

import logging
from base64 import b64encode
from importlib.metadata import version
from pathlib import Path
from typing import Protocol

import msgspec

from openacr.controller import snapshot as snapshots
from openacr.controller import snapshot_file
from openacr.controller.journal import Header
from openacr.errors import StoreError, reason
from openacr.journal.entries import Entered, JournalEntry, record_of
from openacr.journal.records import WORKER, Records
from openacr.map.fingerprint import LAYOUT
from openacr.map.memory import digest_of
from openacr.models import Model
from openacr.motion.clock import Clock
from openacr.plant.describe.schema import World
from openacr.store import private

log = logging.getLogger(__name__)

DIGEST_EVERY_S = 1.0


class RecordedCard(Protocol):
    """What a journal on disk needs of its card."""

    model: Model
    world: World
    clock: Clock

    def image(self) -> bytearray:
        """The state that a digest covers."""

    def snapshot(self) -> snapshots.Snapshot:
        """The whole state at this tick."""


class Recorder:
    """Writes the journal of a card from now on, until `close`."""

    def __init__(
        self,
        card: RecordedCard,
        path: Path,
        *,
        project: str = "",
        fingerprint: str = "",
        waits: bool = True,
    ) -> None:
        self._card = card
        self._waits = waits  # for the thread; else what it has no time for is left out
        self.left_out = 0
        self._path = path
        self.records = self._begun()
        self.every_tk = max(1, round(DIGEST_EVERY_S / card.clock.period_s))
        self.next_tk = card.clock.lived_tk + self.every_tk
        image, kept = card.image(), card.snapshot()
        model, world, period_s = card.model.name, card.world, card.clock.period_s
        tick, every_tk = card.clock.lived_tk, self.every_tk

        def header() -> bytes:
            found = Header(
                version("openacr"),
                LAYOUT,
                model,
                world,
                tick,
                period_s,
                digest_of(image),
                every_tk,
                b64encode(snapshot_file.encode(kept)).decode(),
                project,
                fingerprint,
            )
            return msgspec.json.encode(found) + b"\n"

        self.records.work_out(header)

    def _begun(self) -> Records:
        """The new file; where it cannot be written there is none, and StoreError is raised."""
        try:
            file = private.open_to_write(self._path)
            try:
                return Records(file, self._warn)
            except OSError:
                file.close()
                if self._path.is_file():
                    self._path.unlink()
                raise
        except OSError as failure:
            raise StoreError(
                f"{self._path}: cannot be written: {reason(failure).lower()}"
            ) from None

    def _warn(self, failure: OSError) -> None:
        log.warning("%s is not complete: %s", self._path, reason(failure))  # the card continues

    @property
    def failure(self) -> str:
        """Why writing has stopped; empty while it has not."""
        return "" if self.records.failure is None else reason(self.records.failure)

    @property
    def size_bytes(self) -> int:
        """Length of the file."""
        return self.records.size_bytes

    @property
    def is_late(self) -> bool:
        """Whether a fingerprint would have to wait for the thread, and may not."""
        return not self._waits and WORKER.is_full

    def note(self, entry: JournalEntry) -> None:
        """Record an entry; it is written before time advances."""
        if self.records.failure is None:
            self.records.put(record_of(entry))

    def flush(self) -> None:
        """Write the recorded entries."""
        self.records.flush()

    def mark(self) -> None:
        """Write the digest that is due."""
        self._note_digest(Entered.DIGEST)
        self.next_tk = self._card.clock.lived_tk + self.every_tk

    def _note_digest(self, what: Entered) -> None:
        if self.records.failure is not None:
            return
        if what is Entered.DIGEST and self.is_late:
            self._leave_out()
            self.note(JournalEntry(self._card.clock.lived_tk, what))
            return
        tick, image = self._card.clock.lived_tk, self._card.image()
        self.records.work_out(lambda: record_of(JournalEntry(tick, what, text=digest_of(image))))

    def _leave_out(self) -> None:
        if not self.left_out:
            log.warning(
                "%s: the disk or the computer is too slow for a fingerprint every %g s: some are"
                " left out; the journal replays all the same", self._path, DIGEST_EVERY_S
            )  # fmt: skip
        self.left_out += 1

    def end(self) -> None:
        """Write the last digest and close the file, as soon as a thread has done so."""
        self._note_digest(Entered.END)
        self.records.end()

    def close(self) -> None:
        """Write the last digest and close the file."""
        self._note_digest(Entered.END)
        self.records.close()
