"""HSINT: a move that a capture leads to a new end, a given way behind the captured position.

    SEARCHING    wait for a capture that lies in the window
    CAPTURED     wait for the INT response period, then turn to the new end
    PASSING      the new end is too near for STP: come to rest behind it first
    LAST         on the way to the new end, or no capture will change the way any more

Captures are measured along the move from its start.
"""

from openacr.cmath import fabs
from openacr.kernel.axis_cy import axis_offsets, axis_scale, axis_word
from openacr.kernel.capture_cy import capture_arm
from openacr.kernel.interrupt_cy import flag_state, master_cut, response_period
from openacr.kernel.path_cy import move_geometry, move_record, move_stop_rate
from openacr.kernel.plan_cy import master_plan
from openacr.kernel.profile_cy import STOPPING, profile_reset, profile_stop
from openacr.map.numbers import (
    AF1_CAPTURE_COMPLETE,
    AF1_HSINT_ABORTED,
    AF1_HSINT_REGISTERED,
    AXF_BASE,
    AXF_CAPTURE_CNT,
    AXF_POSITION_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_SLAVE,
    AXI_STRIDE,
    MQF_BASE,
    MQF_DELTA_CNT,
    MQF_HSINT_START_CNT,
    MQF_HSINT_WAY_CNT,
    MQF_HSINT_WINDOW_CNT,
    MQF_JRK_UPS3,
    MQF_LENGTH_U,
    MQF_STRIDE,
    MQF_TARGET_CNT,
    MQI_BASE,
    MQI_HSINT_ABORT,
    MQI_HSINT_AXIS,
    MQI_HSINT_MODE,
    MQI_RELATIVE,
    MQI_STRIDE,
    MSI_BASE,
    MSI_HSINT_PHASE,
    MSI_RESPONSE,
    MSI_STRIDE,
    PRF_ACCEL,
    PRF_BASE,
    PRF_DISTANCE,
    PRF_END_DISTANCE,
    PRF_STRIDE,
    PRF_VELOCITY,
)
from openacr.views import F32, F64, I32

HSINT_NONE = 0
HSINT_SEARCHING = 1
HSINT_CAPTURED = 2
HSINT_PASSING = 3
HSINT_LAST = 4
ENDLESS_U = 1e30


def hsint_begin(F: F64, I: I32, m: int) -> None:
    """The move begins: clear its flags and arm the capture."""
    q: int = MQI_BASE + move_record(I, m) * MQI_STRIDE
    axis: int = I[q + MQI_HSINT_AXIS] - 1
    I[axis_word(axis)] &= ~(AF1_HSINT_REGISTERED | AF1_HSINT_ABORTED)
    capture_arm(F, I, axis, I[q + MQI_HSINT_MODE])
    I[MSI_BASE + m * MSI_STRIDE + MSI_HSINT_PHASE] = HSINT_SEARCHING


