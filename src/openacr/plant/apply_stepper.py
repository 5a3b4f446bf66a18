"""Write stepper motors into the rows of the world (see `plant/stepper_cy.py`)."""

import math

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import stepper_motors
from openacr.plant.counts import count_of
from openacr.plant.schema import Axis, Direction, StepperDrive

FULL_STEPS_OF_PITCH = 4


def write_stepper(memory: Memory, axis: Axis, drive: StepperDrive, accel_per_nm: float) -> None:
    """Write field, torque-speed curve and damping; the rotor is in step where it starts."""
    sign = 1 if axis.encoder_direction is Direction.UP else -1
    pitch_cnt = FULL_STEPS_OF_PITCH * axis.counts / drive.full_steps_per_rev
    per_count = math.tau / pitch_cnt
    stiffness = math.sqrt(max(torque for _, torque in drive.torque_nm) * accel_per_nm * per_count)
    base = at.PLTF_BASE + axis.number * at.PLTF_STRIDE
    rows = {
        at.PLTF_COUNTS_PER_PULSE: sign * axis.counts / drive.steps_per_rev,
        at.PLTF_FIELD_CNT: count_of(axis, axis.initial),
        at.PLTF_RADIANS_PER_CNT: per_count,
        at.PLTF_STIFFNESS_PER_S: stiffness,
        at.PLTF_DAMPING_PER_S: 2.0 * drive.damping * stiffness,
    }
    for point, (speed_rps, torque_nm) in enumerate(drive.torque_nm):
        rows[at.PLTF_SPEED_CPS + point] = speed_rps * axis.counts
        rows[at.PLTF_ACCEL + point] = torque_nm * accel_per_nm
    for row, value in rows.items():
        memory.F[base + row] = value
    memory.I[stepper_motors.points[axis.number]] = len(drive.torque_nm)
