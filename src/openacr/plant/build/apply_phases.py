"""Write the motors that a commutator of the card drives (see `plant/physics/phases_cy.py`)."""

import math

from openacr.map.memory import Memory
from openacr.map.rows import phases as phase_rows
from openacr.plant.describe.schema import Axis, Motor, PhaseDrive


def write_phases(memory: Memory, axis: Axis, drive: PhaseDrive) -> None:
    """Write the electrical angle of a rotor against the count of its encoder.

    The axis starts in the middle of count 0; the angle follows the motor, whatever the
    counting direction of its encoder.
    """
    turn, zero, phases = _rotor(axis.motor)
    sign = axis.encoder_direction.sign
    at_start = math.fmod(zero + turn * axis.initial / axis.units_per_rev, math.tau)
    per_count = sign * turn / axis.counts
    number = axis.number
    memory.F[phase_rows.radians_per_cnt[number]] = per_count
    memory.F[phase_rows.zero_rad[number]] = at_start - 0.5 * per_count
    memory.F[phase_rows.peak_v[number]] = drive.peak_amps / drive.amps_per_volt
    memory.I[phase_rows.second_dac[number]] = drive.dacs[1]
    memory.I[phase_rows.phases[number]] = phases


def _rotor(motor: Motor | None) -> tuple[float, float, int]:
    """Electrical radians of a turn and at position 0, number of phases."""
    if motor is None or motor.pole_pairs is None:
        raise ValueError("a motor with phases has pole_pairs")
    return math.tau * motor.pole_pairs, math.radians(motor.electrical_zero_deg), motor.phases
