"""Canonical actions: what happens between moves, and where a program stops or ends."""

import math
from enum import Enum

from msgspec import Struct

from openacr.cnc.canonical.common import Point, Source


class Spin(Enum):
    """What the spindle does."""

    CLOCKWISE = 3
    COUNTER_CLOCKWISE = 4
    OFF = 5


class Dwell(Struct, frozen=True):
    """Rest for some seconds."""

    source: Source
    seconds: float


class Spindle(Struct, frozen=True):
    """M3, M4, M5 with the speed that holds then."""

    source: Source
    spin: Spin
    rpm: float
    is_awaited: bool = True  # with the handshake; a new S alone has none


class Orient(Struct, frozen=True):
    """Stop the spindle at its angle, or let it go again."""

    source: Source
    is_on: bool


class Tapping(Struct, frozen=True):
    """A tap is about to enter its hole, or is out of it again: no feed hold in between."""

    source: Source
    is_on: bool


class Coolant(Struct, frozen=True):
    """The coolant that flows from now on; both off is M9."""

    source: Source
    mist: bool
    flood: bool


class Output(Struct, frozen=True):
    """A discrete output (M12..M37, OUT): `number` is that of the output, -1 none."""

    source: Source
    number: int
    is_on: bool


class SetBit(Struct, frozen=True):
    """A card flag to be set or cleared (BIT)."""

    source: Source
    bit: int
    is_on: bool


class WaitBit(Struct, frozen=True):
    """Go on when a card flag has a state (M1xx, M2xx), or gets it (`is_edge`); or after a time."""

    source: Source
    bit: int
    is_on: bool
    reason: str
    is_edge: bool = False
    limit_s: float = math.inf


class Tool(Struct, frozen=True):
    """M6: change to this tool."""

    source: Source
    number: int


class Transfer(Struct, frozen=True):
    """T Pn: a card variable gets this value."""

    source: Source
    parameter: int
    value: float


class Check(Enum):
    """What has to hold before the program goes on."""

    REFERENCE_INPUT = "G27"  # the switch of reference point 1 answers
    AT_REFERENCE = "G28"  # the axes stand on the point


class Confirm(Struct, frozen=True):
    """G27, G28, G30: a condition on axes that stand at `point`."""

    source: Source
    check: Check
    axes: tuple[int, ...]
    point: Point


class Say(Struct, frozen=True):
    """A text for the operator."""

    source: Source
    text: str


class Ask(Struct, frozen=True):
    """INPUT: a text for the operator and the parameter that takes the answer; a Sync follows."""

    source: Source
    text: str
    parameter: int


class Pause(Enum):
    """Why a program holds until it is started again."""

    STOP = "M0"
    OPTIONAL = "M1"  # only while Optional Stop is on
    HAND_RETRACT = "M585"


class Stop(Struct, frozen=True):
    """M0, M1 and the hand retract of G88."""

    source: Source
    pause: Pause
    text: str = ""


class BlockEnd(Struct, frozen=True):
    """A block with effect has ended: where single block stops."""

    source: Source


class SetCell(Struct, frozen=True):
    """A store or card parameter that must not change before the motion reaches it."""

    source: Source
    parameter: int
    value: float


class Sync(Struct, frozen=True):
    """Nothing after this is interpreted before the machine is at rest and all is done."""

    source: Source


class End(Struct, frozen=True):
    """M2 (or M30 where it ends programs), or the end of the text."""

    source: Source
    is_by_code: bool
