"""Calls of commands to the kernel: what they do to the state that the loop keeps changing.

A command that runs while ticks go on cannot write such rows itself: they are others by the time
it is done. It notes a call instead, three numbers and a value, and the loop makes it.
"""

from openacr.kernel.axis.axis_cy import axis_preload, axis_renew, axis_settled
from openacr.kernel.axis.capture_cy import capture_arm
from openacr.kernel.axis.feedback_cy import encoder_limit, encoder_roll, encoder_set, feedback_set
from openacr.kernel.jog.jog_command_cy import jog_aim, jog_off
from openacr.kernel.path.queue_cy import (
    path_cut,
    path_halt,
    path_hold,
    path_release,
    path_replace,
    record_enter,
)
from openacr.views import F32, F64, I32

__all__ = ["kernel_call"]

RECORD_ENTER = 1  # master, record
PATH_REPLACE = 2  # master
PATH_CUT = 3  # master
PATH_HOLD = 4  # master
PATH_RELEASE = 5  # master
PATH_HALT = 6  # master
JOG_AIM = 7  # axis; offset
JOG_OFF = 8  # axis
AXIS_PRELOAD = 9  # axis; position
AXIS_RENEW = 10  # axis
AXIS_SETTLED = 11  # axis
FEEDBACK_SET = 12  # axis, position
ENCODER_SET = 13  # encoder, position
CAPTURE_ARM = 14  # axis, mode
ENCODER_ROLL = 15  # encoder, length of a turn
ENCODER_LIMIT = 16  # encoder, rate of edges


def kernel_call(F: F64, I: I32, S: F32, call: int, n: int, k: int, value: float) -> None:
    """Make a call: of object n, with a whole number k and a value where the call has them."""
    if call == RECORD_ENTER:
        record_enter(F, I, S, n, k)
    elif call == PATH_REPLACE:
        path_replace(F, I, S, n)
    elif call == PATH_CUT:
        path_cut(F, I, S, n)
    elif call == PATH_HOLD:
        path_hold(F, I, S, n)
    elif call == PATH_RELEASE:
        path_release(F, I, S, n)
    elif call == PATH_HALT:
        path_halt(F, I, S, n)
    elif call == JOG_AIM:
        jog_aim(F, I, n, value)
    elif call == JOG_OFF:
        jog_off(I, n)
    elif call == AXIS_PRELOAD:
        axis_preload(F, I, n, value)
    elif call == AXIS_RENEW:
        axis_renew(F, I, n)
    elif call == AXIS_SETTLED:
        axis_settled(F, I, n)
    elif call == FEEDBACK_SET:
        feedback_set(F, I, S, n, k)
    elif call == ENCODER_SET:
        encoder_set(F, I, n, k)
    elif call == CAPTURE_ARM:
        capture_arm(F, I, n, k)
    elif call == ENCODER_ROLL:
        encoder_roll(I, n, k)
    elif call == ENCODER_LIMIT:
        encoder_limit(F, I, n, k)
