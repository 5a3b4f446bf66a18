"""How the axes of a card are attached, beside what AcroMill would attach: only read."""

import re
from dataclasses import dataclass

from openacr.client import Card
from openacr.client.errors import RefusedError
from openacr.mill.config.settings import Settings

MASTERS = 8
_SLAVE = re.compile(r'ATTACH SLAVE(\d+) AXIS(\d+) "(.*)"')


@dataclass(frozen=True, slots=True)
class Attached:
    """One axis of a master, as the card lists it."""

    master: int
    slave: int
    axis: int
    name: str


def attached(card: Card) -> list[Attached]:
    """The axes of all masters; none of a card that does not list them."""
    found = []
    for master in range(MASTERS):
        try:
            lines = card.command("ATTACH", program=master)
        except RefusedError:
            break  # a card with fewer programs, or one that does not list them
        for slave in filter(None, map(_SLAVE.match, lines)):
            found.append(Attached(master, int(slave[1]), int(slave[2]), slave[3]))
    return found


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
