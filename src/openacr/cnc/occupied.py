"""What the CNC front end occupies on a card: variables, user flags, a program.

Every module imports these numbers from here, and no number is reserved twice: a second use is
a ValueError at import. The page of all codes prints the table.
"""

from collections.abc import Iterator
from enum import Enum

from msgspec import Struct


class Kind(Enum):
    """The kind of a number; the value is its name on the card."""

    VARIABLE = "P"
    FLAG = "BIT"
    PROGRAM = "PROG"


class Row(Struct, frozen=True):
    """One number or several consecutive ones, and their use."""

    kind: Kind
    numbers: range
    name: str
    meaning: str

    @property
    def shown(self) -> str:
        """The numbers as the card writes them: `P96`, `BIT248 to BIT255`."""
        first, last = (f"{self.kind.value}{n}" for n in (self.numbers[0], self.numbers[-1]))
        return first if first == last else f"{first} to {last}"


class Occupied:
    """The reserved numbers."""

    def __init__(self) -> None:
        self._rows: list[Row] = []

    def __iter__(self) -> Iterator[Row]:
        """The rows, variables first, then flags and programs, each by their numbers."""
        kinds = list(Kind)
        return iter(sorted(self._rows, key=lambda row: (kinds.index(row.kind), row.numbers[0])))

    def reserve(self, kind: Kind, first: int, name: str, meaning: str, count: int = 1) -> int:
        """Reserve `count` numbers and return the first; ValueError if one is already reserved."""
        new = Row(kind, range(first, first + count), name, meaning)
        for row in self._rows:
            if row.kind is kind and not set(row.numbers).isdisjoint(new.numbers):
                raise ValueError(f"{new.shown} {name}: {row.shown} is already used by {row.name}")
        self._rows.append(new)
        return first


TABLE = Occupied()
_P, _BIT, _PROG = Kind.VARIABLE, Kind.FLAG, Kind.PROGRAM

TOOL_REQUESTED = TABLE.reserve(_P, 90, "tool requested", "the tool an M6 asks for")
TOOL_LOADED = TABLE.reserve(_P, 91, "tool in the spindle", "the tool that was loaded last")
CARD_SPEED = TABLE.reserve(_P, 92, "spindle speed", "the S word in effect, rev/min")
CARD_SPINDLE = TABLE.reserve(_P, 93, "spindle state", "3 clockwise, 4 counterclockwise, 5 off")
CARD_LINE = TABLE.reserve(_P, 94, "executing line", "the line of the program that is executed")
CARD_STATE = TABLE.reserve(
    _P, 95, "run state", "0 idle, 1 run, 2 paused, 3 wait, 4 hold, 5 alarm; as P244 of the store"
)
HEARTBEAT = TABLE.reserve(
    _P, 96, "heartbeat", "changes twice a second while a host drives the machine; 0: none does"
)
KILL_CAUSE = TABLE.reserve(
    _P, 97, "cause of a kill", "the alarm that killed all motion, until the kill is taken back"
)
HOLD_AT = TABLE.reserve(
    _P, 98, "hold at", "the move of a planned path at which the watchdog holds the feed; 0: none"
)
RELAYS = 100
FIRST_RELAY = TABLE.reserve(
    _BIT, 128, "relays", "what M100 to M199 wait for to be on, M200 to M299 to be off", RELAYS
)
MACHINE_AXES = 8
FIRST_CUT = TABLE.reserve(
    _BIT,
    237,
    "drives to switch on",
    "an emergency stop has switched off axis 0 to 7: it goes on before the next motion",
    MACHINE_AXES,
)
RAN_SHORT = TABLE.reserve(
    _BIT, 245, "ran short", "the watchdog has held the feed of a planned path at move P98"
)
OUTPUTS_AT_REST = TABLE.reserve(
    _BIT, 246, "outputs at rest", "inverted outputs were put to rest since the card came on"
)
TRIPPED = TABLE.reserve(_BIT, 247, "watchdog tripped", "the watchdog has stopped the machine")
FIRST_HOMED = TABLE.reserve(
    _BIT, 248, "homed axes", "axis 0 to 7 knows its reference point", MACHINE_AXES
)
WATCHDOG_PROGRAM = TABLE.reserve(
    _PROG,
    7,
    "watchdog",
    "the program that stops the machine when its host is lost, with its LV0 to LV2 and $V0;"
    " another program where P250125 names one, none where it is -1",
)
