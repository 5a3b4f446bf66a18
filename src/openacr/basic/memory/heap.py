"""Place the local variables and numeric arrays of programs in the heap of the map.

There is no list of blocks beside the rows that own them: what is in use is read from the
rows each time, so a restored snapshot needs nothing else. DIM is rare, programs are few.
"""

from array import array
from collections.abc import Iterator
from operator import attrgetter

from msgspec import Struct

from openacr.basic.memory.memory_cost import (
    DOUBLE_ARRAY,
    DOUBLE_VARIABLE,
    LONG_ARRAY,
    LONG_VARIABLE,
    SINGLE_ARRAY,
    SINGLE_VARIABLE,
    Cost,
)
from openacr.errors import CardError, StoreError
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import storage
from openacr.messages import OUT_OF_MEMORY, SUBSCRIPT_OUT_OF_RANGE, UNDEFINED_VARIABLE

WORD_BYTES = 4
_FIRST = at.HEAP_BYTE_BASE // WORD_BYTES
_END = _FIRST + at.HEAP_BYTES // WORD_BYTES


class ScalarType(Struct, frozen=True):
    """LV, SV or DV: its rows, its cost and the 32-bit words one of them takes."""

    name: str
    base_row: tuple[int, ...]
    count_row: tuple[int, ...]
    cost: Cost
    words: int


class ArrayType(Struct, frozen=True):
    """LA, SA or DA: the rows of its table of references, cost and words per element."""

    name: str
    base_row: tuple[int, ...]
    count_row: tuple[int, ...]
    cost: Cost
    words: int


SCALARS = (
    ScalarType("LV", storage.lv_base, storage.lv_count, LONG_VARIABLE, 1),
    ScalarType("SV", storage.sv_base, storage.sv_count, SINGLE_VARIABLE, 1),
    ScalarType("DV", storage.dv_base, storage.dv_count, DOUBLE_VARIABLE, 2),
)
ARRAYS = (
    ArrayType("LA", storage.la_base, storage.la_count, LONG_ARRAY, 1),
    ArrayType("SA", storage.sa_base, storage.sa_count, SINGLE_ARRAY, 1),
    ArrayType("DA", storage.da_base, storage.da_count, DOUBLE_ARRAY, 2),
)


class _Block(Struct, frozen=True, order=True):
    """A used block of the heap, in words."""

    start: int
    words: int


