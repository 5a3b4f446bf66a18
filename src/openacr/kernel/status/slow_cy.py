"""The slow flag scan, every 50 ms: limit bands and the request flags of masters and axes."""

from openacr.kernel.axis.axis_cy import axis_renew, axis_scale
from openacr.kernel.axis.drive_cy import drive_disable, drive_driven
from openacr.kernel.path.hold_cy import (
    IN_FEEDHOLD,
    NOT_HELD,
    master_at_rest,
    master_hold,
    master_release,
)
from openacr.map.rows import axes, masters, motors
from openacr.map.words import af1, af4, mf1
from openacr.views import F32, F64, I32

__all__ = ["slow_scan"]

SLAVE_COUNT = 16
AXIS_BANDS = (
    af1.NOT_IN_POSITION
    | af1.NOT_EXCESS_ERROR
    | af1.WITHIN_A_LIMIT
    | af1.NOT_WITHIN_B_LIMIT
    | af1.NOT_TORQUE_LIMIT
    | af1.NOT_IN_TORQUE_BAND
)
ANY_OF = af1.NOT_IN_POSITION | af1.NOT_WITHIN_B_LIMIT | af1.NOT_IN_TORQUE_BAND
ALL_OF = af1.NOT_EXCESS_ERROR | af1.WITHIN_A_LIMIT | af1.NOT_TORQUE_LIMIT
MASTER_BANDS = (
    mf1.NOT_IN_POSITION
    | mf1.NOT_EXCESS_ERROR
    | mf1.WITHIN_A_LIMIT
    | mf1.NOT_WITHIN_B_LIMIT
    | mf1.NOT_TORQUE_LIMIT
    | mf1.NOT_IN_TORQUE_BAND
)
OFFSETS_MOVING = af1.JOG_ACTIVE | af1.GEAR_ACTIVE | af1.CAM_ACTIVATE
MASTER_SHIFT = 16  # bands 0-5 of an axis are flags 16-21 of its master


def inside(S: F32, plus: int, minus: int, value: float) -> bool:
    """Whether `value` lies within the band of two parameters; 0,0 holds only 0."""
    return S[minus] <= value <= S[plus]


def axis_bands(F: F64, I: I32, S: F32, n: int, chosen: int) -> None:
    """Refresh the chosen ones of the limit flags of axis n, and answer an excess error."""
    flags: int = band_flags(F, I, S, n) & chosen
    I[af1.word[n]] = (I[af1.word[n]] & ~chosen) | flags
    if chosen & af1.NOT_EXCESS_ERROR and not flags & af1.NOT_EXCESS_ERROR:
        excess_response(I, n)


def band_flags(F: F64, I: I32, S: F32, n: int) -> int:
    """Limit flags of axis n: bands of following error, command position and output."""
    scale: float = axis_scale(S, n)
    setpoint_cnt: float = F[axes.ssp_cnt[n]]
    error_u: float = (setpoint_cnt - I[axes.actual_position[n]]) / scale
    position_u: float = setpoint_cnt / scale
    output_v: float = S[axes.output_signal[n]]
    flags: int = 0
    if not inside(S, axes.plus_in_position[n], axes.minus_in_position[n], error_u):
        flags |= af1.NOT_IN_POSITION
    if inside(S, axes.plus_excess_error[n], axes.minus_excess_error[n], error_u):
        flags |= af1.NOT_EXCESS_ERROR
    if inside(S, axes.plus_a_limit[n], axes.minus_a_limit[n], position_u):
        flags |= af1.WITHIN_A_LIMIT
    if not inside(S, axes.plus_b_limit[n], axes.minus_b_limit[n], position_u):
        flags |= af1.NOT_WITHIN_B_LIMIT
    if not I[axes.clipped[n]]:
        flags |= af1.NOT_TORQUE_LIMIT
    if not inside(S, axes.plus_torque_band[n], axes.minus_torque_band[n], output_v):
        flags |= af1.NOT_IN_TORQUE_BAND
    return flags


