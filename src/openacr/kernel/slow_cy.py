"""The slow flag scan, every 50 ms: limit bands and the request flags of masters and axes."""

from openacr.kernel.axis_cy import axis_renew, axis_scale, axis_word
from openacr.kernel.drive_cy import drive_disable, drive_driven
from openacr.kernel.hold_cy import (
    IN_FEEDHOLD,
    NOT_HELD,
    master_at_rest,
    master_hold,
    master_release,
)
from openacr.kernel.path_cy import master_word
from openacr.map.numbers import (
    AF1_CAM_ACTIVATE,
    AF1_GEAR_ACTIVE,
    AF1_JOG_ACTIVE,
    AF1_NOT_EXCESS_ERROR,
    AF1_NOT_IN_POSITION,
    AF1_NOT_IN_TORQUE_BAND,
    AF1_NOT_MARKER,
    AF1_NOT_TORQUE_LIMIT,
    AF1_NOT_WITHIN_B_LIMIT,
    AF1_REN_REQUEST_FLAG,
    AF1_WITHIN_A_LIMIT,
    AF4_DISABLE_DRIVE_ON_EXC_ONLY,
    AF4_EXC_RESPONSE_ENABLE,
    AF4_EXCESS_ERROR_FAULT,
    AF4_KILL_ALL_MOTION_REQUEST,
    AF4_WORD,
    AX_ACTUAL_POSITION,
    AX_BASE,
    AX_MINUS_A_LIMIT,
    AX_MINUS_B_LIMIT,
    AX_MINUS_EXCESS_ERROR,
    AX_MINUS_IN_POSITION,
    AX_MINUS_TORQUE_BAND,
    AX_OUTPUT_SIGNAL,
    AX_PLUS_A_LIMIT,
    AX_PLUS_B_LIMIT,
    AX_PLUS_EXCESS_ERROR,
    AX_PLUS_IN_POSITION,
    AX_PLUS_TORQUE_BAND,
    AX_STRIDE,
    AXF_BASE,
    AXF_SSP_CNT,
    AXF_STRIDE,
    AXI_BASE,
    AXI_CLIPPED,
    AXI_MASTER,
    AXI_ON,
    AXI_POSITION_INDEX,
    AXI_STRIDE,
    MF1_CYCLE_START_LOCKOUT,
    MF1_CYCLE_START_REQUEST,
    MF1_FEEDHOLD_REQUEST,
    MF1_IN_MOTION,
    MF1_NOT_EXCESS_ERROR,
    MF1_NOT_IN_POSITION,
    MF1_NOT_IN_TORQUE_BAND,
    MF1_NOT_TORQUE_LIMIT,
    MF1_NOT_WITHIN_B_LIMIT,
    MF1_REN_REQUEST_FLAG,
    MF1_STOP_ALL_MOVES_REQUEST,
    MF1_WITHIN_A_LIMIT,
    MSI_BASE,
    MSI_HOLD,
    MSI_SLAVE_AXIS,
    MSI_STRIDE,
    MSI_SYNC_START,
    PLI_BASE,
    PLI_KIND,
    PLI_MARKER,
    PLI_STRIDE,
)
from openacr.views import F32, F64, I32

__all__ = ["slow_scan"]

SLAVE_COUNT = 16
AXIS_BANDS = (
    AF1_NOT_IN_POSITION
    | AF1_NOT_EXCESS_ERROR
    | AF1_WITHIN_A_LIMIT
    | AF1_NOT_WITHIN_B_LIMIT
    | AF1_NOT_TORQUE_LIMIT
    | AF1_NOT_IN_TORQUE_BAND
)
ANY_OF = AF1_NOT_IN_POSITION | AF1_NOT_WITHIN_B_LIMIT | AF1_NOT_IN_TORQUE_BAND
ALL_OF = AF1_NOT_EXCESS_ERROR | AF1_WITHIN_A_LIMIT | AF1_NOT_TORQUE_LIMIT
MASTER_BANDS = (
    MF1_NOT_IN_POSITION
    | MF1_NOT_EXCESS_ERROR
    | MF1_WITHIN_A_LIMIT
    | MF1_NOT_WITHIN_B_LIMIT
    | MF1_NOT_TORQUE_LIMIT
    | MF1_NOT_IN_TORQUE_BAND
)
OFFSETS_MOVING = AF1_JOG_ACTIVE | AF1_GEAR_ACTIVE | AF1_CAM_ACTIVATE
MASTER_SHIFT = 16  # bands 0-5 of an axis are flags 16-21 of its master


def inside(S: F32, plus: int, minus: int, value: float) -> bool:
    """Whether `value` lies within the band of two parameters; 0,0 holds only 0."""
    return S[minus] <= value <= S[plus]


def axis_bands(F: F64, I: I32, S: F32, n: int, chosen: int) -> None:
    """Refresh the chosen ones of the limit flags of axis n, and answer an excess error."""
    flags: int = band_flags(F, I, S, n) & chosen
    I[axis_word(n)] = (I[axis_word(n)] & ~chosen) | flags
    if chosen & AF1_NOT_EXCESS_ERROR and not flags & AF1_NOT_EXCESS_ERROR:
        excess_response(I, n)


