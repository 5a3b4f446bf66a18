"""What of AcroMill's axes is not attached on a card as it needs them."""

from openacr.lang.attachments import Attached
from openacr.mill.config.settings import Settings


def lacking(there: list[Attached], settings: Settings) -> str:
    """Which of AcroMill's axes are not attached as it needs them, and what they are instead."""
    missing, instead = [], []
    for axis in settings.axes:
        if Attached(settings.master, axis.index, axis.index, axis.name) in there:
            continue
        missing.append(axis.name)
        instead += [
            f"{axis.name} is AXIS{each.axis} of MASTER{each.master}"
            for each in there
            if each.name == axis.name
        ] or [f"no axis is named {axis.name}"]
    if not missing:
        return "AcroMill has not set this card up: its axes are attached, its settings not sent"
    axes = f"axis {missing[0]} is" if len(missing) == 1 else f"axes {' '.join(missing)} are"
    return f"AcroMill's {axes} not attached on this card: {', '.join(instead)}"
