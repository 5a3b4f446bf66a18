"""Coordinated moves: a master takes its moves one after the other.

A master owns a ring of moves. The move at the head is the present one; those after it wait. The
profile of the master gives the distance s(t) along the path, the geometry of the present move the
positions of its slaves: with the vector length L of the move and s0, the distance at which it
begins (`origin_u`),

    position = target - delta * r,    r = 1 - (s - s0) / L,    r = 1 at its start, 0 at its end.

A plan ends with the present move, before it (at a hold, or between the line and the rounded
corner of a move), or some moves after it (look-ahead: `section` moves). One servo period is dt of
path time, or what a source and TOV make of it. It is used up plan by plan:

    left := dt
    repeat
        no move is moving:  enter the one at the head, or wait        move_enter
        left := what is left after the end of the plan, s := s(t)     path_advance
        moves that s has passed are over                              moves_pass
        slaves go where the path is                                   master_place
        nothing is left: end
        the plan is over:  another one, the next move, or rest        plan_over

so that a chain of moves loses nothing to the tick grid.

The slow side writes records and counts (motion/path/moves.py); everything else happens here,
in path_cy and curve_cy (geometry), hold_cy (stops), interrupt_cy (INT, TRG), seek_cy
(MSEEK), hsint_cy (HSINT), timed_cy (TMOV) and timebase_cy (SRC, TOV).
"""

from openacr.kernel.axis.capture_cy import capture_arm
from openacr.kernel.path.bar_cy import path_bar, path_passes, skip_take
from openacr.kernel.path.bezier_cy import is_timed
from openacr.kernel.path.corner_cy import corner_drop, corner_pass
from openacr.kernel.path.curveflags_cy import curve_show
from openacr.kernel.path.hold_cy import (
    FEEDHOLDING,
    IN_FEEDHOLD,
    NOT_HELD,
    ends_early,
    master_at_rest,
    master_drop,
    master_hold,
    master_settle,
    move_over,
)
from openacr.kernel.path.hsint_cy import HSINT_NONE, hsint_begin, hsint_end, hsint_step
from openacr.kernel.path.interrupt_cy import (
    CUT,
    CUT_DUE,
    cut_due,
    cut_end,
    interrupt_step,
    move_barred,
    response_period,
)
from openacr.kernel.path.path_cy import (
    MARK_COUNT_DOWN,
    MARK_COUNT_UP,
    MARK_CURVE_BEGIN,
    MARK_FINAL_ZERO,
    MARK_INTERRUPT,
    MARK_INTERRUPT_LENT,
    MARK_OVERRIDE_LOCKED,
    MARK_TURN,
    master_limit,
    master_place,
    move_geometry,
    move_place,
    move_record,
    move_shape,
)
from openacr.kernel.path.plan_cy import look_refresh, master_plan
from openacr.kernel.path.relay_cy import path_relay
from openacr.kernel.path.seek_cy import (
    SEEK_NONE,
    SEEK_SEARCHING,
    SEEK_STOPPING,
    seek_end,
    seek_step,
)
from openacr.kernel.path.sync_cy import sync_bars
from openacr.kernel.path.timebase_cy import path_advance, path_time
from openacr.kernel.path.timed_cy import move_timed
from openacr.kernel.profile.profile_cy import profile_reset
from openacr.kernel.profile.ramps_cy import ACCELERATING, DECELERATING, STOPPING
from openacr.map.rows import curve_points, masters, moves, profiles
from openacr.map.words import mf1, mf2, mf4
from openacr.views import F32, F64, I32

__all__ = ["master_step"]

# What `move_enter` has done.
ENTERED = 0
SKIPPED = 1
WAITS = 2
BARS = mf1.START_MOVE_INHIBIT | mf1.TRG_PENDING
ROUNDING = 1e-9
PIECES_PER_TICK = 51  # of a full ring of moves shorter than a tick, and a seek that turns back


