"""TRG: what the next move of a master waits for."""

from openacr.map.rows import masters, moves
from openacr.map.words import mf1
from openacr.motion.axis import registers
from openacr.motion.card import Card
from openacr.motion.path.move_request import FlagState


def on_flag(card: Card, master: int, flag: FlagState) -> None:
    """The next move starts when a flag has this state."""
    _put(card, master, flag.signed, 0)


def on_capture(card: Card, master: int, axis: int, mode: int, copy: int) -> None:
    """Arm the capture of an axis; the next move starts when it is complete."""
    registers.arm_capture(card, axis, mode, copy)
    _put(card, master, 0, axis + 1)


def _put(card: Card, master: int, flag: int, axis: int) -> None:
    card.memory.I[masters.trigger[master]] = flag
    card.memory.I[masters.trigger_axis[master]] = axis
    card.memory.I[mf1.word[master]] |= mf1.TRG_PENDING


def off(card: Card, master: int) -> None:
    """Nothing is waited for any more."""
    ints = card.memory.I
    ints[masters.trigger[master]] = ints[masters.trigger_axis[master]] = 0
    first = ints[masters.first[master]]
    for record in range(first, first + ints[masters.size[master]]):
        for row in (moves.trigger, moves.trigger_axis):
            ints[row[record]] = 0
    ints[mf1.word[master]] &= ~mf1.TRG_PENDING
