"""Replay a journal: the same card receives every input again at its tick."""

from __future__ import annotations

from pathlib import Path

from msgspec import Struct

from openacr.controller.controller import Controller
from openacr.controller.journal import Journal
from openacr.controller.player import Player
from openacr.errors import StoreError
from openacr.journal.entries import JournalEntry


class Difference(Struct, frozen=True):
    """A digest of the journal that differs from that of the replayed card."""

    tick: int
    expected: str
    found: str


class Replay:
    """One replay; `card` is the card at the point reached so far."""

    def __init__(self, journal: Journal, device_folder: Path | None = None) -> None:
        self.journal = journal
        header = journal.header
        self.card = Controller(header.model, world=header.world, device_folder=device_folder)
        self.card.is_journalled = False
        self.card.take_over(journal.snapshot)
        if (self.card.digest(), self.card.lived_tk) != (header.digest, header.tick):
            raise StoreError("the journal is damaged: its snapshot is not that of its first tick")
        self.entered = 0  # entries that were applied
        self.equal = 0  # digests that matched the journal
        self.difference: Difference | None = None  # the first one
        self._player = Player(self.card)

    @property
    def lived_s(self) -> float:
        """Simulated seconds since the beginning of the journal."""
        return (self.card.lived_tk - self.journal.header.tick) * self.journal.header.period_s

    def run(self, until_s: float | None = None) -> None:
        """Replay everything, or up to `until_s` simulated seconds after the journal's start."""
        header = self.journal.header
        end_tk = None if until_s is None else header.tick + round(until_s / header.period_s)
        for entry in self.journal.entries:
            if end_tk is not None and entry.tick > end_tk:
                break
            if entry.is_digest:
                self._player.advance_to(entry.tick)
                if entry.text:  # else there was no time for it
                    self._compare(entry)
            else:
                self._player.play(entry)
                self.entered += 1
        if end_tk is not None:
            self._player.advance_to(end_tk)

    def _compare(self, entry: JournalEntry) -> None:
        found = self.card.digest()
        if found == entry.text:
            self.equal += 1
        elif self.difference is None:
            self.difference = Difference(entry.tick, entry.text, found)
