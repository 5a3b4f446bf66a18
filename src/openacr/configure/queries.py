"""Questions to a card about its set-up: lines that any card of the family answers."""

import re
from collections.abc import Iterable, Iterator
from typing import Protocol

from openacr.basic import commands as _registered  # noqa: F401 - fills the registry
from openacr.basic.language.grammar import AxisGroups, AxisList, AxisPairs, AxisValues, Num
from openacr.basic.language.registry import BY_OBJECT, commands
from openacr.controller import Controller
from openacr.lang.attachments import attachments

PROGRAMS = range(16)
_AXIS = re.compile(r"ATTACH AXIS(\d+) ENC(\d+) DAC(\d+)\b")
_PROGRAM = re.compile(r"DIM PROG(\d+)\((\d+)\)")
_PLC = re.compile(r"DIM PLC(\d+)\(")


class Card(Protocol):
    """A card that answers: one over a link, or a virtual one."""

    def command(self, line: str, *, program: int | None = None) -> list[str]:
        """Type a line at SYS or at a program; the lines of its answer, none if it is refused."""

    def read(self, what: int) -> float:
        """Read a parameter."""

    def read_bit(self, what: int) -> bool:
        """Read a flag."""


def axis_words() -> Iterator[str]:
    """The settings of an axis that ESAVE keeps, as words that show them without a value."""
    return _words(AxisValues, AxisPairs, AxisGroups, AxisList)


def master_words() -> Iterator[str]:
    """The same of a master."""
    return _words(Num)


def _words(*forms: type) -> Iterator[str]:
    for each in commands():
        if each.saved and each.levels == BY_OBJECT and isinstance(each.grammar[0], forms):
            yield each.name


def answer(card: Card, line: str, program: int | None = None) -> str:
    """The answer to a query in one line, empty if the card does not know it."""
    return " ".join(card.command(line, program=program)).strip()


def numbers(card: Card, line: str, program: int | None = None) -> list[float]:
    """The numbers of an answer, which commas separate."""
    return [float(part) for part in answer(card, line, program).split(",")]


def attached_axes(card: Card) -> dict[int, tuple[int, int]]:
    """Encoder and analog output of every axis that has both."""
    found = map(_AXIS.match, card.command("ATTACH"))
    return {int(each[1]): (int(each[2]), int(each[3])) for each in found if each}


def attached_master(card: Card, program: int) -> tuple[int | None, dict[str, int]]:
    """The master of a program, and its axes by name in the order of its slaves."""
    master, slaves = attachments(card.command("ATTACH", program=program))
    return master, {each.name: each.axis for each in slaves}


def dimensioned_plcs(card: Card) -> list[int]:
    """The PLCs that have memory."""
    return [int(each[1]) for each in map(_PLC.match, card.command("DIM")) if each]


def program_bytes(card: Card, program: int) -> int:
    """The memory of a program, 0 without any."""
    found = (_PROGRAM.match(line) for line in card.command("DIM"))
    return next((int(each[2]) for each in found if each and int(each[1]) == program), 0)


class Virtual:
    """A virtual card as one that answers."""

    def __init__(self, card: Controller) -> None:
        self._card = card
        card.send("ECHO 4\r")  # answers alone, neither echo nor prompt

    def command(self, line: str, *, program: int | None = None) -> list[str]:
        """Type a line and return what the card has printed."""
        self._card.ask("SYS\r" if program is None else f"PROG{program}\r")
        return self._card.ask(f"{line}\r").splitlines()

    def type(self, lines: Iterable[str]) -> None:
        """Type the lines of a file, which change the level themselves."""
        for line in lines:
            self._card.send(f"{line}\r")

    def read(self, what: int) -> float:
        """Read a parameter."""
        return self._card.p[what]

    def read_bit(self, what: int) -> bool:
        """Read a flag."""
        return self._card.bit[what]
