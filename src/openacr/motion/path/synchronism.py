"""SYNC: which masters begin and end their moves together."""

from collections.abc import Iterable

from openacr.errors import CardError
from openacr.map.rows import kernel
from openacr.map.rows import masters as master_rows
from openacr.map.words import mf2
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card

_FLAGS = mf2.SYNC_MODE | mf2.SYNC_MANUAL | mf2.SYNC_MANUAL_LOADED


def members(card: Card) -> list[int]:
    """The synchronised masters."""
    return [
        master
        for master in range(card.model.masters)
        if card.memory.I[mf2.word[master]] & mf2.SYNC_MODE
    ]


def join(card: Card, masters: Iterable[int]) -> None:
    """SYNC ON: their next moves wait for each other."""
    for master in _checked(card, masters):
        card.memory.I[master_rows.sync_go[master]] = 0
        card.memory.I[mf2.word[master]] |= mf2.SYNC_MODE
    set_manual(card, manual=bool(card.memory.I[kernel.sync_manual]))
    card.memory.I[kernel.synced] = 1


def leave(card: Card, masters: Iterable[int]) -> None:
    """SYNC OFF: their moves no longer wait for others."""
    for master in _checked(card, masters):
        card.memory.I[mf2.word[master]] &= ~_FLAGS
        card.memory.I[master_rows.sync_go[master]] = 0
    card.memory.I[kernel.synced] = int(bool(members(card)))


def set_manual(card: Card, *, manual: bool) -> None:
    """SYNC MDI: wait for a cycle start as well; SYNC PROG: begin when all are loaded."""
    card.memory.I[kernel.sync_manual] = int(manual)
    for master in members(card):
        card.memory.I[master_rows.sync_start[master]] = 0
        flags = card.memory.I[mf2.word[master]] & ~mf2.SYNC_MANUAL
        card.memory.I[mf2.word[master]] = flags | (mf2.SYNC_MANUAL if manual else 0)


def _checked(card: Card, masters: Iterable[int]) -> list[int]:
    found = list(masters)
    if any(not 0 <= master < card.model.masters for master in found):
        raise CardError(INVALID_ARGUMENT)
    return found
