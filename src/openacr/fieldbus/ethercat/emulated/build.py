"""The emulated segment of a machine: a drive for each motor, terminals after them."""

from openacr.errors import UserError
from openacr.fieldbus.ethercat.emulated.drive import Drive
from openacr.fieldbus.ethercat.emulated.motor import Motor, Plant
from openacr.fieldbus.ethercat.emulated.segment import Segment
from openacr.fieldbus.ethercat.emulated.slave import Slave
from openacr.fieldbus.ethercat.emulated.terminals import Analog, Digital
from openacr.plant.describe.schema import AXES, Axis, Load, TorqueDrive, World
from openacr.plant.describe.schema import Motor as MotorTable

COUNTS = 131_072  # of an encoder of 17 bits


def drives_world(count: int) -> World:
    """A machine of equal motors; UserError beyond sixteen."""
    if not 0 <= count <= AXES:
        raise UserError(f"{count} drives: a segment has 0 to {AXES}")
    motor = MotorTable(inertia_kgm2=2.0e-5, torque_nm_per_a=0.1)
    drive = TorqueDrive(amps_per_volt=2.0, peak_amps=18.0)
    load = Load(inertia_kgm2=2.0e-5, viscous_nms=5.0e-5, coulomb_nm=0.01)
    return World(
        axis=tuple(
            Axis(
                number=number,
                name=f"axis{number}",
                counts_per_rev=COUNTS,
                units="rev",
                marker=0.0,
                motor=motor,
                load=load,
                drive=drive,
            )
            for number in range(count)
        )
    )


def segment_of(world: World, digital: int = 0, analog: int = 0) -> Segment:
    """A drive for each motor in the order of the file, then terminals.

    A digital terminal has 8 inputs and 8 outputs, an analog one 4 and 4. UserError for a motor
    whose drive has no counterpart on a bus.
    """
    plant = Plant(world)
    slaves: list[Slave] = [
        Drive(Motor(plant, axis), axis.name or f"axis{axis.number}") for axis in world.axis
    ]
    slaves += [Digital(8, 8) for _ in range(digital)]
    slaves += [Analog(4, 4) for _ in range(analog)]
    return Segment(slaves, plant)
