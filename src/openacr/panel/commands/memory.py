"""MEMORY CONFIG: how the memory of the card is divided among its programs."""

import re
from dataclasses import dataclass
from typing import Annotated

from msgspec import Meta

from openacr.client import Card, Level
from openacr.errors import UserError
from openacr.map.words import pf, plf
from openacr.panel.commands.registry import command
from openacr.panel.control.operator.presses import End
from openacr.panel.control.station import Station
from openacr.panel.helps import Page
from openacr.panel.roles import Role

DIMENSION = re.compile(r"DIM ((?:PROG|PLC)\d+)\((\d+)\)")
SHARED = frozenset(f"PROG{number}" for number in range(8))  # these have a share without DIM
Bytes = Annotated[int, Meta(ge=0, le=1 << 24)]


def _names(station: Station) -> list[str]:
    model = station.link.required.runner.settings.model
    programs = [f"PROG{number}" for number in range(model.programs)]
    return programs + [f"PLC{number}" for number in range(model.plcs)]


def _require_rest(station: Station) -> None:
    if station.interlocks.is_moved:
        raise UserError("the machine moves: the memory is shown and changed at rest only")


def _running(station: Station) -> list[str]:
    """What runs on the card beside the programs of this machine."""
    session = station.link.required
    settings = session.runner.settings
    own = {f"PROG{settings.master}", f"PROG{settings.watchdog_program}"}
    model = settings.model
    words = [pf.word[number] for number in range(model.programs)]
    words += [plf.word[number] for number in range(model.plcs)]
    found = zip(_names(station), session.machine.read_rows(words), strict=True)
    return [name for name, word in found if int(word) & pf.PROGRAM_RUNNING and name not in own]


def _divided(card: Card) -> dict[str, int]:
    lines = card.command("DIM")
    return {name: int(size) for name, size in DIMENSION.findall("\n".join(lines))}


@dataclass(frozen=True, slots=True)
class Found:
    """How the memory of the card is divided, what is free, and which programs run."""

    sizes: dict[str, int]
    free: int
    running: list[str]

    def data(self) -> dict[str, object]:
        """As the screen gets it."""
        return {"sizes": self.sizes, "free": self.free, "running": self.running}


def _found(station: Station) -> Found:
    _require_rest(station)
    card = station.link.required.card
    card.go(Level())
    found = _divided(card)
    free = int(card.command("MEM")[0])
    return Found({name: found.get(name, 0) for name in _names(station)}, free, _running(station))


@command("memory.read", Role.SETUP, needs_control=False)
def read(station: Station) -> dict[str, object]:
    """Read the bytes of every program and PLC program, and those that are free."""
    return _found(station).data()


@command(
    "memory.set",
    Role.SERVICE,
    page=Page(
        "memory",
        "MEMORY CONFIG",
        "The bytes of the card for each program and PLC program. A change loses what is stored in"
        " it, so it is refused while anything runs, and asks first.",
        de=(
            "SPEICHER",
            "Die Bytes der Karte für jedes Programm und SPS-Programm. Eine Änderung"
            " verliert, was darin gespeichert ist; deshalb wird sie abgelehnt, solange"
            " etwas läuft, und fragt vorher.",
        ),
    ),
)
def divide(
    station: Station, *, sizes: dict[str, Bytes], confirm: bool = False
) -> dict[str, object]:
    """Divide the memory of the card anew; what is stored in its programs is lost.

    `sizes`: bytes of programs and PLC programs by name, PROG0 or PLC3; 0: none.
    """
    before = _found(station)
    _check(sizes, before, confirm=confirm)
    wanted = {**before.sizes, **sizes}
    station.hand_motion.presses.end_all(End.MODE, "the memory of the card is divided")
    station.close()
    try:
        with Card.open(station.installation.target) as card:
            for line in ("SYS", "HALT ALL", "NEW ALL", "CLEAR"):
                card.command(line)
            for name, size in wanted.items():
                if size:
                    card.command(f"DIM {name}({size})")
    finally:
        station.open(station.now_s)
    return _found(station).data()


def _check(sizes: dict[str, int], before: Found, *, confirm: bool) -> None:
    """Refuse what is not possible before anything is lost."""
    if before.running:
        names = " and ".join(before.running)
        raise UserError(f"{names} of the card: running; halt it first")
    for name, size in sizes.items():
        if name not in before.sizes:
            raise UserError(f"{name}: the card has {', '.join(before.sizes)}")
        if not size and name in SHARED:
            raise UserError(f"{name} cannot be without memory: 1 byte at least")
    most = before.free + sum(before.sizes.values())
    total = sum({**before.sizes, **sizes}.values())
    if total > most:
        raise UserError(f"{total} bytes in all: the card has {most}")
    if not confirm:
        raise UserError("programs, PLC programs and variables on the card are lost: confirm it")
