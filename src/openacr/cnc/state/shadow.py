"""Cells whose changes are kept apart until committed: for checks, previews and replays."""

from contextlib import AbstractContextManager, nullcontext

from openacr.cnc.rows.room import doubles, integers
from openacr.cnc.rows.values import CELLS, IS_KNOWN, IS_WRITTEN
from openacr.cnc.state.hosts import Cells, Home

KNOWN, WRITTEN = IS_KNOWN, IS_KNOWN | IS_WRITTEN  # states of a cell; 0: not read yet


class Shadow:
    """Reads through to other cells; what is written stays here."""

    def __init__(self, cells: Cells) -> None:
        self._cells = cells
        self._home = cells.home
        # Read before, or written: cells of programs by number, and all others.
        self.values, self.states = doubles(CELLS), integers(CELLS)
        self._kept: dict[int, float] = {}
        self._far: dict[int, float] = {}  # the others that were written
        self._is_open = False

    @property
    def written(self) -> dict[int, float]:
        """The cells that were written, with their numbers: a copy."""
        near = (n for n, state in enumerate(self.states) if state == WRITTEN)
        return {n: self.values[n] for n in near} | self._far

    @property
    def has_values(self) -> bool:
        """Whether its arrays are all there is to a cell of a program that is known."""
        return not self._is_open

    def home(self, n: int) -> Home:
        """Where a number lives."""
        return self._home(n)

    def read(self, n: int) -> float:
        """The number written last, or that of the cells."""
        if self._is_open:
            return self._cells.read(n)
        if 0 <= n < CELLS:
            if not self.states[n]:
                self.values[n], self.states[n] = self._cells.read(n), KNOWN
            return self.values[n]
        found = self._kept.get(n)
        if found is None:
            found = self._kept[n] = self._cells.read(n)
        return found

    def write(self, n: int, value: float) -> None:
        """Keep a number; after `commit` it is written to the cells at once."""
        if self._is_open:
            self._cells.write(n, value)
        elif 0 <= n < CELLS:
            self.values[n], self.states[n] = value, WRITTEN
        else:
            self._kept[n] = self._far[n] = value

    def read_text(self, n: int) -> str:
        """The text in a cell."""
        return self._cells.read_text(n)

    def transaction(self, *, is_durable: bool = True) -> AbstractContextManager[None]:
        """That of the cells, once they are written."""
        return self._cells.transaction(is_durable=is_durable) if self._is_open else nullcontext()

    def commit(self) -> None:
        """Write all kept numbers, and from now on every number at once."""
        with self._cells.transaction():
            for n, value in self.written.items():
                self._cells.write(n, value)
        self._far.clear()
        self._is_open = True
