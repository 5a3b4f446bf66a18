"""Where a debugged card stops: lines, changed values, errors."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import StrEnum

from openacr.controller.controller import Controller
from openacr.debugger.stops import Stop
from openacr.engine.watches import Watch, Watched, parameter_place
from openacr.errors import UserError
from openacr.map import numbers as at
from openacr.map.memory import flag_place
from openacr.map.words import mf1, pf

MASTERS = 16
_NAME = re.compile(r"\s*(P|BIT)\s*(\d+)\s*", re.IGNORECASE)


@dataclass(slots=True)
class LineBreakpoint:
    """Stops before a line of a program, or after a scan that changes a coil of a line of a PLC.

    `condition` is an expression of AcroBASIC that must not be 0; `hits` the count from which on
    it stops; with `log`, it prints that text and does not stop.
    """

    program: int
    line: int
    condition: str = ""
    hits: int = 1
    log: str = ""
    met: int = 0


@dataclass(frozen=True, slots=True)
class DataBreakpoint:
    """Stops after the tick in which a parameter or flag changes; `condition` as of a line."""

    name: str
    condition: str = ""

    def watches(self, card: Controller) -> list[Watch]:
        """What the engine watches for it; UserError if there is no such value."""
        return list(watches_of(card, self.name))


def watches_of(card: Controller, name: str) -> Iterator[Watch]:
    """Watches for any change of `P<number>` or `BIT<number>`; UserError for anything else."""
    found = _NAME.fullmatch(name)
    if found is None:
        raise UserError(f"{name}: a value to be watched is a parameter (P12288) or flag (BIT516)")
    number = int(found[2])
    if found[1].upper() == "BIT":
        if number > at.FLAG_LAST:
            raise UserError(f"{name}: the last flag is BIT{at.FLAG_LAST}")
        word, mask = flag_place(number)
        yield Watch(Watched.WORD, word, mask)
        return
    place = parameter_place(card.memory, number)
    if place is None:
        raise UserError(f"{name}: there is no such parameter (`openacr param` lists them)")
    kind, row = place
    if kind is Watched.FP64:  # its bits are two words
        yield Watch(Watched.WORD, 2 * row)
        yield Watch(Watched.WORD, 2 * row + 1)
    else:
        yield Watch(Watched.WORD, row)


class Fault(StrEnum):
    """Faults that can stop a debugged card."""

    PROGRAM = "program-error"
    KILL = "motion-killed"


Meaning = Callable[[], Stop | None]  # of a watch that has fired: the stop, if it is one


@dataclass(slots=True)
class Watching:
    """All watches of a debugged card, and what each one means."""

    watches: list[Watch] = field(default_factory=list)
    meanings: list[Meaning] = field(default_factory=list)

    def add(self, watches: list[Watch], meaning: Meaning) -> None:
        """Watch for one more thing."""
        self.watches += watches
        self.meanings += [meaning] * len(watches)


def running_watch(program: int) -> Watch:
    """Fires when a program starts or ends."""
    return Watch(Watched.WORD, pf.word[program], pf.PROGRAM_RUNNING)


def kill_watch(master: int) -> Watch:
    """Fires when all motion of a master is killed, or the kill is cleared."""
    return Watch(Watched.WORD, mf1.word[master], mf1.KILL_ALL_MOVES_REQUEST)
