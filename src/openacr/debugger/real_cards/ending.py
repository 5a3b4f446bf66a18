"""What a debugger leaves on a card: what it has started is ended, the rest stays as it is."""

from __future__ import annotations

import logging
from collections.abc import Iterable

from openacr.client import Card, ClientError, Level
from openacr.client.program_states import ROWS, ProgramState, program_states
from openacr.debugger.real_cards.link import order
from openacr.debugger.real_cards.values import axes_of, master_of
from openacr.map.words import mf1, pf

log = logging.getLogger(__name__)

REST_S = 10.0


def end(card: Card, started: set[int], commanded: set[int], paused: set[int]) -> None:
    """HALT programs that were started, and end the moves of others that do not run.

    `commanded` are programs at whose prompt lines were typed, or that were started and have ended:
    one of them that runs was started elsewhere and goes on. Programs that are held stay held,
    so that nothing begins to move; of those that end, what held them is released (`paused`).
    """
    states = program_states(card.read_many(ROWS))
    idle = {program for program in commanded if not states[program].is_running}
    ended = sorted(started | idle)
    for program in ended:
        _try(card, f"HALT {Level.program(program)}")
    for program in sorted(idle):
        _end_jogs(card, program)
    masters = {program: master_of(card, program) for program in ended}
    moving = {mf1.word[master] for master in masters.values() if master is not None}
    card.wait(lambda: not _are_moving(card, moving), timeout_s=REST_S)
    if _are_moving(card, moving):
        log.warning("programs stay in block or pause mode, since there is motion")
        return
    for program in paused.intersection(ended):
        _clear_holds(card, states[program])


def _try(card: Card, line: str) -> None:
    """One command that fails keeps none of the others from the card."""
    try:
        order(card, line)
    except ClientError as failure:
        log.warning("%s", failure)


def _end_jogs(card: Card, program: int) -> None:
    axes = axes_of(card, program)
    if axes:
        try:
            card.command(f"JOG OFF {' '.join(axes)}", program=program)
        except ClientError as failure:
            log.warning("%s", failure)


def _are_moving(card: Card, words: Iterable[int]) -> bool:
    return any(int(word) & mf1.IN_MOTION for word in card.read_many(words))


def _clear_holds(card: Card, state: ProgramState) -> None:
    """Let the next RUN of a program that has ended not be held; its master is at rest."""
    if state.flags & pf.BLOCK_CONTROL:
        _try(card, f"AUT {state.level}")
    if state.flags & pf.PAUSE_CONTROL:
        _try(card, f"RESUME {state.level}")
