"""What stops an axis: kill requests, hardware limits, software limits.

A stop hands the whole command velocity of the axis to its jog profiler, which ramps it
down (HLDEC for kills and hardware limits, SLDEC for software limits; 0 stops at once).
Axes on the same master stop together, each at its own rate. An end-of-travel limit acts
only on motion into it, so that an axis can always be driven off a switch; it bars a
direction while it is active (`limit_bars`). That it was met is recorded in a flag.
"""

from openacr.kernel.axis_cy import axis_scale, axis_word, hard_limit_active, soft_limit_crossed
from openacr.kernel.drive_cy import drive_disable
from openacr.kernel.hold_cy import master_drop
from openacr.kernel.homing_cy import HARD_LIMIT_HIT, SOFT_LIMIT_HIT
from openacr.kernel.jog_cy import JOG_HOMING, JOG_KILLED, jog_take_over
from openacr.kernel.offset_cy import followers_halt, lock_leader
from openacr.kernel.path_cy import master_word
from openacr.map.numbers import (
    AF1_CAM_ACTIVATE,
    AF1_GEAR_ACTIVATE,
    AF1_GEAR_ACTIVE,
    AF4_DISABLE_DRIVE_ON_KILL,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AF5_NEGATIVE_HARDWARE_LIMIT_ENABLE,
    AF5_NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED,
    AF5_NEGATIVE_SOFTWARE_LIMIT_ENABLE,
    AF5_NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED,
    AF5_POSITIVE_HARDWARE_LIMIT_ENABLE,
    AF5_POSITIVE_HARDWARE_LIMIT_ENCOUNTERED,
    AF5_POSITIVE_SOFTWARE_LIMIT_ENABLE,
    AF5_POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED,
    AF5_WORD,
    AXF_BASE,
    AXF_HLDEC_UPS2,
    AXF_PSP_VELOCITY_CPS,
    AXF_SLDEC_UPS2,
    AXF_STRIDE,
    AXI_BASE,
    AXI_HLBIT,
    AXI_HOME_LIMIT_HIT,
    AXI_HOME_MOVING,
    AXI_JOG_MODE,
    AXI_KAMR_OLD,
    AXI_MASTER,
    AXI_STRIDE,
    FLI_BASE,
    FLI_ON,
    FLI_STRIDE,
    MF1_KILL_ALL_MOVES_REQUEST,
    MSI_BASE,
    MSI_MOVING,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["limits_step"]

SLAVE_COUNT = 16
THREE_INPUTS = 7
FLAG_WORDS = 4096
LAST_FLAG = 17663
PREVIOUS_SHIFT = 8
INVERT_SHIFT = 16
FOLLOWING = AF1_GEAR_ACTIVE | AF1_GEAR_ACTIVATE | AF1_CAM_ACTIVATE
WATCHED = (
    AF5_POSITIVE_HARDWARE_LIMIT_ENABLE
    | AF5_NEGATIVE_HARDWARE_LIMIT_ENABLE
    | AF5_POSITIVE_SOFTWARE_LIMIT_ENABLE
    | AF5_NEGATIVE_SOFTWARE_LIMIT_ENABLE
    | AF5_POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED
    | AF5_NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
)


def limit_inputs(I: I32, n: int) -> int:
    """Refresh positive limit, negative limit and home state of axis n; return its flags.

    The three inputs follow HLBIT within one 32-bit word; those beyond it do not exist and
    read 0, level invert or not.
    """
    word: int = AF5_WORD + n
    flags: int = I[word]
    first: int = I[AXI_BASE + n * AXI_STRIDE + AXI_HLBIT]
    state: int = 0
    if 0 <= first <= LAST_FLAG:
        bit: int = first & 31
        inputs: int = I[FLAG_WORDS + (first >> 5)] & 4294967295
        state = (
            ((inputs >> bit) ^ (flags >> INVERT_SHIFT)) & THREE_INPUTS & ((4294967296 >> bit) - 1)
        )
    previous: int = (flags & THREE_INPUTS) << PREVIOUS_SHIFT
    flags = (flags & ~(THREE_INPUTS | (THREE_INPUTS << PREVIOUS_SHIFT))) | state | previous
    I[word] = flags
    return flags


def axis_halt(F: F64, I: I32, S: F32, n: int, rate_ups2: float) -> None:
    """Stop every profiler of axis n; the jog profiler ramps the axis to rest."""
    if lock_leader(I, n) >= 0:  # a locked axis stops with its leader, which it follows
        return
    followers_halt(F, I, n)
    jog_take_over(F, I, S, n, rate_ups2)


def axis_kill(F: F64, I: I32, S: F32, n: int) -> None:
    """Serve a new kill request of axis n: this axis and all others of its master stop."""
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if m < 0:
        axis_kill_one(F, I, S, n)
        return
    for s in range(SLAVE_COUNT):
        other: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        if other >= 0:
            axis_kill_one(F, I, S, other)
    I[master_word(m)] |= MF1_KILL_ALL_MOVES_REQUEST
    master_drop(F, I, S, m)


def axis_kill_one(F: F64, I: I32, S: F32, n: int) -> None:
    """Stop one axis for a kill, unless it has been stopped for one already."""
    i: int = AXI_BASE + n * AXI_STRIDE
    I[AF4_WORD + n] |= AF4_KILL_ALL_MOTION_REQUEST
    if not I[i + AXI_KAMR_OLD]:
        I[i + AXI_KAMR_OLD] = 1
        axis_halt(F, I, S, n, F[AXF_BASE + n * AXF_STRIDE + AXF_HLDEC_UPS2])
        if lock_leader(I, n) >= 0:
            axis_kill(F, I, S, lock_leader(I, n))
    if I[AF4_WORD + n] & AF4_DISABLE_DRIVE_ON_KILL:
        drive_disable(I, n)


def hard_limits(F: F64, I: I32, S: F32, n: int, flags: int, velocity: float) -> None:
    """Trip an enabled hardware limit that is active while the axis moves into it."""
    if velocity == 0.0 or not hard_limit_active(flags, 1 if velocity > 0.0 else -1):
        return
    hit: int = AF5_POSITIVE_HARDWARE_LIMIT_ENCOUNTERED
    if velocity < 0.0:
        hit = AF5_NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED
    i: int = AXI_BASE + n * AXI_STRIDE
    if I[i + AXI_JOG_MODE] == JOG_HOMING:
        home_limit_hit(I, n, HARD_LIMIT_HIT, velocity)
    else:
        I[AF5_WORD + n] |= hit
        axis_kill(F, I, S, n)


def home_limit_hit(I: I32, n: int, kind: int, velocity: float) -> None:
    """Tell the homing sequence of axis n about a limit.

    In the tick in which a search turns round the axis has still moved into the limit.
    """
    i: int = AXI_BASE + n * AXI_STRIDE
    if velocity * I[i + AXI_HOME_MOVING] > 0.0:
        I[i + AXI_HOME_LIMIT_HIT] = kind


def soft_limit(F: F64, I: I32, S: F32, n: int, flags: int, side: int, velocity: float) -> None:
    """One software limit: stop the axes of the master at its crossing, record it while beyond.

    What the axis follows is stopped again if it leads farther out. A stop that is under way
    goes on as it is, so does a jog inwards that first has to turn round: jogs outwards are
    refused as long as the limit bars them.
    """
    word: int = AF5_WORD + n
    latch: int = AF5_POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED
    if side < 0:
        latch = AF5_NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
    if not soft_limit_crossed(F, S, n, flags, side):
        I[word] &= ~latch
    elif not side * velocity > 0.0:
        return
    elif I[AXI_BASE + n * AXI_STRIDE + AXI_JOG_MODE] == JOG_HOMING:
        home_limit_hit(I, n, SOFT_LIMIT_HIT, velocity)
    else:
        leads: int = lock_leader(I, n)  # a locked axis is moved and stopped by its leader
        if leads < 0:
            leads = n
        crossed: bool = I[word] & latch == 0
        I[word] |= latch
        if I[AXI_BASE + leads * AXI_STRIDE + AXI_JOG_MODE] == JOG_KILLED:
            return
        if crossed or followed(I, leads):
            soft_stop(F, I, S, n)


def followed(I: I32, n: int) -> bool:
    """Whether axis n follows a source or a path."""
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if m >= 0 and I[MSI_BASE + m * MSI_STRIDE + MSI_MOVING]:
        return True
    return I[axis_word(n)] & FOLLOWING != 0 or I[FLI_BASE + n * FLI_STRIDE + FLI_ON] != 0


def soft_stop(F: F64, I: I32, S: F32, n: int) -> None:
    """Ramp axis n and the others of its master down with their SLDEC; no kill of axes."""
    if lock_leader(I, n) >= 0:
        soft_stop(F, I, S, lock_leader(I, n))
        return
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if m < 0:
        axis_halt(F, I, S, n, F[AXF_BASE + n * AXF_STRIDE + AXF_SLDEC_UPS2])
        return
    for s in range(SLAVE_COUNT):
        other: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        if other >= 0:
            axis_halt(F, I, S, other, F[AXF_BASE + other * AXF_STRIDE + AXF_SLDEC_UPS2])
    I[master_word(m)] |= MF1_KILL_ALL_MOVES_REQUEST
    master_drop(F, I, S, m)


def limits_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Limits and kill request of axis n for this tick."""
    i: int = AXI_BASE + n * AXI_STRIDE
    flags: int = limit_inputs(I, n)
    if I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST:
        if not I[i + AXI_KAMR_OLD]:
            axis_kill(F, I, S, n)
    else:
        I[i + AXI_KAMR_OLD] = 0
    if not flags & WATCHED:
        return
    velocity: float = F[AXF_BASE + n * AXF_STRIDE + AXF_PSP_VELOCITY_CPS]
    if axis_scale(S, n) < 0.0:
        velocity = -velocity
    if not I[AF4_WORD + n] & AF4_KILL_ALL_MOTION_REQUEST:
        hard_limits(F, I, S, n, flags, velocity)
    soft_limit(F, I, S, n, flags, 1, velocity)
    soft_limit(F, I, S, n, flags, -1, velocity)
