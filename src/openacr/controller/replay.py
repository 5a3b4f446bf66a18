"""Replay a journal: the same card receives every input again at its tick."""

from __future__ import annotations

from dataclasses import dataclass

from openacr.channels import StreamKind
from openacr.controller.controller import Controller
from openacr.controller.journal import Entered, Journal, JournalEntry
from openacr.errors import CardError, NoFreeStreamError, StoreError, UserError
from openacr.protocol.events import ControlKey


@dataclass(frozen=True, slots=True)
class Difference:
    """A digest of the journal that differs from that of the replayed card."""

    tick: int
    expected: str
    found: str


class Replay:
    """One replay; `card` is the card at the point reached so far."""

    def __init__(self, journal: Journal) -> None:
        self.journal = journal
        header = journal.header
        self.card = Controller(header.model, world=header.world)
        self.card.is_journalled = False
        self.card.take_over(journal.snapshot)
        if (self.card.digest(), self.card.lived_tk) != (header.digest, header.tick):
            raise StoreError("the journal is damaged: its snapshot is not that of its first tick")
        self.entered = 0  # entries that were applied
        self.equal = 0  # digests that matched the journal
        self.difference: Difference | None = None  # the first one
        self._streams: dict[int, int] = {}

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
            self._advance_to(entry.tick)
            if entry.is_digest:
                self._compare(entry)
                continue
            try:
                self._apply(entry)
            except (UserError, CardError, NoFreeStreamError, LookupError) as error:
                raise StoreError(
                    f"the journal is damaged: the entry at tick {entry.tick}"
                    f" ({entry.what}) cannot be applied to this card: {error}"
                ) from None
        if end_tk is not None:
            self._advance_to(end_tk)

    def _advance_to(self, tick: int) -> None:
        while self.card.lived_tk < tick:
            self.card.advance(tick - self.card.lived_tk)

    def _compare(self, entry: JournalEntry) -> None:
        found = self.card.digest()
        if found == entry.text:
            self.equal += 1
        elif self.difference is None:
            self.difference = Difference(entry.tick, entry.text, found)

    def _apply(self, entry: JournalEntry) -> None:
        self.entered += 1
        card, what = self.card, entry.what
        if what in (Entered.OPEN, Entered.BYTES, Entered.CLOSE):
            self._apply_to_stream(entry)
        elif what is Entered.INPUT:
            card.set_input(entry.number, bool(entry.value))
        elif what is Entered.RELEASE:
            card.release_input(entry.number)
        elif what is Entered.FAULT:
            card.fault(entry.number, entry.name, entry.value)
        elif what is Entered.MEND:
            card.mend(entry.number, entry.name or None)
        elif what is Entered.ANALOG:
            card.set_analog(entry.number, entry.value)
        elif what is Entered.DRAG:
            card.drag(entry.number, entry.value)
        elif what is Entered.PARAMETER:
            card.p[entry.number] = entry.value
        elif what is Entered.FLAG:
            card.bit[entry.number] = bool(entry.value)
        else:
            card.press(ControlKey(entry.number))

    def _needs(self, stream: int) -> None:
        if not self.card.has_stream(stream):
            raise UserError(f"there is no connection {stream}")

    def _apply_to_stream(self, entry: JournalEntry) -> None:
        """Apply a stream entry; connections may get other numbers than they had."""
        if entry.what is Entered.OPEN:
            opened = self.card.open_stream(StreamKind(entry.text), entry.name or None)
            self._streams[entry.number] = opened
            return
        stream = self._streams.get(entry.number, entry.number)
        if entry.what is Entered.BYTES:
            self._needs(stream)
            self.card.receive(stream, entry.data)
        else:
            self.card.close_stream(stream)