def move_begin(F: F64, I: I32, S: F32, m: int, velocity_ups: float, accel_ups2: float) -> None:
    """Make the record at the head the present move, entered with the given speed."""
    record: int = move_record(I, m)
    word: int = mf1.word[m]
    word2: int = mf2.word[m]
    move_flags(I, S, m, record)
    move_geometry(F, I, S, m)
    turn_deg: float = F[moves.turn_deg[record]]
    S[masters.look_ahead_vector_angle[m]] = turn_deg
    if starts_anew(I, m, record):
        velocity_ups = 0.0
        accel_ups2 = 0.0
    I[masters.moving[m]] = 1
    I[masters.sync_go[m]] = 0
    I[masters.step_go[m]] = 0
    if I[masters.cut[m]] < CUT_DUE:
        I[masters.cut[m]] = 0
    I[masters.response[m]] = response_period(I, m)
    I[masters.hsint_phase[m]] = HSINT_NONE
    if I[moves.hsint_axis[record]]:
        hsint_begin(F, I, m)
    I[masters.seek_phase[m]] = SEEK_NONE
    if I[moves.seek_axis[record]]:
        capture_arm(
            F,
            I,
            I[moves.seek_axis[record]] - 1,
            I[moves.seek_mode[record]],
        )
        I[masters.seek_phase[m]] = SEEK_SEARCHING
    if I[moves.rapid[record]]:
        I[word2] |= mf2.RAPID_ACTIVE
    else:
        I[word2] &= ~mf2.RAPID_ACTIVE
    if velocity_ups <= 0.0:  # from rest: the initial velocity is a step, never above the target
        velocity_ups = min(F[moves.ivel_ups[record]], master_limit(F, I, S, m))
    I[word] |= mf1.IN_MOTION
    profile_reset(F, I, m, velocity_ups, accel_ups2)
    if F[moves.tmov_s[record]] > 0.0:
        move_timed(F, I, S, m)
    master_plan(F, I, S, m)


def starts_anew(I: I32, m: int, record: int) -> bool:
    """Whether speed begins anew with a move.

    Curves in time and turns of the tangential axis are entered and left at rest.
    """
    row: int = masters.manner[m]
    before: int = I[row]
    marks: int = I[moves.marks[record]]
    I[row] = marks & MARK_TURN
    if is_timed(I, record):
        I[row] = 1
    if I[row] != before:
        return True
    return before != 0 and marks & MARK_CURVE_BEGIN != 0


def move_flags(I: I32, S: F32, m: int, record: int) -> None:
    """What the start of a move does to flags: pending to active, move counter."""
    word: int = mf1.word[m]
    word2: int = mf2.word[m]
    flags: int = I[word] & ~(mf1.FVEL_ZERO_ACTIVE | mf1.FOV_ROV_LOCK_ACTIVE)
    marks: int = I[moves.marks[record]]
    if flags & mf1.FVEL_ZERO_PENDING or marks & MARK_FINAL_ZERO:
        flags |= mf1.FVEL_ZERO_ACTIVE
    if flags & mf1.FOV_ROV_LOCK_PENDING or marks & MARK_OVERRIDE_LOCKED:
        flags |= mf1.FOV_ROV_LOCK_ACTIVE
    if marks & MARK_INTERRUPT and not flags & mf1.INTERRUPT_ON_MOVE:
        flags |= mf1.INTERRUPT_ON_MOVE
        I[moves.marks[record]] = marks | MARK_INTERRUPT_LENT
    I[word] = flags
    if I[word2] & mf2.RAPID_PENDING:
        I[moves.rapid[record]] = 1
    counter: int = masters.move_counter[m]
    counted: int = I[counter] + move_count(flags, marks)
    if -2147483647 <= counted and counted <= 2147483647:
        I[counter] = counted


def move_count(flags: int, marks: int) -> int:
    """What a move adds to the counter: as its packet says, else as the flags do."""
    if marks & MARK_COUNT_UP:
        return 1
    if marks & MARK_COUNT_DOWN:
        return -1
    step: int = 0
    if flags & mf1.INCREMENT_COUNT:
        step += 1
    if flags & mf1.DECREMENT_COUNT:
        step -= 1
    return step


def move_pop(I: I32, m: int) -> None:
    """Remove the record at the head of the ring."""
    head: int = I[masters.head[m]] + 1
    I[masters.head[m]] = 0 if head >= I[masters.size[m]] else head
    I[masters.queued[m]] -= 1
    if I[masters.cut[m]] >= CUT_DUE:
        I[masters.cut[m]] = I[masters.cut[m]] - 1 if I[masters.cut[m]] > CUT_DUE else 0
    I[masters.moving[m]] = 0


