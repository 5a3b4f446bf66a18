"""A machine with one torque drive, for tests of servo tuning."""

import math

from openacr.map.memory import Memory
from openacr.map.rows import compliant_loads, motors
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.load import parse_world
from openacr.tuning.motor import Motor
from openacr.tuning.shaft import Shaft


def axis_text(number: int) -> str:
    """A machine file with this axis; its last table is that of the drive."""
    return f"""[[axis]]
number = {number}
encoder_lines = 1000
[axis.motor]
inertia_kgm2 = 2.0e-5
torque_nm_per_a = 0.0771
[axis.load]
inertia_kgm2 = 1.0e-5
viscous_nms = 1.5e-4
coulomb_nm = 0.008
[axis.drive]
mode = "torque"
amps_per_volt = 2.0
peak_amps = 30.0
"""


AXIS = 1
WORLD = axis_text(AXIS)


def elastic(resonance_hz: float, damping_ratio: float, number: int = AXIS) -> str:
    """A machine file with this axis, whose load of half the inertia is on an elastic shaft."""
    spring = f"resonance_hz = {resonance_hz}\ndamping_ratio = {damping_ratio}\n"
    return axis_text(number).replace("viscous_nms", spring + "viscous_nms")


def true_motor(world: str, axis: int = AXIS) -> Motor:
    """The motor of an axis as the world is given it."""
    memory = Memory()
    apply_world(parse_world(world), memory)
    places = (motors.accel_per_volt, motors.viscous_per_s, motors.coulomb_accel, motors.offset_v)
    accel, rate, friction, offset_v = (memory.F[place[axis]] for place in places)
    return Motor(accel, rate, friction, offset_v, shaft=_shaft(memory, axis))


def _shaft(memory: Memory, axis: int) -> Shaft | None:
    resonance_rad_s = memory.F[compliant_loads.resonance_rad_s[axis]]
    if resonance_rad_s == 0.0:
        return None
    return Shaft(
        resonance_rad_s / (2.0 * math.pi),
        memory.F[compliant_loads.damping_per_s[axis]] / resonance_rad_s,
        memory.F[compliant_loads.inertia_ratio[axis]],
    )
