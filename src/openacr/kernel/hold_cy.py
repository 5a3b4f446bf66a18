"""Feedhold, cycle start, and dropping the moves of a master."""

from openacr.kernel.axis_cy import axis_jog_set
from openacr.kernel.bezier_cy import is_bezier
from openacr.kernel.corner_cy import corner_drop
from openacr.kernel.curveflags_cy import curve_drop
from openacr.kernel.hsint_cy import HSINT_NONE, HSINT_PASSING
from openacr.kernel.lookahead_cy import look_beyond
from openacr.kernel.path_cy import (
    FAR_U,
    MARK_INTERRUPT_LENT,
    SLAVE_COUNT,
    master_word,
    move_record,
)
from openacr.kernel.plan_cy import master_plan
from openacr.kernel.profile_cy import (
    DECELERATING,
    STOPPING,
    profile_plan,
    profile_reset,
    profile_stop,
)
from openacr.kernel.round_cy import round_hold_rate, round_holds
from openacr.kernel.seek_cy import SEEK_NONE, SEEK_STOPPING
from openacr.map.numbers import (
    AXF_BASE,
    AXF_FOLDED_CNT,
    AXF_JOG_CNT,
    AXF_POSITION_CNT,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    MA_BASE,
    MA_DISTANCE_INTO_PATH,
    MA_MBUF_FILLED,
    MA_STRIDE,
    MA_VECTOR_ACCELERATION,
    MA_VECTOR_JERK,
    MA_VECTOR_VELOCITY,
    MA_VELOCITY_SQUARED,
    MF1_ACCELERATING,
    MF1_DECELERATING,
    MF1_FEEDHOLDING,
    MF1_IN_FEEDHOLD,
    MF1_IN_MOTION,
    MF1_INTERRUPT_ON_MOVE,
    MF1_JERKING,
    MF1_KILL_ALL_MOVES_REQUEST,
    MF1_MOVE_BUFFERED,
    MF1_STOP_ALL_MOVES_REQUEST,
    MF1_STOPPING,
    MF1_TRG_PENDING,
    MF4_VEL_LIMIT,
    MF4_WORD,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_JRK_UPS3,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQI_BASE,
    MQI_MARKS,
    MQI_STRIDE,
    MSF_BASE,
    MSF_ENTRY_UPS,
    MSF_ENTRY_UPS2,
    MSF_ORIGIN_U,
    MSF_STRETCH_U,
    MSF_STRIDE,
    MSF_TARGET_CNT,
    MSF_TRAVEL_U,
    MSI_BASE,
    MSI_CUT,
    MSI_DROP_AT_REST,
    MSI_HOLD,
    MSI_HSINT_PHASE,
    MSI_MOVING,
    MSI_PIECE,
    MSI_QUEUED,
    MSI_SEEK_PHASE,
    MSI_SLAVE_AXIS,
    MSI_STRETCH,
    MSI_STRIDE,
    MSI_TRIGGER,
    MSI_TRIGGER_AXIS,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_STRIDE,
    PRF_TARGET_VELOCITY,
    PRF_VELOCITY,
    PRI_BASE,
    PRI_KIND,
    PRI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["master_drop", "master_hold", "master_release", "move_over"]

NOT_HELD = 0
FEEDHOLDING = 1
IN_FEEDHOLD = 2


def master_drop(F: F64, I: I32, S: F32, m: int) -> None:
    """Drop the present move and all that wait; the axes stay where they are commanded."""
    i: int = MSI_BASE + m * MSI_STRIDE
    if I[i + MSI_MOVING]:
        move_over(F, I, m, FAR_U)
    S[MA_BASE + m * MA_STRIDE + MA_DISTANCE_INTO_PATH] = F[MSF_BASE + m * MSF_STRIDE + MSF_TRAVEL_U]
    I[MF4_WORD + m] &= ~MF4_VEL_LIMIT
    I[i + MSI_QUEUED] = 0
    I[i + MSI_MOVING] = 0
    I[i + MSI_HOLD] = NOT_HELD
    I[i + MSI_DROP_AT_REST] = 0
    I[i + MSI_SEEK_PHASE] = SEEK_NONE
    I[i + MSI_HSINT_PHASE] = HSINT_NONE
    I[i + MSI_CUT] = 0
    I[i + MSI_STRETCH] = 1
    I[i + MSI_TRIGGER] = 0
    I[i + MSI_TRIGGER_AXIS] = 0
    I[i + MSI_PIECE] = 0
    corner_drop(F, I, m)
    curve_drop(I, m)
    F[MSF_BASE + m * MSF_STRIDE + MSF_ENTRY_UPS] = 0.0
    F[MSF_BASE + m * MSF_STRIDE + MSF_ENTRY_UPS2] = 0.0
    profile_reset(F, I, m, 0.0, 0.0)
    F[PRF_BASE + m * PRF_STRIDE + PRF_TARGET_VELOCITY] = 0.0
    master_settle(F, I, S, m)
    word: int = master_word(m)
    I[word] &= ~(
        MF1_IN_MOTION
        | MF1_MOVE_BUFFERED
        | MF1_ACCELERATING
        | MF1_DECELERATING
        | MF1_STOPPING
        | MF1_JERKING
        | MF1_FEEDHOLDING
        | MF1_IN_FEEDHOLD
        | MF1_TRG_PENDING
    )


def move_over(F: F64, I: I32, m: int, length_u: float) -> None:
    """The present move is over: count what the path went of it, at most its length.

    Interrupt On Move clears if the move itself has set it.
    """
    if I[MQI_BASE + move_record(I, m) * MQI_STRIDE + MQI_MARKS] & MARK_INTERRUPT_LENT:
        I[master_word(m)] &= ~MF1_INTERRUPT_ON_MOVE
    f: int = MSF_BASE + m * MSF_STRIDE
    gone_u: float = F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE] - F[f + MSF_ORIGIN_U]
    F[f + MSF_TRAVEL_U] += max(min(gone_u, length_u), 0.0)


