"""A machine with one torque drive, for tests of servo tuning."""

from openacr.map.memory import Memory
from openacr.map.rows import motors
from openacr.plant.apply import apply_world
from openacr.plant.load import parse_world
from openacr.tuning.motor import Motor


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


def true_motor(world: str) -> Motor:
    """The motor of axis 1 as the world is given it."""
    memory = Memory()
    apply_world(parse_world(world), memory)
    places = (motors.accel_per_volt, motors.viscous_per_s, motors.coulomb_accel, motors.offset_v)
    return Motor(*(memory.F[place[AXIS]] for place in places))