def move_end(F: F64, I: I32, S: F32, m: int) -> None:
    """The present move has arrived: count its length into the totals and remove it."""
    length_u: float = F[moves.length_u[move_record(I, m)]]
    move_over(F, I, m, length_u)
    S[masters.total_distance[m]] = S[masters.total_distance[m]] + length_u
    move_pop(I, m)
    if I[masters.rounding[m]]:
        corner_pass(F, I, m, move_record(I, m))


def moves_pass(F: F64, I: I32, S: F32, m: int) -> None:
    """The plan runs on into the next moves: remove those that are completed."""
    while I[masters.section_cnt[m]] > 1:
        record: int = move_record(I, m)
        length_u: float = F[moves.length_u[record]]
        if F[profiles.distance[m]] < F[masters.origin_u[m]] + length_u:
            return
        move_place(F, I, m, record, 0.0)
        move_end(F, I, S, m)
        I[masters.moving[m]] = 1
        I[masters.section_cnt[m]] -= 1
        F[masters.origin_u[m]] += length_u
        F[masters.corner_in_u[m]] = 0.0  # lies before the move that has been passed
        record = move_record(I, m)
        skip_take(I, m)
        move_flags(I, S, m, record)
        length_u = F[moves.length_u[record]]
        move_shape(F, I, S, m, record, False)
        if F[moves.length_u[record]] != length_u:
            I[masters.look_dirty[m]] = 1  # its start was moved
        turn_deg: float = F[moves.turn_deg[record]]
        S[masters.look_ahead_vector_angle[m]] = turn_deg


def master_show(F: F64, I: I32, S: F32, m: int) -> None:
    """Publish the state of the path in the parameters and flags of the master."""
    record: int = move_record(I, m)
    length_u: float = F[moves.length_u[record]]
    distance_u: float = F[profiles.distance[m]] - F[masters.origin_u[m]]
    pace: float = 1.0
    if I[masters.paced[m]]:
        pace = F[masters.pace[m]]
    velocity_ups: float = F[profiles.velocity[m]] * pace
    S[masters.distance_into_move[m]] = distance_u
    S[masters.distance_into_path[m]] = F[masters.travel_u[m]] + distance_u
    S[masters.vector_velocity[m]] = velocity_ups
    S[masters.vector_acceleration[m]] = F[profiles.accel[m]] * pace * pace
    S[masters.vector_jerk[m]] = F[profiles.jerk[m]] * pace * pace * pace
    S[masters.vector_length[m]] = length_u
    S[masters.target_velocity[m]] = F[profiles.target_velocity[m]]
    S[masters.distance_to_go[m]] = length_u - distance_u
    S[masters.velocity_squared[m]] = velocity_ups * velocity_ups
    S[masters.fraction_into_move[m]] = distance_u / length_u if length_u > 0.0 else 1.0
    kind: int = I[profiles.kind[m]]
    word: int = mf1.word[m]
    flags: int = I[word] & ~(
        mf1.ACCELERATING | mf1.DECELERATING | mf1.STOPPING | mf1.JERKING | mf1.MOVE_BUFFERED
    )
    target_ups2: float = F[moves.acc_ups2[record]]
    if kind == ACCELERATING:
        flags |= mf1.ACCELERATING
    elif kind == DECELERATING:
        flags |= mf1.DECELERATING
        target_ups2 = F[moves.dec_ups2[record]]
    elif kind == STOPPING:
        flags |= mf1.STOPPING
        target_ups2 = F[moves.stp_ups2[record]]
    S[masters.target_acceleration[m]] = target_ups2
    if F[profiles.jerk[m]] != 0.0:
        flags |= mf1.JERKING
    waiting: int = I[masters.queued[m]] - 1
    if waiting > 0:
        flags |= mf1.MOVE_BUFFERED
    I[masters.mbuf_filled[m]] = max(waiting, 0)
    I[word] = flags
    limit_ups: float = S[masters.vel_limit[m]]
    if limit_ups > 0.0 and velocity_ups >= limit_ups * (1.0 - ROUNDING):
        I[mf4.word[m]] |= mf4.VEL_LIMIT
    else:
        I[mf4.word[m]] &= ~mf4.VEL_LIMIT


