"""Which axes know their reference point, as long as the card has not lost its position.

The store remembers it between runs of the host; a variable of the card, which is gone when
its power is, tells whether that is still true.
"""

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.mill.panel import Panel
from openacr.mill.settings import HOMED, Store

CARD_HOMED = 96  # variable of the card


def agree(card: Card, store: Store) -> None:
    """At the start: what the card has forgotten counts no more."""
    try:
        known = int(card.read(CARD_HOMED))
    except RefusedError:
        known = 0  # a card that has just been switched on has no variables yet
    mask = int(store.read(HOMED))
    if mask & ~known:
        store.write(HOMED, mask & known)


def note(panel: Panel, axis: int, homed: bool) -> None:
    """The reference point of an axis is known, or not any more."""
    mask = panel.settings.mark_homed(axis, homed)
    panel.machine.write(CARD_HOMED, mask)


def lose(panel: Panel, name: str) -> None:
    """An axis has lost its position, so also its reference point."""
    for axis in panel.settings.axes:
        if axis.name == name:
            note(panel, axis.index, False)
