"""Events that a stream of a card decodes from received bytes."""

from enum import Enum, IntEnum
from typing import Final, TypeAlias

from msgspec import Struct

from openacr.protocol.packets import Packet


class ControlKey(IntEnum):
    """Keys that act on the whole card the moment they arrive."""

    CTRL_X = 0x18  # stop programs, kill all motion
    CTRL_Y = 0x19  # clear the kill flags
    CTRL_Z = 0x1A  # as Ctrl-X, then drives off


class ReceivedLine(Struct, frozen=True):
    """A complete line for the command interpreter, without its end."""

    text: str


class LineTooLong(Struct, frozen=True):
    """A line of more than 255 characters ended; it was discarded."""


class Typed(Struct, frozen=True):
    """One byte for the program or device that currently reads the stream."""

    byte: int


class Control(Struct, frozen=True):
    """Ctrl-X, Ctrl-Y or Ctrl-Z."""

    code: ControlKey


class Escape(Struct, frozen=True):
    """ESC while listening or passing through: end it, send CR LF and one prompt."""


class Received(Struct, frozen=True):
    """A complete binary packet."""

    packet: Packet


class NeedData(Enum):
    """Returned when all received bytes are used up."""

    NEED_DATA = "need data"


NEED_DATA: Final = NeedData.NEED_DATA
Event: TypeAlias = ReceivedLine | LineTooLong | Typed | Control | Escape | Received