def master_busy(I: I32, m: int) -> bool:
    """Whether master m has moves, a hold, a time base, a curve or a kill to attend to."""
    return (
        I[masters.queued[m]]
        | I[masters.hold[m]]
        | I[masters.paced[m]]
        | I[curve_points.live[m]]
        | (I[mf1.word[m]] & mf1.KILL_ALL_MOVES_REQUEST)
    ) != 0


def master_step(F: F64, I: I32, S: F32, m: int, dt_s: float) -> None:
    """Advance master m by one servo period of `dt_s` seconds of path time."""
    master_moves(F, I, S, m, dt_s)
    if I[curve_points.live[m]]:
        curve_show(I, m)


def master_moves(F: F64, I: I32, S: F32, m: int, dt_s: float) -> None:
    """Take the path of a master on by one servo period, through as many of its moves as fit."""
    left_s: float = dt_s
    if I[masters.paced[m]]:
        left_s = path_time(F, I, S, m, dt_s)
    if not path_runs(F, I, S, m):
        return
    velocity_ups: float = 0.0
    accel_ups2: float = 0.0
    if not I[masters.moving[m]]:
        velocity_ups = F[masters.entry_ups[m]]
        accel_ups2 = F[masters.entry_ups2[m]]
        F[masters.entry_ups[m]] = 0.0
        F[masters.entry_ups2[m]] = 0.0
    for _ in range(PIECES_PER_TICK):
        if not I[masters.moving[m]]:
            entered: int = move_enter(F, I, S, m, velocity_ups, accel_ups2)
            if entered == WAITS:
                break
            if entered == SKIPPED:
                continue
        elif I[masters.hold[m]] == NOT_HELD:
            master_follow(F, I, S, m)
        left_s = path_advance(F, I, m, left_s)
        if I[masters.section_cnt[m]] > 1:
            moves_pass(F, I, S, m)
        master_place(F, I, m)
        if left_s < 0.0:
            break
        velocity_ups = F[profiles.velocity[m]]
        accel_ups2 = F[profiles.accel[m]]
        if not plan_over(F, I, S, m):
            break
    if I[masters.queued[m]]:
        master_show(F, I, S, m)
        return
    if I[masters.hold[m]] == FEEDHOLDING:
        master_at_rest(F, I, S, m)
    master_idle(F, I, S, m)


def path_runs(F: F64, I: I32, S: F32, m: int) -> bool:
    """Whether the path may go on in this tick: it has moves, and no kill or feedhold stops it."""
    word: int = mf1.word[m]
    if I[word] & mf1.KILL_ALL_MOVES_REQUEST:
        if I[masters.queued[m]] or I[masters.hold[m]]:
            master_drop(F, I, S, m)
        if I[mf2.word[m]] & mf2.ENABLE_CLEAR_REQUEST:
            I[word] &= ~mf1.KILL_ALL_MOVES_REQUEST
        return False
    if not I[masters.queued[m]]:
        if I[masters.hold[m]] == FEEDHOLDING:
            master_at_rest(F, I, S, m)
        return False
    return I[masters.hold[m]] != IN_FEEDHOLD


def move_enter(F: F64, I: I32, S: F32, m: int, velocity_ups: float, accel_ups2: float) -> int:
    """Begin the move at the head with this speed: ENTERED, SKIPPED, or the path WAITS."""
    if I[masters.hold[m]] == FEEDHOLDING and velocity_ups <= 0.0:
        master_at_rest(F, I, S, m)
        return WAITS
    barred: bool = sync_bars(I, m) or (I[mf1.word[m]] & BARS != 0 and move_barred(I, m))
    passes: bool = path_passes(I, m, velocity_ups)
    if barred and not passes:
        profile_reset(F, I, m, 0.0, 0.0)
        return WAITS
    if skip_take(I, m) and not passes:
        move_pop(I, m)
        path_relay(F, I, S, m)
        return SKIPPED if I[masters.queued[m]] else WAITS
    move_begin(F, I, S, m, velocity_ups, accel_ups2)
    if I[masters.hold[m]] == FEEDHOLDING:
        master_hold(F, I, S, m)
    return ENTERED


