"""The outputs of a machine before it moves: drives enabled, inverted outputs put to rest."""

from openacr.cnc.occupied import OUTPUTS_AT_REST
from openacr.mill.card.machine_io import MachineIo


def enable_drives(io: MachineIo) -> None:
    """Switch the drive enable output on, before the first motion after it was off.

    Axes may have been turned by hand meanwhile: they stay where they are (REN).
    """
    number = io.settings.wiring.drive_enable
    if number not in io.outputs or io.is_on(number):
        return
    io.machine.type(f"REN {axis.name}" for axis in io.settings.axes)
    io.output(number, True)


def rest_outputs(io: MachineIo) -> None:
    """Put inverted outputs to rest, once after the card came on.

    All outputs are off then, so those that act while they are off act.
    """
    machine = io.machine
    if machine.card.read_bit(OUTPUTS_AT_REST):
        return
    for number in sorted(io.outputs):
        if io.settings.is_output_inverted(number):
            io.output(number, False)
    machine.set_flag(OUTPUTS_AT_REST, True)