def band_flags(F: F64, I: I32, S: F32, n: int) -> int:
    """Limit flags of axis n: bands of following error, command position and output."""
    p: int = AX_BASE + n * AX_STRIDE
    scale: float = axis_scale(S, n)
    setpoint: float = F[AXF_BASE + n * AXF_STRIDE + AXF_SSP_CNT]
    error: float = (setpoint - I[p + AX_ACTUAL_POSITION]) / scale
    position: float = setpoint / scale
    output: float = S[p + AX_OUTPUT_SIGNAL]
    flags: int = 0
    if not inside(S, p + AX_PLUS_IN_POSITION, p + AX_MINUS_IN_POSITION, error):
        flags |= AF1_NOT_IN_POSITION
    if inside(S, p + AX_PLUS_EXCESS_ERROR, p + AX_MINUS_EXCESS_ERROR, error):
        flags |= AF1_NOT_EXCESS_ERROR
    if inside(S, p + AX_PLUS_A_LIMIT, p + AX_MINUS_A_LIMIT, position):
        flags |= AF1_WITHIN_A_LIMIT
    if not inside(S, p + AX_PLUS_B_LIMIT, p + AX_MINUS_B_LIMIT, position):
        flags |= AF1_NOT_WITHIN_B_LIMIT
    if not I[AXI_BASE + n * AXI_STRIDE + AXI_CLIPPED]:
        flags |= AF1_NOT_TORQUE_LIMIT
    if not inside(S, p + AX_PLUS_TORQUE_BAND, p + AX_MINUS_TORQUE_BAND, output):
        flags |= AF1_NOT_IN_TORQUE_BAND
    return flags


def excess_response(I: I32, n: int) -> None:
    """Excess error of an axis that answers it: fault latch, kill, drive off.

    An axis whose drive is not enabled is not being controlled, so it has no error to
    answer.
    """
    word: int = AF4_WORD + n
    flags: int = I[word]
    if not drive_driven(I, n) or not I[AXI_BASE + n * AXI_STRIDE + AXI_ON]:
        return
    if flags & AF4_EXC_RESPONSE_ENABLE:
        I[word] = flags | AF4_EXCESS_ERROR_FAULT | AF4_KILL_ALL_MOTION_REQUEST
        drive_disable(I, n)
    elif flags & AF4_DISABLE_DRIVE_ON_EXC_ONLY:
        I[word] = flags | AF4_EXCESS_ERROR_FAULT
        drive_disable(I, n)


def axis_marker(I: I32, n: int) -> None:
    """Not Marker: set while the marker of the attached encoder is absent."""
    k: int = I[AXI_BASE + n * AXI_STRIDE + AXI_POSITION_INDEX]
    word: int = axis_word(n)
    absent: bool = True
    if 0 <= k < 16 and I[PLI_BASE + k * PLI_STRIDE + PLI_KIND]:
        absent = I[PLI_BASE + k * PLI_STRIDE + PLI_MARKER] == 0
    if absent:
        I[word] |= AF1_NOT_MARKER
    else:
        I[word] &= ~AF1_NOT_MARKER


def master_bands(I: I32, m: int) -> None:
    """Limit flags of master m from those of its axes: "not inside" if any, "inside" if all."""
    some: int = 0
    every: int = ALL_OF
    attached: bool = False
    for s in range(SLAVE_COUNT):
        axis: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
        if axis >= 0:
            attached = True
            some |= I[axis_word(axis)] & ANY_OF
            every &= I[axis_word(axis)]
    word: int = master_word(m)
    if attached:
        I[word] = (I[word] & ~MASTER_BANDS) | ((some | every) << MASTER_SHIFT)
    else:
        I[word] &= ~MASTER_BANDS


def master_requests(F: F64, I: I32, S: F32, m: int) -> None:
    """Serve feedhold, stop, cycle start and REN requests of master m; they clear themselves."""
    word: int = master_word(m)
    flags: int = I[word]
    hold: int = I[MSI_BASE + m * MSI_STRIDE + MSI_HOLD]
    if flags & (MF1_FEEDHOLD_REQUEST | MF1_STOP_ALL_MOVES_REQUEST) and hold == NOT_HELD:
        master_hold(F, I, S, m)
    elif flags & MF1_STOP_ALL_MOVES_REQUEST and hold == IN_FEEDHOLD:
        master_at_rest(F, I, S, m)
    I[word] &= ~MF1_FEEDHOLD_REQUEST
    if flags & MF1_CYCLE_START_REQUEST:
        I[word] &= ~MF1_CYCLE_START_REQUEST
        if hold != NOT_HELD and not flags & MF1_CYCLE_START_LOCKOUT:
            master_release(F, I, S, m)
        elif not flags & MF1_CYCLE_START_LOCKOUT:
            I[MSI_BASE + m * MSI_STRIDE + MSI_SYNC_START] = 1
    if flags & MF1_REN_REQUEST_FLAG:
        I[word] &= ~MF1_REN_REQUEST_FLAG
        for s in range(SLAVE_COUNT):
            axis: int = I[MSI_BASE + m * MSI_STRIDE + MSI_SLAVE_AXIS + s]
            if axis >= 0:
                I[axis_word(axis)] |= AF1_REN_REQUEST_FLAG
                axis_request(F, I, axis)


def axis_request(F: F64, I: I32, n: int) -> None:
    """Serve the REN request of axis n; in motion, where REN is refused, it waits for rest."""
    m: int = I[AXI_BASE + n * AXI_STRIDE + AXI_MASTER]
    if I[axis_word(n)] & OFFSETS_MOVING:
        return
    if m >= 0 and I[master_word(m)] & MF1_IN_MOTION:
        return
    I[axis_word(n)] &= ~AF1_REN_REQUEST_FLAG
    axis_renew(F, I, n)


def slow_scan(F: F64, I: I32, S: F32, axes: int, masters: int) -> None:
    """One slow scan over all axes and masters."""
    for n in range(axes):
        axis_bands(F, I, S, n, AXIS_BANDS)
        axis_marker(I, n)
        if I[axis_word(n)] & AF1_REN_REQUEST_FLAG:
            axis_request(F, I, n)
    for m in range(masters):
        master_bands(I, m)
        master_requests(F, I, S, m)
