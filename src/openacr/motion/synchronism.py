"""SYNC: which masters begin and end their moves together."""

from collections.abc import Iterable

from openacr.errors import CardError
from openacr.map.numbers import (
    KRI_BASE,
    KRI_SYNC_MANUAL,
    KRI_SYNCED,
    MF2_SYNC_MANUAL,
    MF2_SYNC_MANUAL_LOADED,
    MF2_SYNC_MODE,
    MSI_SYNC_GO,
    MSI_SYNC_START,
)
from openacr.messages import INVALID_ARGUMENT
from openacr.motion.card import Card
from openacr.motion.rows import master_ints, master_word2

_FLAGS = MF2_SYNC_MODE | MF2_SYNC_MANUAL | MF2_SYNC_MANUAL_LOADED


def members(card: Card) -> list[int]:
    """The synchronised masters."""
    return [
        master
        for master in range(card.model.masters)
        if card.memory.I[master_word2(master)] & MF2_SYNC_MODE
    ]


def join(card: Card, masters: Iterable[int]) -> None:
    """SYNC ON: their next moves wait for each other."""
    for master in _checked(card, masters):
        card.memory.I[master_ints(master) + MSI_SYNC_GO] = 0
        card.memory.I[master_word2(master)] |= MF2_SYNC_MODE
    set_manual(card, manual=bool(card.memory.I[KRI_BASE + KRI_SYNC_MANUAL]))
    card.memory.I[KRI_BASE + KRI_SYNCED] = 1


def leave(card: Card, masters: Iterable[int]) -> None:
    """SYNC OFF: their moves no longer wait for others."""
    for master in _checked(card, masters):
        card.memory.I[master_word2(master)] &= ~_FLAGS
        card.memory.I[master_ints(master) + MSI_SYNC_GO] = 0
    card.memory.I[KRI_BASE + KRI_SYNCED] = int(bool(members(card)))


def set_manual(card: Card, *, manual: bool) -> None:
    """SYNC MDI: wait for a cycle start as well; SYNC PROG: begin when all are loaded."""
    card.memory.I[KRI_BASE + KRI_SYNC_MANUAL] = int(manual)
    for master in members(card):
        card.memory.I[master_ints(master) + MSI_SYNC_START] = 0
        flags = card.memory.I[master_word2(master)] & ~MF2_SYNC_MANUAL
        card.memory.I[master_word2(master)] = flags | (MF2_SYNC_MANUAL if manual else 0)


def _checked(card: Card, masters: Iterable[int]) -> list[int]:
    found = list(masters)
    if any(not 0 <= master < card.model.masters for master in found):
        raise CardError(INVALID_ARGUMENT)
    return found
