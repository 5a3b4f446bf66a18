"""Moments of a card: ends of ticks, and places before a line within a tick."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from openacr.journal.entries import Entered, JournalEntry


class Moment(NamedTuple):
    """A moment: a tick of the life of the card, and 0 or a statement (`Controller.within`)."""

    tick: int
    within: int = 0

    @property
    def order(self) -> tuple[int, float]:
        """What moments are compared by: the end of a tick follows all its statements."""
        return self.tick, self.within or float("inf")


def moments(entries: Sequence[JournalEntry], first: int = 0) -> Iterator[tuple[Moment, int]]:
    """The moments at which entries from `first` on take effect, with their places in `entries`.

    `first` begins a moment: it is 0, follows a keyframe, or is of a later tick than the one before.
    """
    present = Moment(0)
    for place in range(first, len(entries)):
        entry = entries[place]
        if entry.what is Entered.WITHIN:
            present = Moment(entry.tick, entry.number)
        elif entry.tick != present.tick:
            present = Moment(entry.tick)
        yield present, place
