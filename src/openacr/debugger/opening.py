"""The card that is to be debugged: of a project, or of a journal."""

from __future__ import annotations

from pathlib import Path

from openacr.controller.controller import Controller
from openacr.controller.journal import Journal, read_journal
from openacr.debugger.requests import Launch
from openacr.errors import UserError


def opened(wanted: Launch) -> tuple[Controller, Journal | None]:
    """The card of a launch, and the journal it comes from; errors of project or journal."""
    if bool(wanted.program) == bool(wanted.journal):
        raise UserError("launch: give either `program` (a project) or `journal` (of a card)")
    if wanted.program:
        return Controller.from_project(wanted.program), None
    journal = read_journal(Path(wanted.journal))
    card = Controller(journal.header.model, world=journal.header.world)
    card.take_over(journal.snapshot)
    if card.digest() != journal.header.digest:
        raise UserError(f"{wanted.journal}: its snapshot is not that of its first tick")
    card.owns_console = True  # lines that are typed now continue those of the journal
    return card, journal
