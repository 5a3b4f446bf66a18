"""What paces a master: time of moves (TMOV), factor (TOV) and source (SRC) of its time base."""

from openacr.errors import CardError
from openacr.kernel.sources import source_cy
from openacr.map.rows import masters
from openacr.map.words import mf2
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.sources import sources

FASTEST = 2.0
_OBJECTS = frozenset(("RATCH", "LIMIT"))


# TMOV


def set_move_time(card: Card, master: int, time_s: float) -> None:
    """Let every move take this time; 0 lets them take what they need."""
    card.memory.S[masters.move_time[master]] = time_s
    switch_move_time(card, master, on=time_s > 0.0)


def switch_move_time(card: Card, master: int, *, on: bool) -> None:
    """Switch timed moves on, which needs a time, or off."""
    if on and not card.memory.S[masters.move_time[master]] > 0.0:
        raise CardError(INVALID_ARGUMENT)
    _switch(card, master, mf2.MASTER_IN_TMOV, on=on)


# TOV


def set_factor(card: Card, master: int, factor: float) -> None:
    """Multiply the pace of the time base, 0 to 2."""
    if not 0.0 <= factor <= FASTEST:
        raise CardError(INVALID_ARGUMENT)
    card.memory.S[masters.time_over_velocity[master]] = factor
    switch_factor(card, master, on=True)


def switch_factor(card: Card, master: int, *, on: bool) -> None:
    """Switch the factor on or off."""
    _switch(card, master, mf2.MASTER_TOV, on=on)
    card.memory.I[masters.paced[master]] = 1


def _switch(card: Card, master: int, flag: int, *, on: bool) -> None:
    word = mf2.word[master]
    flags = card.memory.I[word] & ~flag
    card.memory.I[word] = flags | flag if on else flags


# SRC


def _tap(master: int) -> int:
    return source_cy.TIME_TAPS + master


def set_source(card: Card, master: int, word: str, number: int) -> None:
    """Count the time of a master by a source: 1000 of its pulses are one second."""
    sources.check(card, word, number)
    if word in _OBJECTS:
        sources.objects_go_live(card)
    sources.choose(card, _tap(master), word, number)
    card.memory.I[masters.paced[master]] = 1


def source_text(card: Card, master: int) -> str:
    """The source of a master as it is written."""
    return sources.text(card, _tap(master))
