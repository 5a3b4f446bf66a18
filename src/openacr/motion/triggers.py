"""TRG: what the next move of a master waits for."""

from openacr.map.numbers import (
    MF1_TRG_PENDING,
    MQI_BASE,
    MQI_STRIDE,
    MQI_TRIGGER,
    MQI_TRIGGER_AXIS,
    MSI_FIRST,
    MSI_SIZE,
    MSI_TRIGGER,
    MSI_TRIGGER_AXIS,
)
from openacr.motion import registers
from openacr.motion.card import Card
from openacr.motion.orders import FlagState
from openacr.motion.rows import master_ints, master_word


def on_flag(card: Card, master: int, flag: FlagState) -> None:
    """The next move starts when a flag has this state."""
    _put(card, master, flag.signed, 0)


def on_capture(card: Card, master: int, axis: int, mode: int, copy: int) -> None:
    """Arm the capture of an axis; the next move starts when it is complete."""
    registers.arm_capture(card, axis, mode, copy)
    _put(card, master, 0, axis + 1)


def _put(card: Card, master: int, flag: int, axis: int) -> None:
    rows = master_ints(master)
    card.memory.I[rows + MSI_TRIGGER] = flag
    card.memory.I[rows + MSI_TRIGGER_AXIS] = axis
    card.memory.I[master_word(master)] |= MF1_TRG_PENDING


def off(card: Card, master: int) -> None:
    """Nothing is waited for any more."""
    rows = master_ints(master)
    ints = card.memory.I
    ints[rows + MSI_TRIGGER] = ints[rows + MSI_TRIGGER_AXIS] = 0
    first = ints[rows + MSI_FIRST]
    for record in range(first, first + ints[rows + MSI_SIZE]):
        for row in (MQI_TRIGGER, MQI_TRIGGER_AXIS):
            ints[MQI_BASE + record * MQI_STRIDE + row] = 0
    ints[master_word(master)] &= ~MF1_TRG_PENDING
