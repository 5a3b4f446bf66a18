"""The memory of an interpreter: one buffer, seen as doubles `F` and as integers `I`.

The modules beside this one name the rows in it, as `map/rows` names those of a card:
`F[points.target_u[axis]]`, `I[modes.motion]`. The rows of a module begin where those of the one
before end: scans, modes, points, holes, runs, plans, values, results.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from openacr.views import F64, I32

DOUBLE_BYTES, INTEGER_BYTES = 8, 4


def doubles(count: int) -> F64:
    """A view of doubles, 0."""
    return memoryview(bytearray(DOUBLE_BYTES * count)).cast("d")


def integers(count: int) -> I32:
    """A view of integers, 0."""
    return memoryview(bytearray(INTEGER_BYTES * count)).cast("i")


class Room:
    """Gives rows their places in a buffer, one after another from a byte on."""

    def __init__(self, begin: int = 0) -> None:
        self.end = begin  # bytes

    def _take(self, count: int, size: int) -> range:
        first = -(-self.end // size)
        self.end = size * (first + count)
        return range(first, first + count)

    def reals(self, count: int) -> range:
        """Places of doubles in F."""
        return self._take(count, DOUBLE_BYTES)

    def real(self) -> int:
        """The place of one double."""
        return self.reals(1)[0]

    def wholes(self, count: int) -> range:
        """Places of integers in I."""
        return self._take(count, INTEGER_BYTES)

    def whole(self) -> int:
        """The place of one integer."""
        return self.wholes(1)[0]


class Memory:
    """A buffer of `size` bytes, 0 at first."""

    def __init__(self, size: int) -> None:
        buffer = bytearray(-(-size // DOUBLE_BYTES) * DOUBLE_BYTES)
        self.F: F64 = memoryview(buffer).cast("d")
        self.I: I32 = memoryview(buffer).cast("i")

    def reals(self, row: range) -> F64:
        """The doubles of a row, to be read and written."""
        return self.F[row.start : row.stop]

    def wholes(self, row: range) -> I32:
        """The integers of a row, to be read and written."""
        return self.I[row.start : row.stop]
