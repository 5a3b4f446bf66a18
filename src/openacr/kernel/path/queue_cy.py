"""What commands do to the moves of a master: a move enters its ring, all are replaced or halted.

The slow side writes the record of a move and what is its own of it. What depends on where the
path is just then happens here, in one piece, when the loop takes the command over.
"""

from openacr.kernel.axis.axis_cy import axis_show, axis_target_changed
from openacr.kernel.path.hold_cy import (
    IN_FEEDHOLD,
    NOT_HELD,
    master_drop,
    master_hold,
    master_release,
    move_over,
)
from openacr.kernel.path.interrupt_cy import CUT, master_cut
from openacr.kernel.path.keeps_cy import path_drop
from openacr.kernel.path.lookahead_cy import look_active
from openacr.kernel.path.path_cy import (
    FAR_U,
    SLAVE_COUNT,
    move_directions,
    move_record,
    path_join,
)
from openacr.kernel.path.round_between_cy import round_between
from openacr.kernel.path.round_cy import round_through
from openacr.map.rows import axes, masters, moves, profiles
from openacr.map.words import mf1
from openacr.views import F32, F64, I32


def record_place(I: I32, m: int, count: int) -> int:
    """The record of the ring that lies `count` moves after the present one."""
    place: int = I[masters.head[m]] + count
    if place >= I[masters.size[m]]:
        place -= I[masters.size[m]]
    return I[masters.first[m]] + place


def record_enter(F: F64, I: I32, S: F32, m: int, record: int) -> None:
    """Put a record that has been written at the end of the ring; the flags show it at once.

    If the moves before it have been dropped since, it is not the next one any more: it is
    dropped with them.
    """
    queued: int = I[masters.queued[m]]
    if record_place(I, m, queued) != record:
        record_refuse(F, I, m, record, queued)
        return
    record_look_back(F, I, S, m, record, queued)
    for s in range(SLAVE_COUNT):
        if I[moves.slaves[record]] & (1 << s):
            axis: int = I[masters.slave_axis[m] + s]
            F[masters.target_cnt[m] + s] = F[moves.target_cnt[record] + s]
            if axis >= 0:
                if queued == 0:
                    F[axes.target_cnt[axis]] = F[moves.target_cnt[record] + s]
                axis_show(F, I, axis)
    length_u: float = F[moves.length_u[record]]
    S[masters.distance_squared[m]] = length_u * length_u
    I[masters.queued[m]] = queued + 1
    I[mf1.word[m]] |= mf1.IN_MOTION
    if queued:
        I[mf1.word[m]] |= mf1.MOVE_BUFFERED


def record_refuse(F: F64, I: I32, m: int, record: int, queued: int) -> None:
    """A record is not taken: without moves, the next one begins where the axes are."""
    if queued:
        return
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0 and I[moves.slaves[record]] & (1 << s):
            F[masters.target_cnt[m] + s] = F[axes.position_cnt[axis]]


def record_look_back(F: F64, I: I32, S: F32, m: int, record: int, queued: int) -> None:
    """Note where the path heads, and by how much it turns after the move before."""
    move_directions(F, I, S, m, record)
    F[moves.turn_deg[record]] = 0.0
    I[masters.look_dirty[m]] = 1
    if queued:
        before: int = record_place(I, m, queued - 1)
        path_join(F, I, S, m, before, record)
        round_between(F, I, S, m, before, record)
    F[moves.corner_u[record]] = 0.0
    F[moves.corner_turn[record]] = 0.0
    if F[moves.tolerance_u[record]] > 0.0:
        I[masters.rounding[m]] = 1
        if look_active(I, m) and not I[moves.curved[record]]:
            # A rounded corner or a stop may come: no room is left for it before a final velocity.
            F[moves.fvel_ups[record]] = 0.0


def path_replace(F: F64, I: I32, S: F32, m: int) -> None:
    """TRJ: drop all moves; the speed is kept for the one that follows."""
    if not I[masters.queued[m]]:
        return
    if I[masters.moving[m]]:
        move_over(F, I, m, FAR_U)
        F[masters.entry_ups[m]] = F[profiles.velocity[m]]
        F[masters.entry_ups2[m]] = F[profiles.accel[m]]
    I[masters.queued[m]] = 0
    I[masters.moving[m]] = 0
    I[masters.cut[m]] = 0
    I[masters.seek_phase[m]] = 0
    I[masters.hsint_phase[m]] = 0
    for s in range(SLAVE_COUNT):  # those of the dropped moves end where they are
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            axis_target_changed(F, I, axis)
            axis_show(F, I, axis)


def path_cut(F: F64, I: I32, S: F32, m: int) -> None:
    """TRJ that turns back: come to rest at once or, among rounded corners, as soon as it can."""
    if not I[masters.queued[m]] or not I[masters.moving[m]]:
        return
    parted: bool = round_through(F, I, m, move_record(I, m))
    if not parted or I[masters.cut[m]] == CUT:
        # it may stop in the next
        I[masters.queued[m]] = I[masters.section_cnt[m]]
        master_cut(F, I, S, m)
        return
    path_drop(F, I, S, m)
    # The new move needs its place.
    I[masters.queued[m]] = min(I[masters.queued[m]], I[masters.size[m]] - 1)
    I[masters.cut[m]] = CUT + I[masters.queued[m]]


def path_hold(F: F64, I: I32, S: F32, m: int) -> None:
    """Feedhold: slow the path to rest, unless it is held already."""
    if I[masters.hold[m]] == NOT_HELD:
        master_hold(F, I, S, m)


def path_release(F: F64, I: I32, S: F32, m: int) -> None:
    """Cycle start: a path that is held goes on."""
    if I[masters.hold[m]] != NOT_HELD:
        master_release(F, I, S, m)


def path_halt(F: F64, I: I32, S: F32, m: int) -> None:
    """HALT: slow the path to rest, then drop all its moves."""
    if not I[masters.queued[m]] and not I[mf1.word[m]] & mf1.IN_MOTION:
        return
    if I[masters.hold[m]] == IN_FEEDHOLD:
        master_drop(F, I, S, m)
    else:
        path_hold(F, I, S, m)
        I[masters.drop_at_rest[m]] = 1
