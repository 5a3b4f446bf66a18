"""Hold, step and release programs of a card: PAUSE, RESUME, BLK, AUT and STEP.

The order of the commands is such that a connection lost between two of them leaves the program
held, or at most one line further.
"""

from __future__ import annotations

from collections.abc import Callable

from openacr.client import Card
from openacr.client.program_states import ROWS, ProgramState, program_states
from openacr.debugger.real_cards.link import order
from openacr.errors import UserError
from openacr.map.words import pf

FOLLOWS_S = 2.0  # until the card shows what was commanded: its slow scan takes 50 ms
MODES = pf.PAUSE_MODE | pf.BLOCK_MODE
WAITS = pf.PAUSE_MODE_WAITING | pf.BLOCK_MODE_WAITING


def is_held(state: ProgramState) -> bool:
    """Whether a program is held by pause or block mode; a line that a step began goes on."""
    if not state.is_running or state.flags & pf.STEP_REQUEST_FLAG:
        return False
    return bool(state.flags & (pf.PAUSE_MODE | pf.BLOCK_MODE_WAITING))


def step(card: Card, state: ProgramState) -> None:
    """Let a held program execute one line, or complete the one in which PAUSE has met it."""
    if not state.flags & pf.BLOCK_CONTROL:
        order(card, f"BLK {state.level}")
    _await(card, state, lambda flags: bool(flags & pf.BLOCK_MODE), "does not enter block mode")
    if state.flags & WAITS:
        order(card, f"STEP {state.level}")
    if state.flags & pf.PAUSE_CONTROL:
        order(card, f"RESUME {state.level}")


def release(card: Card, state: ProgramState) -> None:
    """Let a held program go on."""
    if state.flags & pf.BLOCK_CONTROL:
        order(card, f"AUT {state.level}")
    if state.flags & pf.PAUSE_CONTROL:
        order(card, f"RESUME {state.level}")
    _await(card, state, lambda flags: not flags & MODES, "stays held")


def _await(card: Card, state: ProgramState, shows: Callable[[int], bool], fault: str) -> None:
    def is_shown() -> bool:
        present = program_states(card.read_many(ROWS))[state.level.number]
        return shows(present.flags)

    if not card.wait(is_shown, timeout_s=FOLLOWS_S):
        raise UserError(f"{state.level} {fault}")
