"""One servo period of the world outside the card.

For every modelled axis: digital-to-analog converter, drive, friction, hard stops, encoder,
marker; then the inputs that switches, regions of space and outputs drive.

**Sign.** A positive output voltage accelerates the motor in the direction in which its
encoder counts up. The servo's output is PGAIN * (setpoint - position), so turning an encoder
up by hand gives a negative voltage that drives it back: with positive MULT and DAC GAIN the
loop is stable; if one of them is negative, or the encoder counts in the other direction, the
axis runs away, as on the real machine.
"""

from openacr.cmath import fabs
from openacr.map import numbers as at
from openacr.map.rows import plant
from openacr.plant.physics.analog_cy import analogs_follow
from openacr.plant.physics.bus_motor_cy import bus_motor, reported_marker
from openacr.plant.physics.compliance_cy import flex, flexion, is_compliant
from openacr.plant.physics.drive_cy import (
    cache_motion_factors,
    clamp_accel,
    drive_ready,
    drive_volts,
    torque_drive,
    velocity_drive,
)
from openacr.plant.physics.exact_cy import exact_motor
from openacr.plant.physics.phases_cy import phase_volts
from openacr.plant.physics.stepper_cy import stepper_motor
from openacr.plant.physics.wiring_cy import (
    follow_outputs,
    marker_edges,
    motor_borders,
    read_boxes,
    write_wired_inputs,
)
from openacr.views import F32, F64, I32

__all__ = ["plant_refresh", "plant_step"]

NO_MOTOR = 0
TORQUE_DRIVE = 1
VELOCITY_DRIVE = 2
IDEAL_DRIVE = 3
PHASE_DRIVE = 4
STEPPER_DRIVE = 5
EXACT_DRIVE = 6
BUS_DRIVE = 7

# of encoder_fault
EDGES_LOST = 1
SIGNALS_LOST = 2
NO_ENCODER = 4
NO_SIGNALS = 6

NO_ACCEL_LIMIT = 1e30
SPEED_BOUND_CPS = 1e10  # keeps a runaway axis within what a double can count for days


def plant_step(F: F64, I: I32, S: F32, axis_count: int, dt: float) -> None:
    """Advance all motors by `dt` seconds and set the inputs they act on."""
    n: int = 0
    crossed: int = 0
    I[plant.rises] = 0
    I[plant.falls] = 0
    for n in range(axis_count):
        if I[at.PLI_BASE + n * at.PLI_STRIDE + at.PLI_KIND] != NO_MOTOR:
            crossed |= _motor_tick(F, I, S, n, dt)
    if crossed != 0:
        read_boxes(F, I)
    if I[plant.follows] != 0:
        follow_outputs(F, I, dt)
    if I[plant.analogs] != 0:
        analogs_follow(F, I, S)
    write_wired_inputs(I)


def plant_refresh(F: F64, I: I32, axis_count: int) -> None:
    """Set inputs and markers from the present positions, without motion and without edges."""
    n: int = 0
    for n in range(axis_count):
        F[at.PLF_BASE + n * at.PLF_STRIDE + at.PLF_PREVIOUS_CNT] = F[
            at.PLF_BASE + n * at.PLF_STRIDE + at.PLF_POSITION_CNT
        ]
        motor_borders(F, I, n)
    read_boxes(F, I)
    I[plant.rises] = 0
    I[plant.falls] = 0
    write_wired_inputs(I)


def _motor_tick(F: F64, I: I32, S: F32, n: int, dt: float) -> int:
    """Advance motor n; 1 if it passed the border of a switch, region or marker."""
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    i: int = at.PLI_BASE + n * at.PLI_STRIDE
    ready: int = drive_ready(I, i)
    position: float = F[f + at.PLF_POSITION_CNT]
    if F[f + at.PLF_CACHED_DT_S] != dt:
        cache_motion_factors(F, f, dt)
    F[f + at.PLF_PREVIOUS_CNT] = position
    kind: int = I[i + at.PLI_KIND]
    if kind == STEPPER_DRIVE:
        stepper_motor(F, I, n, ready, dt)
    elif kind == BUS_DRIVE:
        bus_motor(F, I, n)
    else:
        _driven_motor(F, I, S, n, ready, dt)
    _hard_stops(F, f)
    position = F[f + at.PLF_POSITION_CNT]
    # floor() without a call; no position is beyond the range of an integer
    whole: float = float(int(position))
    if whole > position:
        whole -= 1.0
    F[f + at.PLF_RAW_COUNT] = whole
    I[i + at.PLI_MARKER_EDGES] = reported_marker(I, n) if kind == BUS_DRIVE else 0
    if F[f + at.PLF_QUIET_LOW_CNT] <= position and position < F[f + at.PLF_QUIET_HIGH_CNT]:
        return 0
    if (I[i + at.PLI_ENCODER_FAULT] & NO_SIGNALS) == 0:
        marker_edges(F, I, f, i)
    motor_borders(F, I, n)
    return 1


def _analog_motor(F: F64, I: I32, S: F32, n: int, ready: int, dt: float) -> None:
    """Advance a motor whose drive takes voltages."""
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    i: int = at.PLI_BASE + n * at.PLI_STRIDE
    kind: int = I[i + at.PLI_KIND]
    if kind == PHASE_DRIVE:
        phase_volts(F, I, S, n)
    else:
        drive_volts(F, I, S, f, i)
    if kind == EXACT_DRIVE:
        exact_motor(F, I, n, ready)
    elif kind == IDEAL_DRIVE or (kind == VELOCITY_DRIVE and ready != 0):
        limit: float = NO_ACCEL_LIMIT
        if kind == VELOCITY_DRIVE:
            limit = F[f + at.PLF_PEAK_ACCEL]
        velocity_drive(F, f, ready * F[f + at.PLF_VOLTS], limit, dt)
    else:  # a velocity drive that is not ready lets its motor coast
        torque_drive(F, f, ready, dt)


def _driven_motor(F: F64, I: I32, S: F32, n: int, ready: int, dt: float) -> None:
    """Advance a motor; on an elastic shaft the centre of motor and load, and the motor about it."""
    f: int = at.PLF_BASE + n * at.PLF_STRIDE
    compliant: bool = is_compliant(F, n)
    velocity: float = F[f + at.PLF_VELOCITY_CPS]
    if compliant:
        F[f + at.PLF_POSITION_CNT] -= flexion(F, n)
    _analog_motor(F, I, S, n, ready, dt)
    if compliant:
        flex(F, n, ready, velocity, dt)
        F[f + at.PLF_POSITION_CNT] += flexion(F, n)


def _hard_stops(F: F64, f: int) -> None:
    """Hard stops take all the speed of an axis that runs into them."""
    v: float = F[f + at.PLF_VELOCITY_CPS]
    if F[f + at.PLF_POSITION_CNT] > F[f + at.PLF_HIGH_STOP_CNT]:
        F[f + at.PLF_POSITION_CNT] = F[f + at.PLF_HIGH_STOP_CNT]
        if v > 0.0:
            F[f + at.PLF_VELOCITY_CPS] = 0.0
    elif F[f + at.PLF_POSITION_CNT] < F[f + at.PLF_LOW_STOP_CNT]:
        F[f + at.PLF_POSITION_CNT] = F[f + at.PLF_LOW_STOP_CNT]
        if v < 0.0:
            F[f + at.PLF_VELOCITY_CPS] = 0.0
    elif fabs(v) > SPEED_BOUND_CPS:
        F[f + at.PLF_VELOCITY_CPS] = clamp_accel(v, SPEED_BOUND_CPS)
