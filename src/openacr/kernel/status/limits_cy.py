"""What stops an axis: kill requests, hardware limits, software limits.

A stop hands the whole command velocity of the axis to its jog profiler, which ramps it
down (HLDEC for kills and hardware limits, SLDEC for software limits; 0 stops at once).
Axes on the same master stop together, each at its own rate. An end-of-travel limit acts
only on motion into it, so that an axis can always be driven off a switch; it bars a
direction while it is active (`limit_bars`). That it was met is recorded in a flag.
"""

from openacr.kernel.axis.axis_cy import (
    LIMITS_ENABLED,
    axis_scale,
    hard_limit_active,
    soft_limit_crossed,
)
from openacr.kernel.axis.drive_cy import drive_disable
from openacr.kernel.followers.offset_cy import followers_halt, lock_leader
from openacr.kernel.jog.homing_cy import HARD_LIMIT_HIT, SOFT_LIMIT_HIT
from openacr.kernel.jog.jog_cy import JOG_HOMING, JOG_KILLED, jog_take_over
from openacr.kernel.path.hold_cy import master_drop
from openacr.map.numbers import FLAG_WORD_BASE
from openacr.map.rows import axes, filters, masters
from openacr.map.words import af1, af4, af5, mf1
from openacr.views import F32, F64, I32

__all__ = ["limits_step"]
__inlined__ = ["limits_step"]

SLAVE_COUNT = 16
THREE_INPUTS = 7
LAST_WHOLE_BIT = 29  # from which three flags are in one word
LAST_FLAG = 17663
PREVIOUS_SHIFT = 8
INVERT_SHIFT = 16
FOLLOWING = af1.GEAR_ACTIVE | af1.GEAR_ACTIVATE | af1.CAM_ACTIVATE
WATCHED = (
    LIMITS_ENABLED
    | af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED
    | af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
)


def limit_inputs(I: I32, n: int) -> int:
    """Refresh positive limit, negative limit and home state of axis n; return its flags.

    The three inputs follow HLBIT within one 32-bit word; those beyond it do not exist and
    read 0, level invert or not.
    """
    word: int = af5.word[n]
    flags: int = I[word]
    first: int = I[axes.hlbit[n]]
    state: int = 0
    if 0 <= first <= LAST_FLAG:
        bit: int = first & 31
        inputs: int = I[FLAG_WORD_BASE + (first >> 5)]
        state = ((inputs >> bit) ^ (flags >> INVERT_SHIFT)) & THREE_INPUTS
        if bit > LAST_WHOLE_BIT:
            state = state & ((4294967296 >> bit) - 1)
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
    m: int = I[axes.master[n]]
    if m < 0:
        axis_kill_one(F, I, S, n)
        return
    for s in range(SLAVE_COUNT):
        other: int = I[masters.slave_axis[m] + s]
        if other >= 0:
            axis_kill_one(F, I, S, other)
    I[mf1.word[m]] |= mf1.KILL_ALL_MOVES_REQUEST
    master_drop(F, I, S, m)


def axis_kill_one(F: F64, I: I32, S: F32, n: int) -> None:
    """Stop one axis for a kill, unless it has been stopped for one already."""
    I[af4.word[n]] |= af4.KILL_ALL_MOTION_REQUEST
    if not I[axes.kamr_old[n]]:
        I[axes.kamr_old[n]] = 1
        axis_halt(F, I, S, n, F[axes.hldec_ups2[n]])
        if lock_leader(I, n) >= 0:
            axis_kill(F, I, S, lock_leader(I, n))
    if I[af4.word[n]] & af4.DISABLE_DRIVE_ON_KILL:
        drive_disable(I, n)


