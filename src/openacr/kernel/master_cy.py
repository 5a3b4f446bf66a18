"""Coordinated moves: one path profile per master, its slaves at start + fraction of the way.

A master owns a ring of moves. The move at the head is the present one; those behind it
wait. Each tick the profile of the master advances along the vector of the present move and
every slave that takes part stands at

    target - delta * (1 - s/L),

which is exactly the target at s = L. Time left over at the end of a move goes into the
next one, so a chain of moves loses nothing to the tick grid.

The slow side writes records and counts (motion/moves.py); everything else happens here.
"""

from openacr.cmath import fabs, sqrt
from openacr.kernel.axis_cy import axis_preload, axis_scale, axis_word
from openacr.kernel.capture_cy import capture_arm, encoder_shift
from openacr.kernel.profile_cy import (
    ACCELERATING,
    DECELERATING,
    STOPPING,
    profile_advance,
    profile_plan,
    profile_reset,
    profile_stop,
)
from openacr.map.numbers import (
    AF1_CAPTURE_COMPLETE,
    AX_BASE,
    AX_COUNT,
    AX_MAX_VELOCITY_LIMIT,
    AX_STRIDE,
    AXF_BASE,
    AXF_CAPTURE_CNT,
    AXF_POSITION_CNT,
    AXF_SSP_CNT,
    AXF_STRIDE,
    AXF_TARGET_CNT,
    MA_BASE,
    MA_DISTANCE_INTO_MOVE,
    MA_DISTANCE_INTO_PATH,
    MA_DISTANCE_SQUARED,
    MA_DISTANCE_TO_GO,
    MA_FEEDRATE_OVERRIDE,
    MA_FRACTION_INTO_MOVE,
    MA_MANUAL_VECTOR,
    MA_MBUF_FILLED,
    MA_MOVE_COUNTER,
    MA_RAPID_FEEDRATE_OVERRIDE,
    MA_STRIDE,
    MA_TARGET_ACCELERATION,
    MA_TARGET_VELOCITY,
    MA_TOTAL_DISTANCE,
    MA_USER_VELOCITY,
    MA_VECTOR_ACCELERATION,
    MA_VECTOR_JERK,
    MA_VECTOR_LENGTH,
    MA_VECTOR_VELOCITY,
    MA_VEL_LIMIT,
    MA_VELOCITY_SQUARED,
    MF1_ACCELERATING,
    MF1_DECELERATING,
    MF1_DECREMENT_COUNT,
    MF1_FEEDHOLDING,
    MF1_FOV_ROV_LOCK_ACTIVE,
    MF1_FOV_ROV_LOCK_PENDING,
    MF1_FVEL_ZERO_ACTIVE,
    MF1_FVEL_ZERO_PENDING,
    MF1_IN_FEEDHOLD,
    MF1_IN_MOTION,
    MF1_INCREMENT_COUNT,
    MF1_JERKING,
    MF1_KILL_ALL_MOVES_REQUEST,
    MF1_MOVE_BUFFERED,
    MF1_START_MOVE_INHIBIT,
    MF1_STOP_ALL_MOVES_REQUEST,
    MF1_STOPPING,
    MF1_WORD,
    MF1_WORD_HIGH,
    MF2_BLOCK_SKIP_CHECK,
    MF2_BLOCK_SKIP_INPUT,
    MF2_ENABLE_CLEAR_REQUEST,
    MF2_RAPID_ACTIVE,
    MF2_RAPID_PENDING,
    MF2_SLAVEMAXVEL,
    MF2_WORD,
    MF2_WORD_HIGH,
    MQF_ACC_UPS2,
    MQF_BASE,
    MQF_DEC_UPS2,
    MQF_DELTA_CNT,
    MQF_FVEL_UPS,
    MQF_IVEL_UPS,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_MAXVEL_UPS,
    MQF_STP_UPS2,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQF_VEL_UPS,
    MQF_WEIGHT,
    MQI_BASE,
    MQI_RAPID,
    MQI_RELATIVE,
    MQI_SEEK_AXIS,
    MQI_SEEK_MODE,
    MQI_SLAVES,
    MQI_STRIDE,
    MSF_BASE,
    MSF_STRIDE,
    MSF_TARGET_CNT,
    MSI_BASE,
    MSI_DROP_AT_REST,
    MSI_HEAD,
    MSI_HOLD,
    MSI_MOVING,
    MSI_QUEUED,
    MSI_SEEK_PHASE,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
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

__all__ = ["master_drop", "master_hold", "master_release", "master_step"]

RING = 16  # moves per master (map/hidden/motion.py)
SLAVE_COUNT = 16
MOVES_PER_TICK = 8  # a chain of shorter moves than a tick still ends

NOT_HELD = 0
FEEDHOLDING = 1
IN_FEEDHOLD = 2

SEEK_NONE = 0
SEEK_SEARCHING = 1
SEEK_STOPPING = 2
SEEK_RETURNING = 3


def master_word(m: int) -> int:
    """Parameter number of the flag word of master m."""
    return MF1_WORD + m if m < 8 else MF1_WORD_HIGH + m


def master_word2(m: int) -> int:
    """Parameter number of the secondary flag word of master m."""
    return MF2_WORD + m if m < 8 else MF2_WORD_HIGH + m


def move_record(I: I32, m: int) -> int:
    """Index of the record of the present move of master m."""
    return m * RING + I[MSI_BASE + m * MSI_STRIDE + MSI_HEAD]


def master_limit(F: F64, I: I32, S: F32, m: int) -> float:
    """Cruising speed wanted now [units/s]: the move's own under override and limits."""
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    p: int = MA_BASE + m * MA_STRIDE
    velocity: float = F[q + MQF_VEL_UPS]
    if velocity <= 0.0:  # accepted while VEL was 0: takes over the first VEL above it
        velocity = S[p + MA_USER_VELOCITY]
        F[q + MQF_VEL_UPS] = velocity
    if not I[master_word(m)] & MF1_FOV_ROV_LOCK_ACTIVE:
        if I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID]:
            velocity *= S[p + MA_RAPID_FEEDRATE_OVERRIDE]
        else:
            velocity *= S[p + MA_FEEDRATE_OVERRIDE]
    if S[p + MA_VEL_LIMIT] > 0.0:
        velocity = min(velocity, S[p + MA_VEL_LIMIT])
    if F[q + MQF_MAXVEL_UPS] > 0.0:
        velocity = min(velocity, F[q + MQF_MAXVEL_UPS])
    return max(velocity, 0.0)


