"""How the axes of a card are attached to the masters of its programs: only read."""

import re
from dataclasses import dataclass

from openacr.client.effects import Op
from openacr.client.errors import RefusedError
from openacr.client.requests import Level
from openacr.client.talk import Talk

PROGRAMS = 16
_MASTER = re.compile(r"ATTACH MASTER(\d+)")
_SLAVE = re.compile(r'ATTACH SLAVE(\d+) AXIS(\d+) "(.*)"')


@dataclass(frozen=True, slots=True)
class Attached:
    """One axis of a master, as the card lists it."""

    master: int
    slave: int
    axis: int
    name: str


def attached(talk: Talk) -> Op[list[Attached]]:
    """The axes of all masters; none of a card that does not list them."""
    home = talk.level
    found = []
    for program in range(PROGRAMS):
        try:
            lines = yield from talk.query("ATTACH", at=Level.program(program))
        except RefusedError:  # it has no memory, or the card does not list them
            continue
        masters = [int(each[1]) for each in map(_MASTER.match, lines) if each]
        for slave in filter(None, map(_SLAVE.match, lines)):
            found.append(Attached(masters[0], int(slave[1]), int(slave[2]), slave[3]))
    yield from talk.go(home)
    return found
