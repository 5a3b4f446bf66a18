"""What bars a motion command: the checks every motion command shares."""

from math import isfinite

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import axis_cy
from openacr.map.numbers import (
    AF1_CAM_ACTIVATE,
    AF1_GEAR_ACTIVATE,
    AF1_GEAR_ACTIVE,
    AF1_JOG_ACTIVE,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AX_PPU,
    AXI_MASTER,
    AXI_ON,
    FOI_BASE,
    FOI_LEADER,
    FOI_STRIDE,
    MF1_IN_MOTION,
    MF1_KILL_ALL_MOVES_REQUEST,
    MSI_QUEUED,
    MSI_SLAVE_AXIS,
)
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
from openacr.motion.rows import (
    axis_ints,
    axis_parameter,
    axis_word,
    master_ints,
    master_word,
)

_limit_bars = pick(axis_cy.limit_bars)

OFFSETS_MOVING = AF1_JOG_ACTIVE | AF1_GEAR_ACTIVATE | AF1_GEAR_ACTIVE | AF1_CAM_ACTIVATE


def scale_of(card: Card, axis: int) -> float:
    """Pulses per unit of an axis; as in the kernel, what is no number counts as 1."""
    ppu = card.memory.S[axis_parameter(axis) + AX_PPU]
    return ppu if ppu and isfinite(ppu) else 1.0


def master_of(card: Card, axis: int) -> int | None:
    """The master an axis is attached to."""
    master = card.memory.I[axis_ints(axis) + AXI_MASTER]
    return master if master >= 0 else None


def axes_of(card: Card, master: int) -> list[int]:
    """The axes attached to a master, in slave order."""
    first = master_ints(master) + MSI_SLAVE_AXIS
    return [axis for axis in card.memory.I[first : first + SLAVES] if axis >= 0]


def master_moving(card: Card, master: int) -> bool:
    """Whether a master has a move, running, held or waiting."""
    rows = card.memory.I
    return bool(rows[master_word(master)] & MF1_IN_MOTION or rows[master_ints(master) + MSI_QUEUED])


def axis_moving(card: Card, axis: int) -> bool:
    """Whether any profiler moves an axis."""
    master = master_of(card, axis)
    if master is not None and master_moving(card, master):
        return True
    return bool(card.memory.I[axis_word(axis)] & OFFSETS_MOVING)


def needs_rest(card: Card, axis: int) -> None:
    """Refuse while the axis moves."""
    if axis_moving(card, axis):
        raise CardError(NOT_VALID_WHILE_IN_MOTION)


def needs_no_kill(card: Card, axis: int) -> None:
    """Refuse while KAMR is set on the axis or on another axis of its master."""
    master = master_of(card, axis)
    _needs_none_killed(card, [axis] if master is None else axes_of(card, master))


def _needs_none_killed(card: Card, axes: list[int]) -> None:
    if any(card.memory.I[AF4_WORD + other] & AF4_KILL_ALL_MOTION_REQUEST for other in axes):
        raise CardError(SLAVE_KILL_ACTIVE)


def needs_moves(card: Card, master: int) -> None:
    """Refuse coordinated moves while a kill is set on the master or one of its axes."""
    _needs_none_killed(card, axes_of(card, master))
    if card.memory.I[master_word(master)] & MF1_KILL_ALL_MOVES_REQUEST:
        raise CardError(MASTER_KILL_ACTIVE)


def needs_on(card: Card, axis: int) -> None:
    """Refuse motion of an axis that is off, or that is locked to another."""
    if not card.memory.I[axis_ints(axis) + AXI_ON]:
        raise CardError(AXIS_IS_OFF)
    if card.memory.I[FOI_BASE + axis * FOI_STRIDE + FOI_LEADER]:
        raise CardError(AXIS_IS_LOCKED)


def needs_free_way(card: Card, axis: int, direction: float) -> None:
    """Refuse motion that starts now towards a limit that is active (its sign is the side)."""
    if not direction:
        return
    rows = card.memory
    barred = _limit_bars(rows.F, rows.I, rows.S, axis, 1 if direction > 0 else -1)
    if barred == axis_cy.HARD_BARRED:
        raise CardError(HARD_LIMIT)
    if barred == axis_cy.SOFT_BARRED:
        raise CardError(SOFT_LIMIT)
