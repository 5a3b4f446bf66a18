"""The outputs of a machine before it moves: drives enabled, inverted outputs put to rest."""

from openacr.cnc.occupied import OUTPUTS_AT_REST
from openacr.mill.panel import Panel


def enable_drives(panel: Panel) -> None:
    """Switch the drive enable output on, before the first motion after it was off.

    Axes may have been turned by hand meanwhile: they stay where they are (REN).
    """
    number = panel.settings.wiring.drive_enable
    if number not in panel.outputs or panel.is_on(number):
        return
    panel.machine.type(f"REN {axis.name}" for axis in panel.settings.axes)
    panel.output(number, True)


def rest_outputs(panel: Panel) -> None:
    """Put inverted outputs to rest, once after the card came on.

    All outputs are off then, so those that act while they are off act.
    """
    machine = panel.machine
    if machine.card.read_bit(OUTPUTS_AT_REST):
        return
    for number in sorted(panel.outputs):
        if panel.settings.is_output_inverted(number):
            panel.output(number, False)
    machine.set_flag(OUTPUTS_AT_REST, True)
