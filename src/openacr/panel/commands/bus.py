"""Commands of the bus of a machine."""

from openacr.errors import UserError
from openacr.panel.commands.registry import command
from openacr.panel.control.machine.installation import Installation
from openacr.panel.roles import Role


@command("bus.reset", Role.SERVICE, en="RESET COUNTERS", de="ZÄHLER AUF 0")
def reset_counters(installation: Installation) -> None:
    """Let the counters of the frames of the bus begin at 0."""
    if installation.bus is None:
        raise UserError("the panel has opened no bus: openacr panel PROJECT --real")
    installation.bus.reset_counters()