def hard_limits(F: F64, I: I32, S: F32, n: int, flags: int, velocity_cps: float) -> None:
    """Trip an enabled hardware limit that is active while the axis moves into it."""
    if velocity_cps == 0.0 or not hard_limit_active(flags, 1 if velocity_cps > 0.0 else -1):
        return
    hit: int = af5.POSITIVE_HARDWARE_LIMIT_ENCOUNTERED
    if velocity_cps < 0.0:
        hit = af5.NEGATIVE_HARDWARE_LIMIT_ENCOUNTERED
    if I[axes.jog_mode[n]] == JOG_HOMING:
        home_limit_hit(I, n, HARD_LIMIT_HIT, velocity_cps)
    else:
        I[af5.word[n]] |= hit
        axis_kill(F, I, S, n)


def home_limit_hit(I: I32, n: int, kind: int, velocity_cps: float) -> None:
    """Tell the homing sequence of axis n about a limit.

    In the tick in which a search turns round the axis has still moved into the limit.
    """
    if velocity_cps * I[axes.home_moving[n]] > 0.0:
        I[axes.home_limit_hit[n]] = kind


def soft_limit(F: F64, I: I32, S: F32, n: int, flags: int, side: int, velocity_cps: float) -> None:
    """One software limit: stop the axes of the master at its crossing, record it while beyond.

    What the axis follows is stopped again if it leads farther out. A stop that is under way
    goes on as it is, so does a jog inwards that first has to turn round: jogs outwards are
    refused as long as the limit bars them.
    """
    word: int = af5.word[n]
    latch: int = af5.POSITIVE_SOFTWARE_LIMIT_ENCOUNTERED
    if side < 0:
        latch = af5.NEGATIVE_SOFTWARE_LIMIT_ENCOUNTERED
    if not soft_limit_crossed(F, S, n, flags, side):
        I[word] &= ~latch
    elif not side * velocity_cps > 0.0:
        return
    elif I[axes.jog_mode[n]] == JOG_HOMING:
        home_limit_hit(I, n, SOFT_LIMIT_HIT, velocity_cps)
    else:
        leads: int = lock_leader(I, n)  # a locked axis is moved and stopped by its leader
        if leads < 0:
            leads = n
        crossed: bool = I[word] & latch == 0
        I[word] |= latch
        if I[axes.jog_mode[leads]] == JOG_KILLED:
            return
        if crossed or followed(I, leads):
            soft_stop(F, I, S, n)


def followed(I: I32, n: int) -> bool:
    """Whether axis n follows a source or a path."""
    m: int = I[axes.master[n]]
    if m >= 0 and I[masters.moving[m]]:
        return True
    return I[af1.word[n]] & FOLLOWING != 0 or I[filters.on[n]] != 0


def soft_stop(F: F64, I: I32, S: F32, n: int) -> None:
    """Ramp axis n and the others of its master down with their SLDEC; no kill of axes."""
    if lock_leader(I, n) >= 0:
        soft_stop(F, I, S, lock_leader(I, n))
        return
    m: int = I[axes.master[n]]
    if m < 0:
        axis_halt(F, I, S, n, F[axes.sldec_ups2[n]])
        return
    for s in range(SLAVE_COUNT):
        other: int = I[masters.slave_axis[m] + s]
        if other >= 0:
            axis_halt(F, I, S, other, F[axes.sldec_ups2[other]])
    I[mf1.word[m]] |= mf1.KILL_ALL_MOVES_REQUEST
    master_drop(F, I, S, m)


def limits_step(F: F64, I: I32, S: F32, n: int) -> None:
    """Limits and kill request of axis n for this tick."""
    flags: int = limit_inputs(I, n)
    if I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST:
        if not I[axes.kamr_old[n]]:
            axis_kill(F, I, S, n)
    else:
        I[axes.kamr_old[n]] = 0
    if not flags & WATCHED:
        return
    velocity_cps: float = F[axes.psp_velocity_cps[n]]
    if axis_scale(S, n) < 0.0:
        velocity_cps = -velocity_cps
    if not I[af4.word[n]] & af4.KILL_ALL_MOTION_REQUEST:
        hard_limits(F, I, S, n, flags, velocity_cps)
    soft_limit(F, I, S, n, flags, 1, velocity_cps)
    soft_limit(F, I, S, n, flags, -1, velocity_cps)
