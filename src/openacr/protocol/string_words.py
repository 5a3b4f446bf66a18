"""Strings of the programs as 32-bit words, addressed by address packets 06 ($V) and 07 ($A).

The manual defines only the count of strings; the rest follows its description of arrays:

    $V        count, then the address of each string
    $A        count, then the address of each array, 0 while it has no strings;
              an array is laid out as $V is
    a string  number of its characters, then room for the dimensioned length, four characters
              a word, the first one lowest; 0 after the last
"""

from collections.abc import Sequence
from typing import Protocol

from openacr.errors import MapError

STRINGS = 0x10000000
BLOCK_WORDS = 1 << 23  # more than the memory of the card can hold
_PER_PROGRAM = 2  # $V and $A
_CHARACTERS = 4  # of a word


class Strings(Protocol):
    """Strings of one dimensioned length."""

    @property
    def length(self) -> int:
        """Capacity of each string in characters."""

    @property
    def values(self) -> Sequence[str]:
        """The contents of the strings."""

    @property
    def string_words(self) -> int:
        """Words of one string."""


class Sizes(Protocol):
    """The words of arrays, one after the other."""

    def before(self, index: int) -> int:
        """Words of all arrays before an index."""

    def find(self, total: int) -> int:
        """The array in which the word after `total` others lies; the number of arrays if none."""


class ProgramStrings(Protocol):
    """All strings of a program."""

    @property
    def variables(self) -> Strings | None:
        """Its $V."""

    @property
    def arrays(self) -> Sequence[Strings | None]:
        """Its $A."""

    @property
    def sizes(self) -> Sizes:
        """The words of its $A."""


def variables_address(program: int, strings: ProgramStrings) -> int:
    """The address of the $V of a program; 0 if it has none."""
    return _base(program, 0) if strings.variables else 0


def arrays_address(program: int, strings: ProgramStrings) -> int:
    """The address of the $A of a program; 0 if it has none."""
    return _base(program, 1) if strings.arrays else 0


def read(programs: Sequence[ProgramStrings], address: int, count: int) -> list[int]:
    """Read `count` words from an address on; MapError outside the strings."""
    block, first = divmod(address - STRINGS, BLOCK_WORDS)
    program, is_array = divmod(block, _PER_PROGRAM)
    if not 0 <= program < len(programs):
        raise MapError(f"there is no memory at address 0x{address:X}")
    strings, base = programs[program], _base(program, is_array)
    offsets = range(first, first + count)
    if is_array:
        return [_array_word(strings, base, offset) for offset in offsets]
    if strings.variables is None:
        raise MapError(f"program {program} has no $V")
    return [_word(strings.variables, base, offset) for offset in offsets]


def _base(program: int, is_array: int) -> int:
    return STRINGS + (program * _PER_PROGRAM + is_array) * BLOCK_WORDS


def _word(strings: Strings, base: int, offset: int) -> int:
    """One word of a block of strings that begins at `base`."""
    count, stride = len(strings.values), strings.string_words
    if offset == 0:
        return count
    if offset <= count:
        return base + 1 + count + (offset - 1) * stride
    number, word = divmod(offset - 1 - count, stride)
    if number >= count:
        raise MapError(f"there is no memory at address 0x{base + offset:X}")
    text = strings.values[number]
    if word == 0:
        return len(text)
    part = text[_CHARACTERS * (word - 1) : _CHARACTERS * word]
    return int.from_bytes(part.encode("latin-1"), "little")


def _array_word(strings: ProgramStrings, base: int, offset: int) -> int:
    """One word of the table of arrays at `base`, or of the arrays that follow it."""
    arrays, sizes = strings.arrays, strings.sizes
    first = 1 + len(arrays)
    if arrays and offset == 0:
        return len(arrays)
    if 0 < offset < first:
        return base + first + sizes.before(offset - 1) if arrays[offset - 1] else 0
    number = sizes.find(offset - first)
    array = arrays[number] if number < len(arrays) else None
    if array is None:
        raise MapError(f"there is no memory at address 0x{base + offset:X}")
    start = first + sizes.before(number)
    return _word(array, base + start, offset - start)
