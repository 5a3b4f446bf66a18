"""Loops that move without end, found while a program is read without a machine.

At every jump the state is compared with that of an earlier pass, kept at passes 1, 2, 4, 8 …:
a state that comes back comes back for ever, for nothing outside changes. A loop whose state
changes with every pass ends at `MOST_PASSES`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from openacr.cnc.reading.findings import CodeError
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow

if TYPE_CHECKING:
    from openacr.cnc.canonical import Point
    from openacr.cnc.codes.ngc.owords import OWords
    from openacr.cnc.codes.run import Run
    from openacr.cnc.program.flow import Frame
    from openacr.cnc.program.labels import Part
    from openacr.cnc.program.program import Node

MOST_PASSES = 500_000
HINT = "it does not end by itself; a machine runs it until it is ended"


class Loops:
    """The jumps of one run, by the line that jumps."""

    def __init__(self, run: Run, o_words: OWords) -> None:
        self._run, self._o_words = run, o_words
        self._cnts: dict[tuple[int, int], int] = {}
        self._last: Node | None = None  # the line that jumped last
        self._hole: Frame | None = None  # passes of a cycle are counted hole by hole
        self._earlier: dict[tuple[int, int], tuple[Point, tuple[object, ...]]] = {}

    def jumped(self) -> None:
        """A line jumps; CodeError A62 where it did so in this very state before."""
        run = self._run
        node = run.execution.node
        if node is None:
            return
        self._last = node
        key = id(node.part), node.line
        if node.part.is_cycles and run.flow.frames[-1] is not self._hole:
            self._hole = run.flow.frames[-1]
            self._cnts = {k: count for k, count in self._cnts.items() if k[0] != key[0]}
        count = self._cnts.get(key, 0) + 1
        self._cnts[key] = count
        if count > MOST_PASSES:
            raise CodeError("A62", 1, f"more than {MOST_PASSES:,} passes", HINT)
        earlier = self._earlier.get(key)
        if earlier is not None and earlier[0] == run.path.target and earlier[1] == self._state():
            raise CodeError("A62", 1, "the same moves again and again", HINT)
        if count & (count - 1) == 0:
            self._earlier[key] = run.path.target, self._state()

    def passes(self, node: Node) -> tuple[int, Point | None]:
        """How often a line has jumped, and where the machine was in the pass that is kept."""
        key = id(node.part), node.line
        earlier = self._earlier.get(key)
        return self._cnts.get(key, 0), earlier[0] if earlier else None

    def jump_around(self, node: Node) -> Node:
        """The line whose jump closes the loop around a line; without one, the line itself."""
        last = self._last
        if last is None or last.part is not node.part or last.line < node.line:
            return node
        return last if self.passes(last)[0] > 1 else node

    def count(self, part: Part, line: int, passes: int) -> None:
        """Note how often a line has jumped."""
        self._cnts[id(part), line] = passes

    def _state(self) -> tuple[object, ...]:
        """All that decides how the program goes on; frames are compared by identity."""
        run = self._run
        cells, machine = run.cells, run.machine
        return (
            run.path.program,
            run.modal.copy(),
            tuple(run.parameters.values),
            dict(run.parameters.names),
            dict(run.parameters.global_names),
            bytes(run.parameters.own or b""),
            cells.written if isinstance(cells, Shadow) else None,
            dict(machine.parameters) if isinstance(machine, VirtualMachine) else None,
            self._o_words.left,
            tuple(run.flow.frames),
        )