class Heap:
    """First-fit allocation over the heap of the state buffer."""

    def __init__(self, memory: Memory) -> None:
        self.memory = memory

    def row(self, program: int, row: tuple[int, ...]) -> int:
        """One storage row of a program."""
        return self.memory.I[row[program]]

    def set_row(self, program: int, row: tuple[int, ...], value: int) -> None:
        """Write one storage row of a program."""
        self.memory.I[row[program]] = value

    def place_scalars(self, program: int, kind: ScalarType, count: int) -> None:
        """Give a program `count` variables of a type, all 0."""
        start = self._allocate(count * kind.words, phase=0, step=kind.words)
        self.set_row(program, kind.base_row, start // kind.words)
        self.set_row(program, kind.count_row, count)

    def place_references(self, program: int, kind: ArrayType, count: int) -> None:
        """Give a program room for `count` arrays of a type, none dimensioned yet."""
        self.set_row(program, kind.base_row, self._allocate(count, phase=0, step=1))
        self.set_row(program, kind.count_row, count)

    def place_array(self, program: int, kind: ArrayType, index: int, count: int) -> None:
        """Give one array `count` elements, all 0; elements of DA are 8-byte aligned."""
        start = self._allocate(1 + count * kind.words, phase=kind.words - 1, step=kind.words)
        self.memory.I[start] = count
        self.memory.I[self._reference(program, kind, index)] = start

    def array_count(self, program: int, kind: ArrayType, index: int) -> int:
        """Elements of one array, 0 while it is not dimensioned."""
        header = self.memory.I[self._reference(program, kind, index)]
        return self.memory.I[header] if header else 0

    def arrays(self, program: int, kind: ArrayType) -> Iterator[tuple[int, int]]:
        """Number and elements of each array that is dimensioned."""
        table, longs = self.row(program, kind.base_row), self.memory.I
        for place in self.memory.references(table, self.row(program, kind.count_row)):
            yield place - table, longs[longs[place]]

    def scalars(self, program: int, kind: ScalarType) -> bytes:
        """All variables of a kind as they are in memory."""
        start = self.row(program, kind.base_row) * kind.words
        return self.memory.I[
            start : start + self.row(program, kind.count_row) * kind.words
        ].tobytes()

    def elements(self, program: int, kind: ArrayType) -> Iterator[bytes]:
        """The elements of every array of a table; none while it is not dimensioned."""
        rows, table = self.memory.I, self.row(program, kind.base_row)
        for header in rows[table : table + self.row(program, kind.count_row)]:
            count = rows[header] if header else 0
            yield rows[header + 1 : header + 1 + count * kind.words].tobytes()

    def free(self, program: int) -> None:
        """Forget all locals of a program."""
        for kind in (*SCALARS, *ARRAYS):
            self.set_row(program, kind.count_row, 0)
            self.set_row(program, kind.base_row, 0)

    def check(self) -> None:
        """StoreError unless everything in use lies in the heap, and nothing on anything else.

        For rows from a file: programs reach what these rows say without asking.
        """
        end = _FIRST
        for block in sorted(self._checked_blocks()):
            if block.start < end or block.words < 0 or block.start + block.words > _END:
                raise StoreError("the snapshot is damaged: variables or arrays overlap")
            end = block.start + block.words

    def _checked_blocks(self) -> Iterator[_Block]:
        """All blocks; a table is read once it is known to lie in the heap."""
        for program in range(storage.COUNT):
            for scalar in SCALARS:
                count, base = (
                    self.row(program, scalar.count_row),
                    self.row(program, scalar.base_row),
                )
                if count:
                    yield _Block(base * scalar.words, count * scalar.words)
            for kind in ARRAYS:
                table, count = self.row(program, kind.base_row), self.row(program, kind.count_row)
                if count:
                    self._needs_heap(table, count)
                    yield _Block(table, count)
                    yield from self._checked_arrays(table, count, kind)

    def _checked_arrays(self, table: int, count: int, kind: ArrayType) -> Iterator[_Block]:
        for header in self.memory.I[table : table + count]:
            if header:
                self._needs_heap(header, 1)
                if (header + 1) % kind.words:
                    raise StoreError("the snapshot is damaged: an array lies at an odd place")
                yield _Block(header, 1 + self.memory.I[header] * kind.words)

    @staticmethod
    def _needs_heap(start: int, words: int) -> None:
        if not (_FIRST <= start and 0 < words and start + words <= _END):
            raise StoreError("the snapshot is damaged: a table of arrays lies outside the heap")

    def _reference(self, program: int, kind: ArrayType, index: int) -> int:
        count = self.row(program, kind.count_row)
        if not count:
            raise CardError(UNDEFINED_VARIABLE)
        if not 0 <= index < count:
            raise CardError(SUBSCRIPT_OUT_OF_RANGE)
        return self.row(program, kind.base_row) + index

    def _allocate(self, words: int, *, phase: int, step: int) -> int:
        """First zeroed block of `words` whose start is `phase` modulo `step`."""
        start = _FIRST + (phase - _FIRST) % step
        for block in sorted(self._blocks(), key=attrgetter("start")):
            if start + words <= block.start:
                break
            after = max(start, block.start + block.words)
            start = after + (phase - after) % step
        if start + words > _END:
            raise CardError(OUT_OF_MEMORY)
        self.memory.I[start : start + words] = array("i", bytes(WORD_BYTES * words))
        return start

    def _blocks(self) -> Iterator[_Block]:
        for program in range(storage.COUNT):
            for scalar in SCALARS:
                count = self.row(program, scalar.count_row)
                start = self.row(program, scalar.base_row) * scalar.words
                if count:
                    yield _Block(start, count * scalar.words)
            for kind in ARRAYS:
                count = self.row(program, kind.count_row)
                if count:
                    yield from self._array_blocks(self.row(program, kind.base_row), count, kind)

    def _array_blocks(self, table: int, count: int, kind: ArrayType) -> Iterator[_Block]:
        yield _Block(table, count)
        longs = self.memory.I
        for place in self.memory.references(table, count):
            yield _Block(longs[place], 1 + longs[longs[place]] * kind.words)
