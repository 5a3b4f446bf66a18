"""The address space of peek, poke and address packets: 32-bit words.

Real addresses differ from card to card, so hosts query them. This card answers with:

    system pointers   of all documented cards: the address of the global variables, or 0
    0x00411000...     parameter p at 0x00410000 + p
    0x00500000        number of global variables, then P0, P1, ... as FP64 (two words each)
    0x00800000...     heap: numeric arrays, each a count followed by its elements
    0x01000000...     a block per program and kind: a count followed by the variables, or
                      by the addresses of the arrays
    0x10000000...     strings, as `string_words` lays them out; they can be peeked only
"""

from collections.abc import Callable, Iterator, Sequence

from msgspec import Struct

from openacr.errors import MapError
from openacr.map import numbers as at
from openacr.map.kinds_cy import is_read_only, kind_of
from openacr.map.memory import Memory
from openacr.map.rows import storage, system
from openacr.protocol import string_words
from openacr.protocol.memory import VariableKind

SYSTEM_POINTERS = frozenset((0x400008, 0x400009, 0x403E08, 0xC08008))
PARAMETERS = 0x410000
GLOBALS = 0x500000
HEAP = 0x800000
LOCALS = 0x1000000
BLOCK_WORDS = 1 << 20
KINDS = len(VariableKind)
PROGRAMS = 16

_HEAP_FIRST = at.HEAP_BYTE_BASE // 4
_HEAP_WORDS = at.HEAP_BYTES // 4
_FP64_WORDS = 2


class _Rows(Struct, frozen=True):
    """The storage rows that describe one kind of variables of a program."""

    base: tuple[int, ...]
    count: tuple[int, ...]
    words: int  # of one variable, or of one reference to an array
    element_words: int = 0  # of the arrays a table refers to

    @property
    def is_table(self) -> bool:
        """Whether the block holds references to arrays."""
        return self.element_words > 0


_ROWS = {
    VariableKind.DV: _Rows(storage.dv_base, storage.dv_count, _FP64_WORDS),
    VariableKind.DA: _Rows(storage.da_base, storage.da_count, 1, _FP64_WORDS),
    VariableKind.SV: _Rows(storage.sv_base, storage.sv_count, 1),
    VariableKind.SA: _Rows(storage.sa_base, storage.sa_count, 1, 1),
    VariableKind.LV: _Rows(storage.lv_base, storage.lv_count, 1),
    VariableKind.LA: _Rows(storage.la_base, storage.la_count, 1, 1),
}
_STRING_KINDS = {
    VariableKind.STRING_VARIABLES: string_words.variables_address,
    VariableKind.STRING_ARRAYS: string_words.arrays_address,
}


def _in_heap(address: int) -> bool:
    return 0 <= address - HEAP < _HEAP_WORDS