def plan_over(F: F64, I: I32, S: F32, m: int) -> bool:
    """The plan has ended within the tick: decide what follows; False where the path rests.

    A hold, or a piece of a move, ends before the move does; a seek or an HSINT may have more to
    do at its end. Otherwise the move is over, and with INT so is what was planned beyond it.
    """
    if master_short_of_target(F, I, m):
        master_at_rest(F, I, S, m)
        return False
    if I[masters.piece[m]]:
        return piece_over(F, I, S, m)
    elsewhere: bool = I[masters.cut[m]] == CUT  # than planned
    if I[masters.seek_phase[m]] != SEEK_NONE:
        if seek_end(F, I, S, m):
            return True
        elsewhere = True
    if I[masters.hsint_phase[m]] != HSINT_NONE:
        if hsint_end(F, I, S, m):
            return True
        elsewhere = True
    if I[masters.cut[m]] == CUT:
        cut_end(F, I, m)
        while I[masters.section_cnt[m]] > 1:  # what the path was planned through goes with it
            move_end(F, I, S, m)
            F[masters.origin_u[m]] = F[profiles.distance[m]]  # nothing of it has been gone
            I[masters.section_cnt[m]] -= 1
        I[masters.cut[m]] = 0
    move_end(F, I, S, m)
    if elsewhere:
        path_relay(F, I, S, m)
    return I[masters.queued[m]] != 0


def piece_over(F: F64, I: I32, S: F32, m: int) -> bool:
    """Plan the next piece of the present move; False where a hold has ended in rest."""
    held: bool = I[masters.hold[m]] == FEEDHOLDING
    if held and F[profiles.velocity[m]] <= 0.0:
        master_at_rest(F, I, S, m)
        return False
    master_plan(F, I, S, m)
    if held:
        master_hold(F, I, S, m)
    return True


def master_short_of_target(F: F64, I: I32, m: int) -> bool:
    """True when a hold has stopped the path before the target of the move."""
    return (
        I[masters.hold[m]] == FEEDHOLDING and F[profiles.end_distance[m]] < F[masters.section_u[m]]
    )


def master_follow(F: F64, I: I32, S: F32, m: int) -> None:
    """Replan when the wanted speed has changed (override, limit) or a seek has captured."""
    if I[masters.seek_phase[m]] == SEEK_SEARCHING:
        seek_step(F, I, S, m)
        if I[masters.seek_phase[m]] == SEEK_STOPPING:
            return
    if I[masters.hsint_phase[m]] != HSINT_NONE:
        hsint_step(F, I, S, m)
    if I[moves.interrupt[move_record(I, m)]]:
        interrupt_step(F, I, S, m)
    word: int = mf1.word[m]
    path_bar(F, I, S, m)
    dirty: bool = I[masters.look_dirty[m]] != 0
    if dirty and I[masters.cut[m]] != CUT:
        look_refresh(F, I, S, m)
    if I[masters.cut[m]] >= CUT_DUE:
        cut_due(F, I, S, m)
    if not ends_early(I, m) and (
        master_limit(F, I, S, m) != F[profiles.target_velocity[m]]
        or I[masters.final_zero[m]] != I[word] & mf1.FVEL_ZERO_ACTIVE
    ):
        master_plan(F, I, S, m)


def master_idle(F: F64, I: I32, S: F32, m: int) -> None:
    """All moves have arrived: motion flags clear in the tick of the final positions."""
    word: int = mf1.word[m]
    moving: int = 0
    if I[curve_points.open[m]]:  # a curve waits for its next points
        moving = I[word] & mf1.IN_MOTION
    I[word] &= ~(
        mf1.IN_MOTION
        | mf1.MOVE_BUFFERED
        | mf1.ACCELERATING
        | mf1.DECELERATING
        | mf1.STOPPING
        | mf1.JERKING
    )
    I[word] |= moving
    profile_reset(F, I, m, 0.0, 0.0)
    if I[masters.rounding[m]]:
        I[masters.rounding[m]] = 0
        corner_drop(F, I, m)
    S[masters.distance_into_move[m]] = S[masters.vector_length[m]]
    S[masters.distance_into_path[m]] = F[masters.travel_u[m]]
    S[masters.distance_to_go[m]] = 0.0
    S[masters.fraction_into_move[m]] = 1.0
    master_settle(F, I, S, m)
