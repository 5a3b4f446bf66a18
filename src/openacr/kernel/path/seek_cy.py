"""MSEEK: a move that looks for a capture, slows down there and goes back to it.

The captured position becomes 0.
"""

from openacr.kernel.axis.axis_cy import axis_offsets, axis_preload
from openacr.kernel.axis.capture_cy import capture_arm, encoder_shift
from openacr.kernel.path.interrupt_cy import CUT
from openacr.kernel.path.path_cy import move_geometry, move_record, move_stop_rate
from openacr.kernel.path.plan_cy import master_plan
from openacr.kernel.profile.profile_cy import profile_reset, profile_stop
from openacr.kernel.profile.ramps_cy import STOPPING
from openacr.map.rows import axes, masters, moves
from openacr.map.words import af1
from openacr.views import F32, F64, I32

SEEK_NONE = 0
SEEK_SEARCHING = 1
SEEK_STOPPING = 2
SEEK_RETURNING = 3


def seek_step(F: F64, I: I32, S: F32, m: int) -> None:
    """MSEEK in search: at the capture, slow down with STP (DEC if that is 0)."""
    record: int = move_record(I, m)
    axis: int = I[moves.seek_axis[record]] - 1
    if I[af1.word[axis]] & af1.CAPTURE_COMPLETE:
        rate_ups2: float = move_stop_rate(F, record)
        I[masters.seek_phase[m]] = SEEK_STOPPING
        jerk_ups3: float = F[moves.jrk_ups3[record]]
        profile_stop(F, I, m, F[moves.length_u[record]], rate_ups2, jerk_ups3, STOPPING)


def seek_end(F: F64, I: I32, S: F32, m: int) -> bool:
    """An MSEEK path has come to rest; True while it still has to go back to the capture.

    One that was cut on its return (INT, TRJ) rests beside the capture: no position becomes 0.
    """
    record: int = move_record(I, m)
    phase: int = I[masters.seek_phase[m]]
    axis: int = I[moves.seek_axis[record]] - 1
    if phase == SEEK_STOPPING:
        # Jog, gear and cam offsets take part in the captured actual position.
        s: int = I[axes.slave[axis]]
        F[moves.target_cnt[record] + s] = F[axes.capture_cnt[axis]] - axis_offsets(F, axis)
        I[moves.relative[record]] = 0
        move_geometry(F, I, S, m)
        I[masters.seek_phase[m]] = SEEK_RETURNING
        profile_reset(F, I, m, 0.0, 0.0)
        master_plan(F, I, S, m)
        return True
    if phase == SEEK_RETURNING and I[masters.cut[m]] != CUT:
        encoder_shift(F, I, S, axis, int(F[axes.capture_cnt[axis]]))
        axis_preload(F, I, axis, 0.0)
    elif phase == SEEK_SEARCHING:
        capture_arm(F, I, axis, -1)
    I[masters.seek_phase[m]] = SEEK_NONE
    return False
