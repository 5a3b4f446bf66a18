"""The whole state of a card at one tick, to come back to."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from openacr.controller.controller import Controller


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Memory and everything beside it; independent of the card it was taken from."""

    memory: bytes
    language: bytes
    execution: bytes


def take(card: Controller) -> Snapshot:
    """Take a snapshot of a card."""
    language = pickle.dumps((card.card.attachments, card.system.state()))
    return Snapshot(card.memory.snapshot(), language, card.executor.state())


def put_back(card: Controller, snapshot: Snapshot) -> None:
    """Return a card to a snapshot."""
    card.memory.restore(snapshot.memory)
    card.card.attachments, language = pickle.loads(snapshot.language)
    card.system.restore(language)
    card.executor.restore(snapshot.execution)
