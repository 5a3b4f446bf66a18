"""What bars a motion command: the checks every motion command shares."""

from math import isfinite

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel.axis import axis_cy
from openacr.map.rows import axes as axis_rows
from openacr.map.rows import followers, masters
from openacr.map.words import af1, af4, mf1
from openacr.messages import (
    AXIS_IS_LOCKED,
    AXIS_IS_OFF,
    HARD_LIMIT,
    MASTER_KILL_ACTIVE,
    NOT_VALID_WHILE_IN_MOTION,
    SLAVE_KILL_ACTIVE,
    SOFT_LIMIT,
)
from openacr.motion.card import SLAVES, Card

_limit_bars = pick(axis_cy.limit_bars)

OFFSETS_MOVING = af1.JOG_ACTIVE | af1.GEAR_ACTIVATE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE


def scale_of(card: Card, axis: int) -> float:
    """Pulses per unit of an axis; as in the kernel, what is no number counts as 1."""
    ppu = card.memory.S[axis_rows.ppu[axis]]
    return ppu if ppu and isfinite(ppu) else 1.0


def master_of(card: Card, axis: int) -> int | None:
    """The master an axis is attached to."""
    master = card.memory.I[axis_rows.master[axis]]
    return master if master >= 0 else None


def axes_of(card: Card, master: int) -> list[int]:
    """The axes attached to a master, in slave order."""
    first = masters.slave_axis[master]
    return [axis for axis in card.memory.I[first : first + SLAVES] if axis >= 0]


def master_moving(card: Card, master: int) -> bool:
    """Whether a master has a move, running, held or waiting."""
    rows = card.memory.I
    return bool(rows[mf1.word[master]] & mf1.IN_MOTION or rows[masters.queued[master]])


def axis_moving(card: Card, axis: int) -> bool:
    """Whether any profiler moves an axis."""
    master = master_of(card, axis)
    if master is not None and master_moving(card, master):
        return True
    return bool(card.memory.I[af1.word[axis]] & OFFSETS_MOVING)


def needs_rest(card: Card, axis: int) -> None:
    """Refuse while the axis moves."""
    if axis_moving(card, axis):
        raise CardError(NOT_VALID_WHILE_IN_MOTION)


def needs_no_kill(card: Card, axis: int) -> None:
    """Refuse while KAMR is set on the axis or on another axis of its master."""
    master = master_of(card, axis)
    _needs_none_killed(card, [axis] if master is None else axes_of(card, master))


def _needs_none_killed(card: Card, axes: list[int]) -> None:
    if any(card.memory.I[af4.word[other]] & af4.KILL_ALL_MOTION_REQUEST for other in axes):
        raise CardError(SLAVE_KILL_ACTIVE)


def needs_moves(card: Card, master: int) -> None:
    """Refuse coordinated moves while a kill is set on the master or one of its axes."""
    _needs_none_killed(card, axes_of(card, master))
    if card.memory.I[mf1.word[master]] & mf1.KILL_ALL_MOVES_REQUEST:
        raise CardError(MASTER_KILL_ACTIVE)


def needs_on(card: Card, axis: int) -> None:
    """Refuse motion of an axis that is off, or that is locked to another."""
    if not card.memory.I[axis_rows.on[axis]]:
        raise CardError(AXIS_IS_OFF)
    if card.memory.I[followers.leader[axis]]:
        raise CardError(AXIS_IS_LOCKED)


def needs_free_direction(card: Card, axis: int, direction: float) -> None:
    """Refuse motion that starts now towards a limit that is active (its sign is the side)."""
    if not direction:
        return
    rows = card.memory
    barred = _limit_bars(rows.F, rows.I, rows.S, axis, 1 if direction > 0 else -1)
    if barred == axis_cy.HARD_BARRED:
        raise CardError(HARD_LIMIT)
    if barred == axis_cy.SOFT_BARRED:
        raise CardError(SOFT_LIMIT)
