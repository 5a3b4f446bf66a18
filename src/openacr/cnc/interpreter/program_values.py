"""Parameters and jumps of a program as arrays, for blocks that are executed many at a time."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, cast

from openacr.cnc.canonical import AXES
from openacr.cnc.interpreter import formulas_cy as vm
from openacr.cnc.interpreter import run_rows_cy as core
from openacr.cnc.interpreter import values_cy as values
from openacr.cnc.program.labels import Place
from openacr.cnc.reading.line_shapes import doubles, integers
from openacr.cnc.state.parameters import (
    FEED_CELL,
    FIRST_STORED,
    FREE_CELLS,
    LAST_STORED,
    SHOWN,
)
from openacr.cnc.state.shadow import NEAR, Shadow

if TYPE_CHECKING:
    from openacr.cnc.interpreter.inside import Inside
    from openacr.cnc.program.labels import Part
    from openacr.views import F64, I32


@cache
def access() -> I32:
    """What programs may do with cells, by number: read those of the store, write the free ones."""
    found = integers(NEAR)
    for n in range(FIRST_STORED, min(LAST_STORED, NEAR - 1) + 1):
        found[n] = vm.MAY_READ
    for first, last in FREE_CELLS:
        for n in range(first, last + 1):
            found[n] = vm.MAY_READ | vm.MAY_WRITE
    for n in (*SHOWN, FEED_CELL):
        if n < NEAR:
            found[n] = 0
    return found


class ProgramValues:
    """Views of what parameters are kept in, and what programs may do with the cells.

    Cells are read and written by the core where they are those of a `Shadow`.
    """

    def __init__(self, run: Inside) -> None:
        parameters, cells = run.parameters, run.cells
        self._cells = cells if isinstance(cells, Shadow) else None
        self.locals = cast("F64", memoryview(parameters.values))
        own = parameters.own
        self.own = doubles(1) if own is None else cast("F64", memoryview(own))
        self.access = access()
        if self._cells is None:
            self.cells, self.states = doubles(NEAR), integers(NEAR)
        else:
            self.cells, self.states = self._cells.values, self._cells.states

    @property
    def are_here(self) -> bool:
        """Whether the core may read and write the cells."""
        return self._cells is not None and self._cells.has_values


class Jumps:
    """Where the lines of a text jump to, and their passes, as the core keeps them.

    A jump is executed by its line at first: then the place where the program goes on is known. The
    passes are counted as `Loops` does, which sees those passes whose state it compares.
    """

    def __init__(self, run: Inside) -> None:
        self._run = run
        self.rows = integers(values.JUMPS * values.JUMP)
        self.kept = doubles(values.JUMPS * AXES)
        self._part: Part | None = None
        self._pending = 0  # the line that was left, which may be a jump
        self._K: I32 = integers(core.K_RUN_SIZE)

    def begin(self, part: Part, first: int, K: I32) -> None:
        """Lines of a text are executed; `first` is the place of their data in it."""
        if part is not self._part:
            self.rows[:] = integers(len(self.rows))
            self._part = part
        K[core.K_FIRST] = first
        self._K = K
        self._pending = 0

    def left(self, at: Place) -> None:
        """A line was left to its tree."""
        self._pending = at.line

    def end(self) -> None:
        """Hand the passes to `Loops`."""
        if not self._K[core.K_JUMPS] or self._run.loops is None or self._part is None:
            return
        J = self.rows
        for at in range(0, len(J), values.JUMP):
            if J[at + values.J_LINE]:
                self._run.loops.count(self._part, J[at + values.J_LINE], J[at + values.J_PASSES])

    def arrived(self, place: Place) -> None:
        """The program goes on at a place: that is the target of the line that was left."""
        line, self._pending = self._pending, 0
        node = self._run.execution.node
        if not line or node is None or node.line != line or place.line == line + 1:
            return
        if node.part is not self._part or place.part is not self._part:
            return
        slot = line & values.JUMP_MASK
        at, J = slot * values.JUMP, self.rows
        J[at + values.J_LINE], J[at + values.J_PLACE] = line, place.offset
        J[at + values.J_TARGET], J[at + values.J_IS_KEPT] = place.line, 0
        if self._run.loops is not None:
            J[at + values.J_PASSES], kept = self._run.loops.passes(node)
            if kept is not None:
                J[at + values.J_IS_KEPT] = 1
                for axis in range(AXES):
                    self.kept[slot * AXES + axis] = kept[axis]
