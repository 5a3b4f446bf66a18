"""The tool table of a store: radius, length and tip of each tool by its number.

Tool n has the offsets D n and H n, each with its wear. Their cells are the AcroMill guide's.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

from openacr.sysvar import Store
from openacr.sysvar.tabs import CELLS, TOOL

Read = Callable[[int], float]
TABLES = (CELLS.d_radius, CELLS.d_wear, CELLS.h_length, CELLS.h_wear)
MOST_TOOLS = len(CELLS.h_length) - 1  # number 0 is no tool


class Tip(IntEnum):
    """The end of a cutter."""

    FLAT = 0
    BALL = 1


@dataclass(frozen=True, slots=True)
class Tool:
    """A tool whose radius or length is entered, each with its wear; None: that one is not."""

    number: int
    radius_u: float | None
    length_u: float | None
    tip: Tip
    radius_wear_u: float = 0.0
    length_wear_u: float = 0.0


def radius_u(read: Read, number: int) -> float:
    """The radius of a tool with its wear; 0 where it has none."""
    return _entered(read, number, CELLS.d_radius, CELLS.d_wear) or 0.0


def tool_at(read: Read, number: int) -> Tool | None:
    """The tool with a number; None where neither radius nor length is entered."""
    radius = _entered(read, number, CELLS.d_radius, CELLS.d_wear)
    length = _entered(read, number, CELLS.h_length, CELLS.h_wear)
    if radius is None and length is None:
        return None
    worn_radius = 0.0 if radius is None else read(CELLS.d_wear[number])
    worn_length = 0.0 if length is None else read(CELLS.h_wear[number])
    tip = Tip(int(read(TOOL.tip[number])))
    return Tool(number, radius, length, tip, worn_radius, worn_length)


def _entered(read: Read, number: int, sizes: range, wears: range) -> float | None:
    """Size and wear of a tool; None outside the table, and where both are 0."""
    if not 1 <= number < len(sizes):
        return None
    size, wear = read(sizes[number]), read(wears[number])
    return size + wear if size or wear else None


class ToolTable:
    """The tools of one store. Only what was ever written is read: a table has 2800 cells."""

    def __init__(self, cells: Store) -> None:
        self._cells = cells
        self._token = 0
        self._numbers: set[int] = set()

    def read(self) -> tuple[Tool, ...]:
        """The tools as they are stored now, by number."""
        cells = self._cells
        changes = cells.changes_since(self._token)
        self._token = changes.token
        for table in TABLES:
            self._numbers.update(n - table[0] for n in changes.numbers if n in table)
        found = (tool_at(cells.read, number) for number in sorted(self._numbers))
        return tuple(tool for tool in found if tool is not None)
