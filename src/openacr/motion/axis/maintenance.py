"""PM: position maintenance of stepper axes (kernel/axis/maintain_cy.py)."""

from openacr.map.rows import axes
from openacr.motion.card import Card


def is_on(card: Card, axis: int) -> bool:
    """Whether lost steps of an axis are put out again."""
    return bool(card.memory.I[axes.pm_on[axis]])


def switch(card: Card, axis: int, *, on: bool) -> None:
    """Switch it; the steps put out so far stay."""
    card.memory.I[axes.pm_on[axis]] = int(on)
    card.memory.I[axes.pm_sign[axis]] = 0
    card.memory.F[axes.pm_off_s[axis]] = 0.0
