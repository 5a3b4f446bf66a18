"""Rows of the SYSVAR store: meaning, allowed values and default of every cell.

A tab is a range of numbers: parameter `k` of axis `a` is cell `base + 1000 a + k`. A row can
describe a series of equal cells, `step` apart. Lengths are declared in inches.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from functools import cached_property
from typing import Any, Generic, TypeVar

from msgspec import Struct, field

from openacr.errors import MapError
from openacr.map.numbers import FLAG_WORD_BASE

FIRST_SYSTEM = 100_000  # the first system parameter; below are variables and offsets of programs
CARD_VARIABLES = range(100)  # P numbers of the card, not of the store:
GLOBAL_VARIABLES = range(34)  # free for programs,
INTERNAL_VARIABLES = range(34, 90)  # reserved by the guide,
FRONT_END_VARIABLES = range(90, 100)  # written by the front end alone
CARD_PARAMETERS = range(FLAG_WORD_BASE, 20_488)
AXES = 8
AXIS_CELLS = 1_000
ANY = math.inf


class CellKind(Enum):
    """The type of the value in a cell."""

    REAL = "R"
    INTEGER = "I"
    BOOLEAN = "B"
    CHOICE = "E"
    TEXT = "S"


class Wire(Enum):
    """What kind of line a cell gives the number of."""

    INPUT = "input"
    OUTPUT = "output"


class At(Struct, frozen=True):
    """Where a default is computed: axis, position in the series, and the other cells."""

    axis: int
    index: int
    read: Callable[[int], float]


Default = float | str | Callable[[At], float | str]


class Row(Struct, frozen=True):
    """One line of a tab: a parameter, or a series of `count` of them."""

    k: int
    name: str  # {} is replaced by the number in the series
    kind: CellKind
    unit: str = ""  # u = default unit, u/m, u/s, u/s2 ... as the reference writes them
    default: Default = 0.0
    typical: str = ""
    low: float = -ANY
    high: float = ANY
    is_low_open: bool = False  # the lowest value itself is refused
    words: Mapping[int, str] = field(default_factory=dict)  # names of values
    bits: tuple[str, ...] = ()  # what the bits of a value mean where they are set, from bit 0 on
    noun: str = ""  # prefix with which numbers may be written and are displayed: Axis4
    doc: str = ""
    count: int = 1
    step: int = 1
    first: int = 0  # number of the first cell of the series
    axis: int | None = None
    is_by_axis: bool = False  # the position in the series is the axis number
    is_per_axis: bool = False
    is_motion: bool = False  # must not change while a program runs
    is_fixed: bool = False  # read-only
    is_of_tool: bool = False  # a length of linear axes, in the cell of a rotary one, too
    wire: Wire | None = None  # the value is the number of an input or output of the card

    @property
    def is_series(self) -> bool:
        """Whether the name contains the number in the series."""
        return "{}" in self.name


class Parameter(Struct, frozen=True):
    """One cell: its number, tab, axis and row."""

    number: int
    tab: str
    row: Row
    axis: int | None
    index: int

    @property
    def name(self) -> str:
        """The name as printed in the guide, with the number in the series."""
        return self.row.name.format(self.index) if self.row.is_series else self.row.name

    @property
    def kind(self) -> CellKind:
        """The type of the value."""
        return self.row.kind

    @property
    def is_text(self) -> bool:
        """Whether the cell holds text."""
        return self.row.kind is CellKind.TEXT

    @property
    def is_length(self) -> bool:
        """Whether the value is multiplied by 25.4 from inches to millimetres."""
        return self.row.unit.split("/")[0].split(" ")[0] == "u"

    @property
    def is_per_length(self) -> bool:
        """Whether the value is divided by 25.4 from inches to millimetres."""
        return self.row.unit.endswith("/u")

    def __str__(self) -> str:
        axis = "" if self.axis is None else f" (axis {self.axis})"
        return f"P{self.number} {self.name}{axis}"


Declared = TypeVar("Declared", int, range)


class Declaring(ABC, Generic[Declared]):
    """Declares rows of a tab; the result of each declaration is what users of the cell write."""

    @abstractmethod
    def _row(self, k: int, name: str, kind: CellKind, **more: object) -> Declared:
        """Take a row in; the result is the number of its cell, or of each of its cells."""

    def real(
        self, k: int, name: str, unit: str, default: Default = 0.0, **more: object
    ) -> Declared:
        """Add a number."""
        return self._row(k, name, CellKind.REAL, unit=unit, default=default, **more)

    def integer(self, k: int, name: str, default: Default = 0, **more: object) -> Declared:
        """Add a whole number."""
        return self._row(k, name, CellKind.INTEGER, default=default, **more)

    def boolean(self, k: int, name: str, default: Default = 0, **more: object) -> Declared:
        """Add a false/true value."""
        marks = {"default": default, "words": FALSE_TRUE, "low": 0, "high": 1}
        return self._row(k, name, CellKind.BOOLEAN, **marks, **more)

    def choice(
        self, k: int, name: str, words: Mapping[int, str], default: Default = 0, **more: object
    ) -> Declared:
        """Add a choice: a few values, each with a name."""
        return self._row(k, name, CellKind.CHOICE, words=words, default=default, **more)

    def text(self, k: int, name: str, default: Default = "", **more: object) -> Declared:
        """Add a text."""
        return self._row(k, name, CellKind.TEXT, default=default, **more)


class Tab(Declaring[int]):
    """A tab of the system parameters, or the cells of programs.

    A row of one cell is declared at the tab itself and gives its number; rows of several
    cells are declared at `per_axis`, `by_axis` or a `series` and give the range of theirs.
    """

    def __init__(self, name: str, base: int) -> None:
        self.name, self.base = name, base
        self.rows: list[Row] = []
        self._is_motion = False

    def motion(self) -> None:
        """Mark the rows added from now on as fixed while a program runs."""
        self._is_motion = True

    def still(self) -> None:
        """Mark the rows added from now on as changeable at any time."""
        self._is_motion = False

    @property
    def per_axis(self) -> "Series":
        """Declares rows with a cell in the thousand of each axis."""
        return Series(self, is_per_axis=True)

    @property
    def by_axis(self) -> "Series":
        """Declares rows with a cell for each axis, one after the other."""
        return Series(self, count=AXES, is_by_axis=True)

    def series(self, count: int, **more: object) -> "Series":
        """Declares rows of `count` like cells, `step` apart, the first with the number `first`."""
        return Series(self, count=count, **more)

    @property
    def is_per_axis(self) -> bool:
        """Whether each axis has a thousand of the numbers."""
        return any(row.is_per_axis for row in self.rows)

    def add(self, row: Row) -> range:
        """Add a row; two rows for one cell are an error in the tables."""
        self.rows.append(row)
        count, step = (AXES, AXIS_CELLS) if row.is_per_axis else (row.count, row.step)
        first = self.base + row.k
        return range(first, first + count * step, step)

    def declare(self, k: int, name: str, kind: CellKind, **more: object) -> range:
        """Take a row in from its fields; the result is the numbers of its cells."""
        return self.add(
            Row(k, name, kind, **{"is_motion": self._is_motion, **more})  # type: ignore[arg-type]
        )

    def _row(self, k: int, name: str, kind: CellKind, **more: object) -> int:
        return self.declare(k, name, kind, **more)[0]

    @cached_property
    def cells(self) -> dict[int, tuple[Row, int | None, int]]:
        """Row, axis and position in the series of every cell, by its offset from the base."""
        found: dict[int, tuple[Row, int | None, int]] = {}
        for row in self.rows:
            for offset, axis, index in _places(row):
                if offset in found:
                    raise MapError(f"{self.name}: two rows for P{self.base + offset}")
                found[offset] = (row, axis, index)
        return found

    def parameter(self, number: int) -> Parameter | None:
        """The parameter of a cell number; None if this tab has no such cell."""
        found = self.cells.get(number - self.base)
        if found is None:
            return None
        row, axis, index = found
        return Parameter(number, self.name, row, axis, index)


class Series(Declaring[range]):
    """Declares rows of several cells: `SERIES[axis]` or `SERIES[place]` is the number of one."""

    def __init__(self, tab: Tab, **marks: object) -> None:
        self._tab, self._marks = tab, marks

    def _row(self, k: int, name: str, kind: CellKind, **more: object) -> range:
        return self._tab.declare(k, name, kind, **{**self._marks, **more})


FALSE_TRUE = {0: "false", 1: "true"}
DISABLE = {-1: "disable"}
COLOURS = (
    "black", "blue", "green", "cyan", "red", "magenta", "brown", "light grey", "dark grey",
    "light blue", "light green", "light cyan", "light red", "light magenta", "yellow", "white",
)  # fmt: skip
COLOUR: dict[str, Any] = {"low": 0, "high": len(COLOURS) - 1, "words": dict(enumerate(COLOURS))}
LAST_LINE = 511  # of the fourth expansion module
INPUT: dict[str, Any] = {"low": -1, "high": LAST_LINE, "words": DISABLE, "wire": Wire.INPUT}
OUTPUT: dict[str, Any] = {"low": -1, "high": LAST_LINE, "words": DISABLE, "wire": Wire.OUTPUT}


def _places(row: Row) -> Iterator[tuple[int, int | None, int]]:
    for axis in range(AXES) if row.is_per_axis else (row.axis,):
        for place in range(row.count):
            index = row.first + place
            offset = row.k + place * row.step + (AXIS_CELLS * (axis or 0) if row.is_per_axis else 0)
            yield offset, index if row.is_by_axis else axis, index
