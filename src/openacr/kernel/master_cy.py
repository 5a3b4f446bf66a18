"""Coordinated moves: a master takes its moves one after the other.

A master owns a ring of moves. The move at the head is the present one; those behind it
wait. Time left over at the end of a move goes into the next one, so a chain of moves loses
nothing to the tick grid.

The slow side writes records and counts (motion/moves.py); everything else happens here,
in path_cy and curve_cy (geometry), hold_cy (stops), interrupt_cy (INT, TRG), seek_cy
(MSEEK), hsint_cy (HSINT), timed_cy (TMOV) and timebase_cy (SRC, TOV).
"""

from openacr.kernel.bezier_cy import is_timed
from openacr.kernel.capture_cy import capture_arm
from openacr.kernel.corner_cy import corner_drop, corner_pass
from openacr.kernel.curveflags_cy import curve_show
from openacr.kernel.hold_cy import (
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
from openacr.kernel.hsint_cy import HSINT_NONE, hsint_begin, hsint_end, hsint_step
from openacr.kernel.interrupt_cy import cut_end, interrupt_step, move_barred, response_period
from openacr.kernel.path_cy import (
    MARK_BLOCK_SKIP,
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
    master_word,
    master_word2,
    move_geometry,
    move_place,
    move_record,
    move_shape,
)
from openacr.kernel.plan_cy import look_refresh, master_plan
from openacr.kernel.profile_cy import (
    ACCELERATING,
    DECELERATING,
    STOPPING,
    profile_reset,
)
from openacr.kernel.seek_cy import SEEK_NONE, SEEK_SEARCHING, SEEK_STOPPING, seek_end, seek_step
from openacr.kernel.sync_cy import sync_bars
from openacr.kernel.timebase_cy import path_advance, path_time
from openacr.kernel.timed_cy import move_timed
from openacr.map.numbers import (
    CPI_BASE,
    CPI_LIVE,
    CPI_OPEN,
    CPI_STRIDE,
    MA_BASE,
    MA_DISTANCE_INTO_MOVE,
    MA_DISTANCE_INTO_PATH,
    MA_DISTANCE_TO_GO,
    MA_FRACTION_INTO_MOVE,
    MA_LOOK_AHEAD_VECTOR_ANGLE,
    MA_MBUF_FILLED,
    MA_MOVE_COUNTER,
    MA_STRIDE,
    MA_TARGET_ACCELERATION,
    MA_TARGET_VELOCITY,
    MA_TOTAL_DISTANCE,
    MA_VECTOR_ACCELERATION,
    MA_VECTOR_JERK,
    MA_VECTOR_LENGTH,
    MA_VECTOR_VELOCITY,
    MA_VEL_LIMIT,
    MA_VELOCITY_SQUARED,
    MF1_ACCELERATING,
    MF1_DECELERATING,
    MF1_DECREMENT_COUNT,
    MF1_FOV_ROV_LOCK_ACTIVE,
    MF1_FOV_ROV_LOCK_PENDING,
    MF1_FVEL_ZERO_ACTIVE,
    MF1_FVEL_ZERO_PENDING,
    MF1_IN_MOTION,
    MF1_INCREMENT_COUNT,
    MF1_INTERRUPT_ON_MOVE,
    MF1_JERKING,
    MF1_KILL_ALL_MOVES_REQUEST,
    MF1_MOVE_BUFFERED,
    MF1_START_MOVE_INHIBIT,
    MF1_STOPPING,
    MF1_TRG_PENDING,
    MF2_BLOCK_SKIP_CHECK,
    MF2_BLOCK_SKIP_INPUT,
    MF2_ENABLE_CLEAR_REQUEST,
    MF2_RAPID_ACTIVE,
    MF2_RAPID_PENDING,
    MF4_VEL_LIMIT,
    MF4_WORD,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_IVEL_UPS,
    MQF_LENGTH_U,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TMOV_S,
    MQF_TURN_DEG,
    MQI_BASE,
    MQI_HSINT_AXIS,
    MQI_INTERRUPT,
    MQI_MARKS,
    MQI_RAPID,
    MQI_SEEK_AXIS,
    MQI_SEEK_MODE,
    MQI_STRIDE,
    MSF_BASE,
    MSF_ENTRY_UPS,
    MSF_ENTRY_UPS2,
    MSF_ORIGIN_U,
    MSF_PACE,
    MSF_STRETCH_U,
    MSF_STRIDE,
    MSF_TRAVEL_U,
    MSI_BASE,
    MSI_CUT,
    MSI_FINAL_ZERO,
    MSI_HEAD,
    MSI_HOLD,
    MSI_HSINT_PHASE,
    MSI_LOOK_DIRTY,
    MSI_MANNER,
    MSI_MOVING,
    MSI_PACED,
    MSI_PIECE,
    MSI_QUEUED,
    MSI_RESPONSE,
    MSI_ROUNDING,
    MSI_SEEK_PHASE,
    MSI_SIZE,
    MSI_STEP_GO,
    MSI_STRETCH,
    MSI_STRIDE,
    MSI_SYNC_GO,
    PRF_ACCEL,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_END_DISTANCE,
    PRF_JERK,
    PRF_STRIDE,
    PRF_TARGET_VELOCITY,
    PRF_VELOCITY,
    PRI_BASE,
    PRI_KIND,
    PRI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["master_step"]

BARS = MF1_START_MOVE_INHIBIT | MF1_TRG_PENDING
ROUNDING = 1e-9
PIECES_PER_TICK = 51  # of a full ring of moves shorter than a tick, and a seek that turns back


def move_begin(F: F64, I: I32, S: F32, m: int, velocity: float, accel: float) -> None:
    """Make the record at the head the present move, entered with the given speed."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    word: int = master_word(m)
    word2: int = master_word2(m)
    move_flags(I, S, m, record)
    move_geometry(F, I, S, m)
    turn: float = F[MQF_BASE + record * MQF_STRIDE + MQF_TURN_DEG]
    S[MA_BASE + m * MA_STRIDE + MA_LOOK_AHEAD_VECTOR_ANGLE] = turn
    if starts_anew(I, m, record):
        velocity = 0.0
        accel = 0.0
    I[i + MSI_MOVING] = 1
    I[i + MSI_SYNC_GO] = 0
    I[i + MSI_STEP_GO] = 0
    I[i + MSI_CUT] = 0
    I[i + MSI_RESPONSE] = response_period(I, m)
    I[i + MSI_HSINT_PHASE] = HSINT_NONE
    if I[MQI_BASE + record * MQI_STRIDE + MQI_HSINT_AXIS]:
        hsint_begin(F, I, m)
    I[i + MSI_SEEK_PHASE] = SEEK_NONE
    if I[MQI_BASE + record * MQI_STRIDE + MQI_SEEK_AXIS]:
        capture_arm(
            F,
            I,
            I[MQI_BASE + record * MQI_STRIDE + MQI_SEEK_AXIS] - 1,
            I[MQI_BASE + record * MQI_STRIDE + MQI_SEEK_MODE],
        )
        I[i + MSI_SEEK_PHASE] = SEEK_SEARCHING
    if I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID]:
        I[word2] |= MF2_RAPID_ACTIVE
    else:
        I[word2] &= ~MF2_RAPID_ACTIVE
    if velocity <= 0.0:  # from rest: the initial velocity is a step, never above the target
        velocity = min(F[MQF_BASE + record * MQF_STRIDE + MQF_IVEL_UPS], master_limit(F, I, S, m))
    I[word] |= MF1_IN_MOTION
    profile_reset(F, I, m, velocity, accel)
    if F[MQF_BASE + record * MQF_STRIDE + MQF_TMOV_S] > 0.0:
        move_timed(F, I, S, m)
    master_plan(F, I, S, m)


def starts_anew(I: I32, m: int, record: int) -> bool:
    """Whether speed begins anew with a move.

    Curves in time and turns of the tangential axis are entered and left at rest.
    """
    row: int = MSI_BASE + m * MSI_STRIDE + MSI_MANNER
    before: int = I[row]
    marks: int = I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS]
    I[row] = marks & MARK_TURN
    if is_timed(I, record):
        I[row] = 1
    if I[row] != before:
        return True
    return before != 0 and marks & MARK_CURVE_BEGIN != 0


def move_flags(I: I32, S: F32, m: int, record: int) -> None:
    """What the start of a move does to flags: pending to active, move counter."""
    word: int = master_word(m)
    word2: int = master_word2(m)
    flags: int = I[word] & ~(MF1_FVEL_ZERO_ACTIVE | MF1_FOV_ROV_LOCK_ACTIVE)
    marks: int = I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS]
    if flags & MF1_FVEL_ZERO_PENDING or marks & MARK_FINAL_ZERO:
        flags |= MF1_FVEL_ZERO_ACTIVE
    if flags & MF1_FOV_ROV_LOCK_PENDING or marks & MARK_OVERRIDE_LOCKED:
        flags |= MF1_FOV_ROV_LOCK_ACTIVE
    if marks & MARK_INTERRUPT and not flags & MF1_INTERRUPT_ON_MOVE:
        flags |= MF1_INTERRUPT_ON_MOVE
        I[MQI_BASE + record * MQI_STRIDE + MQI_MARKS] = marks | MARK_INTERRUPT_LENT
    I[word] = flags
    if I[word2] & MF2_RAPID_PENDING:
        I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID] = 1
    counter: int = MA_BASE + m * MA_STRIDE + MA_MOVE_COUNTER
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
    if flags & MF1_INCREMENT_COUNT:
        step += 1
    if flags & MF1_DECREMENT_COUNT:
        step -= 1
    return step


def move_skipped(I: I32, m: int) -> bool:
    """Block skip: with Check and Input set the next move is dropped; Check clears."""
    word2: int = master_word2(m)
    flags: int = I[word2]
    if I[MQI_BASE + move_record(I, m) * MQI_STRIDE + MQI_MARKS] & MARK_BLOCK_SKIP:
        flags |= MF2_BLOCK_SKIP_CHECK
    if not flags & MF2_BLOCK_SKIP_CHECK:
        return False
    I[word2] = flags & ~MF2_BLOCK_SKIP_CHECK
    return flags & MF2_BLOCK_SKIP_INPUT != 0


def move_pop(I: I32, m: int) -> None:
    """Remove the record at the head of the ring."""
    i: int = MSI_BASE + m * MSI_STRIDE
    head: int = I[i + MSI_HEAD] + 1
    I[i + MSI_HEAD] = 0 if head >= I[i + MSI_SIZE] else head
    I[i + MSI_QUEUED] -= 1
    I[i + MSI_MOVING] = 0


def move_end(F: F64, I: I32, S: F32, m: int) -> None:
    """The present move has arrived: count its length into the totals and remove it."""
    p: int = MA_BASE + m * MA_STRIDE
    length: float = F[MQF_BASE + move_record(I, m) * MQF_STRIDE + MQF_LENGTH_U]
    move_over(F, I, m, length)
    S[p + MA_TOTAL_DISTANCE] = S[p + MA_TOTAL_DISTANCE] + length
    move_pop(I, m)
    if I[MSI_BASE + m * MSI_STRIDE + MSI_ROUNDING]:
        corner_pass(F, I, m, move_record(I, m))


def moves_pass(F: F64, I: I32, S: F32, m: int) -> None:
    """The plan runs on into the next moves: remove those that are behind."""
    i: int = MSI_BASE + m * MSI_STRIDE
    f: int = MSF_BASE + m * MSF_STRIDE
    while I[i + MSI_STRETCH] > 1:
        record: int = move_record(I, m)
        length: float = F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]
        if F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE] < F[f + MSF_ORIGIN_U] + length:
            return
        move_place(F, I, m, record, 0.0)
        move_end(F, I, S, m)
        I[i + MSI_MOVING] = 1
        I[i + MSI_STRETCH] -= 1
        F[f + MSF_ORIGIN_U] += length
        record = move_record(I, m)
        move_flags(I, S, m, record)
        length = F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U]
        move_shape(F, I, S, m, record, False)
        if F[MQF_BASE + record * MQF_STRIDE + MQF_LENGTH_U] != length:
            I[i + MSI_LOOK_DIRTY] = 1  # somebody has moved its start
        turn: float = F[MQF_BASE + record * MQF_STRIDE + MQF_TURN_DEG]
        S[MA_BASE + m * MA_STRIDE + MA_LOOK_AHEAD_VECTOR_ANGLE] = turn


def master_show(F: F64, I: I32, S: F32, m: int) -> None:
    """Publish the state of the path in the parameters and flags of the master."""
    f: int = PRF_BASE + m * PRF_STRIDE
    p: int = MA_BASE + m * MA_STRIDE
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    length: float = F[q + MQF_LENGTH_U]
    distance: float = F[f + PRF_DISTANCE] - F[MSF_BASE + m * MSF_STRIDE + MSF_ORIGIN_U]
    pace: float = 1.0
    if I[MSI_BASE + m * MSI_STRIDE + MSI_PACED]:
        pace = F[MSF_BASE + m * MSF_STRIDE + MSF_PACE]
    velocity: float = F[f + PRF_VELOCITY] * pace
    S[p + MA_DISTANCE_INTO_MOVE] = distance
    S[p + MA_DISTANCE_INTO_PATH] = F[MSF_BASE + m * MSF_STRIDE + MSF_TRAVEL_U] + distance
    S[p + MA_VECTOR_VELOCITY] = velocity
    S[p + MA_VECTOR_ACCELERATION] = F[f + PRF_ACCEL] * pace * pace
    S[p + MA_VECTOR_JERK] = F[f + PRF_JERK] * pace * pace * pace
    S[p + MA_VECTOR_LENGTH] = length
    S[p + MA_TARGET_VELOCITY] = F[f + PRF_TARGET_VELOCITY]
    S[p + MA_DISTANCE_TO_GO] = length - distance
    S[p + MA_VELOCITY_SQUARED] = velocity * velocity
    S[p + MA_FRACTION_INTO_MOVE] = distance / length if length > 0.0 else 1.0
    kind: int = I[PRI_BASE + m * PRI_STRIDE + PRI_KIND]
    word: int = master_word(m)
    flags: int = I[word] & ~(
        MF1_ACCELERATING | MF1_DECELERATING | MF1_STOPPING | MF1_JERKING | MF1_MOVE_BUFFERED
    )
    target: float = F[q + MQF_ACC_UPS2]
    if kind == ACCELERATING:
        flags |= MF1_ACCELERATING
    elif kind == DECELERATING:
        flags |= MF1_DECELERATING
        target = F[q + MQF_DEC_UPS2]
    elif kind == STOPPING:
        flags |= MF1_STOPPING
        target = F[q + MQF_STP_UPS2]
    S[p + MA_TARGET_ACCELERATION] = target
    if F[f + PRF_JERK] != 0.0:
        flags |= MF1_JERKING
    waiting: int = I[MSI_BASE + m * MSI_STRIDE + MSI_QUEUED] - 1
    if waiting > 0:
        flags |= MF1_MOVE_BUFFERED
    I[p + MA_MBUF_FILLED] = max(waiting, 0)
    I[word] = flags
    limit: float = S[p + MA_VEL_LIMIT]
    if limit > 0.0 and velocity >= limit * (1.0 - ROUNDING):
        I[MF4_WORD + m] |= MF4_VEL_LIMIT
    else:
        I[MF4_WORD + m] &= ~MF4_VEL_LIMIT


def master_busy(I: I32, m: int) -> bool:
    """Whether master m has moves, a hold, a time base, a curve or a kill to attend to."""
    i: int = MSI_BASE + m * MSI_STRIDE
    return (
        I[i + MSI_QUEUED]
        | I[i + MSI_HOLD]
        | I[i + MSI_PACED]
        | I[CPI_BASE + m * CPI_STRIDE + CPI_LIVE]
        | (I[master_word(m)] & MF1_KILL_ALL_MOVES_REQUEST)
    ) != 0


def master_step(F: F64, I: I32, S: F32, m: int, dt: float) -> None:
    """Advance master m by one servo period of `dt` seconds of path time."""
    master_moves(F, I, S, m, dt)
    if I[CPI_BASE + m * CPI_STRIDE + CPI_LIVE]:
        curve_show(I, m)


def master_moves(F: F64, I: I32, S: F32, m: int, dt: float) -> None:
    """Take the path of a master on, through as many of its moves as fit."""
    i: int = MSI_BASE + m * MSI_STRIDE
    word: int = master_word(m)
    left: float = dt
    if I[i + MSI_PACED]:
        left = path_time(F, I, S, m, dt)
    if I[word] & MF1_KILL_ALL_MOVES_REQUEST:
        if I[i + MSI_QUEUED] or I[i + MSI_HOLD]:
            master_drop(F, I, S, m)
        if I[master_word2(m)] & MF2_ENABLE_CLEAR_REQUEST:
            I[word] &= ~MF1_KILL_ALL_MOVES_REQUEST
        return
    if not I[i + MSI_QUEUED]:
        if I[i + MSI_HOLD] == FEEDHOLDING:
            master_at_rest(F, I, S, m)
        return
    if I[i + MSI_HOLD] == IN_FEEDHOLD:
        return
    velocity: float = 0.0
    accel: float = 0.0
    if not I[i + MSI_MOVING]:
        velocity = F[MSF_BASE + m * MSF_STRIDE + MSF_ENTRY_UPS]
        accel = F[MSF_BASE + m * MSF_STRIDE + MSF_ENTRY_UPS2]
        F[MSF_BASE + m * MSF_STRIDE + MSF_ENTRY_UPS] = 0.0
        F[MSF_BASE + m * MSF_STRIDE + MSF_ENTRY_UPS2] = 0.0
    for _ in range(PIECES_PER_TICK):
        if not I[i + MSI_MOVING]:
            if I[i + MSI_HOLD] == FEEDHOLDING and velocity <= 0.0:
                master_at_rest(F, I, S, m)
                break
            if sync_bars(I, m) or (I[word] & BARS and move_barred(I, m)):
                profile_reset(F, I, m, 0.0, 0.0)
                break
            if move_skipped(I, m):
                move_pop(I, m)
                if not I[i + MSI_QUEUED]:
                    break
                continue
            move_begin(F, I, S, m, velocity, accel)
            if I[i + MSI_HOLD] == FEEDHOLDING:
                master_hold(F, I, S, m)
        elif I[i + MSI_HOLD] == NOT_HELD:
            master_follow(F, I, S, m)
        left = path_advance(F, I, m, left)
        if I[i + MSI_STRETCH] > 1:
            moves_pass(F, I, S, m)
        master_place(F, I, m)
        if left < 0.0:
            break
        velocity = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
        accel = F[PRF_BASE + m * PRF_STRIDE + PRF_ACCEL]
        if master_short_of_target(F, I, m):
            master_at_rest(F, I, S, m)
            break
        if I[i + MSI_PIECE]:
            if I[i + MSI_HOLD] == FEEDHOLDING and velocity <= 0.0:
                master_at_rest(F, I, S, m)
                break
            master_plan(F, I, S, m)
            if I[i + MSI_HOLD] == FEEDHOLDING:
                master_hold(F, I, S, m)
            continue
        if I[i + MSI_SEEK_PHASE] != SEEK_NONE and seek_end(F, I, S, m):
            continue
        if I[i + MSI_HSINT_PHASE] != HSINT_NONE and hsint_end(F, I, S, m):
            continue
        if I[i + MSI_CUT]:
            cut_end(F, I, m)
            while I[i + MSI_STRETCH] > 1:  # what the path was planned through goes with it
                move_end(F, I, S, m)
                F[MSF_BASE + m * MSF_STRIDE + MSF_ORIGIN_U] = F[
                    PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE
                ]  # nothing of it has been gone
                I[i + MSI_STRETCH] -= 1
        move_end(F, I, S, m)
        if not I[i + MSI_QUEUED]:
            break
    if not I[i + MSI_QUEUED]:
        if I[i + MSI_HOLD] == FEEDHOLDING:
            master_at_rest(F, I, S, m)
        master_idle(F, I, S, m)
    else:
        master_show(F, I, S, m)


def master_short_of_target(F: F64, I: I32, m: int) -> bool:
    """True when a hold has stopped the path before the target of the move."""
    return (
        I[MSI_BASE + m * MSI_STRIDE + MSI_HOLD] == FEEDHOLDING
        and F[PRF_BASE + m * PRF_STRIDE + PRF_END_DISTANCE]
        < F[MSF_BASE + m * MSF_STRIDE + MSF_STRETCH_U]
    )


def master_follow(F: F64, I: I32, S: F32, m: int) -> None:
    """Replan when the wanted speed has changed (override, limit) or a seek has captured."""
    if I[MSI_BASE + m * MSI_STRIDE + MSI_SEEK_PHASE] == SEEK_SEARCHING:
        seek_step(F, I, S, m)
        if I[MSI_BASE + m * MSI_STRIDE + MSI_SEEK_PHASE] == SEEK_STOPPING:
            return
    if I[MSI_BASE + m * MSI_STRIDE + MSI_HSINT_PHASE] != HSINT_NONE:
        hsint_step(F, I, S, m)
    if I[MQI_BASE + move_record(I, m) * MQI_STRIDE + MQI_INTERRUPT]:
        interrupt_step(F, I, S, m)
    word: int = master_word(m)
    dirty: bool = I[MSI_BASE + m * MSI_STRIDE + MSI_LOOK_DIRTY] != 0
    if dirty and not I[MSI_BASE + m * MSI_STRIDE + MSI_CUT]:
        look_refresh(F, I, S, m)
    if not ends_early(I, m) and (
        master_limit(F, I, S, m) != F[PRF_BASE + m * PRF_STRIDE + PRF_TARGET_VELOCITY]
        or I[MSI_BASE + m * MSI_STRIDE + MSI_FINAL_ZERO] != I[word] & MF1_FVEL_ZERO_ACTIVE
    ):
        master_plan(F, I, S, m)


def master_idle(F: F64, I: I32, S: F32, m: int) -> None:
    """All moves have arrived: motion flags clear in the tick of the final positions."""
    word: int = master_word(m)
    moving: int = 0
    if I[CPI_BASE + m * CPI_STRIDE + CPI_OPEN]:  # a curve waits for its next points
        moving = I[word] & MF1_IN_MOTION
    I[word] &= ~(
        MF1_IN_MOTION
        | MF1_MOVE_BUFFERED
        | MF1_ACCELERATING
        | MF1_DECELERATING
        | MF1_STOPPING
        | MF1_JERKING
    )
    I[word] |= moving
    profile_reset(F, I, m, 0.0, 0.0)
    if I[MSI_BASE + m * MSI_STRIDE + MSI_ROUNDING]:
        I[MSI_BASE + m * MSI_STRIDE + MSI_ROUNDING] = 0
        corner_drop(F, I, m)
    p: int = MA_BASE + m * MA_STRIDE
    S[p + MA_DISTANCE_INTO_MOVE] = S[p + MA_VECTOR_LENGTH]
    S[p + MA_DISTANCE_INTO_PATH] = F[MSF_BASE + m * MSF_STRIDE + MSF_TRAVEL_U]
    S[p + MA_DISTANCE_TO_GO] = 0.0
    S[p + MA_FRACTION_INTO_MOVE] = 1.0
    master_settle(F, I, S, m)
