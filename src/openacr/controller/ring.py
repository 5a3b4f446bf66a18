"""The journal of the last minutes of a card that may run for months."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from openacr.controller.journal import JournalEntry, Recorder
from openacr.errors import StoreError

if TYPE_CHECKING:
    from openacr.controller.controller import Controller

SUFFIX = ".journal"


class Ring:
    """Keeps the last minutes of a card in a folder: a file for each stretch of time.

    Every file begins with a snapshot, so each can be replayed without those before it.
    """

    def __init__(
        self, card: Controller, folder: Path, *, stretch_s: float = 300.0, files: int = 3
    ) -> None:
        self._card, self._folder, self._files = card, folder, files
        self._stretch_tk = round(stretch_s / card.period_s)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as failure:
            raise StoreError(f"{folder} cannot be used: {failure.strerror}") from None
        self._number = max(map(_number_of, self._paths()), default=0)
        self._recorder = self._begin()

    @property
    def next_tk(self) -> int:
        """When the next digest is due."""
        return self._recorder.next_tk

    def note(self, entry: JournalEntry) -> None:
        """Write one entry."""
        self._recorder.note(entry)

    def mark(self) -> None:
        """Write the digest that is due; when a stretch is over, begin the next file."""
        self._recorder.mark()
        if self._card.lived_tk >= self._end_tk:
            self._recorder.close()
            self._recorder = self._begin()

    def close(self) -> None:
        """Close the present file."""
        self._recorder.close()

    def _begin(self) -> Recorder:
        self._number += 1
        for path in self._paths()[: -self._files + 1 or None]:
            path.unlink(missing_ok=True)
        self._end_tk = self._card.lived_tk + self._stretch_tk
        return Recorder(self._card, self._folder / f"{self._number:06}{SUFFIX}")

    def _paths(self) -> list[Path]:
        found = (path for path in self._folder.glob(f"*{SUFFIX}") if _number_of(path))
        return sorted(found, key=_number_of)


def _number_of(path: Path) -> int:
    return int(path.stem) if path.stem.isascii() and path.stem.isdigit() else 0
