"""Lay the moves that wait out again: the path has ended elsewhere than planned.

A move is laid out when it is appended, from where the moves before it lead, and its corners are
decided with that. INT, TRJ, a capture or Block Skip end the path at another place: absolute moves
then have other directions and lengths, and what their corners allowed does not hold any more.
The path is at rest when that is found, so that all of it may be decided anew.
"""

from openacr.kernel.path.lookahead_cy import look_record
from openacr.kernel.path.path_cy import (
    SLAVE_COUNT,
    move_directions,
    move_shape,
    path_join,
)
from openacr.kernel.path.round_between_cy import round_again
from openacr.map.rows import axes, masters, moves
from openacr.views import F32, F64, I32


def path_relay(F: F64, I: I32, S: F32, m: int) -> None:
    """Lay all moves of a master at rest out from where its axes are, with their corners."""
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            F[masters.target_cnt[m] + s] = F[axes.position_cnt[axis]]
    for k in range(I[masters.queued[m]]):
        record: int = look_record(I, m, k)
        move_shape(F, I, S, m, record, True)
        move_directions(F, I, S, m, record)
        for s in range(SLAVE_COUNT):
            if I[moves.slaves[record]] & (1 << s):
                F[masters.target_cnt[m] + s] = F[moves.target_cnt[record] + s]
        if k > 0:
            before: int = look_record(I, m, k - 1)
            path_join(F, I, S, m, before, record)
            round_again(F, I, S, m, before, record)
