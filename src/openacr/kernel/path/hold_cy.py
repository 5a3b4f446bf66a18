"""Feedhold, cycle start, and dropping the moves of a master."""

from openacr.kernel.axis.axis_cy import axis_jog_set
from openacr.kernel.path.bezier_cy import is_bezier, is_timed
from openacr.kernel.path.corner_cy import corner_drop
from openacr.kernel.path.curveflags_cy import curve_drop
from openacr.kernel.path.hsint_cy import HSINT_NONE, HSINT_PASSING
from openacr.kernel.path.lookahead_cy import look_beyond
from openacr.kernel.path.path_cy import (
    FAR_U,
    MARK_INTERRUPT_LENT,
    SLAVE_COUNT,
    move_record,
)
from openacr.kernel.path.plan_cy import master_plan
from openacr.kernel.path.round_hold_cy import round_hold_rate, round_holds
from openacr.kernel.path.seek_cy import SEEK_NONE, SEEK_STOPPING
from openacr.kernel.path.timed_stop_cy import GOES_ON, PLAIN, stop_seek
from openacr.kernel.profile.profile_cy import profile_plan, profile_reset, profile_stop
from openacr.kernel.profile.ramps_cy import DECELERATING, STOPPING
from openacr.map.rows import axes, masters, moves, profiles
from openacr.map.words import mf1, mf4
from openacr.views import F32, F64, I32

__all__ = ["master_drop", "master_hold", "master_release", "move_over"]

NOT_HELD = 0
FEEDHOLDING = 1
IN_FEEDHOLD = 2


def master_drop(F: F64, I: I32, S: F32, m: int) -> None:
    """Drop the present move and all that wait; the axes stay where they are commanded."""
    if I[masters.moving[m]]:
        move_over(F, I, m, FAR_U)
    S[masters.distance_into_path[m]] = F[masters.travel_u[m]]
    I[mf4.word[m]] &= ~mf4.VEL_LIMIT
    I[masters.queued[m]] = 0
    I[masters.moving[m]] = 0
    I[masters.hold[m]] = NOT_HELD
    I[masters.drop_at_rest[m]] = 0
    I[masters.seek_phase[m]] = SEEK_NONE
    I[masters.hsint_phase[m]] = HSINT_NONE
    I[masters.cut[m]] = 0
    I[masters.section_cnt[m]] = 1
    I[masters.trigger[m]] = 0
    I[masters.trigger_axis[m]] = 0
    I[masters.piece[m]] = 0
    corner_drop(F, I, m)
    curve_drop(I, m)
    F[masters.entry_ups[m]] = 0.0
    F[masters.entry_ups2[m]] = 0.0
    profile_reset(F, I, m, 0.0, 0.0)
    F[profiles.target_velocity[m]] = 0.0
    master_settle(F, I, S, m)
    word: int = mf1.word[m]
    I[word] &= ~(
        mf1.IN_MOTION
        | mf1.MOVE_BUFFERED
        | mf1.ACCELERATING
        | mf1.DECELERATING
        | mf1.STOPPING
        | mf1.JERKING
        | mf1.FEEDHOLDING
        | mf1.IN_FEEDHOLD
        | mf1.TRG_PENDING
    )


def move_over(F: F64, I: I32, m: int, length_u: float) -> None:
    """The present move is over: count what the path went of it, at most its length.

    Interrupt On Move clears if the move itself has set it.
    """
    if I[moves.marks[move_record(I, m)]] & MARK_INTERRUPT_LENT:
        I[mf1.word[m]] &= ~mf1.INTERRUPT_ON_MOVE
    gone_u: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    F[masters.travel_u[m]] += max(min(gone_u, length_u), 0.0)


def master_settle(F: F64, I: I32, S: F32, m: int) -> None:
    """At rest the target of every slave is its current position; shown values clear."""
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            F[axes.target_cnt[axis]] = F[axes.position_cnt[axis]]
            F[axes.folded_cnt[axis]] = 0.0
            F[masters.target_cnt[m] + s] = F[axes.position_cnt[axis]]
    S[masters.vector_velocity[m]] = 0.0
    S[masters.vector_acceleration[m]] = 0.0
    S[masters.vector_jerk[m]] = 0.0
    S[masters.velocity_squared[m]] = 0.0
    I[masters.mbuf_filled[m]] = 0


