"""Record of homed axes, kept in the store and on the card.

The store keeps the record between runs of the host. A user flag of the card for each axis,
off at power-on, shows whether it still holds. Variables would not do: cards with a battery
keep them although their positions start from 0.
"""

from collections.abc import Callable

from openacr.client import Card
from openacr.cnc.occupied import FIRST_HOMED, MACHINE_AXES
from openacr.mill.card import soft_limits
from openacr.mill.card.machine_io import MachineIo
from openacr.mill.config.settings import HOMED, Settings, Store


def agree(card: Card, store: Store, say: Callable[[str], None] = lambda _text: None) -> None:
    """Drop axes that the card no longer knows as homed, and report them to the operator."""
    flags = card.read_bits(range(FIRST_HOMED, FIRST_HOMED + MACHINE_AXES))
    known = sum(1 << axis for axis, is_homed in enumerate(flags) if is_homed)
    mask = int(store.read(HOMED))
    if mask & ~known:
        store.write(HOMED, mask & known)
        names = [axis.name for axis in Settings(store).axes if mask & ~known & 1 << axis.index]
        say(
            f"axis {' '.join(names)} is no longer homed: the card was switched off or reset,"
            " and positions count from where it was switched on"
        )


def note(io: MachineIo, axis: int, homed: bool) -> None:
    """Record that the reference point of an axis is known, or no longer known."""
    if not homed:
        soft_limits.disable(io, axis)
    io.settings.mark_homed(axis, homed)
    io.machine.set_flag(FIRST_HOMED + axis, homed)


def forget(io: MachineIo) -> None:
    """Mark all axes as not homed: the card was reset."""
    for axis in io.settings.axes:
        note(io, axis.index, False)


def lose(io: MachineIo, name: str) -> None:
    """Mark an axis that has lost its position as not homed."""
    for axis in io.settings.axes:
        if axis.name == name:
            note(io, axis.index, False)
