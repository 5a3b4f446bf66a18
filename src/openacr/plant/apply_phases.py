"""Write the motors that a commutator of the card drives (see `plant/phases_cy.py`)."""

import math

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.plant.schema import Axis, Direction, Motor, PhaseDrive


def write_phases(memory: Memory, axis: Axis, drive: PhaseDrive) -> None:
    """Write the electrical angle of a rotor against the count of its encoder.

    The axis starts in the middle of count 0; the angle follows the motor, whatever the
    counting direction of its encoder.
    """
    turn, zero, phases = _rotor(axis.motor)
    sign = 1 if axis.encoder_direction is Direction.UP else -1
    at_start = math.fmod(zero + turn * axis.initial / axis.units_per_rev, math.tau)
    per_count = sign * turn / axis.counts
    base = at.PLBF_BASE + axis.number * at.PLBF_STRIDE
    memory.F[base + at.PLBF_RADIANS_PER_CNT] = per_count
    memory.F[base + at.PLBF_ZERO_RAD] = at_start - 0.5 * per_count
    memory.F[base + at.PLBF_PEAK_V] = drive.peak_amps / drive.amps_per_volt
    base = at.PLBI_BASE + axis.number * at.PLBI_STRIDE
    memory.I[base + at.PLBI_SECOND_DAC] = drive.dacs[1]
    memory.I[base + at.PLBI_PHASES] = phases


def _rotor(motor: Motor | None) -> tuple[float, float, int]:
    """Electrical radians of a turn and at position 0, number of phases."""
    if motor is None or motor.pole_pairs is None:
        raise ValueError("a motor with phases has pole_pairs")
    return math.tau * motor.pole_pairs, math.radians(motor.electrical_zero_deg), motor.phases