def excess_response(I: I32, n: int) -> None:
    """Excess error of an axis that answers it: fault latch, kill, drive off.

    An axis whose drive is not enabled is not being controlled, so it has no error to
    answer.
    """
    word: int = af4.word[n]
    flags: int = I[word]
    if not drive_driven(I, n) or not I[axes.on[n]]:
        return
    if flags & af4.EXC_RESPONSE_ENABLE:
        I[word] = flags | af4.EXCESS_ERROR_FAULT | af4.KILL_ALL_MOTION_REQUEST
        drive_disable(I, n)
    elif flags & af4.DISABLE_DRIVE_ON_EXC_ONLY:
        I[word] = flags | af4.EXCESS_ERROR_FAULT
        drive_disable(I, n)


def axis_marker(I: I32, n: int) -> None:
    """Not Marker: set while the marker of the attached encoder is absent."""
    k: int = I[axes.position_index[n]]
    word: int = af1.word[n]
    absent: bool = True
    if 0 <= k < 16 and I[motors.kind[k]]:
        absent = I[motors.marker[k]] == 0
    if absent:
        I[word] |= af1.NOT_MARKER
    else:
        I[word] &= ~af1.NOT_MARKER


def master_bands(I: I32, m: int) -> None:
    """Limit flags of master m from those of its axes: "not inside" if any, "inside" if all."""
    some: int = 0
    every: int = ALL_OF
    attached: bool = False
    for s in range(SLAVE_COUNT):
        axis: int = I[masters.slave_axis[m] + s]
        if axis >= 0:
            attached = True
            some |= I[af1.word[axis]] & ANY_OF
            every &= I[af1.word[axis]]
    word: int = mf1.word[m]
    if attached:
        I[word] = (I[word] & ~MASTER_BANDS) | ((some | every) << MASTER_SHIFT)
    else:
        I[word] &= ~MASTER_BANDS


def master_requests(F: F64, I: I32, S: F32, m: int) -> None:
    """Serve feedhold, stop, cycle start and REN requests of master m; they clear themselves."""
    word: int = mf1.word[m]
    flags: int = I[word]
    hold: int = I[masters.hold[m]]
    if flags & (mf1.FEEDHOLD_REQUEST | mf1.STOP_ALL_MOVES_REQUEST) and hold == NOT_HELD:
        master_hold(F, I, S, m)
    elif flags & mf1.STOP_ALL_MOVES_REQUEST and hold == IN_FEEDHOLD:
        master_at_rest(F, I, S, m)
    I[word] &= ~mf1.FEEDHOLD_REQUEST
    if flags & mf1.CYCLE_START_REQUEST:
        I[word] &= ~mf1.CYCLE_START_REQUEST
        if hold != NOT_HELD and not flags & mf1.CYCLE_START_LOCKOUT:
            master_release(F, I, S, m)
        elif not flags & mf1.CYCLE_START_LOCKOUT:
            I[masters.sync_start[m]] = 1
    if flags & mf1.REN_REQUEST_FLAG:
        I[word] &= ~mf1.REN_REQUEST_FLAG
        for s in range(SLAVE_COUNT):
            axis: int = I[masters.slave_axis[m] + s]
            if axis >= 0:
                I[af1.word[axis]] |= af1.REN_REQUEST_FLAG
                axis_request(F, I, axis)


def axis_request(F: F64, I: I32, n: int) -> None:
    """Serve the REN request of axis n; in motion, where REN is refused, it waits for rest."""
    m: int = I[axes.master[n]]
    if I[af1.word[n]] & OFFSETS_MOVING:
        return
    if m >= 0 and I[mf1.word[m]] & mf1.IN_MOTION:
        return
    I[af1.word[n]] &= ~af1.REN_REQUEST_FLAG
    axis_renew(F, I, n)


def slow_scan(F: F64, I: I32, S: F32, axis_count: int, master_count: int) -> None:
    """One slow scan over all axes and masters."""
    for n in range(axis_count):
        axis_bands(F, I, S, n, AXIS_BANDS)
        axis_marker(I, n)
        if I[af1.word[n]] & af1.REN_REQUEST_FLAG:
            axis_request(F, I, n)
    for m in range(master_count):
        master_bands(I, m)
        master_requests(F, I, S, m)