class AddressSpace:
    """The words of one card's memory, by address."""

    def __init__(
        self, memory: Memory, strings: Callable[[], Sequence[string_words.ProgramStrings]]
    ) -> None:
        self._memory = memory
        self._strings = strings  # of all programs, wherever they are now

    def parameter_address(self, number: int) -> int:
        """The address of a parameter; 0 if there is no such parameter."""
        if 0 <= number < self._globals():
            return GLOBALS + 1 + _FP64_WORDS * number
        return PARAMETERS + number if self._is_word_parameter(number) else 0

    def variable_address(self, program: int, kind: int) -> int:
        """The address of the variables of one kind of a program; 0 if it has none."""
        if kind in _STRING_KINDS and 0 <= program < PROGRAMS:
            return _STRING_KINDS[VariableKind(kind)](program, self._strings()[program])
        block = program * KINDS + kind
        return LOCALS + block * BLOCK_WORDS if self._block(block) else 0

    def read_words(self, address: int, count: int) -> list[int]:
        """Read `count` words from an address on; MapError where there is no memory."""
        if _in_heap(address) and _in_heap(address + count - 1):
            start = _HEAP_FIRST + address - HEAP
            return self._memory.I[start : start + count].tolist()
        if address >= string_words.STRINGS:
            return string_words.read(self._strings(), address, count)
        return [self._word(address + n) for n in range(count)]

    def write_words(self, address: int, words: Sequence[int]) -> None:
        """Store words; MapError, and nothing stored, unless all can be written."""
        addresses = range(address, address + len(words))
        elements = self._array_at(address) if _in_heap(address) else range(0)
        places = [self._place(each, elements) for each in addresses]
        for n, place in enumerate(places):
            if place is None or is_read_only(place):
                raise MapError(f"address 0x{address + n:X} cannot be written")
        for place, word in zip(places, words, strict=True):
            if place is not None:
                self._memory.I[place] = word

    def _word(self, address: int) -> int:
        if _in_heap(address):
            return self._memory.I[_HEAP_FIRST + address - HEAP]
        place = self._place(address)
        if place is not None:
            return self._memory.I[place]
        computed = self._computed(address)
        if computed is None:
            raise MapError(f"there is no memory at address 0x{address:X}")
        return computed

    def _place(self, address: int, elements: range = range(0)) -> int | None:
        """Index of the word in the state buffer, for words that hold a value.

        In the heap these are the `elements` of one array; counts and tables hold it together.
        """
        if self._is_word_parameter(address - PARAMETERS):
            return address - PARAMETERS
        if 0 < address - GLOBALS <= _FP64_WORDS * self._globals():
            return _FP64_WORDS * at.USER_BASE + address - GLOBALS - 1
        if _in_heap(address):
            place = _HEAP_FIRST + address - HEAP
            return place if place in elements else None
        block, offset = divmod(address - LOCALS, BLOCK_WORDS)
        found = self._block(block)
        if found is None or found[0].is_table or not 0 < offset <= found[2] * found[0].words:
            return None
        rows, base, _ = found
        return base * rows.words + offset - 1

    def _computed(self, address: int) -> int | None:
        """The value of a count or pointer word, which no program can change."""
        if address in SYSTEM_POINTERS:
            return GLOBALS if self._globals() else 0
        if address == GLOBALS:
            return self._globals()
        block, offset = divmod(address - LOCALS, BLOCK_WORDS)
        found = self._block(block)
        if found is None or offset > found[2]:
            return None
        _, base, count = found
        return self._array_address(base + offset - 1) if offset else count

    def _array_address(self, reference: int) -> int:
        """Address of the array whose reference is this word; 0 while it has no elements."""
        header = self._memory.I[reference]
        return HEAP + header - _HEAP_FIRST if header else 0

    def _array_at(self, address: int) -> range:
        """The element places of the array that a heap word belongs to, empty outside arrays.

        Adjacent words belong to one array: two arrays are separated by a count.
        """
        place = _HEAP_FIRST + address - HEAP
        longs = self._memory.I
        for rows, base, count in filter(None, map(self._block, range(PROGRAMS * KINDS))):
            for header in self._headers(base, count) if rows.is_table else ():
                if header < place <= header + longs[header] * rows.element_words:
                    return range(header + 1, header + 1 + longs[header] * rows.element_words)
        return range(0)

    def _headers(self, table: int, count: int) -> Iterator[int]:
        """Where the arrays of a table that have elements begin."""
        return (self._memory.I[place] for place in self._memory.references(table, count))

    def _globals(self) -> int:
        return self._memory.I[system.p_count]

    def _is_word_parameter(self, number: int) -> bool:
        return kind_of(self._memory.I, number) in (at.KIND_LONG, at.KIND_FP32)

    def _block(self, block: int) -> tuple[_Rows, int, int] | None:
        """Rows, base index and count of a block of locals; None when there is none."""
        program, kind = divmod(block, KINDS)
        if not 0 <= program < PROGRAMS or kind not in _ROWS:
            return None
        rows = _ROWS[VariableKind(kind)]
        count = self._memory.I[rows.count[program]]
        return (rows, self._memory.I[rows.base[program]], count) if count else None
