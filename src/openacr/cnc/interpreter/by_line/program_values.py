"""Parameters and jumps of a program as arrays, for blocks that are executed many at a time."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from openacr.cnc.canonical import AXES
from openacr.cnc.program.labels import Place
from openacr.cnc.rows import runs
from openacr.cnc.rows import values as rows
from openacr.cnc.rows.room import doubles, integers
from openacr.cnc.state.parameters import (
    FEED_CELL,
    FIRST_STORED,
    FREE_CELLS,
    LAST_STORED,
    SHOWN,
)
from openacr.cnc.state.shadow import Shadow

if TYPE_CHECKING:
    from openacr.cnc.interpreter.by_block.inside import Inside
    from openacr.cnc.program.labels import Part
    from openacr.views import I32


@cache
def access() -> I32:
    """What programs may do with cells, by number: read those of the store, write the free ones."""
    found = integers(rows.CELLS)
    for n in range(FIRST_STORED, min(LAST_STORED, rows.CELLS - 1) + 1):
        found[n] = rows.MAY_READ
    for first, last in FREE_CELLS:
        for n in range(first, last + 1):
            found[n] = rows.MAY_READ | rows.MAY_WRITE
    for n in (*SHOWN, FEED_CELL):
        if n < rows.CELLS:
            found[n] = 0
    return found


class ProgramValues:
    """The cells of a run as arrays, and what its program may do with them.

    Cells are read and written by the core where they are those of a `Shadow`.
    """

    def __init__(self, run: Inside) -> None:
        self._shadow = run.cells if isinstance(run.cells, Shadow) else None
        run.memory.wholes(rows.access)[:] = access()
        if self._shadow is None:
            self.cells, self.states = doubles(rows.CELLS), integers(rows.CELLS)
        else:
            self.cells, self.states = self._shadow.values, self._shadow.states

    @property
    def are_here(self) -> bool:
        """Whether the core may read and write the cells."""
        return self._shadow is not None and self._shadow.has_values


class Jumps:
    """Where the lines of a text jump to, and their passes, as the core keeps them.

    A jump is executed by its line at first: then the place where the program goes on is known. The
    passes are counted as `Loops` does, which sees those passes whose state it compares.
    """

    def __init__(self, run: Inside) -> None:
        self._run = run
        self._part: Part | None = None
        self._pending = 0  # the line that was left, which may be a jump

    def begin(self, part: Part, first: int) -> None:
        """Lines of a text are executed; `first` is the place of their data in it."""
        if part is not self._part:
            self._run.memory.wholes(rows.jump)[:] = integers(len(rows.jump))
            self._part = part
        I = self._run.memory.I
        I[runs.first_at], I[runs.jump_cnt] = first, 0
        self._pending = 0

    def left(self, at: Place) -> None:
        """A line was left to its tree."""
        self._pending = at.line

    def end(self) -> None:
        """Hand the passes to `Loops`."""
        I, loops = self._run.memory.I, self._run.loops
        if not I[runs.jump_cnt] or loops is None or self._part is None:
            return
        for at in rows.jump[:: rows.JUMP]:
            if I[at + rows.JUMP_LINE]:
                loops.count(self._part, I[at + rows.JUMP_LINE], I[at + rows.JUMP_PASSES])

    def arrived(self, place: Place) -> None:
        """The program goes on at a place: that is the target of the line that was left."""
        line, self._pending = self._pending, 0
        node = self._run.execution.node
        if not line or node is None or node.line != line or place.line == line + 1:
            return
        if node.part is not self._part or place.part is not self._part:
            return
        F, I = self._run.memory.F, self._run.memory.I
        slot = line & rows.JUMP_MASK
        at = rows.jump[slot * rows.JUMP]
        I[at + rows.JUMP_LINE], I[at + rows.JUMP_PLACE] = line, place.offset
        I[at + rows.JUMP_TARGET], I[at + rows.JUMP_IS_KEPT] = place.line, 0
        if self._run.loops is not None:
            I[at + rows.JUMP_PASSES], kept = self._run.loops.passes(node)
            if kept is not None:
                I[at + rows.JUMP_IS_KEPT] = 1
                for axis in range(AXES):
                    F[rows.kept_u[slot * AXES + axis]] = kept[axis]
