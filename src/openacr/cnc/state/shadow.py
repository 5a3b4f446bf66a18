"""Cells whose changes are kept apart until committed: for checks, previews and replays."""

from contextlib import AbstractContextManager, nullcontext

from openacr.cnc.state.hosts import Cells, Home


class Shadow:
    """Reads through to other cells; what is written stays here."""

    def __init__(self, cells: Cells) -> None:
        self._cells = cells
        self._home = cells.home
        self._kept: dict[int, float] = {}  # read before, or written
        self.written: dict[int, float] = {}
        self._is_open = False

    def home(self, n: int) -> Home:
        """Where a number lives."""
        return self._home(n)

    def read(self, n: int) -> float:
        """The number written last, or that of the cells."""
        if self._is_open:
            return self._cells.read(n)
        found = self._kept.get(n)
        if found is None:
            found = self._kept[n] = self._cells.read(n)
        return found

    def write(self, n: int, value: float) -> None:
        """Keep a number; after `commit` it is written to the cells at once."""
        if self._is_open:
            self._cells.write(n, value)
        else:
            self._kept[n] = self.written[n] = value

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
        self.written.clear()
        self._is_open = True
