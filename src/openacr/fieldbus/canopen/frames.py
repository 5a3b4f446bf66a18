"""Frames of CANopen (CiA 301): which identifier means what, and the commands to all nodes."""

from collections.abc import Collection
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

HIGHEST_NODE = 127
OF_A_NODE = 0x7F  # bits of an identifier that name the node
STATE = 0x7F  # bits of a health report: the state, without the toggle bit
OFF, WARNING = 256, 96  # error counters of a controller


class Cob(IntEnum):
    """Identifiers; those of a node have its number added."""

    NMT = 0x000
    SYNC = 0x080
    EMERGENCY = 0x080
    INPUTS = 0x180  # the first of four, 0x100 apart
    OUTPUTS = 0x200
    SDO_ANSWER = 0x580
    SDO = 0x600
    FREE = 0x680  # to FREE_LAST: for process data beyond the first four of a node
    FREE_LAST = 0x6DF
    HEALTH = 0x700


class Nmt(IntEnum):
    """Commands that change the state of nodes."""

    START = 0x01
    STOP = 0x02
    PRE_OPERATIONAL = 0x80
    RESET = 0x81


class NodeState(IntEnum):
    """The state a node reports."""

    BOOT = 0x00
    STOPPED = 0x04
    OPERATIONAL = 0x05
    PRE_OPERATIONAL = 0x7F


@dataclass(frozen=True, slots=True)
class Frame:
    """A frame with an identifier of 11 bits."""

    id: int
    data: bytes = b""
    is_remote: bool = False


@dataclass(frozen=True, slots=True)
class Trouble:
    """What has gone wrong on a bus: frames lost on their way to the program, error counter."""

    lost: int = 0
    is_overrun: bool = False  # frames were lost in the controller
    errors: int = 0
    failure: str = ""  # why nothing can be sent or received, "" while that is possible


class Link(Protocol):
    """A CAN bus. No call waits."""

    name: str
    bit_rate: int  # kbit/s

    def send(self, frame: Frame) -> bool:
        """Send a frame; False if the bus does not take it."""

    def take(self) -> list[Frame]:
        """All frames that have arrived since the last call, the oldest first."""

    def listen(self, identifiers: Collection[int] | None) -> None:
        """Leave out frames with other identifiers, where the bus can; None: take all."""

    def trouble(self) -> Trouble:
        """What has gone wrong since the last call."""

    def reopen(self) -> str:
        """Begin anew after a failure; why that is not possible, "" if it is."""

    def now_s(self) -> float:
        """Seconds of a clock that never goes back."""


def nmt(command: Nmt, node: int = 0) -> Frame:
    """A command to one node, or to all (0)."""
    return Frame(Cob.NMT, bytes((command, node)))
