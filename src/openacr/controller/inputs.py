"""The journals of a card: every external input, in memory and in a file while one is written."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from openacr.journal.entries import Entered, JournalEntry
from openacr.motion.clock import Clock


class JournalFile(Protocol):
    """A journal on disk, as a recorder or a ring of recorders writes it."""

    @property
    def next_tk(self) -> int:
        """When the next digest is due, in ticks of the life of the card."""

    def note(self, entry: JournalEntry) -> None:
        """Record an entry."""

    def flush(self) -> None:
        """Write the recorded entries."""

    def mark(self) -> None:
        """Write the digest that is due."""

    def close(self) -> None:
        """Complete the file and close it."""


class InputLog:
    """Records external inputs with the tick at which they arrive."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.place: Callable[[], int] = lambda: 0  # see Controller.within
        self.entries: list[JournalEntry] = []
        self.is_kept = True  # in memory; a file is written nevertheless
        self.file: JournalFile | None = None
        self._latest = (0, 0)  # tick and place of the latest entry

    def note(
        self, what: Entered, number: int, value: float = 0.0, *, text: str = "", name: str = ""
    ) -> None:
        """Record an external input in the journals."""
        if self.is_kept or self.file is not None:
            tick, place = self._clock.lived_tk, self.place()
            if place != (self._latest[1] if tick == self._latest[0] else 0):
                self._keep(JournalEntry(tick, Entered.WITHIN, place))
            self._latest = tick, place
            self._keep(JournalEntry(tick, what, number, text, float(value), name))

    def _keep(self, entry: JournalEntry) -> None:
        if self.is_kept:
            self.entries.append(entry)
        if self.file is not None:
            self.file.note(entry)

    def flush(self, ticks: int, now_tk: int) -> int:
        """Write the recorded entries; returns `ticks`, at most those to the next digest."""
        if self.file is None:
            return ticks
        self.file.flush()
        return min(ticks, self.file.next_tk - now_tk)

    def mark_if_due(self, now_tk: int) -> None:
        """Write a digest to the file if it is due."""
        if self.file is not None and now_tk >= self.file.next_tk:
            self.file.mark()

    def close(self) -> None:
        """Close the file, if one is written."""
        if self.file is not None:
            self.file.close()
            self.file = None
