"""SYNC: masters whose moves begin in the same servo period and end together.

A move of a member waits until every member has one. Then all of them get the time that the
slowest needs, as TMOV does it. With SYNC MDI they wait for a cycle start of any member as
well. A kill on one member drops what waits in all.
"""

from openacr.kernel.hold_cy import NOT_HELD, master_drop
from openacr.kernel.interrupt_cy import move_barred
from openacr.kernel.path_cy import (
    SLAVE_COUNT,
    master_word,
    master_word2,
    move_geometry,
    move_limit,
    move_record,
)
from openacr.kernel.profile_cy import profile_reset
from openacr.kernel.timed_cy import plan_seconds
from openacr.map.numbers import (
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    KRI_BASE,
    KRI_SYNC_KILLED,
    MA_BASE,
    MA_DELTA_TMOV_TIME,
    MA_STRIDE,
    MF1_KILL_ALL_MOVES_REQUEST,
    MF2_SYNC_MANUAL,
    MF2_SYNC_MANUAL_LOADED,
    MF2_SYNC_MODE,
    MQF_BASE,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MQF_TMOV_S,
    MSI_BASE,
    MSI_HOLD,
    MSI_MOVING,
    MSI_QUEUED,
    MSI_SLAVE_AXIS,
    MSI_STRETCH,
    MSI_STRIDE,
    MSI_SYNC_GO,
    MSI_SYNC_START,
)
from openacr.views import F32, F64, I32


def sync_member(I: I32, m: int) -> bool:
    """Whether master m is synchronised."""
    return I[master_word2(m)] & MF2_SYNC_MODE != 0


def sync_bars(I: I32, m: int) -> bool:
    """Whether the move at the head waits for those of the other members."""
    return sync_member(I, m) and not I[MSI_BASE + m * MSI_STRIDE + MSI_SYNC_GO]


def sync_loaded(I: I32, m: int) -> bool:
    """Whether a move of master m waits for its begin."""
    i: int = MSI_BASE + m * MSI_STRIDE
    if not I[i + MSI_QUEUED] or I[i + MSI_MOVING] or I[i + MSI_HOLD] != NOT_HELD:
        return False
    return not move_barred(I, m)


def sync_killed(I: I32, m: int) -> bool:
    """Whether a kill stands against master m or one of its axes."""
    if I[master_word(m)] & MF1_KILL_ALL_MOVES_REQUEST:
        return True
    for s in range(SLAVE_COUNT):
        axis: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        if axis >= 0 and I[AF4_WORD + axis] & AF4_KILL_ALL_MOTION_REQUEST:
            return True
    return False


def sync_seconds(F: F64, I: I32, S: F32, m: int) -> float:
    """The least time the waiting move of master m takes."""
    move_geometry(F, I, S, m)
    record: int = move_record(I, m)
    time: float = F[MQF_BASE + record * MQF_STRIDE + MQF_TMOV_S]
    bound: float = move_limit(F, I, S, m, record, 1.0)
    if not bound > 0.0 or F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U] <= 0.0:
        return time
    profile_reset(F, I, m, 0.0, 0.0)
    return max(time, plan_seconds(F, I, m, bound))


def sync_drop(F: F64, I: I32, S: F32, m: int) -> None:
    """Drop the moves of master m that wait; one under way goes on."""
    i: int = MSI_BASE + m * MSI_STRIDE
    if I[i + MSI_MOVING]:
        I[i + MSI_QUEUED] = I[i + MSI_STRETCH]
    elif I[i + MSI_QUEUED]:
        master_drop(F, I, S, m)


def sync_release(F: F64, I: I32, S: F32, masters: int) -> None:
    """Let the waiting moves of all members begin, with the time of the slowest."""
    time: float = 0.0
    for m in range(masters):
        if sync_member(I, m):
            time = max(time, sync_seconds(F, I, S, m))
    for m in range(masters):
        if sync_member(I, m):
            F[MQF_BASE + move_record(I, m) * MQF_STRIDE + MQF_TMOV_S] = time
            S[MA_BASE + m * MA_STRIDE + MA_DELTA_TMOV_TIME] = time
            I[MSI_BASE + m * MSI_STRIDE + MSI_SYNC_GO] = 1
            I[MSI_BASE + m * MSI_STRIDE + MSI_SYNC_START] = 0


def sync_step(F: F64, I: I32, S: F32, masters: int) -> None:
    """Look which members have a move loaded, and let all begin once every one has."""
    ready: bool = True
    manual: bool = False
    started: bool = False
    killed: bool = False
    for m in range(masters):
        if sync_member(I, m):
            loaded: bool = sync_loaded(I, m)
            word2: int = master_word2(m)
            ready = ready and loaded
            killed = killed or sync_killed(I, m)
            manual = manual or I[word2] & MF2_SYNC_MANUAL != 0
            started = started or I[MSI_BASE + m * MSI_STRIDE + MSI_SYNC_START] != 0
            I[word2] &= ~MF2_SYNC_MANUAL_LOADED
            if loaded:
                I[word2] |= MF2_SYNC_MANUAL_LOADED
    if killed and not I[KRI_BASE + KRI_SYNC_KILLED]:
        for m in range(masters):
            if sync_member(I, m):
                sync_drop(F, I, S, m)
    I[KRI_BASE + KRI_SYNC_KILLED] = 1 if killed else 0
    if ready and not killed and (started or not manual):
        sync_release(F, I, S, masters)
