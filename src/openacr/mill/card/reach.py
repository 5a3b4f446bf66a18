"""Reachability of the card: how long it has not answered, by the clock of the link."""

from openacr.client import Card

PATIENCE = 3.0  # link timeouts until a card is given up
MOST_LOSSES = 8  # of a link that comes and goes, until it is given up


class Reach:
    """State of the link to one card, judged by its answers."""

    def __init__(self, card: Card, timeout_s: float) -> None:
        self._card = card
        self._timeout_s = timeout_s
        self._answered_s = card.now_s()
        self._losses = 0
        self.is_lost = False

    def answer(self) -> None:
        """Record an answer of the card."""
        self._answered_s = self._card.now_s()
        self.is_lost = False

    def lose(self) -> bool:
        """Record a missing answer; returns whether the link was up before."""
        is_new = not self.is_lost
        self._losses += is_new
        self.is_lost = True
        return is_new

    @property
    def is_overdue(self) -> bool:
        """Whether the card has been silent for longer than the link timeout."""
        return self._card.now_s() - self._answered_s > self._timeout_s

    @property
    def is_given_up(self) -> bool:
        """Whether the card is given up: nothing is sent to it again."""
        silent_s = self._card.now_s() - self._answered_s
        is_gone = self.is_lost and silent_s > PATIENCE * self._timeout_s
        return is_gone or self._losses >= MOST_LOSSES
