"""What a handler has changed on its copy of the state, as a list that the loop takes over."""

from __future__ import annotations

from array import array
from collections.abc import Iterator

from openacr.compiled import pick
from openacr.engine import changes_cy
from openacr.map.memory import Memory
from openacr.map.merging import HEAP, Cell, cells
from openacr.map.rows import storage

_CHUNK = 1024  # cells that are compared together
_NUMBERS = (Cell.NUMBER, Cell.NUMBER_SHIFT, Cell.LOOP_NUMBER, Cell.ORDER_NUMBER)
_LOOPS = (Cell.LOOP_WORD, Cell.LOOP_NUMBER)
_ORDERS = (Cell.ORDER_WORD, Cell.ORDER_NUMBER)

_changes_take = pick(changes_cy.changes_take)


class Changes:
    """Entries in the order in which they are taken over."""

    def __init__(self) -> None:
        self._entries = array("i")

    def __len__(self) -> int:
        return len(self._entries) // changes_cy.ENTRY

    def note_call(self, call: int, number: int, whole: int, value: float) -> None:
        """Add a call of the kernel."""
        halves = array("i", array("d", [value]).tobytes())
        self._entries.extend([changes_cy.CALL, call, number, whole, *halves])

    def note(self, before: bytes, memory: Memory) -> Changes:
        """Add the cells of `memory` that are not as in `before`; returns the orders among them.

        Orders to the engine are not added, and cells that only the loop changes are left alone.
        """
        orders = Changes()
        for kind, place, old, new in _differing(before, memory):
            if kind in _LOOPS:
                continue
            entries = orders._entries if kind in _ORDERS else self._entries
            entries.extend([kind, place, *old, *new])
        return orders

    def take(self, memory: Memory) -> None:
        """Change a state by these entries."""
        if self._entries:
            entries = memoryview(self._entries)
            numbers = entries.cast("B").cast("d")
            _changes_take(memory.F, memory.I, memory.S, entries, numbers, len(self))


_Halves = tuple[int, int]


def _differing(before: bytes, memory: Memory) -> Iterator[tuple[Cell, int, _Halves, _Halves]]:
    """Kind, place, old and new bits of every cell that is not what it was."""
    old, new = memoryview(before).cast("i"), memory.I
    table = cells()
    heap_numbers: set[int] | None = None
    for start in range(0, len(old), _CHUNK):
        stop = min(start + _CHUNK, len(old))
        if before[4 * start : 4 * stop] == new[start:stop].tobytes():
            continue
        number = -1
        for cell in range(start, stop):
            if old[cell] == new[cell] or cell >> 1 == number:
                continue
            kind = Cell(table[cell]) if cell < HEAP else Cell.WORD
            if cell >= HEAP:
                heap_numbers = (
                    _numbers_of_programs(memory) if heap_numbers is None else heap_numbers
                )
                kind = Cell.NUMBER if cell >> 1 in heap_numbers else Cell.WORD
            if kind not in _NUMBERS:
                yield kind, cell, (old[cell], 0), (new[cell], 0)
                continue
            number = cell >> 1
            low, high = 2 * number, 2 * number + 1
            yield kind, number, (old[low], old[high]), (new[low], new[high])


def _numbers_of_programs(memory: Memory) -> set[int]:
    """Places in F of the 64-bit variables and array elements of all programs."""
    rows = memory.I
    found: set[int] = set()
    for owner in range(storage.COUNT):
        first = rows[storage.dv_base[owner]]
        found.update(range(first, first + rows[storage.dv_count[owner]]))
        table = rows[storage.da_base[owner]]
        for header in memory.references(table, rows[storage.da_count[owner]]):
            place = rows[header]
            found.update(range((place + 1) // 2, (place + 1) // 2 + rows[place]))
    return found
