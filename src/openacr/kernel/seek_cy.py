"""MSEEK: a move that looks for a capture, slows down there and goes back to it.

The captured position becomes 0.
"""

from openacr.kernel.axis_cy import axis_offsets, axis_preload, axis_word
from openacr.kernel.capture_cy import capture_arm, encoder_shift
from openacr.kernel.path_cy import move_geometry, move_record, move_stop_rate
from openacr.kernel.plan_cy import master_plan
from openacr.kernel.profile_cy import STOPPING, profile_reset, profile_stop
from openacr.map.numbers import (
    AF1_CAPTURE_COMPLETE,
    AXF_BASE,
    AXF_CAPTURE_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_SLAVE,
    AXI_STRIDE,
    MQF_BASE,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQI_BASE,
    MQI_RELATIVE,
    MQI_SEEK_AXIS,
    MQI_STRIDE,
    MSI_BASE,
    MSI_SEEK_PHASE,
    MSI_STRIDE,
)
from openacr.views import F32, F64, I32

SEEK_NONE = 0
SEEK_SEARCHING = 1
SEEK_STOPPING = 2
SEEK_RETURNING = 3


def seek_step(F: F64, I: I32, S: F32, m: int) -> None:
    """MSEEK in search: at the capture, slow down with STP (DEC if that is 0)."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    axis: int = I[MQI_BASE + record * MQI_STRIDE + MQI_SEEK_AXIS] - 1
    if I[axis_word(axis)] & AF1_CAPTURE_COMPLETE:
        q: int = MQF_BASE + record * MQF_STRIDE
        rate: float = move_stop_rate(F, record)
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
        s: int = I[AXI_BASE + axis * AXI_STRIDE + AXI_SLAVE]
        F[q + MQF_TARGET_CNT + s] = F[a + AXF_CAPTURE_CNT] - axis_offsets(F, axis)
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
