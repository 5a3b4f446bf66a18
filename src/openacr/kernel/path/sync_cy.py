"""SYNC: masters whose moves begin in the same servo period and end together.

A move of a member waits until every member has one. Then all of them get the time that the
slowest needs, as TMOV does it. With SYNC MDI they wait for a cycle start of any member as
well. A kill on one member drops what waits in all.
"""

from openacr.kernel.path.hold_cy import NOT_HELD, master_drop
from openacr.kernel.path.interrupt_cy import move_barred
from openacr.kernel.path.keeps_cy import path_drop
from openacr.kernel.path.path_cy import (
    SLAVE_COUNT,
    move_geometry,
    move_limit,
    move_record,
    moves_lead,
)
from openacr.kernel.path.timed_cy import plan_seconds
from openacr.kernel.profile.profile_cy import profile_reset
from openacr.map.rows import kernel, masters, moves
from openacr.map.words import af4, mf1, mf2
from openacr.views import F32, F64, I32


def sync_member(I: I32, m: int) -> bool:
    """Whether master m is synchronised."""
    return I[mf2.word[m]] & mf2.SYNC_MODE != 0


def sync_bars(I: I32, m: int) -> bool:
    """Whether the move at the head waits for those of the other members."""
    return sync_member(I, m) and not I[masters.sync_go[m]]


def sync_loaded(I: I32, m: int) -> bool:
    """Whether a move of master m waits for its begin."""
    if not I[masters.queued[m]] or I[masters.moving[m]] or I[masters.hold[m]] != NOT_HELD:
        return False
    return not move_barred(I, m)


def sync_killed(I: I32, m: int) -> bool:
    """Whether a kill stands against master m or one of its axes."""
    if I[mf1.word[m]] & mf1.KILL_ALL_MOVES_REQUEST:
        return True
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0 and I[af4.word[axis]] & af4.KILL_ALL_MOTION_REQUEST:
            return True
    return False


def sync_seconds(F: F64, I: I32, S: F32, m: int) -> float:
    """The least time the waiting move of master m takes."""
    move_geometry(F, I, S, m)
    record: int = move_record(I, m)
    time_s: float = F[moves.tmov_s[record]]
    bound_ups: float = move_limit(F, I, S, m, record, 1.0)
    if not bound_ups > 0.0 or F[moves.length_u[record]] <= 0.0:
        return time_s
    profile_reset(F, I, m, 0.0, 0.0)
    return max(time_s, plan_seconds(F, I, m, bound_ups))


def sync_drop(F: F64, I: I32, S: F32, m: int) -> None:
    """Drop the moves of master m that wait; one under way goes on, if need be round a corner."""
    if I[masters.moving[m]]:
        path_drop(F, I, S, m)
        moves_lead(F, I, m)
    elif I[masters.queued[m]]:
        master_drop(F, I, S, m)


def sync_release(F: F64, I: I32, S: F32, master_count: int) -> None:
    """Let the waiting moves of all members begin, with the time of the slowest."""
    time_s: float = 0.0
    for m in range(master_count):
        if sync_member(I, m):
            time_s = max(time_s, sync_seconds(F, I, S, m))
    for m in range(master_count):
        if sync_member(I, m):
            F[moves.tmov_s[move_record(I, m)]] = time_s
            S[masters.delta_tmov_time[m]] = time_s
            I[masters.sync_go[m]] = 1
            I[masters.sync_start[m]] = 0


def sync_step(F: F64, I: I32, S: F32, master_count: int) -> None:
    """Look which members have a move loaded, and let all begin once every one has."""
    ready: bool = True
    manual: bool = False
    started: bool = False
    killed: bool = False
    for m in range(master_count):
        if sync_member(I, m):
            loaded: bool = sync_loaded(I, m)
            word2: int = mf2.word[m]
            ready = ready and loaded
            killed = killed or sync_killed(I, m)
            manual = manual or I[word2] & mf2.SYNC_MANUAL != 0
            started = started or I[masters.sync_start[m]] != 0
            I[word2] &= ~mf2.SYNC_MANUAL_LOADED
            if loaded:
                I[word2] |= mf2.SYNC_MANUAL_LOADED
    if killed and not I[kernel.sync_killed]:
        for m in range(master_count):
            if sync_member(I, m):
                sync_drop(F, I, S, m)
    I[kernel.sync_killed] = 1 if killed else 0
    if ready and not killed and (started or not manual):
        sync_release(F, I, S, master_count)
