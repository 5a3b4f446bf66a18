"""Write the record of a move into the ring of its master."""

from collections.abc import Sequence

from msgspec import Struct

from openacr.compiled import pick
from openacr.errors import CardError
from openacr.kernel import calls_cy
from openacr.kernel.path import path_cy
from openacr.map.rows import masters, moves
from openacr.map.words import mf2
from openacr.messages import INVALID_ARC
from openacr.motion.axis import settings
from openacr.motion.card import Card
from openacr.motion.path import curves
from openacr.motion.path.move_request import Shape

_COPIED = (
    (masters.acc_ups2, moves.acc_ups2),
    (masters.dec_ups2, moves.dec_ups2),
    (masters.stp_ups2, moves.stp_ups2),
    (masters.jrk_ups3, moves.jrk_ups3),
    (masters.fvel_ups, moves.fvel_ups),
    (masters.ivel_ups, moves.ivel_ups),
    (masters.tolerance_u, moves.tolerance_u),
)
_CLEARED = (
    moves.rapid,
    moves.seek_axis,
    moves.interrupt,
    moves.hsint_axis,
    moves.marks,
    moves.tang_slave,
    moves.ahead,
)
_move_shape = pick(path_cy.move_shape)


class SlaveMove(Struct, frozen=True):
    """The displacement of one slave; a relative one keeps it wherever the move begins.

    A weightless one does not count for the length of the path.
    """

    slave: int
    axis: int
    start_cnt: float
    target_cnt: float
    delta_cnt: float
    relative: bool
    weightless: bool = False


def append(
    card: Card, program: int, master: int, slave_moves: list[SlaveMove], parts: Sequence[Shape]
) -> int:
    """Write the next record of the ring and set the motion flags at once; its index."""
    record = write(card, program, master, slave_moves, parts)
    card.call(calls_cy.RECORD_ENTER, master, record)
    return record


def write(
    card: Card, program: int, master: int, slave_moves: list[SlaveMove], parts: Sequence[Shape]
) -> int:
    """Write the next record of the ring, which does not take it yet; its index."""
    settings.refresh_max_velocity(card, master)
    memory = card.memory
    queued = memory.I[masters.queued[master]]
    ring = (memory.I[masters.head[master]] + queued) % memory.I[masters.size[master]]
    record = memory.I[masters.first[master]] + ring
    _write_profile(card, master, record)
    _write_slave_moves(card, master, record, slave_moves)
    curves.write(card, program, record, parts)
    _lay_out(card, master, record, slave_moves)
    _take_trigger(card, master, record)
    return record


def _write_profile(card: Card, master: int, record: int) -> None:
    reals = card.memory.F
    for row, copy in _COPIED:
        reals[copy[record]] = reals[row[master]]
    timed = card.memory.I[mf2.word[master]] & mf2.MASTER_IN_TMOV
    time_s = card.memory.S[masters.move_time[master]]
    reals[moves.tmov_s[record]] = time_s if timed else 0.0
    reals[moves.vel_ups[record]] = card.memory.S[masters.user_velocity[master]]


def _write_slave_moves(card: Card, master: int, record: int, slave_moves: list[SlaveMove]) -> None:
    memory = card.memory
    slaves = relative = 0
    for one in slave_moves:
        slaves |= 1 << one.slave
        relative |= int(one.relative) << one.slave
        memory.F[moves.target_cnt[record] + one.slave] = one.target_cnt
        memory.F[moves.delta_cnt[record] + one.slave] = one.delta_cnt
        weight = 0.0 if one.weightless else memory.F[masters.vecdef[master] + one.slave]
        memory.F[moves.weight[record] + one.slave] = weight
    memory.I[moves.slaves[record]] = slaves
    memory.I[moves.relative[record]] = relative
    for row in _CLEARED:
        memory.I[row[record]] = 0


def _lay_out(card: Card, master: int, record: int, slave_moves: list[SlaveMove]) -> None:
    """Lay the move out from its planned start; `Invalid arc` for an impossible curve."""
    memory = card.memory
    for one in slave_moves:
        memory.F[masters.target_cnt[master] + one.slave] = one.start_cnt
    _move_shape(memory.F, memory.I, memory.S, master, record, True)
    if memory.I[moves.curve[record]]:
        if not 0.0 < memory.F[moves.length_u[record]]:
            raise CardError(INVALID_ARC)


def _take_trigger(card: Card, master: int, record: int) -> None:
    """TRG is for the next move: this one."""
    ints = card.memory.I
    for row, copy in ((masters.trigger, moves.trigger), (masters.trigger_axis, moves.trigger_axis)):
        ints[copy[record]] = ints[row[master]]
        ints[row[master]] = 0
