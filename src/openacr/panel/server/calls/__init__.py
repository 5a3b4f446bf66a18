"""The calls of `/api`, by theme; importing this package fills the table."""

from openacr.panel.server.calls import (
    ballscrew,
    card,
    forms,
    help,
    journals,
    lines,
    on_card,
    parts,
    pictures,
    programs,
    session,
)

__all__ = [
    "ballscrew",
    "card",
    "forms",
    "help",
    "journals",
    "lines",
    "on_card",
    "parts",
    "pictures",
    "programs",
    "session",
]