def master_plan(F: F64, I: I32, S: F32, m: int) -> None:
    """Plan the present move of master m from where it is."""
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    final: float = F[q + MQF_FVEL_UPS]
    if I[master_word(m)] & MF1_FVEL_ZERO_ACTIVE:
        final = 0.0
    profile_plan(
        F,
        I,
        m,
        F[q + MQF_LENGTH_U],
        master_limit(F, I, S, m),
        final,
        F[q + MQF_ACC_UPS2],
        F[q + MQF_DEC_UPS2],
        F[q + MQF_STP_UPS2],
        F[q + MQF_JRK_UPS3],
    )


def move_geometry(F: F64, I: I32, S: F32, m: int) -> None:
    """Vector length and axis limits of the present move from where the axes are.

    L = sqrt(sum (w d)^2) over the moving slaves; without any weight the manual vector,
    without that the longest single displacement, so that no displacement is a jump.
    """
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    relative: int = I[MQI_BASE + record * MQI_STRIDE + MQI_RELATIVE]
    square: float = 0.0
    longest: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            position: float = F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT]
            if relative & (1 << s):
                F[q + MQF_TARGET_CNT + s] = position + F[q + MQF_DELTA_CNT + s]
            else:
                F[q + MQF_DELTA_CNT + s] = F[q + MQF_TARGET_CNT + s] - position
            F[AXF_BASE + axis * AXF_STRIDE + AXF_TARGET_CNT] = F[q + MQF_TARGET_CNT + s]
            travel: float = fabs(F[q + MQF_DELTA_CNT + s]) / fabs(axis_scale(S, axis))
            square += F[q + MQF_WEIGHT + s] * F[q + MQF_WEIGHT + s] * travel * travel
            longest = max(longest, travel)
    length: float = sqrt(square)
    if length <= 0.0 and longest > 0.0:
        length = S[MA_BASE + m * MA_STRIDE + MA_MANUAL_VECTOR]
        if length <= 0.0:
            length = longest
    F[q + MQF_LENGTH_U] = length
    F[q + MQF_MAXVEL_UPS] = 0.0
    if I[master_word2(m)] & MF2_SLAVEMAXVEL:
        move_maxvel(F, I, S, m, q, slaves)


