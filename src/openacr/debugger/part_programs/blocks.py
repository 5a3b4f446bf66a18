"""The blocks of a run as they were read: what was in force before each of them acted."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass

from openacr.cnc.canonical import Point
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.program.program import Node
from openacr.cnc.state.hosts import Cells, Home
from openacr.cnc.state.modal import Modal

MOST_BLOCKS = 100_000  # kept before the present one


class NotedCells:
    """Cells of a program whose values at any earlier write are known."""

    def __init__(self, cells: Cells) -> None:
        self._cells = cells
        self._writes: dict[int, list[tuple[int, float]]] = {}  # by cell: place, value before
        self.written_cnt = 0

    def home(self, n: int) -> Home:
        """Where a number lives."""
        return self._cells.home(n)

    def read(self, n: int) -> float:
        """The number in a cell."""
        return self._cells.read(n)

    def write(self, n: int, value: float) -> None:
        """Set a cell, and note what it was before."""
        self._writes.setdefault(n, []).append((self.written_cnt, self._cells.read(n)))
        self.written_cnt += 1
        self._cells.write(n, value)

    def read_text(self, n: int) -> str:
        """The text in a cell."""
        return self._cells.read_text(n)

    def transaction(self, *, is_durable: bool = True) -> AbstractContextManager[None]:
        """What is written inside is stored together, or not at all."""
        return self._cells.transaction(is_durable=is_durable)

    def read_at(self, n: int, written_cnt: int) -> float:
        """The number that was in a cell after a count of writes of the program."""
        writes = self._writes.get(n, [])
        place = bisect_left(writes, (written_cnt,))
        return writes[place][1] if place < len(writes) else self._cells.read(n)

    def written_since(self, written_cnt: int) -> list[int]:
        """The cells that were written from a count of writes on, in ascending order."""
        return sorted(n for n, writes in self._writes.items() if writes[-1][0] >= written_cnt)


@dataclass(frozen=True, slots=True)
class Block:
    """A block as it was before it acted.

    `ended_cnt` blocks had ended before it, which is how the runner counts; `written_cnt` cells had
    been written. `callers` are the lines that have called its routine, the latest one last.
    """

    file: str
    line: int
    text: str
    ended_cnt: int
    written_cnt: int
    callers: tuple[tuple[str, int], ...]
    modal: Modal
    position: Point  # of the program, in default units
    locals: tuple[float, ...]  # #0 to #33; #0 is 0 outside of calls
    names: dict[str, float]

    @property
    def place(self) -> tuple[str, int]:
        """Its file and line."""
        return self.file, self.line


class BlockLog:
    """The blocks of a run in the order in which they were read; they count from 0.

    `run` and `noted` are there when a session has begun to read.
    """

    run: Interpreter
    noted: NotedCells

    def __init__(self) -> None:
        self.first = 0  # the earliest that is kept
        self.begin_cnt = 0  # cells that were written before the first block
        self._blocks: list[Block] = []

    @property
    def end(self) -> int:
        """The count of all blocks that were read."""
        return self.first + len(self._blocks)

    def __getitem__(self, number: int) -> Block:
        """A block that is kept."""
        return self._blocks[number - self.first]

    def between(self, first: int, end: int) -> Iterator[int]:
        """The numbers from `first` on before `end` of blocks that are kept."""
        yield from range(max(first, self.first), min(end, self.end))

    def forget(self, before: int) -> None:
        """Drop the blocks before one."""
        del self._blocks[: before - self.first]
        self.first = before

    # what a session that reads a program calls (openacr.mill.session.Reader)

    def begin(self, run: Interpreter) -> None:
        """A program is about to be read."""
        self.run = run

    def cells(self, cells: Cells) -> Cells:
        """The cells that the program is given."""
        self.noted = NotedCells(cells)
        return self.noted

    def attend(self, node: Node) -> None:
        """Note a block before it acts."""
        run, noted = self.run, self.noted
        last = self._blocks[-1] if self._blocks else None
        if last is None:
            self.begin_cnt = noted.written_cnt
        modal, names = run.modal, run.parameters.names | run.parameters.global_names
        self._blocks.append(
            Block(
                node.part.text.name,
                node.line,
                node.raw.strip(),
                run.ended_cnt,
                noted.written_cnt,
                self._callers(last, len(run.flow.frames)),
                last.modal if last is not None and last.modal == modal else modal.copy(),
                run.position,
                tuple(run.parameters.values),
                last.names if last is not None and last.names == names else names,
            )
        )

    def _callers(self, last: Block | None, depth: int) -> tuple[tuple[str, int], ...]:
        if last is None or depth == 0:
            return ()
        return (*last.callers[:depth], *[last.place] * (depth - len(last.callers)))
