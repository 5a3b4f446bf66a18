"""A rolling journal: the last minutes of a card that may run for months."""

from __future__ import annotations

import logging
from contextlib import suppress
from pathlib import Path

from openacr.controller.recorder import RecordedCard, Recorder
from openacr.errors import StoreError
from openacr.journal.entries import JournalEntry
from openacr.store.lock import FolderLock, InUseError

log = logging.getLogger(__name__)

SUFFIX = ".journal"
PLACES = 64  # cards served on one computer at once


class Ring:
    """Keeps the last minutes of a card in a folder, one file per period of time.

    Every file begins with a snapshot, so each can be replayed without the earlier ones. A
    file also ends early when hosts have sent a large amount. A file that cannot be written
    is omitted; the card continues. `waits` as of a `Recorder`: not for a card in real time.
    """

    def __init__(
        self,
        card: RecordedCard,
        folder: Path,
        *,
        file_s: float = 300.0,
        files: int = 3,
        most_bytes: int = 1 << 25,
        waits: bool = True,
    ) -> None:
        self._card, self._folder, self._files = card, folder, files
        self._file_tk = round(file_s / card.clock.period_s)
        self._most_bytes, self._waits = most_bytes, waits
        self._lock = FolderLock(folder)
        self._number = max(map(_number_of, journals(folder)), default=0)
        try:
            self._recorder: Recorder | None = self._begin()
        except StoreError:
            self._lock.release()
            raise

    @property
    def next_tk(self) -> int:
        """When the next digest is due."""
        return self._end_tk if self._recorder is None else self._recorder.next_tk

    def note(self, entry: JournalEntry) -> None:
        """Record an entry."""
        if self._recorder is not None:
            self._recorder.note(entry)

    def flush(self) -> None:
        """Write the recorded entries."""
        if self._recorder is not None:
            self._recorder.flush()

    def mark(self) -> None:
        """Write the digest that is due; when the period of a file is over, begin the next."""
        recorder = self._recorder
        is_full = recorder is not None and recorder.size_bytes > self._most_bytes
        is_late = recorder is not None and recorder.is_late  # no time for the state of a new file
        if is_late or (self._card.clock.lived_tk < self._end_tk and not is_full):
            if recorder is not None:
                recorder.mark()
            return
        if recorder is not None:
            recorder.end()
        try:
            self._recorder = self._begin()
        except StoreError as failure:
            log.warning("no journal for the next minutes: %s", failure)
            self._recorder = None

    def close(self) -> None:
        """Close the current file and release the folder."""
        if self._recorder is not None:
            self._recorder.close()
        self._lock.release()

    def _begin(self) -> Recorder:
        self._number += 1
        self._end_tk = self._card.clock.lived_tk + self._file_tk
        for path in journals(self._folder)[: -self._files + 1 or None]:
            path.unlink(missing_ok=True)
        return Recorder(self._card, self._folder / f"{self._number:06}{SUFFIX}", waits=self._waits)


def own_ring(card: RecordedCard, folder: Path) -> Ring:
    """A ring in the first folder `folder/1`, `folder/2`, ... that no other card uses."""
    for place in range(1, PLACES + 1):
        with suppress(InUseError):
            return Ring(card, folder / str(place), waits=False)
    raise StoreError(f"{folder} has no room for another card: {PLACES} cards use it")


def journals(folder: Path) -> list[Path]:
    """The files of a ring, oldest first."""
    found = (path for path in folder.glob(f"*{SUFFIX}") if _number_of(path))
    return sorted(found, key=_number_of)


def _number_of(path: Path) -> int:
    return int(path.stem) if path.stem.isascii() and path.stem.isdigit() else 0
