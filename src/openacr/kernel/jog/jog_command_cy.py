"""What commands do to a jog: a target, the end, and an offset of another size.

As with the moves of a master, what depends on where the jog is just then happens here.
"""

from openacr.kernel.jog.homing_cy import home_abort
from openacr.kernel.jog.jog_cy import (
    JOG_CONTINUOUS,
    JOG_HOMING,
    JOG_IDLE,
    JOG_KILLED,
    JOG_TO_TARGET,
)
from openacr.map.rows import axes
from openacr.map.words import af1
from openacr.views import F64, I32


def jog_aim(F: F64, I: I32, n: int, target_cnt: float) -> None:
    """JOG ABS and INC: go to an offset; after the stop of a limit or kill, if one is running."""
    word: int = af1.word[n]
    mode: int = I[axes.jog_mode[n]]
    if mode == JOG_HOMING:
        home_abort(I, n)
    F[axes.jog_target_cnt[n]] = target_cnt
    I[word] &= ~(af1.JOG_FORWARD | af1.JOG_REVERSE)
    if target_cnt == F[axes.jog_cnt[n]] and not I[word] & af1.JOG_ACTIVE:
        return
    if I[word] & af1.JOG_LOCKOUT and mode == JOG_IDLE:
        return
    if mode != JOG_KILLED:  # else a limit or kill brings the axis to rest first
        I[axes.jog_mode[n]] = JOG_TO_TARGET
    I[axes.jog_replan[n]] = 1
    I[word] |= af1.JOG_ACTIVE


def jog_off(I: I32, n: int) -> None:
    """JOG OFF: ramp to rest with JOG DEC."""
    word: int = af1.word[n]
    mode: int = I[axes.jog_mode[n]]
    I[word] &= ~(af1.JOG_FORWARD | af1.JOG_REVERSE)
    if mode == JOG_HOMING:
        home_abort(I, n)
    if mode == JOG_HOMING or mode == JOG_TO_TARGET:
        I[axes.jog_want[n]] = 0
        I[axes.jog_mode[n]] = JOG_CONTINUOUS  # without a direction: ramp to rest
    elif mode == JOG_KILLED:
        I[axes.jog_replan[n]] = 0  # a target that waits for the end of the stop
    elif mode == JOG_IDLE:
        I[word] &= ~af1.JOG_ACTIVE