def master_hold(F: F64, I: I32, S: F32, m: int) -> None:
    """Slow the path to rest with DEC (STP if DEC is 0); the move itself stays loaded.

    Where an end ramp no softer than that is already running, or the ramp would pass a target
    at which the path stops anyway, the move simply ends at its target.
    """
    if I[masters.hold[m]] != FEEDHOLDING:
        F[masters.stop_ups3[m]] = 0.0
    I[masters.hold[m]] = FEEDHOLDING
    I[mf1.word[m]] |= mf1.FEEDHOLDING
    if not I[masters.moving[m]]:
        return
    record: int = move_record(I, m)
    if is_timed(I, record) and timed_holds(F, I, S, m):
        return
    rate_ups2: float = F[moves.dec_ups2[record]]
    if rate_ups2 <= 0.0:
        rate_ups2 = F[moves.stp_ups2[record]]
    if master_stopping(I, m) and (rate_ups2 <= F[moves.stp_ups2[record]] or ends_early(I, m)):
        return
    if round_holds(F, I, S, m, rate_ups2):
        return
    end_u: float = F[masters.section_u[m]]
    jerk_ups3: float = F[moves.jrk_ups3[record]]
    flows: bool = F[moves.stp_ups2[record]] <= 0.0 or look_beyond(I, m, move_record(I, m))
    flows = flows or is_bezier(I, move_record(I, m))
    merged: bool = flows and I[masters.queued[m]] > I[masters.section_cnt[m]]
    merged = merged or I[masters.piece[m]] != 0
    rate_ups2 = round_hold_rate(F, I, m, rate_ups2)
    if not profile_stop(F, I, m, end_u, rate_ups2, jerk_ups3, DECELERATING) and not merged:
        stp_ups2: float = F[moves.stp_ups2[record]]
        if stp_ups2 <= 0.0:
            stp_ups2 = rate_ups2
        limit_ups: float = F[profiles.velocity[m]]
        profile_plan(F, I, m, end_u, limit_ups, 0.0, rate_ups2, rate_ups2, stp_ups2, jerk_ups3)


def timed_holds(F: F64, I: I32, S: F32, m: int) -> bool:
    """Slow a curve in time within the limits of its axes; False where it holds as a move does."""
    found: int = stop_seek(F, I, S, m)
    if found == PLAIN:
        return False
    if found == GOES_ON:
        master_plan(F, I, S, m)
        return True
    rate_ups2: float = F[masters.stop_ups2[m]]
    jerk_ups3: float = F[masters.stop_ups3[m]]
    profile_stop(F, I, m, F[masters.section_u[m]], rate_ups2, jerk_ups3, DECELERATING)
    return True


def master_release(F: F64, I: I32, S: F32, m: int) -> None:
    """End a feedhold: the path speeds up again (Cycle Start)."""
    path_unfold(F, I, m)
    I[masters.hold[m]] = NOT_HELD
    I[masters.drop_at_rest[m]] = 0
    I[mf1.word[m]] &= ~(mf1.FEEDHOLDING | mf1.IN_FEEDHOLD)
    if not I[masters.moving[m]] or master_stopping(I, m):
        return
    if ends_early(I, m):
        # Has found what it looked for, or is to go no farther: it ends here.
        profile_stop(F, I, m, F[profiles.distance[m]], 0.0, 0.0, STOPPING)
    else:
        master_plan(F, I, S, m)


def path_unfold(F: F64, I: I32, m: int) -> None:
    """What JOG RES took into a held path is jog offset again: the path goes on where it was."""
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0 and F[axes.folded_cnt[axis]] != 0.0:
            F[axes.position_cnt[axis]] -= F[axes.folded_cnt[axis]]
            axis_jog_set(F, I, axis, F[axes.jog_cnt[axis]] + F[axes.folded_cnt[axis]])
            F[axes.folded_cnt[axis]] = 0.0


def ends_early(I: I32, m: int) -> bool:
    """Whether the present move ends where it comes to rest: it has found what it looked for."""
    passing: bool = I[masters.hsint_phase[m]] == HSINT_PASSING
    return I[masters.seek_phase[m]] == SEEK_STOPPING or passing or I[masters.cut[m]] == 1


def master_stopping(I: I32, m: int) -> bool:
    """Whether the end ramp of the move, or the stop of a seek, is running already."""
    return I[profiles.kind[m]] == STOPPING


def master_at_rest(F: F64, I: I32, S: F32, m: int) -> None:
    """A feedhold has come to rest: note it, and finish what it was the first step of."""
    word: int = mf1.word[m]
    I[masters.hold[m]] = IN_FEEDHOLD
    I[word] |= mf1.IN_FEEDHOLD
    if I[word] & mf1.STOP_ALL_MOVES_REQUEST:
        I[word] = (I[word] & ~mf1.STOP_ALL_MOVES_REQUEST) | mf1.KILL_ALL_MOVES_REQUEST
        master_drop(F, I, S, m)
    elif I[masters.drop_at_rest[m]]:
        master_drop(F, I, S, m)
