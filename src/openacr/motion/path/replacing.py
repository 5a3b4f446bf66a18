"""TRJ: let a new move take the place of all that a master has."""

from openacr.compiled import pick
from openacr.kernel.axis import axis_cy
from openacr.kernel.path import hold_cy, interrupt_cy, keeps_cy, path_cy, round_cy
from openacr.map.rows import masters, moves, profiles
from openacr.motion.card import Card
from openacr.motion.interlocks import axes_of, scale_of
from openacr.motion.path.records import SlaveMove

_axis_target_changed = pick(axis_cy.axis_target_changed)
_master_cut = pick(interrupt_cy.master_cut)
_move_over = pick(hold_cy.move_over)
_path_drop = pick(keeps_cy.path_drop)
_round_through = pick(round_cy.round_through)
_path_slope = pick(path_cy.path_slope)


FARTHEST_U = 1e30  # no bound on what is counted of a move


def replace_waiting_moves(card: Card, master: int, slave_moves: list[SlaveMove]) -> None:
    """Drop all moves; the speed is kept unless the new direction turns back too far.

    Beyond 90 degrees the present move comes to rest first, and the new one follows it.
    """
    memory = card.memory
    if not memory.I[masters.queued[master]]:
        return
    if memory.I[masters.moving[master]] and _turns_back(card, master, slave_moves):
        _cut(card, master)
        return
    if memory.I[masters.moving[master]]:
        _move_over(memory.F, memory.I, master, FARTHEST_U)
        memory.F[masters.entry_ups[master]] = memory.F[profiles.velocity[master]]
        memory.F[masters.entry_ups2[master]] = memory.F[profiles.accel[master]]
    for row in (
        masters.queued,
        masters.moving,
        masters.cut,
        masters.seek_phase,
        masters.hsint_phase,
    ):
        memory.I[row[master]] = 0
    for axis in axes_of(card, master):  # those of the dropped moves end where they are
        _axis_target_changed(memory.F, memory.I, axis)
        card.show(axis)


def _cut(card: Card, master: int) -> None:
    """Let the path come to rest: at once or, where corners are rounded, as soon as it can."""
    memory = card.memory
    record = memory.I[masters.first[master]] + memory.I[masters.head[master]]
    parted = _round_through(memory.F, memory.I, master, record)
    if not parted or memory.I[masters.cut[master]] == interrupt_cy.CUT:
        # it may stop in the next
        memory.I[masters.queued[master]] = memory.I[masters.section_cnt[master]]
        _master_cut(memory.F, memory.I, memory.S, master)
        return
    _path_drop(memory.F, memory.I, memory.S, master)
    most = memory.I[masters.size[master]] - 1  # the new move needs its place
    memory.I[masters.queued[master]] = min(memory.I[masters.queued[master]], most)
    memory.I[masters.cut[master]] = interrupt_cy.CUT + memory.I[masters.queued[master]]


def _turns_back(card: Card, master: int, slave_moves: list[SlaveMove]) -> bool:
    """Whether the new direction is more than 90 degrees off the present one."""
    memory = card.memory
    record = memory.I[masters.first[master]] + memory.I[masters.head[master]]
    length = memory.F[moves.length_u[record]]
    gone = memory.F[profiles.distance[master]]
    gone -= memory.F[masters.origin_u[master]]
    part = gone / length if length > 0.0 else 1.0
    product = 0.0
    for one in slave_moves:
        slope = _path_slope(memory.F, memory.I, record, one.slave, part)
        product += slope * one.delta_cnt / scale_of(card, one.axis) ** 2
    return product < 0.0
