"""Commands of the drives of any axis of the card: on, off, reset."""

from openacr.client.drives import MEI_RESET
from openacr.errors import UserError
from openacr.panel.commands.registry import command
from openacr.panel.control.engineer.drives import Drives
from openacr.panel.control.interlocks import Interlocks
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.operator.orders import LATER, Later, Order, answer_with
from openacr.panel.roles import Role


@command("drive.on", Role.SETUP, is_motion=True, en="DRIVE ON", de="ANTRIEB EIN")
def drive_on(
    order: Order,
    drives: Drives,
    interlocks: Interlocks,
    installation: Installation,
    now_s: float,
    *,
    axis: str,
) -> Later:
    """Switch the drive of an axis on and take its position over; what bars it is named.

    Kills and latches of the axis are lifted, as by DRIVE ON of the card. Answered once it is on.
    """
    index = installation.axis(axis)
    if interlocks.is_moved:
        raise UserError("the panel moves the machine: drives are switched on at rest")
    answer_with(order, drives.on(index, now_s), lambda _on: {"axis": axis})
    return LATER


@command("drive.off", en="DRIVE OFF", de="ANTRIEB AUS")
def drive_off(drives: Drives, installation: Installation, *, axis: str) -> dict[str, str]:
    """Switch the drive of an axis off, at rest; `stop.drives` switches all off, moving or not."""
    drives.off(installation.axis(axis))
    return {"axis": axis}


@command("drive.reset", Role.SETUP, en="RESET DRIVE", de="ANTRIEB RÜCKSETZEN")
def drive_reset(drives: Drives, installation: Installation, *, axis: str) -> dict[str, str]:
    """Reset the drive of an axis: its fault clears, and the latch of the Motion Enable Input."""
    drives.reset(installation.axis(axis), MEI_RESET)
    return {"axis": axis}
