"""TRJ: let a new move take the place of all that a master has."""

from openacr.compiled import pick
from openacr.kernel import axis_cy, hold_cy, interrupt_cy, path_cy
from openacr.map.numbers import (
    MQF_BASE,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MSF_ENTRY_UPS,
    MSF_ENTRY_UPS2,
    MSF_ORIGIN_U,
    MSI_FIRST,
    MSI_HEAD,
    MSI_HSINT_PHASE,
    MSI_MOVING,
    MSI_QUEUED,
    MSI_SEEK_PHASE,
    MSI_STRETCH,
    PRF_ACCEL,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
    PRF_VELOCITY,
)
from openacr.motion.card import Card
from openacr.motion.permits import axes_of, scale_of
from openacr.motion.records import Way
from openacr.motion.rows import master_ints, master_reals

_axis_target_changed = pick(axis_cy.axis_target_changed)
_master_cut = pick(interrupt_cy.master_cut)
_move_over = pick(hold_cy.move_over)
_path_slope = pick(path_cy.path_slope)


FARTHEST_U = 1e30  # no bound on what is counted of a move


def clear_the_way(card: Card, master: int, ways: list[Way]) -> None:
    """Drop all moves; the speed is kept unless the new direction turns back too far.

    Beyond 90 degrees the present move comes to rest first, and the new one follows it.
    """
    memory = card.memory
    rows = master_ints(master)
    if not memory.I[rows + MSI_QUEUED]:
        return
    if memory.I[rows + MSI_MOVING] and _turns_back(card, master, ways):
        memory.I[rows + MSI_QUEUED] = memory.I[rows + MSI_STRETCH]  # it may stop in the next
        _master_cut(memory.F, memory.I, memory.S, master)
        return
    if memory.I[rows + MSI_MOVING]:
        profile = PRF_BASE + master * PRF_STRIDE
        reals = master_reals(master)
        _move_over(memory.F, memory.I, master, FARTHEST_U)
        memory.F[reals + MSF_ENTRY_UPS] = memory.F[profile + PRF_VELOCITY]
        memory.F[reals + MSF_ENTRY_UPS2] = memory.F[profile + PRF_ACCEL]
    for row in (MSI_QUEUED, MSI_MOVING, MSI_SEEK_PHASE, MSI_HSINT_PHASE):
        memory.I[rows + row] = 0
    for axis in axes_of(card, master):  # those of the dropped moves end where they are
        _axis_target_changed(memory.F, memory.I, axis)
        card.show(axis)


def _turns_back(card: Card, master: int, ways: list[Way]) -> bool:
    """Whether the new direction is more than 90 degrees off the present one."""
    memory = card.memory
    rows = master_ints(master)
    record = memory.I[rows + MSI_FIRST] + memory.I[rows + MSI_HEAD]
    length = memory.F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]
    gone = memory.F[PRF_BASE + master * PRF_STRIDE + PRF_DISTANCE]
    gone -= memory.F[master_reals(master) + MSF_ORIGIN_U]
    part = gone / length if length > 0.0 else 1.0
    product = 0.0
    for way in ways:
        slope = _path_slope(memory.F, memory.I, record, way.slave, part)
        product += slope * way.delta_cnt / scale_of(card, way.axis) ** 2
    return product < 0.0
