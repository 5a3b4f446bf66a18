"""Requests of a host to one stream of a card, and their answers."""

import re
from typing import Self, TypeAlias

from msgspec import Struct

from openacr.protocol.events import ControlKey
from openacr.protocol.packets import Packet

_PROMPT = re.compile(r"(SYS|P|PLC)(\d*)>")
_GO = re.compile(r"\s*(SYS|PROG|PLC)\s*(\d*)\s*", re.IGNORECASE)


class Level(Struct, frozen=True):
    """The level of a stream: the system, a program or a PLC."""

    word: str = "SYS"
    number: int = 0

    @classmethod
    def program(cls, number: int) -> Self:
        """The level of a program."""
        return cls("PROG", number)

    @classmethod
    def plc(cls, number: int) -> Self:
        """The level of a PLC."""
        return cls("PLC", number)

    @classmethod
    def of_prompt(cls, text: str) -> Self | None:
        """The level named by a prompt."""
        found = _PROMPT.fullmatch(text)
        if found is None:
            return None
        return cls("PROG" if found[1] == "P" else found[1], int(found[2] or 0))

    @classmethod
    def of_line(cls, line: str) -> Self | None:
        """The level a line changes to; None for any other line."""
        found = _GO.fullmatch(line)
        return cls(found[1].upper(), int(found[2] or 0)) if found else None

    def __str__(self) -> str:
        return self.word if self.word == "SYS" else f"{self.word}{self.number}"


SYS = Level()


class Line(Struct, frozen=True):
    """A line of text; `is_query`: it changes nothing, so it may be sent again."""

    text: str
    is_query: bool = False

    def __str__(self) -> str:
        return self.text


class Ask(Struct, frozen=True):
    """Packets that the card answers, sent together and answered in order."""

    packets: tuple[Packet, ...]
    is_query: bool = True

    def __str__(self) -> str:
        return ", ".join(map(str, self.packets))


class Press(Struct, frozen=True):
    """Ctrl-X, Ctrl-Y or Ctrl-Z: acts at once and is not answered."""

    key: ControlKey
    is_query: bool = False

    def __str__(self) -> str:
        return self.key.name.replace("_", "-").title()


class Follow(Struct, frozen=True):
    """LISTEN or LRUN: follow the output of a program until it ends or ESC is sent."""

    text: str
    is_query: bool = False

    def __str__(self) -> str:
        return self.text


class Leave(Struct, frozen=True):
    """ESC: stop listening; the prompt returns."""

    is_query: bool = False

    def __str__(self) -> str:
        return "ESC"


class Align(Struct, frozen=True):
    """Bring the stream from any state to the SYS level and a known ECHO mode."""

    is_query: bool = True

    def __str__(self) -> str:
        return "the greeting of the client"


Request: TypeAlias = Line | Ask | Press | Follow | Leave | Align


class Answer(Struct, frozen=True):
    """The answer to a completed request: lines of text or packet data."""

    lines: tuple[str, ...] = ()
    data: bytes = b""
    is_garbled: bool = False
    raw: bytes = b""  # the bytes of a garbled answer


class Heard(Struct, frozen=True):
    """Text printed by a followed program."""

    text: str
