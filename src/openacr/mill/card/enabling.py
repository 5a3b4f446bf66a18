"""Outputs before the first motion: drives enabled, inverted outputs set to their inactive level."""

from openacr.cnc.occupied import OUTPUTS_AT_REST
from openacr.mill.card.machine_io import MachineIo


def enable_drives(io: MachineIo) -> None:
    """Switch the drive enable output on before motion, if it is off.

    Axes may have been turned by hand meanwhile: their positions are taken over (REN).
    """
    number = io.settings.wiring.drive_enable
    if number not in io.outputs or io.is_on(number):
        return
    io.machine.type(f"REN {axis.name}" for axis in io.settings.axes)
    io.output(number, True)


def rest_outputs(io: MachineIo) -> None:
    """Set inverted outputs to their inactive level, once after power-on of the card.

    All outputs are off at power-on, so inverted outputs would be active.
    """
    machine = io.machine
    if machine.card.read_bit(OUTPUTS_AT_REST):
        return
    for number in sorted(io.outputs):
        if io.settings.is_output_inverted(number):
            io.output(number, False)
    machine.set_flag(OUTPUTS_AT_REST, True)
