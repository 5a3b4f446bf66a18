"""TRJ: let a new move take the place of all that a master has."""

from openacr.compiled import pick
from openacr.kernel import calls_cy
from openacr.kernel.path import path_cy
from openacr.map.rows import masters, moves, profiles
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.motion.path.records import SlaveMove

_path_slope = pick(path_cy.path_slope)


def replace_waiting_moves(card: Card, master: int, slave_moves: list[SlaveMove]) -> None:
    """Drop all moves; the speed is kept unless the new direction turns back too far.

    Beyond 90 degrees the present move comes to rest first, and the new one follows it.
    """
    memory = card.memory
    if not memory.I[masters.queued[master]]:
        return
    if memory.I[masters.moving[master]] and _turns_back(card, master, slave_moves):
        card.call(calls_cy.PATH_CUT, master)
    else:
        card.call(calls_cy.PATH_REPLACE, master)


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
