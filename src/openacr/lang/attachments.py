"""What a card answers to ATTACH at a program: its master, and the axes of the master."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

_MASTER = re.compile(r"ATTACH MASTER(\d+)")
_SLAVE = re.compile(r'ATTACH SLAVE(\d+) AXIS(\d+) "(.*)"')


@dataclass(frozen=True, slots=True)
class Attached:
    """One axis of a master, as the card lists it."""

    master: int
    slave: int
    axis: int
    name: str
    program: int | None = field(default=None, compare=False)  # that has listed it


def attachments(lines: Iterable[str]) -> tuple[int | None, list[Attached]]:
    """The master of a program, None without one, and its axes in the order of the answer."""
    answer = list(lines)
    masters = [int(found[1]) for found in map(_MASTER.match, answer) if found]
    if not masters:
        return None, []
    slaves = filter(None, map(_SLAVE.match, answer))
    return masters[0], [
        Attached(masters[0], int(found[1]), int(found[2]), found[3]) for found in slaves
    ]