def move_maxvel(F: F64, I: I32, S: F32, m: int, q: int, slaves: int) -> None:
    """Bound of the path speed by MAXVEL of the axes: the least v_i L/|d_i|."""
    i: int = MSI_BASE + m * MSI_STRIDE
    bound: float = 0.0
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if slaves & (1 << s) and axis >= 0:
            limit: float = S[AX_BASE + axis * AX_STRIDE + AX_MAX_VELOCITY_LIMIT]
            travel: float = fabs(F[q + MQF_DELTA_CNT + s]) / fabs(axis_scale(S, axis))
            if limit > 0.0 and travel > 0.0:
                speed: float = limit * F[q + MQF_LENGTH_U] / travel
                if bound <= 0.0 or speed < bound:
                    bound = speed
    F[q + MQF_MAXVEL_UPS] = bound


def move_begin(F: F64, I: I32, S: F32, m: int, velocity: float, accel: float) -> None:
    """Make the record at the head the present move, entered with the given speed."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    word: int = master_word(m)
    word2: int = master_word2(m)
    move_flags(I, S, m, record)
    move_geometry(F, I, S, m)
    I[i + MSI_MOVING] = 1
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
        S[MA_BASE + m * MA_STRIDE + MA_DISTANCE_INTO_PATH] = 0.0
    I[word] |= MF1_IN_MOTION
    profile_reset(F, I, m, velocity, accel)
    master_plan(F, I, S, m)


def move_flags(I: I32, S: F32, m: int, record: int) -> None:
    """What the start of a move does to flags: pending to active, move counter."""
    word: int = master_word(m)
    word2: int = master_word2(m)
    flags: int = I[word] & ~(MF1_FVEL_ZERO_ACTIVE | MF1_FOV_ROV_LOCK_ACTIVE)
    if flags & MF1_FVEL_ZERO_PENDING:
        flags |= MF1_FVEL_ZERO_ACTIVE
    if flags & MF1_FOV_ROV_LOCK_PENDING:
        flags |= MF1_FOV_ROV_LOCK_ACTIVE
    I[word] = flags
    if I[word2] & MF2_RAPID_PENDING:
        I[MQI_BASE + record * MQI_STRIDE + MQI_RAPID] = 1
    counter: int = MA_BASE + m * MA_STRIDE + MA_MOVE_COUNTER
    if flags & MF1_INCREMENT_COUNT and I[counter] < 2147483647:
        I[counter] += 1
    if flags & MF1_DECREMENT_COUNT and I[counter] > -2147483647:
        I[counter] -= 1


def move_skipped(I: I32, m: int) -> bool:
    """Block skip: with Check and Input set the next move is dropped; Check clears."""
    word2: int = master_word2(m)
    flags: int = I[word2]
    if not flags & MF2_BLOCK_SKIP_CHECK:
        return False
    I[word2] = flags & ~MF2_BLOCK_SKIP_CHECK
    return flags & MF2_BLOCK_SKIP_INPUT != 0


def move_pop(I: I32, m: int) -> None:
    """Remove the record at the head of the ring."""
    i: int = MSI_BASE + m * MSI_STRIDE
    head: int = I[i + MSI_HEAD] + 1
    I[i + MSI_HEAD] = 0 if head >= RING else head
    I[i + MSI_QUEUED] -= 1
    I[i + MSI_MOVING] = 0


def master_drop(F: F64, I: I32, S: F32, m: int) -> None:
    """Drop the present move and all that wait; the axes stay where they are commanded."""
    i: int = MSI_BASE + m * MSI_STRIDE
    I[i + MSI_QUEUED] = 0
    I[i + MSI_MOVING] = 0
    I[i + MSI_HOLD] = NOT_HELD
    I[i + MSI_DROP_AT_REST] = 0
    I[i + MSI_SEEK_PHASE] = SEEK_NONE
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
    )


def master_settle(F: F64, I: I32, S: F32, m: int) -> None:
    """At rest the target of every slave is its current position; shown values clear."""
    i: int = MSI_BASE + m * MSI_STRIDE
    for s in range(SLAVE_COUNT):
        axis: int = I[i + MSI_SLAVE_AXIS + s]
        if axis >= 0:
            a: int = AXF_BASE + axis * AXF_STRIDE
            F[a + AXF_TARGET_CNT] = F[a + AXF_POSITION_CNT]
            F[MSF_BASE + m * MSF_STRIDE + MSF_TARGET_CNT + s] = F[a + AXF_POSITION_CNT]
    p: int = MA_BASE + m * MA_STRIDE
    S[p + MA_VECTOR_VELOCITY] = 0.0
    S[p + MA_VECTOR_ACCELERATION] = 0.0
    S[p + MA_VECTOR_JERK] = 0.0
    S[p + MA_VELOCITY_SQUARED] = 0.0
    I[p + MA_MBUF_FILLED] = 0


def master_hold(F: F64, I: I32, S: F32, m: int) -> None:
    """Slow the path to rest with DEC (STP if DEC is 0); the move itself stays loaded.

    Where the end ramp of the move is already running, or the ramp would pass a target at
    which the path stops anyway, the move simply ends at its target.
    """
    i: int = MSI_BASE + m * MSI_STRIDE
    I[i + MSI_HOLD] = FEEDHOLDING
    I[master_word(m)] |= MF1_FEEDHOLDING
    if not I[i + MSI_MOVING]:
        return
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    if I[PRI_BASE + m * PRI_STRIDE + PRI_KIND] == STOPPING:
        return
    rate: float = F[q + MQF_DEC_UPS2]
    if rate <= 0.0:
        rate = F[q + MQF_STP_UPS2]
    end: float = F[q + MQF_LENGTH_U]
    jerk: float = F[q + MQF_JRK_UPS3]
    merged: bool = F[q + MQF_STP_UPS2] <= 0.0 and I[i + MSI_QUEUED] > 1
    if not profile_stop(F, I, m, end, rate, jerk, DECELERATING) and not merged:
        stp: float = F[q + MQF_STP_UPS2]
        if stp <= 0.0:
            stp = rate
        limit: float = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
        profile_plan(F, I, m, end, limit, 0.0, rate, rate, stp, jerk)


def master_release(F: F64, I: I32, S: F32, m: int) -> None:
    """End a feedhold: the path speeds up again (Cycle Start)."""
    i: int = MSI_BASE + m * MSI_STRIDE
    I[i + MSI_HOLD] = NOT_HELD
    I[i + MSI_DROP_AT_REST] = 0
    I[master_word(m)] &= ~(MF1_FEEDHOLDING | MF1_IN_FEEDHOLD)
    if I[i + MSI_MOVING]:
        master_plan(F, I, S, m)


def master_at_rest(F: F64, I: I32, S: F32, m: int) -> None:
    """A feedhold has come to rest: note it, and finish what it was the first step of."""
    i: int = MSI_BASE + m * MSI_STRIDE
    word: int = master_word(m)
    I[i + MSI_HOLD] = IN_FEEDHOLD
    I[word] = (I[word] & ~MF1_FEEDHOLDING) | MF1_IN_FEEDHOLD
    if I[word] & MF1_STOP_ALL_MOVES_REQUEST:
        I[word] = (I[word] & ~MF1_STOP_ALL_MOVES_REQUEST) | MF1_KILL_ALL_MOVES_REQUEST
        master_drop(F, I, S, m)
    elif I[i + MSI_DROP_AT_REST]:
        master_drop(F, I, S, m)


def master_place(F: F64, I: I32, m: int) -> None:
    """Put the slaves of the present move where the path is."""
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    i: int = MSI_BASE + m * MSI_STRIDE
    slaves: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SLAVES]
    length: float = F[q + MQF_LENGTH_U]
    rest: float = 0.0
    if length > 0.0:
        rest = 1.0 - F[PRF_BASE + m * PRF_STRIDE + PRF_DISTANCE] / length
    s: int = 0
    while slaves:
        if slaves & 1:
            axis: int = I[i + MSI_SLAVE_AXIS + s]
            if 0 <= axis < AX_COUNT:
                F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT] = (
                    F[q + MQF_TARGET_CNT + s] - F[q + MQF_DELTA_CNT + s] * rest
                )
        slaves = slaves >> 1
        s += 1


def master_show(F: F64, I: I32, S: F32, m: int) -> None:
    """Publish the state of the path in the parameters and flags of the master."""
    f: int = PRF_BASE + m * PRF_STRIDE
    p: int = MA_BASE + m * MA_STRIDE
    q: int = MQF_BASE + move_record(I, m) * MQF_STRIDE
    length: float = F[q + MQF_LENGTH_U]
    distance: float = F[f + PRF_DISTANCE]
    velocity: float = F[f + PRF_VELOCITY]
    S[p + MA_DISTANCE_INTO_MOVE] = distance
    S[p + MA_VECTOR_VELOCITY] = velocity
    S[p + MA_VECTOR_ACCELERATION] = F[f + PRF_ACCEL]
    S[p + MA_VECTOR_JERK] = F[f + PRF_JERK]
    S[p + MA_VECTOR_LENGTH] = length
    S[p + MA_TARGET_VELOCITY] = F[f + PRF_TARGET_VELOCITY]
    S[p + MA_DISTANCE_TO_GO] = length - distance
    S[p + MA_DISTANCE_SQUARED] = length * length
    S[p + MA_VELOCITY_SQUARED] = velocity * velocity
    S[p + MA_FRACTION_INTO_MOVE] = distance / length if length > 0.0 else 1.0
    kind: int = I[PRI_BASE + m * PRI_STRIDE + PRI_KIND]
    word: int = master_word(m)
    flags: int = I[word] & ~(
        MF1_ACCELERATING | MF1_DECELERATING | MF1_STOPPING | MF1_JERKING | MF1_MOVE_BUFFERED
    )
    target: float = 0.0
    if kind == ACCELERATING:
        flags |= MF1_ACCELERATING
        target = F[q + MQF_ACC_UPS2]
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


def move_end(F: F64, I: I32, S: F32, m: int) -> None:
    """The present move has arrived: count its length into the totals and remove it."""
    p: int = MA_BASE + m * MA_STRIDE
    length: float = F[MQF_BASE + move_record(I, m) * MQF_STRIDE + MQF_LENGTH_U]
    S[p + MA_DISTANCE_INTO_PATH] = S[p + MA_DISTANCE_INTO_PATH] + length
    S[p + MA_TOTAL_DISTANCE] = S[p + MA_TOTAL_DISTANCE] + length
    move_pop(I, m)


def seek_step(F: F64, I: I32, S: F32, m: int) -> None:
    """MSEEK in search: at the capture, slow down with STP (DEC if that is 0)."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    axis: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SEEK_AXIS] - 1
    if I[axis_word(axis)] & AF1_CAPTURE_COMPLETE:
        q: int = MQF_BASE + record * MQF_STRIDE
        rate: float = F[q + MQF_STP_UPS2]
        if rate <= 0.0:
            rate = F[q + MQF_DEC_UPS2]
        I[i + MSI_SEEK_PHASE] = SEEK_STOPPING
        jerk: float = F[q + MQF_JRK_UPS3]
        profile_stop(F, I, m, F[q + MQF_LENGTH_U], rate, jerk, STOPPING)


