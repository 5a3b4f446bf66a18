"""Numbered parameters of the rs274ngc dialect: volatile, but for those that show the state.

#1 to #30 belong to the call, #31 to #5000 to the run; above stand results of probing,
reference points, offsets and the position.
"""

from __future__ import annotations

import math

from openacr.cnc.canonical import AXES
from openacr.cnc.geometry.coordinates import TURN, system_base
from openacr.cnc.reading.findings import CodeError
from openacr.cnc.state.parameters import SHOWN, Parameters, number
from openacr.sysvar import tabs

FIRST_SYSTEM, SYSTEMS, SYSTEM_STEP = 5221, 9, 20
ROTATION = 9  # of the parameters of a system: its rotation
FIRST_POSITION = 5420
LAST_OWN = 5000
LAST = 5999


def _run_of(first: int, cell: int) -> dict[int, int]:
    return {first + axis: cell + axis for axis in range(AXES)}


CELLS = {
    5070: tabs.CELLS.g31_tripped,
    5210: tabs.CELLS.floating_zero_active,
    **_run_of(5061, tabs.CELLS.g31_program_position[0]),
    **_run_of(5161, tabs.CELLS.reference_point_1[0]),
    **_run_of(5181, tabs.CELLS.reference_point_2[0]),
    **_run_of(5211, tabs.CELLS.floating_zero_shift[0]),
}
for _n in range(SYSTEMS):
    CELLS |= _run_of(FIRST_SYSTEM + SYSTEM_STEP * _n, system_base(_n + 1))
    CELLS[FIRST_SYSTEM + SYSTEM_STEP * _n + ROTATION] = system_base(_n + 1) + TURN
STATES = {5220: tabs.CELLS.work_system_in_use, 5400: tabs.CELLS.tool_in_spindle}


class NgcParameters(Parameters):
    """Reads and writes as the dialect numbers them."""

    last_local = 30

    def reset(self) -> None:
        """The start of a program: nothing is set, and #1 to #30 are there."""
        super().reset()
        self.values[0] = 1.0
        self.own: dict[int, float] = {}

    def is_plain_cell(self, n: float) -> bool:
        """None is."""
        return False

    def is_card_cell(self, n: float) -> bool:
        """None is."""
        return False

    def read_hash(self, n: float) -> float:
        """Parameter #n; 0 where nothing was written."""
        k = number(n)
        if 1 <= k <= self.last_local:
            return self.values[k]
        if k in CELLS:
            return self._read_cell(CELLS[k])
        if k in STATES:
            return SHOWN[STATES[k]](self._modal)
        if FIRST_POSITION <= k < FIRST_POSITION + AXES:
            return self._run.path.shown(self._run.path.program[k - FIRST_POSITION])
        if not 1 <= k <= LAST:
            raise CodeError("E211", 0, f"#{k}")
        return self.own.get(k, 0.0)

    def write(self, kind: str, n: float | str, value: float) -> None:
        """Set #n, or what the text of a cycle assigns."""
        if kind != "#" or isinstance(n, str):
            super().write(kind, n, value)
            return
        k = number(n)
        if not math.isfinite(value):
            raise CodeError("E210")
        if 1 <= k <= self.last_local:
            self.values[k] = value
        elif k in CELLS:
            self.store(CELLS[k], value)
        elif 1 <= k <= LAST_OWN:
            self.own[k] = value
        else:
            raise CodeError("E212" if k <= LAST else "E211", 0, f"#{k}")