def master_settle(F: F64, I: I32, S: F32, m: int) -> None:
    """At rest the target of every slave is its current position; shown values clear."""
    i: int = MSI_BASE + m * MSI_STRIDE
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if axis >= 0:
            a: int = AXF_BASE + axis * AXF_STRIDE
            F[a + AXF_TARGET_CNT] = F[a + AXF_POSITION_CNT]
            F[a + AXF_FOLDED_CNT] = 0.0
            F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + s] = F[a + AXF_POSITION_CNT]
    p: int = MA_BASE + m * MA_STRIDE
    S[p + MA_VECTOR_VELOCITY] = 0.0
    S[p + MA_VECTOR_ACCELERATION] = 0.0
    S[p + MA_VECTOR_JERK] = 0.0
    S[p + MA_VELOCITY_SQUARED] = 0.0
    I[p + MA_MBUF_FILLED] = 0


def master_hold(F: F64, I: I32, S: F32, m: int) -> None:
    """Slow the path to rest with DEC (STP if DEC is 0); the move itself stays loaded.

    Where an end ramp no softer than that is already running, or the ramp would pass a target
    at which the path stops anyway, the move simply ends at its target.
    """
    i: int = MSI_BASE + m * MSI_STRIDE
    I[i + MSI_HOLD] = FEEDHOLDING
    I[master_word(m)] |= MF1_FEEDHOLDING
    if not I[i + MSI_MOVING]:
        return
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    rate: float = F[q + MQF_DEC_UPS2]
    if rate <= 0.0:
        rate = F[q + MQF_STP_UPS2]
    if master_stopping(I, m) and (rate <= F[q + MQF_STP_UPS2] or ends_early(I, m)):
        return
    if round_holds(F, I, S, m, rate):
        return
    end: float = F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U]
    jerk: float = F[q + MQF_JRK_UPS3]
    flows: bool = F[q + MQF_STP_UPS2] <= 0.0 or look_beyond(I, m, move_record(I, m))
    flows = flows or is_bezier(I, move_record(I, m))
    merged: bool = flows and I[i + MSI_QUEUED] > I[i + MSI_STRETCH]
    merged = merged or I[i + MSI_PIECE] != 0
    rate = round_hold_rate(F, I, m, rate)
    if not profile_stop(F, I, m, end, rate, jerk, DECELERATING) and not merged:
        stp: float = F[q + MQF_STP_UPS2]
        if stp <= 0.0:
            stp = rate
        limit: float = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
        profile_plan(F, I, m, end, limit, 0.0, rate, rate, stp, jerk)


def master_release(F: F64, I: I32, S: F32, m: int) -> None:
    """End a feedhold: the path speeds up again (Cycle Start)."""
    i: int = MSI_BASE + m * MSI_STRIDE
    path_unfold(F, I, m)
    I[i + MSI_HOLD] = NOT_HELD
    I[i + MSI_DROP_AT_REST] = 0
    I[master_word(m)] &= ~(MF1_FEEDHOLDING | MF1_IN_FEEDHOLD)
    if not I[i + MSI_MOVING] or master_stopping(I, m):
        return
    if ends_early(I, m):
        # Has found what it looked for, or is to go no farther: it ends here.
        profile_stop(F, I, m, F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE], 0.0, 0.0, STOPPING)
    else:
        master_plan(F, I, S, m)


def path_unfold(F: F64, I: I32, m: int) -> None:
    """What JOG RES took into a held path is jog offset again: the path goes on where it was."""
    for s in range(SLAVE_COUNT):
        axis: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        if axis >= 0 and F[AXF_BASE + axis * AXF_STRIDE + AXF_FOLDED_CNT] != 0.0:
            a: int = AXF_BASE + axis * AXF_STRIDE
            F[a + AXF_POSITION_CNT] -= F[a + AXF_FOLDED_CNT]
            axis_jog_set(F, I, axis, F[a + AXF_JOG_CNT] + F[a + AXF_FOLDED_CNT])
            F[a + AXF_FOLDED_CNT] = 0.0


def ends_early(I: I32, m: int) -> bool:
    """Whether the present move ends where it comes to rest: it has found what it looked for."""
    i: int = MSI_BASE + m * MSI_STRIDE
    passing: bool = I[i + MSI_HSINT_PHASE] == HSINT_PASSING
    return I[i + MSI_SEEK_PHASE] == SEEK_STOPPING or passing or I[i + MSI_CUT] != 0


def master_stopping(I: I32, m: int) -> bool:
    """Whether the end ramp of the move, or the stop of a seek, is running already."""
    return I[PRI_BASE + m * PRI_STRIDE + PRI_KIND] == STOPPING


def master_at_rest(F: F64, I: I32, S: F32, m: int) -> None:
    """A feedhold has come to rest: note it, and finish what it was the first step of."""
    i: int = MSI_BASE + m * MSI_STRIDE
    word: int = master_word(m)
    I[i + MSI_HOLD] = IN_FEEDHOLD
    I[word] |= MF1_IN_FEEDHOLD
    if I[word] & MF1_STOP_ALL_MOVES_REQUEST:
        I[word] = (I[word] & ~MF1_STOP_ALL_MOVES_REQUEST) | MF1_KILL_ALL_MOVES_REQUEST
        master_drop(F, I, S, m)
    elif I[i + MSI_DROP_AT_REST]:
        master_drop(F, I, S, m)
