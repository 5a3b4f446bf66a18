"""Apply the entries of a journal to a card, each at its moment."""

from __future__ import annotations

from openacr.channels import StreamKind
from openacr.controller.controller import Controller
from openacr.errors import CardError, NoFreeStreamError, StoreError, UserError
from openacr.journal.entries import Entered, JournalEntry
from openacr.protocol.events import ControlKey

_ALL_PROGRAMS = 0xFFFF


class Player:
    """Brings a card to the moments of entries and enters them again."""

    def __init__(self, card: Controller) -> None:
        self.card = card
        self._streams: dict[int, int] = {}

    def play(self, entry: JournalEntry) -> None:
        """Advance to the moment of an entry and apply it; StoreError if it cannot be applied."""
        if entry.what is Entered.WITHIN:
            self.advance_within(entry.tick, entry.number)
            return
        self.advance_to(entry.tick)
        self.apply(entry)

    def advance_to(self, tick: int) -> None:
        """Advance to the end of a tick of the life of the card."""
        while self.card.lived_tk < tick:
            self.card.advance(tick - self.card.lived_tk)

    def advance_within(self, tick: int, statement: int) -> None:
        """Advance into a tick as far as a statement; 0: to the end of the tick."""
        card = self.card
        if (card.lived_tk, card.within) == (tick, statement):
            return
        if statement:
            self.advance_to(tick - 1)
            card.announce_lines(_ALL_PROGRAMS, lambda *_: card.next_statement >= statement)
            card.advance(tick - card.lived_tk)
            card.announce_lines()
        else:
            self.advance_to(tick)
            card.advance()
        if (card.lived_tk, card.within) != (tick, statement):
            raise StoreError(
                f"the journal is damaged: no line begins at statement {statement} of tick {tick}"
            )

    def apply(self, entry: JournalEntry) -> None:
        """Apply an entry at the present moment; StoreError if it does not fit the card."""
        try:
            self._apply(entry)
        except (UserError, CardError, NoFreeStreamError, LookupError) as error:
            raise StoreError(
                f"the journal is damaged: the entry at tick {entry.tick}"
                f" ({entry.what}) cannot be applied to this card: {error}"
            ) from None

    def _apply(self, entry: JournalEntry) -> None:
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
        elif what is Entered.COMMAND:
            card.command(card.devices.label(entry.number), entry.name, entry.value)
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

    def _apply_to_stream(self, entry: JournalEntry) -> None:
        """Apply a stream entry; connections may get other numbers than they had."""
        if entry.what is Entered.OPEN:
            opened = self.card.open_stream(StreamKind(entry.text), entry.name or None)
            self._streams[entry.number] = opened
            return
        stream = self._streams.get(entry.number, entry.number)
        if entry.what is Entered.BYTES:
            if not self.card.has_stream(stream):
                raise UserError(f"there is no connection {stream}")
            self.card.receive(stream, entry.data)
        else:
            self.card.close_stream(stream)
