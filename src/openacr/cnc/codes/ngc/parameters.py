"""Numbered parameters of the rs274ngc dialect: volatile, but for those that show the state.

#1 to #30 belong to the call, #31 to #5000 to the run; above stand results of probing,
reference points, offsets, the tool in the spindle and the position.
"""

from __future__ import annotations

import math
import re
from array import array
from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from openacr.cnc.canonical import AXES, AXIS_LETTERS, ROTARY
from openacr.cnc.codes.ngc.named import PREDEFINED
from openacr.cnc.geometry.coordinates import TURN, system_base
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.rows import values as rows
from openacr.cnc.state.cells import LAST_RADIUS, LENGTHS, RADII
from openacr.cnc.state.hosts import Cells
from openacr.cnc.state.parameters import SHOWN, ParameterHost, Parameters, number
from openacr.sysvar import tabs

if TYPE_CHECKING:
    from openacr.cnc.codes.run import Run
    from openacr.views import F64

FIRST_SYSTEM, SYSTEMS, SYSTEM_STEP = 5221, 9, 20
ROTATION = 9  # of the parameters of a system: its rotation
FIRST_POSITION = 5420
LAST = rows.OWN - 1

CELLS = {5070: tabs.CELLS.g31_tripped, 5210: tabs.CELLS.floating_zero_active}
POINTS = {
    5061: tabs.CELLS.g31_program_position[0],
    5161: tabs.CELLS.reference_point_1[0],
    5181: tabs.CELLS.reference_point_2[0],
    5211: tabs.CELLS.floating_zero_shift[0],
}  # of X, then of Y, Z, A, B, C, U, V: the cell of axis 0
for _n in range(SYSTEMS):
    POINTS[FIRST_SYSTEM + SYSTEM_STEP * _n] = system_base(_n + 1)
    CELLS[FIRST_SYSTEM + SYSTEM_STEP * _n + ROTATION] = system_base(_n + 1) + TURN


def axes_by_letter(axes: dict[str, int]) -> list[int]:
    """The axis numbers of X Y Z A B C U V; letters without an axis have those that are left."""
    used = {axes[letter] for letter in AXIS_LETTERS if letter in axes}
    left = (axis for axis in range(AXES) if axis not in used)
    return [axes[letter] if letter in axes else next(left) for letter in AXIS_LETTERS]


TOOL: dict[int, Callable[[Cells, int], float]] = {
    5403: lambda cells, tool: cells.read(LENGTHS + tool),
    5410: lambda cells, tool: 2.0 * cells.read(RADII + min(tool, LAST_RADIUS)),
}  # of the tool in the spindle: length along Z and diameter
WAITED = 5399  # what M66 found
SHARED = re.compile(r"_(?:INI|HAL)\[")
STATES = {5220: tabs.CELLS.work_system_in_use, 5400: tabs.CELLS.tool_in_spindle}


class NgcParameters(Parameters):
    """Reads and writes as the dialect numbers them."""

    last_local = 30
    own: F64  # #31 to #5000, and what M66 found

    def __init__(self, run: ParameterHost) -> None:
        self.own = run.memory.reals(rows.own)
        self._axes = axes_by_letter(cast("Run", run).planner.axes)
        self._cell_of = dict(CELLS)
        for first, cell in POINTS.items():
            for place, axis in enumerate(self._axes):
                self._cell_of[first + place] = cell + axis
        super().__init__(run)

    def reset(self) -> None:
        """The start of a program: nothing is set, and #1 to #30 are there."""
        super().reset()
        self.values[0] = 1.0
        self.own[:] = array("d", bytes(8 * len(self.own)))

    def is_plain_cell(self, n: float, *, is_hash: bool) -> bool:
        """Those that the texts of cycles name."""
        return not is_hash and super().is_plain_cell(n, is_hash=is_hash)

    def is_card_cell(self, n: float, *, is_hash: bool) -> bool:
        """Those that the texts of cycles name."""
        return not is_hash and super().is_card_cell(n, is_hash=is_hash)

    def read_hash(self, n: float) -> float:
        """Parameter #n; 0 where nothing was written."""
        k = number(n)
        if 1 <= k <= self.last_local:
            return self.values[k]
        if k in self._cell_of:
            return self._read_cell(self._cell_of[k])
        if k in STATES:
            return SHOWN[STATES[k]](self._modal)
        if FIRST_POSITION <= k < FIRST_POSITION + AXES:
            value = self._run.path.program[self._axes[k - FIRST_POSITION]]
            return value if AXIS_LETTERS[k - FIRST_POSITION] in ROTARY else self._shown(value)
        if k in TOOL:
            return self._run.path.shown(TOOL[k](self._cells, self._modal.tool_in_spindle))
        if not 1 <= k <= LAST:
            raise CodeError("E211", 0, f"#{k}")
        return self.own[k]

    def _shown(self, value: float) -> float:
        """A length in active units."""
        return self._run.path.shown(value)

    def read_named(self, name: str) -> float:
        """A named parameter, of the program or of its state."""
        found = PREDEFINED.get(name)
        if found is None or name in self.global_names:
            return super().read_named(name)
        return found.read(cast("Run", self._run))

    def has_named(self, name: str) -> bool:
        """Whether a named parameter exists."""
        return name in PREDEFINED or super().has_named(name)

    def set_waited(self, value: float) -> None:
        """Show what M66 found in #5399."""
        self.own[WAITED] = value

    def write(self, kind: str, n: float | str, value: float) -> None:
        """Set #n, or what the text of a cycle assigns."""
        if isinstance(n, str) and (n in PREDEFINED or SHARED.match(n)):
            raise CodeError("E212", 0, f"#<{n.lower()}>")
        if kind != "#" or isinstance(n, str):
            super().write(kind, n, value)
            return
        k = number(n)
        if not math.isfinite(value):
            raise CodeError("E210")
        if 1 <= k <= self.last_local:
            self.values[k] = value
        elif k in self._cell_of:
            self.store(self._cell_of[k], value)
        elif 1 <= k <= rows.LAST_OWN:
            self.own[k] = value
        else:
            raise CodeError("E212" if k <= LAST else "E211", 0, f"#{k}")