def hsint_step(F: F64, I: I32, S: F32, m: int) -> None:
    """Every tick of the move: abort flag, captures, and the turn to the new end."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    axis: int = I[MQI_BASE + record * MQI_STRIDE + MQI_HSINT_AXIS] - 1
    phase: int = I[i + MSI_HSINT_PHASE]
    if phase == HSINT_SEARCHING:
        abort: int = I[MQI_BASE + record * MQI_STRIDE + MQI_HSINT_ABORT]
        if abort and flag_state(I, abort):
            capture_arm(F, I, axis, -1)
            I[axis_word(axis)] |= AF1_HSINT_ABORTED
            I[i + MSI_HSINT_PHASE] = HSINT_LAST
            master_cut(F, I, S, m)
        elif I[axis_word(axis)] & AF1_CAPTURE_COMPLETE:
            hsint_captured(F, I, m, record, axis)
    elif phase == HSINT_CAPTURED:
        I[i + MSI_RESPONSE] -= 1
        if I[i + MSI_RESPONSE] <= 0:
            hsint_turn(F, I, S, m, record, axis)


def hsint_captured(F: F64, I: I32, m: int, record: int, axis: int) -> None:
    """A capture: take it if it lies in the window, else wait for the next."""
    i: int = MSI_BASE + m * MSI_STRIDE
    q: int = MQF_BASE + record * MQF_STRIDE
    s: int = I[AXI_BASE + axis * AXI_STRIDE + AXI_SLAVE]
    delta: float = F[q + MQF_DELTA_CNT + s]
    captured: float = F[AXF_BASE + axis * AXF_STRIDE + AXF_CAPTURE_CNT]
    travel: float = captured - axis_offsets(F, axis) - (F[q + MQF_TARGET_CNT + s] - delta)
    if delta < 0.0:
        travel = -travel
    window: float = F[q + MQF_HSINT_WINDOW_CNT]
    start: float = F[q + MQF_HSINT_START_CNT]
    if window > 0.0 and not start <= travel <= start + window:
        capture_arm(F, I, axis, I[MQI_BASE + record * MQI_STRIDE + MQI_HSINT_MODE])
        return
    I[axis_word(axis)] |= AF1_HSINT_REGISTERED
    I[i + MSI_RESPONSE] = response_period(I, m)
    I[i + MSI_HSINT_PHASE] = HSINT_LAST if I[i + MSI_RESPONSE] < 0 else HSINT_CAPTURED


def hsint_turn(F: F64, I: I32, S: F32, m: int, record: int, axis: int) -> None:
    """Lead the move to its new end with the speed it has, or stop behind it first."""
    i: int = MSI_BASE + m * MSI_STRIDE
    f: int = PRF_BASE + m * PRF_STRIDE
    q: int = MQF_BASE + record * MQF_STRIDE
    s: int = I[AXI_BASE + axis * AXI_STRIDE + AXI_SLAVE]
    rate: float = move_stop_rate(F, record)
    position: float = F[AXF_BASE + axis * AXF_STRIDE + AXF_POSITION_CNT]
    way: float = (hsint_end_cnt(F, record, axis) - position) / axis_scale(S, axis)
    travel: float = F[q + MQF_DELTA_CNT + s] / axis_scale(S, axis)
    if travel < 0.0:
        way = -way
    if travel != 0.0:
        way = way * F[q + MQF_LENGTH_U] / fabs(travel)
    velocity: float = F[f + PRF_VELOCITY]
    accel: float = F[f + PRF_ACCEL]
    profile_stop(F, I, m, ENDLESS_U, rate, F[q + MQF_JRK_UPS3], STOPPING)
    if F[f + PRF_END_DISTANCE] - F[f + PRF_DISTANCE] > way * (1.0 + 1e-9):
        I[i + MSI_HSINT_PHASE] = HSINT_PASSING
        return
    hsint_lead(F, I, S, m, record, axis)
    profile_reset(F, I, m, velocity, accel)
    master_plan(F, I, S, m)


def hsint_end_cnt(F: F64, record: int, axis: int) -> float:
    """The new end in coordinated pulses: offsets take part in the captured position."""
    captured: float = F[AXF_BASE + axis * AXF_STRIDE + AXF_CAPTURE_CNT] - axis_offsets(F, axis)
    return captured + F[MQF_BASE + record * MQF_STRIDE + MQF_HSINT_WAY_CNT]


def hsint_lead(F: F64, I: I32, S: F32, m: int, record: int, axis: int) -> None:
    """Make the new end the target of the move, from where the axis is."""
    s: int = I[AXI_BASE + axis * AXI_STRIDE + AXI_SLAVE]
    F[MQF_BASE + record * MQF_STRIDE + MQF_TARGET_CNT + s] = hsint_end_cnt(F, record, axis)
    I[MQI_BASE + record * MQI_STRIDE + MQI_RELATIVE] = 0
    move_geometry(F, I, S, m)
    I[MSI_BASE + m * MSI_STRIDE + MSI_HSINT_PHASE] = HSINT_LAST


def hsint_end(F: F64, I: I32, S: F32, m: int) -> bool:
    """The path has come to its end; True while it still has to return to the new end."""
    i: int = MSI_BASE + m * MSI_STRIDE
    record: int = move_record(I, m)
    axis: int = I[MQI_BASE + record * MQI_STRIDE + MQI_HSINT_AXIS] - 1
    phase: int = I[i + MSI_HSINT_PHASE]
    if phase == HSINT_PASSING:
        hsint_lead(F, I, S, m, record, axis)
        profile_reset(F, I, m, 0.0, 0.0)
        master_plan(F, I, S, m)
        return True
    if phase == HSINT_SEARCHING:
        capture_arm(F, I, axis, -1)
    I[i + MSI_HSINT_PHASE] = HSINT_NONE
    return False
