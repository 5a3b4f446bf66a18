"""What moves and actions share: points, planes, where they come from, how they run."""

from dataclasses import dataclass, field
from enum import Enum

from msgspec import Struct

AXES = 8
AXIS_LETTERS = "XYZABCUV"
ROTARY = frozenset("ABC")
Point = tuple[float, ...]  # one value for each of the 8 axes
# Z in every plane: the tool length acts along it, and the tool is retracted along it.
TOOL_AXIS = 2


class PathMode(Enum):
    """How a move joins the next one."""

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


PLANES = {17: Plane.XY, 18: Plane.ZX, 19: Plane.YZ}  # by the G code that chooses it


@dataclass(frozen=True, slots=True)
class Source:
    """Where in the text an entry comes from; `text` is the block as written."""

    file: str
    line: int
    text: str
    caller: "Source | None" = field(default=None, compare=False)  # the block of its cycle


class Pace(Struct, frozen=True):
    """How a feed move is run: feed, junction with the next move, locks.

    The feed holds along the linear axes; where only rotary axes move, in degrees per
    minute of the fastest one. `is_confirmed` adds the wait until all axes are in
    position (G9, G61). With `tolerance_u` the path may leave corners that far to keep moving;
    machines that cannot do that go exactly through them. `side` is where cutter radius
    compensation in the XY plane has the tool, and the part is not: 1 left of its path, -1
    right, 0 where that is not known.
    """

    feed_upm: float
    mode: PathMode = PathMode.FREE
    is_locked: bool = False  # feed override has no effect (G63, tapping)
    is_confirmed: bool = False
    tolerance_u: float = 0.0
    side: int = 0
