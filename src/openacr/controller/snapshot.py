"""The whole state of a card at one tick, to come back to."""

from __future__ import annotations

import pickle
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

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
    return Snapshot(card.memory.snapshot(), pickle.dumps(_language(card)), card.executor.state())


def put_back(card: Controller, snapshot: Snapshot) -> None:
    """Return a card to a snapshot."""
    card.memory.restore(snapshot.memory)
    system = card.system
    state = pickle.loads(snapshot.language)
    card.card.attachments = state["attachments"]
    system.programs.texts = state["texts"]
    system.programs.password = state["password"]
    system.aliases.restore(state["aliases"])
    system.storage.locals.restore_strings(state["strings"])
    system.setup = state["setup"]
    for name, session_state in state["sessions"].items():
        system.sessions[name].restore(session_state)
    system.devices.restore(state["devices"])
    card.executor.restore(snapshot.execution)


def _language(card: Controller) -> dict[str, Any]:
    system = card.system
    return {
        "attachments": card.card.attachments,
        "texts": system.programs.texts,
        "password": system.programs.password,
        "aliases": system.aliases.state(),
        "strings": system.storage.locals.strings_state(),
        "setup": system.setup,
        "sessions": {name: session.state() for name, session in system.sessions.items()},
        "devices": system.devices.state(),
    }
