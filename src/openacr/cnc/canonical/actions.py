"""Canonical actions: what happens between moves, and where a program stops or ends."""

import math
from dataclasses import dataclass
from enum import Enum

from openacr.cnc.canonical.common import Point, Source


class Spin(Enum):
    """What the spindle does."""

    CLOCKWISE = 3
    COUNTER_CLOCKWISE = 4
    OFF = 5


@dataclass(frozen=True, slots=True)
class Dwell:
    """Rest for some seconds."""

    source: Source
    seconds: float


@dataclass(frozen=True, slots=True)
class Spindle:
    """M3, M4, M5 with the speed that holds then."""

    source: Source
    spin: Spin
    rpm: float
    is_awaited: bool = True  # with the handshake; a new S alone has none


@dataclass(frozen=True, slots=True)
class Orient:
    """Stop the spindle at its angle, or let it go again."""

    source: Source
    is_on: bool


@dataclass(frozen=True, slots=True)
class Tapping:
    """A tap is about to enter its hole, or is out of it again: no feed hold in between."""

    source: Source
    is_on: bool


@dataclass(frozen=True, slots=True)
class Coolant:
    """The coolant that flows from now on; both off is M9."""

    source: Source
    mist: bool
    flood: bool


@dataclass(frozen=True, slots=True)
class Output:
    """A discrete output (M12..M37, OUT): `number` is that of the output, -1 none."""

    source: Source
    number: int
    is_on: bool


@dataclass(frozen=True, slots=True)
class SetBit:
    """A card flag to be set or cleared (BIT)."""

    source: Source
    bit: int
    is_on: bool


@dataclass(frozen=True, slots=True)
class WaitBit:
    """Go on when a card flag has a state (M1xx, M2xx), or gets it (`is_edge`); or after a time."""

    source: Source
    bit: int
    is_on: bool
    reason: str
    is_edge: bool = False
    limit_s: float = math.inf


@dataclass(frozen=True, slots=True)
class Tool:
    """M6: change to this tool."""

    source: Source
    number: int


@dataclass(frozen=True, slots=True)
class Transfer:
    """T Pn: a card variable gets this value."""

    source: Source
    parameter: int
    value: float


class Check(Enum):
    """What has to hold before the program goes on."""

    REFERENCE_INPUT = "G27"  # the switch of reference point 1 answers
    AT_REFERENCE = "G28"  # the axes stand on the point


@dataclass(frozen=True, slots=True)
class Confirm:
    """G27, G28, G30: a condition on axes that stand at `point`."""

    source: Source
    check: Check
    axes: tuple[int, ...]
    point: Point


@dataclass(frozen=True, slots=True)
class Say:
    """A text for the operator."""

    source: Source
    text: str


@dataclass(frozen=True, slots=True)
class Ask:
    """INPUT: a text for the operator and the parameter that takes the answer; a Sync follows."""

    source: Source
    text: str
    parameter: int


class Pause(Enum):
    """Why a program holds until it is started again."""

    STOP = "M0"
    OPTIONAL = "M1"  # only while Optional Stop is on
    HAND_RETRACT = "M585"


@dataclass(frozen=True, slots=True)
class Stop:
    """M0, M1 and the hand retract of G88."""

    source: Source
    pause: Pause
    text: str = ""


@dataclass(frozen=True, slots=True)
class BlockEnd:
    """A block with effect has ended: where single block stops."""

    source: Source


@dataclass(frozen=True, slots=True)
class SetCell:
    """A store or card parameter that must not change before the motion reaches it."""

    source: Source
    parameter: int
    value: float


@dataclass(frozen=True, slots=True)
class Sync:
    """Nothing after this is interpreted before the machine is at rest and all is done."""

    source: Source


@dataclass(frozen=True, slots=True)
class End:
    """M2 (or M30 where it ends programs), or the end of the text."""

    source: Source
    is_by_code: bool
