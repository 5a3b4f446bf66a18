"""Which axes know their reference point, as long as the card has not lost its position.

The store remembers it between runs of the host; a user flag of the card for each axis, which
is off when its power comes on, tells whether that is still true. Variables would not do:
cards with a battery keep them, and count from 0 all the same.
"""

from collections.abc import Callable

from openacr.client import Card
from openacr.cnc.occupied import FIRST_HOMED, HOMED_AXES
from openacr.mill.card import soft_limits
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import HOMED, Settings, Store


def agree(card: Card, store: Store, say: Callable[[str], None] = lambda _text: None) -> None:
    """At the start: what the card has forgotten counts no more, and the operator is told."""
    flags = card.read_bits(range(FIRST_HOMED, FIRST_HOMED + HOMED_AXES))
    known = sum(1 << axis for axis, is_homed in enumerate(flags) if is_homed)
    mask = int(store.read(HOMED))
    if mask & ~known:
        store.write(HOMED, mask & known)
        names = [axis.name for axis in Settings(store).axes if mask & ~known & 1 << axis.index]
        say(
            f"axis {' '.join(names)} is not homed any more: the card was switched off or reset,"
            " and positions count from where it was switched on"
        )


def note(io: MachineIo, axis: int, homed: bool) -> None:
    """The reference point of an axis is known, or not any more."""
    if not homed:
        soft_limits.open_way(io, axis)
    io.settings.mark_homed(axis, homed)
    io.machine.set_flag(FIRST_HOMED + axis, homed)


def forget(io: MachineIo) -> None:
    """The card was reset: no axis knows its reference point."""
    for axis in io.settings.axes:
        note(io, axis.index, False)


def lose(io: MachineIo, name: str) -> None:
    """An axis has lost its position, so also its reference point."""
    for axis in io.settings.axes:
        if axis.name == name:
            note(io, axis.index, False)
