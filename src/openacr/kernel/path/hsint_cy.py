"""HSINT: a move that a capture leads to a new end, a given distance after the captured position.

    SEARCHING    wait for a capture that lies in the window
    CAPTURED     wait for the INT response period, then turn to the new end
    PASSING      the new end is too near for STP: come to rest after it first
    LAST         on the way to the new end, or no capture will change the path again

Captures are measured along the move from its start.
"""

from openacr.cmath import fabs
from openacr.kernel.axis.axis_cy import axis_offsets, axis_scale
from openacr.kernel.axis.capture_cy import capture_arm
from openacr.kernel.path.interrupt_cy import flag_state, master_cut, response_period
from openacr.kernel.path.path_cy import move_geometry, move_record, move_stop_rate
from openacr.kernel.path.plan_cy import master_plan
from openacr.kernel.profile.profile_cy import profile_reset, profile_stop
from openacr.kernel.profile.ramps_cy import STOPPING
from openacr.map.rows import axes, masters, moves, profiles
from openacr.map.words import af1
from openacr.views import F32, F64, I32

HSINT_NONE = 0
HSINT_SEARCHING = 1
HSINT_CAPTURED = 2
HSINT_PASSING = 3
HSINT_LAST = 4
ENDLESS_U = 1e30


def hsint_begin(F: F64, I: I32, m: int) -> None:
    """The move begins: clear its flags and arm the capture."""
    record: int = move_record(I, m)
    axis: int = I[moves.hsint_axis[record]] - 1
    I[af1.word[axis]] &= ~(af1.HSINT_REGISTERED | af1.HSINT_ABORTED)
    capture_arm(F, I, axis, I[moves.hsint_mode[record]])
    I[masters.hsint_phase[m]] = HSINT_SEARCHING


def hsint_step(F: F64, I: I32, S: F32, m: int) -> None:
    """Every tick of the move: abort flag, captures, and the turn to the new end."""
    record: int = move_record(I, m)
    axis: int = I[moves.hsint_axis[record]] - 1
    phase: int = I[masters.hsint_phase[m]]
    if phase == HSINT_SEARCHING:
        abort: int = I[moves.hsint_abort[record]]
        if abort and flag_state(I, abort):
            capture_arm(F, I, axis, -1)
            I[af1.word[axis]] |= af1.HSINT_ABORTED
            I[masters.hsint_phase[m]] = HSINT_LAST
            master_cut(F, I, S, m)
        elif I[af1.word[axis]] & af1.CAPTURE_COMPLETE:
            hsint_captured(F, I, m, record, axis)
    elif phase == HSINT_CAPTURED:
        I[masters.response[m]] -= 1
        if I[masters.response[m]] <= 0:
            hsint_turn(F, I, S, m, record, axis)


def hsint_captured(F: F64, I: I32, m: int, record: int, axis: int) -> None:
    """A capture: take it if it lies in the window, else wait for the next."""
    s: int = I[axes.slave[axis]]
    delta_cnt: float = F[moves.delta_cnt[record] + s]
    captured_cnt: float = F[axes.capture_cnt[axis]]
    travel_cnt: float = (
        captured_cnt - axis_offsets(F, axis) - (F[moves.target_cnt[record] + s] - delta_cnt)
    )
    if delta_cnt < 0.0:
        travel_cnt = -travel_cnt
    window_cnt: float = F[moves.hsint_window_cnt[record]]
    start_cnt: float = F[moves.hsint_start_cnt[record]]
    if window_cnt > 0.0 and not start_cnt <= travel_cnt <= start_cnt + window_cnt:
        capture_arm(F, I, axis, I[moves.hsint_mode[record]])
        return
    I[af1.word[axis]] |= af1.HSINT_REGISTERED
    I[masters.response[m]] = response_period(I, m)
    I[masters.hsint_phase[m]] = HSINT_LAST if I[masters.response[m]] < 0 else HSINT_CAPTURED


def hsint_turn(F: F64, I: I32, S: F32, m: int, record: int, axis: int) -> None:
    """Lead the move to its new end with the speed it has, or stop after it first."""
    s: int = I[axes.slave[axis]]
    rate_ups2: float = move_stop_rate(F, record)
    position_cnt: float = F[axes.position_cnt[axis]]
    distance_u: float = (hsint_end_cnt(F, record, axis) - position_cnt) / axis_scale(S, axis)
    travel_u: float = F[moves.delta_cnt[record] + s] / axis_scale(S, axis)
    if travel_u < 0.0:
        distance_u = -distance_u
    if travel_u != 0.0:
        distance_u = distance_u * F[moves.length_u[record]] / fabs(travel_u)
    velocity_ups: float = F[profiles.velocity[m]]
    accel_ups2: float = F[profiles.accel[m]]
    profile_stop(F, I, m, ENDLESS_U, rate_ups2, F[moves.jrk_ups3[record]], STOPPING)
    if F[profiles.end_distance[m]] - F[profiles.distance[m]] > distance_u * (1.0 + 1e-9):
        I[masters.hsint_phase[m]] = HSINT_PASSING
        return
    hsint_lead(F, I, S, m, record, axis)
    profile_reset(F, I, m, velocity_ups, accel_ups2)
    master_plan(F, I, S, m)


def hsint_end_cnt(F: F64, record: int, axis: int) -> float:
    """The new end in coordinated pulses: offsets take part in the captured position."""
    captured_cnt: float = F[axes.capture_cnt[axis]] - axis_offsets(F, axis)
    return captured_cnt + F[moves.hsint_distance_cnt[record]]


def hsint_lead(F: F64, I: I32, S: F32, m: int, record: int, axis: int) -> None:
    """Make the new end the target of the move, from where the axis is."""
    s: int = I[axes.slave[axis]]
    F[moves.target_cnt[record] + s] = hsint_end_cnt(F, record, axis)
    I[moves.relative[record]] = 0
    move_geometry(F, I, S, m)
    I[masters.hsint_phase[m]] = HSINT_LAST


def hsint_end(F: F64, I: I32, S: F32, m: int) -> bool:
    """The path has come to its end; True while it still has to return to the new end."""
    record: int = move_record(I, m)
    axis: int = I[moves.hsint_axis[record]] - 1
    phase: int = I[masters.hsint_phase[m]]
    if phase == HSINT_PASSING:
        hsint_lead(F, I, S, m, record, axis)
        profile_reset(F, I, m, 0.0, 0.0)
        master_plan(F, I, S, m)
        return True
    if phase == HSINT_SEARCHING:
        capture_arm(F, I, axis, -1)
    I[masters.hsint_phase[m]] = HSINT_NONE
    return False