def seek_end(F: F64, I: I32, S: F32, m: int) -> bool:
    """An MSEEK path has come to rest; True while it still has to go back to the capture."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    q: int = MQF_BASE + record * MQF_STRIDE
    phase: int = I[i + MSI_SEEK_PHASE]
    axis: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SEEK_AXIS] - 1
    a: int = AXF_BASE + axis * AXF_STRIDE
    if phase == SEEK_STOPPING:
        # Jog, gear and cam offsets take part in the captured actual position.
        for s in range(SLAVE_COUNT):
            if I[i + MSI_SLAVE_AXIS + s] == axis:
                offsets: float = F[a + AXF_SSP_CNT] - F[a + AXF_POSITION_CNT]
                F[q + MQF_TARGET_CNT + s] = F[a + AXF_CAPTURE_CNT] - offsets
                I[MQI_BASE + record * MQI_STRIDE + MQI_RELATIVE] = 0
        move_geometry(F, I, S, m)
        I[i + MSI_SEEK_PHASE] = SEEK_RETURNING
        profile_reset(F, I, m, 0.0, 0.0)
        master_plan(F, I, S, m)
        return True
    if phase == SEEK_RETURNING:
        encoder_shift(F, I, S, axis, int(F[a + AXF_CAPTURE_CNT]))
        axis_preload(F, I, axis, 0.0)
    elif phase == SEEK_SEARCHING:
        capture_arm(F, I, axis, -1)
    I[i + MSI_SEEK_PHASE] = SEEK_NONE
    return False


def master_step(F: F64, I: I32, S: F32, m: int, dt: float) -> None:
    """Advance master m by one servo period of `dt` seconds of path time."""
    i: int = MSI_BASE + m * MSI_STRIDE
    word: int = master_word(m)
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
    left: float = dt
    velocity: float = 0.0
    accel: float = 0.0
    for _ in range(MOVES_PER_TICK):
        if not I[i + MSI_MOVING]:
            if I[i + MSI_HOLD] == FEEDHOLDING and velocity <= 0.0:
                master_at_rest(F, I, S, m)
                break
            if I[word] & MF1_START_MOVE_INHIBIT:
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
        left = profile_advance(F, I, m, left)
        master_place(F, I, m)
        if left < 0.0:
            break
        velocity = F[PRF_BASE + m * PRF_STRIDE + PRF_VELOCITY]
        accel = F[PRF_BASE + m * PRF_STRIDE + PRF_ACCEL]
        if I[i + MSI_SEEK_PHASE] != SEEK_NONE:
            if seek_end(F, I, S, m):
                continue
        elif master_short_of_target(F, I, m):
            master_at_rest(F, I, S, m)
            break
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
    length: float = F[MQF_BASE + move_record(I, m) * MQF_STRIDE + MQF_LENGTH_U]
    return (
        I[MSI_BASE + m * MSI_STRIDE + MSI_HOLD] == FEEDHOLDING
        and F[PRF_BASE + m * PRF_STRIDE + PRF_END_DISTANCE] < length
    )


def master_follow(F: F64, I: I32, S: F32, m: int) -> None:
    """Replan when the wanted speed has changed (override, limit) or a seek has captured."""
    if I[MSI_BASE + m * MSI_STRIDE + MSI_SEEK_PHASE] == SEEK_SEARCHING:
        seek_step(F, I, S, m)
        if I[MSI_BASE + m * MSI_STRIDE + MSI_SEEK_PHASE] == SEEK_STOPPING:
            return
    if (
        I[PRI_BASE + m * PRI_STRIDE + PRI_KIND] != STOPPING
        and I[MSI_BASE + m * MSI_STRIDE + MSI_SEEK_PHASE] != SEEK_STOPPING
        and master_limit(F, I, S, m) != F[PRF_BASE + m * PRF_STRIDE + PRF_TARGET_VELOCITY]
    ):
        master_plan(F, I, S, m)


def master_idle(F: F64, I: I32, S: F32, m: int) -> None:
    """All moves have arrived: motion flags clear in the tick of the final positions."""
    word: int = master_word(m)
    I[word] &= ~(
        MF1_IN_MOTION
        | MF1_MOVE_BUFFERED
        | MF1_ACCELERATING
        | MF1_DECELERATING
        | MF1_STOPPING
        | MF1_JERKING
    )
    profile_reset(F, I, m, 0.0, 0.0)
    p: int = MA_BASE + m * MA_STRIDE
    S[p + MA_DISTANCE_INTO_MOVE] = S[p + MA_VECTOR_LENGTH]
    S[p + MA_DISTANCE_TO_GO] = 0.0
    S[p + MA_FRACTION_INTO_MOVE] = 1.0
    master_settle(F, I, S, m)
