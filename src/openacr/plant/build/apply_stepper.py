"""Write stepper motors into the rows of the world (see `plant/physics/stepper_cy.py`)."""

import math

from openacr.map.memory import Memory
from openacr.map.rows import stepper_motors
from openacr.plant.describe.counts import count_of
from openacr.plant.describe.schema import Axis, StepperDrive

FULL_STEPS_OF_PITCH = 4


def write_stepper(memory: Memory, axis: Axis, drive: StepperDrive, accel_per_nm: float) -> None:
    """Write field, torque-speed curve and damping; the rotor is in step where it starts."""
    sign = axis.encoder_direction.sign
    pitch_cnt = FULL_STEPS_OF_PITCH * axis.counts / drive.full_steps_per_rev
    per_count = math.tau / pitch_cnt
    stiffness = math.sqrt(max(torque for _, torque in drive.torque_nm) * accel_per_nm * per_count)
    rows = {
        stepper_motors.counts_per_pulse: sign * axis.counts / drive.steps_per_rev,
        stepper_motors.field_cnt: count_of(axis, axis.initial),
        stepper_motors.radians_per_cnt: per_count,
        stepper_motors.stiffness_per_s: stiffness,
        stepper_motors.damping_per_s: 2.0 * drive.damping * stiffness,
    }
    for row, value in rows.items():
        memory.F[row[axis.number]] = value
    for point, (speed_rps, torque_nm) in enumerate(drive.torque_nm):
        memory.F[stepper_motors.speed_cps[axis.number] + point] = speed_rps * axis.counts
        memory.F[stepper_motors.accel[axis.number] + point] = torque_nm * accel_per_nm
    memory.I[stepper_motors.points[axis.number]] = len(drive.torque_nm)
