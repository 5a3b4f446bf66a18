"""What a handler has changed on its copy of the state, as a list that the loop takes over."""

from __future__ import annotations

from array import array
from collections.abc import Iterator

from openacr.compiled import pick
from openacr.engine import changes_cy
from openacr.map.memory import Memory
from openacr.map.merging import HEAP, Cell, cells
from openacr.map.rows import storage

_ENTRY = changes_cy.ENTRY
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
        return len(self._entries) // _ENTRY

    def note_call(self, call: int, number: int, whole: int, value: float) -> None:
        """Add a call of the kernel."""
        halves = array("i", array("d", [value]).tobytes())
        self._entries.extend([changes_cy.CALL, call, number, whole, *halves])

    def extend(self, others: Changes) -> None:
        """Add all of another list."""
        self._entries.extend(others._entries)

    def words(self) -> memoryview[int]:
        """The list as numbers, as the loop takes it over."""
        return memoryview(self._entries)

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

    def note_as_they_are(self, memory: Memory, place: int, count: int = 1, mask: int = -1) -> None:
        """Add the masked bits of words, whatever the loop makes of them meanwhile."""
        for word in range(place, place + count):
            self._entries.extend([changes_cy.MASKED, word, mask, 0, memory.I[word], 0])

    def crossed(self, memory: Memory) -> list[tuple[Cell, int]]:
        """The cells that get the handler's value although the loop has changed them meanwhile.

        Kind and place (in F or in I), but for words that are given as they are; up to the first
        call of the kernel, which may change any.
        """
        entries = [self._entries[k : k + _ENTRY] for k in range(0, len(self._entries), _ENTRY)]
        given = {entry[1] for entry in entries if entry[0] == changes_cy.MASKED}
        found = []
        for kind, place, *bits in entries:
            if kind == changes_cy.CALL:
                break
            if kind not in (Cell.WORD, Cell.NUMBER) or place in given:
                continue
            if kind == Cell.WORD:
                now = [memory.I[place], 0]
            else:
                now = memory.I[2 * place : 2 * place + 2].tolist()
            if now not in (bits[:2], bits[2:]):
                found.append((Cell(kind), place))
        return found

    def take(self, memory: Memory) -> None:
        """Change a state by these entries."""
        if self._entries:
            entries = memoryview(self._entries)
            numbers = entries.cast("B").cast("d")
            _changes_take(memory.F, memory.I, memory.S, entries, numbers, 0, len(self))


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
