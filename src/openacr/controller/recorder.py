"""Write the journal of a card while it runs.

A card in real time has no milliseconds to spare for a fingerprint of its memory or for a
compressed snapshot: only a copy is taken in the tick, the rest is done in a thread.
Records keep their order; those after an unfinished one wait for it. Inputs are written
together whenever time advances, so a process that is killed loses the last tick.
"""

from __future__ import annotations

import logging
from base64 import b64encode
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from importlib.metadata import version
from pathlib import Path
from typing import Any, Protocol, TypeVar

import msgspec

from openacr.controller import snapshot as snapshots
from openacr.controller import snapshot_file
from openacr.controller.journal import MAGIC, Entered, Header, JournalEntry, record_of
from openacr.errors import StoreError, reason
from openacr.map.fingerprint import LAYOUT
from openacr.map.memory import digest_of
from openacr.models import Model
from openacr.plant.schema import World
from openacr.store import private

log = logging.getLogger(__name__)

DIGEST_EVERY_S = 1.0
T = TypeVar("T")
MOST_WORKED_OUT = 8  # records that are being computed; each holds a copy of the state (3 MB)
TOGETHER_BYTES = 1 << 16


class _Worker:
    """The thread of all journals of this process, with at most MOST_WORKED_OUT records to compute.

    Each of them holds copies of the state: a card that runs faster than the thread would take all
    memory.
    """

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="journal")
        self._open: deque[Future[Any]] = deque()

    @property
    def is_full(self) -> bool:
        while self._open and self._open[0].done():
            self._open.popleft()
        return len(self._open) >= MOST_WORKED_OUT

    def submit(self, do: Callable[[], T]) -> Future[T]:
        """Have something done after all that was submitted before; waits while `is_full`."""
        while self.is_full:
            wait([self._open[0]])
        future = self._pool.submit(do)
        self._open.append(future)
        return future


_WORKER = _Worker()


class Records:
    """A file of records in order, some of which are still being computed.

    When the disk is full the file ends with its last complete record and the card continues.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.failure = ""  # why writing has stopped
        self.size_bytes = 0
        self._waiting: deque[bytes | Future[bytes]] = deque()
        self._waiting_bytes = 0
        try:
            self._file = private.open_to_write(path)
            self._write_mark()
        except OSError as failure:
            raise StoreError(f"{path}: cannot be written: {reason(failure).lower()}") from None

    def _write_mark(self) -> None:
        try:
            self._write_all(MAGIC)
        except OSError:
            self._file.close()
            if self.path.is_file():
                self.path.unlink()
            raise

    def put(self, record: bytes) -> None:
        """Append one record."""
        self._waiting.append(record)
        self._waiting_bytes += len(record)
        if self._waiting_bytes > TOGETHER_BYTES:
            self.flush()

    def work_out(self, record: Callable[[], bytes]) -> None:
        """Append a record that a thread computes; waits while the thread has too many."""
        self._waiting.append(_WORKER.submit(record))

    def flush(self, *, waits: bool = False) -> None:
        """Write the records that are ready; with `waits`, all of them."""
        ready = bytearray()
        while self._waiting and (waits or _is_ready(self._waiting[0])):
            record = self._waiting.popleft()
            ready += record if isinstance(record, bytes) else record.result()
        self._waiting_bytes = 0
        if ready and not self.failure:
            self._write(ready)

    def _write(self, data: bytearray) -> None:
        try:
            self._write_all(data)
        except OSError as failure:  # the card continues
            self.failure = reason(failure)
            log.warning("%s is not complete: %s", self.path, self.failure)

    def _write_all(self, data: bytes | bytearray) -> None:
        self.size_bytes += len(data)
        rest = memoryview(data)
        while rest:
            rest = rest[self._file.write(rest) :]

    def end(self) -> None:
        """Close the file as soon as everything is written, without waiting for it."""
        self.flush()
        _WORKER.submit(self.close)

    def close(self) -> None:
        """Write everything and close the file."""
        self.flush(waits=True)
        self._file.close()


def _is_ready(record: bytes | Future[bytes]) -> bool:
    return isinstance(record, bytes) or record.done()


class RecordedCard(Protocol):
    """What a journal on disk needs of its card."""

    model: Model
    world: World

    @property
    def period_s(self) -> float:
        """Length of a tick [s]."""

    @property
    def lived_tk(self) -> int:
        """Ticks in total, those before restarts included."""

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
        self.records = Records(path)
        self.every_tk = max(1, round(DIGEST_EVERY_S / card.period_s))
        self.next_tk = card.lived_tk + self.every_tk
        image, kept = card.image(), card.snapshot()
        model, world, period_s = card.model.name, card.world, card.period_s
        tick, every_tk = card.lived_tk, self.every_tk

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

    @property
    def failure(self) -> str:
        """Why writing has stopped; empty while it has not."""
        return self.records.failure

    @property
    def size_bytes(self) -> int:
        """Length of the file."""
        return self.records.size_bytes

    @property
    def is_late(self) -> bool:
        """Whether a fingerprint would have to wait for the thread, and may not."""
        return not self._waits and _WORKER.is_full

    def note(self, entry: JournalEntry) -> None:
        """Record an entry; it is written before time advances."""
        if not self.failure:
            self.records.put(record_of(entry))

    def flush(self) -> None:
        """Write the recorded entries."""
        self.records.flush()

    def mark(self) -> None:
        """Write the digest that is due."""
        self._note_digest(Entered.DIGEST)
        self.next_tk = self._card.lived_tk + self.every_tk

    def _note_digest(self, what: Entered) -> None:
        if self.failure:
            return
        if what is Entered.DIGEST and self.is_late:
            self._leave_out()
            self.note(JournalEntry(self._card.lived_tk, what))
            return
        tick, image = self._card.lived_tk, self._card.image()
        self.records.work_out(lambda: record_of(JournalEntry(tick, what, text=digest_of(image))))

    def _leave_out(self) -> None:
        if not self.left_out:
            log.warning(
                "%s: the disk or the computer is too slow for a fingerprint every %g s: some are"
                " left out; the journal replays all the same", self.records.path, DIGEST_EVERY_S
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
