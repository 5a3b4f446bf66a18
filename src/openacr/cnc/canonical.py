"""Canonical moves: what a part program comes down to.

The interpreter yields these, in the order in which they have to happen; planner, preview,
run-time estimate, checks and card driver read nothing else. Positions are machine
positions in default units (degrees for rotary axes), feeds default units per minute,
angles radians, times seconds.

The list is pulled: an entry has happened when its reader asks for the one behind
`Sync`, not before. Whoever only reads (check, plot) goes straight on.
"""

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

AXES = 8
Point = tuple[float, ...]  # one value for each of the 8 axes


class PathMode(Enum):
    """How a move meets the one behind it."""

    EXACT = "G61"
    CORNER = "G62"
    LOCKED = "G63"
    FREE = "G64"


class Plane(Enum):
    """The plane of arcs, compensation and cycles: first, second and drill axis."""

    XY = (0, 1, 2)
    ZX = (2, 0, 1)
    YZ = (1, 2, 0)

    @property
    def first(self) -> int:
        """The axis angles are counted from."""
        return self.value[0]

    @property
    def second(self) -> int:
        """The axis angles are counted towards."""
        return self.value[1]

    @property
    def drill(self) -> int:
        """The axis across the plane."""
        return self.value[2]


class Spin(Enum):
    """What the spindle does."""

    CLOCKWISE = 3
    COUNTER_CLOCKWISE = 4
    OFF = 5


@dataclass(frozen=True, slots=True)
class Source:
    """Where in the text an entry comes from; `text` is the block as written."""

    file: str
    line: int
    text: str


@dataclass(frozen=True, slots=True)
class Pace:
    """How a feed move is run: feed, junction with the next move, locks.

    The feed holds along the linear axes; where only rotary axes move, in degrees per
    minute of the fastest one. `is_confirmed` adds the wait until all axes are in
    position (G9, G61).
    """

    feed_upm: float
    mode: PathMode = PathMode.FREE
    is_locked: bool = False  # feed override has no effect (G63, tapping)
    is_confirmed: bool = False


@dataclass(frozen=True, slots=True)
class Rapid:
    """A straight line of all axes at rapid speed, from rest to rest."""

    source: Source
    end: Point
    is_inserted: bool = False


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line at feed."""

    source: Source
    end: Point
    pace: Pace
    is_inserted: bool = False
    is_compensated: bool = False


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc or spiral in a plane; other axes go along linearly.

    `centre` lies on the first and second axis of the plane; `sweep_rad` is positive
    counter-clockwise, seen from the positive end of the drill axis, and up to a full turn.
    The radius changes linearly from `start_radius` to `end_radius` over the sweep.
    """

    source: Source
    end: Point
    plane: Plane
    centre: tuple[float, float]
    sweep_rad: float
    start_radius: float
    end_radius: float
    pace: Pace
    is_inserted: bool = False
    is_compensated: bool = False


@dataclass(frozen=True, slots=True)
class Polyline:
    """Many plain lines at once, for long programs: `ends` is n x 8, `lines` n numbers of lines.

    All of them have the same pace; the text of each block can be read again from the file.
    Each line is a block of its own: no BlockEnd says so.
    """

    source: Source  # of the first one
    ends: "NDArray[np.float64]"
    lines: "NDArray[np.int64]"
    pace: Pace


@dataclass(frozen=True, slots=True)
class Probe:
    """G31: a line at feed that ends where the probe trips; a Sync follows.

    `is_away`: it starts with the probe tripped and ends where that is over.
    """

    source: Source
    end: Point
    pace: Pace
    is_away: bool = False


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
    """Go on when a card flag has a state (M1xx, M2xx)."""

    source: Source
    bit: int
    is_on: bool
    reason: str


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
    """Nothing behind this is interpreted before the machine is at rest and all is done."""

    source: Source


@dataclass(frozen=True, slots=True)
class End:
    """M2 (or M30 where it ends programs), or the end of the text."""

    source: Source
    is_by_code: bool


Motion = Rapid | Line | Arc | Polyline | Probe
Action = (
    Dwell
    | Spindle
    | Orient
    | Coolant
    | Output
    | SetBit
    | WaitBit
    | Tool
    | Transfer
    | Confirm
    | Say
    | Ask
    | Stop
    | SetCell
)
Entry = Motion | Action | BlockEnd | Sync | End
