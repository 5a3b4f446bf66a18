"""The connection to a debugged card over which it is commanded and asked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from openacr.channels import StreamKind
from openacr.client import (
    Card,
    ConnectionLostError,
    GarbledError,
    Level,
    NoReplyError,
    Options,
    RefusedError,
)
from openacr.client.links import link_to
from openacr.client.program_states import ROWS, ProgramState, program_states
from openacr.errors import UserError

T = TypeVar("T")

OPTIONS = Options(timeout_s=3.0, deadline_s=20.0, reconnect_s=0.0)
MOST_GARBLED = 3  # replies in succession: more is no noise


class CardLink:
    """A connection that is not made anew: what a card has done meanwhile would not be known."""

    def __init__(self, host: str) -> None:
        """ClientError or UserError where there is no card."""
        self.host = host
        self.is_serial = link_to(host).kind is StreamKind.SERIAL
        self.lost = ""  # why there is no connection any more
        self._garbled = 0
        self._card = Card.open(host, OPTIONS)

    def do(self, act: Callable[[Card], T]) -> T:
        """Do something with the card; UserError once it is lost."""
        if self.lost:
            raise UserError(self.lost)
        try:
            result = act(self._card)
        except ConnectionLostError as failure:
            self._lose(failure)
            raise UserError(self.lost) from None
        if self._card.connections > 1:
            self._lose("the connection was interrupted")
            raise UserError(self.lost)
        return result

    def _lose(self, why: object) -> None:
        self.lost = f"the card is lost: {why}; what it does now is not known here"
        self._card.close()

    def states(self) -> list[ProgramState]:
        """What its programs and PLCs do; UserError once it is lost."""
        return self.do(lambda card: program_states(card.read_many(ROWS)))

    def poll(self) -> list[ProgramState] | None:
        """The same, None after noise; a card that does not answer is lost."""
        try:
            states = self.states()
        except GarbledError as failure:
            self._garbled += 1
            if self._garbled >= MOST_GARBLED:
                self._lose(failure)
            return None
        except NoReplyError as failure:
            self._lose(failure)
            return None
        except UserError:
            return None
        self._garbled = 0
        return states

    def order(self, line: str) -> None:
        """Give a command of the system level; RefusedError with the message of the card."""
        self.do(lambda card: order(card, line))

    def close(self) -> None:
        """Disconnect; motion and programs continue."""
        self._card.close()

    def last_card(self) -> Card:
        """The card for what has to be done at the end: over another connection if it is lost."""
        return Card.open(self.host, OPTIONS) if self.lost else self._card


def order(card: Card, line: str) -> None:
    """Give a command of the system level; RefusedError with the message of the card."""
    card.go(Level())
    lines = card.command(line)
    if lines:
        raise RefusedError(line, lines[-1])
