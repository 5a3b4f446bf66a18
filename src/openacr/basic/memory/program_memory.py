"""Locals of the programs: variables, arrays, strings and the move buffer of DIM and CLEAR."""

from collections.abc import Callable, Iterator

from openacr.basic.memory.heap import ARRAYS, SCALARS, ArrayType, Heap
from openacr.basic.memory.memory_cost import (
    ARRAY_REFERENCES,
    BUFFERED_MOVE,
    STRING_ARRAY_CHARACTERS,
    string_bytes,
)
from openacr.basic.memory.string_storage import (
    LONGEST_STRING,
    ProgramStrings,
    StringBlock,
    StringsState,
)
from openacr.errors import CardError
from openacr.map.rows import programs, storage
from openacr.messages import (
    INVALID_ARGUMENT,
    REDIMENSIONED_BLOCK,
    SUBSCRIPT_OUT_OF_RANGE,
    UNDEFINED_VARIABLE,
)

PROGRAMS = programs.COUNT

_SCALAR = {kind.name: kind for kind in SCALARS}
_ARRAY = {kind.name: kind for kind in ARRAYS}


class Locals:
    """What every program has dimensioned for itself.

    `take(program, bytes)` refuses what the memory of the program has no room for. With
    `repeat` a running program may give a DIM again with unchanged sizes: nothing happens.
    """

    def __init__(self, heap: Heap, take: Callable[[int, int], None]) -> None:
        self.heap = heap
        self._take = take
        self.strings = [ProgramStrings() for _ in range(PROGRAMS)]

    def variables(self, program: int, name: str, count: int, *, repeat: bool = False) -> None:
        """DIM LV, SV or DV: `count` variables, all 0."""
        kind = _SCALAR[name]
        if _is_new(self.heap.row(program, kind.count_row), count, repeat):
            self._take(program, kind.cost.bytes(count))
            self.heap.place_scalars(program, kind, count)

    def references(self, program: int, name: str, count: int, *, repeat: bool = False) -> None:
        """DIM LA, SA, DA or $A with one number: how many arrays there can be."""
        if name == "$A":
            present = len(self.strings[program].arrays)
            if _is_new(present, count, repeat):
                self._take(program, ARRAY_REFERENCES.bytes(count))
                self.strings[program].dimension(count)
            return
        kind = _ARRAY[name]
        if _is_new(self.heap.row(program, kind.count_row), count, repeat):
            self._take(program, ARRAY_REFERENCES.bytes(count))
            self.heap.place_references(program, kind, count)

    def array(
        self, program: int, name: str, index: int, count: int, *, repeat: bool = False
    ) -> None:
        """DIM LAi, SAi or DAi: the elements of one array."""
        kind = _ARRAY[name]
        if _is_new(self.heap.array_count(program, kind, index), count, repeat):
            self._take(program, kind.cost.bytes(count))
            self.heap.place_array(program, kind, index, count)

    def string_variables(
        self, program: int, count: int, length: int, *, repeat: bool = False
    ) -> None:
        """DIM $V: `count` strings of up to `length` characters, all empty."""
        _check_length(length)
        block = self.strings[program].variables
        present = block.shape if block else 0
        if _is_new(present, (count, length), repeat):
            self._take(program, count * string_bytes(length))
            self.strings[program].variables = StringBlock(length, [""] * count)

    def string_array(
        self, program: int, index: int, count: int, length: int, *, repeat: bool = False
    ) -> None:
        """DIM $Ai: `count` strings of up to `length` characters, all empty."""
        _check_length(length)
        arrays = self.strings[program].arrays
        if not arrays:
            raise CardError(UNDEFINED_VARIABLE)
        if not 0 <= index < len(arrays):
            raise CardError(SUBSCRIPT_OUT_OF_RANGE)
        block = arrays[index]
        if _is_new(block.shape if block else 0, (count, length), repeat):
            self._take(program, STRING_ARRAY_CHARACTERS.bytes(count * length))
            self.strings[program].put(index, StringBlock(length, [""] * count))

    def move_buffer(self, program: int, count: int, *, repeat: bool = False) -> None:
        """DIM MBUF: user memory for `count` buffered moves."""
        if _is_new(self.heap.row(program, storage.mbuf_count), count, repeat):
            self._take(program, BUFFERED_MOVE.bytes(count))
            self.heap.set_row(program, storage.mbuf_count, count)

    def clear(self, program: int) -> None:
        """CLEAR at a program: its locals, arrays, strings and MBUF are gone."""
        self.heap.free(program)
        self.heap.set_row(program, storage.mbuf_count, 0)
        self.strings[program] = ProgramStrings()

    def lines(self, program: int) -> Iterator[str]:
        """DIM at a program: its locals, in the form in which they are typed."""
        for scalar in SCALARS:
            yield from _listed(scalar.name, self.heap.row(program, scalar.count_row))
        strings = self.strings[program]
        if strings.variables:
            yield "DIM $V({},{})".format(*strings.variables.shape)
        for kind in ARRAYS:
            count = self.heap.row(program, kind.count_row)
            yield from _listed(kind.name, count)
            for index, elements in self.heap.arrays(program, kind):
                yield from _listed(f"{kind.name}{index}", elements)
        yield from _listed("$A", len(strings.arrays))
        for index, block in enumerate(strings.arrays):
            if block:
                yield "DIM $A{}({},{})".format(index, *block.shape)
        yield from _listed("MBUF", self.heap.row(program, storage.mbuf_count))

    def bytes(self, program: int) -> int:
        """User memory taken by the locals of a program."""
        used = BUFFERED_MOVE.bytes(self.heap.row(program, storage.mbuf_count))
        for scalar in SCALARS:
            if count := self.heap.row(program, scalar.count_row):
                used += scalar.cost.bytes(count)
        for kind in ARRAYS:
            if count := self.heap.row(program, kind.count_row):
                used += self._array_bytes(program, kind, count)
        return used + self.strings[program].bytes

    def forget(self) -> None:
        """All programs without locals, as on a new card."""
        for program in range(PROGRAMS):
            self.clear(program)

    def strings_state(self) -> list[StringsState]:
        """All strings as plain data, the only part that is not in the map."""
        return [program.state() for program in self.strings]

    def restore_strings(self, state: list[StringsState]) -> None:
        """Take over what `strings_state` returned."""
        self.strings = [ProgramStrings.from_state(program) for program in state]

    def _array_bytes(self, program: int, kind: ArrayType, count: int) -> int:
        arrays = (kind.cost.bytes(elements) for _, elements in self.heap.arrays(program, kind))
        return ARRAY_REFERENCES.bytes(count) + sum(arrays)


def _is_new(present: object, wanted: object, repeat: bool) -> bool:
    """Whether to dimension: False where a running program repeats itself."""
    counts = wanted if isinstance(wanted, tuple) else (wanted,)
    if min(counts) < 1:
        raise CardError(INVALID_ARGUMENT)
    if not present:
        return True
    if repeat and present == wanted:
        return False
    raise CardError(REDIMENSIONED_BLOCK)


def _check_length(length: int) -> None:
    if not 0 < length <= LONGEST_STRING:
        raise CardError(INVALID_ARGUMENT)


def _listed(name: str, count: int) -> Iterator[str]:
    if count:
        yield f"DIM {name}({count})"
