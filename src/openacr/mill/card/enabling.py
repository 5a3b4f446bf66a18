"""Outputs before the first motion: drives enabled, inverted outputs set to their inactive level."""

from openacr.client.drives import ENABLE_S, Drive, read_drives
from openacr.client.errors import RefusedError
from openacr.cnc.occupied import FIRST_CUT, OUTPUTS_AT_REST
from openacr.errors import UserError
from openacr.mill.card.machine_io import MachineIo


def enable_drives(io: MachineIo) -> None:
    """Switch the drives on before motion: their enable output, and those that an E-stop cut.

    Axes may have been turned by hand meanwhile: their positions are taken over (REN). UserError
    where a drive stays off; the output stays on, since a drive may need its power for a while
    before it is ready.
    """
    number = io.settings.wiring.drive_enable
    if number in io.outputs and not io.is_on(number):
        io.machine.type(f"REN {axis.name}" for axis in io.settings.axes)
        io.output(number, True)
    _restore(io)


def _restore(io: MachineIo) -> None:
    """Switch on what the last emergency stop has switched off, as it is noted on the card."""
    machine = io.machine
    cut = machine.read_cut()
    names = {axis.index: axis.name for axis in io.settings.axes if axis.index in cut}
    if not names:
        return
    for axis, name in names.items():
        try:
            machine.type([f"AXIS{axis} DRIVE ON"])
        except RefusedError as refused:
            raise UserError(f"the drive of axis {name} stays off: {refused.message}") from refused

    def off() -> list[Drive]:
        drives = read_drives(machine.read_rows, list(names))
        return [drive for drive in drives if not drive.is_enabled]

    has_band = any(axis.excess_error_u > 0.0 for axis in io.settings.axes)

    def are_on() -> bool:
        return not off() and (not has_band or machine.poll().is_within_error)  # the former error

    if not machine.card.wait(are_on, timeout_s=ENABLE_S):
        for drive in off():
            why = "; ".join(drive.bars) or "the card does not say why"
            raise UserError(f"the drive of axis {names[drive.axis]} stays off: {why}")
    for axis in names:
        machine.set_flag(FIRST_CUT + axis, False)


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
