"""PM: position maintenance of stepper axes (kernel/maintain_cy.py)."""

from openacr.map.numbers import AXF_PM_OFF_S, AXI_PM_ON, AXI_PM_SIGN
from openacr.motion.card import Card
from openacr.motion.rows import axis_ints, axis_reals


def is_on(card: Card, axis: int) -> bool:
    """Whether lost steps of an axis are put out again."""
    return bool(card.memory.I[axis_ints(axis) + AXI_PM_ON])


def switch(card: Card, axis: int, *, on: bool) -> None:
    """Switch it; the steps put out so far stay."""
    card.memory.I[axis_ints(axis) + AXI_PM_ON] = int(on)
    card.memory.I[axis_ints(axis) + AXI_PM_SIGN] = 0
    card.memory.F[axis_reals(axis) + AXF_PM_OFF_S] = 0.0
