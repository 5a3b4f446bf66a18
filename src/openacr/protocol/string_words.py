"""Strings of the programs as 32-bit words, addressed by address packets 06 ($V) and 07 ($A).

The manual defines only the count of strings; the rest follows its description of arrays:

    $V        count, then the address of each string
    $A        count, then the address of each array, 0 while it has no strings;
              an array is laid out as $V is
    a string  number of its characters, then room for the dimensioned length, four characters
              a word, the first one lowest; 0 after the last
"""

from collections.abc import Sequence
from itertools import accumulate
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


class ProgramStrings(Protocol):
    """All strings of a program."""

    @property
    def variables(self) -> Strings | None:
        """Its $V."""

    @property
    def arrays(self) -> Sequence[Strings | None]:
        """Its $A."""


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
        return _array_words(strings.arrays, base, offsets)
    if strings.variables is None:
        raise MapError(f"program {program} has no $V")
    return [_word(strings.variables, base, offset) for offset in offsets]


def _base(program: int, is_array: int) -> int:
    return STRINGS + (program * _PER_PROGRAM + is_array) * BLOCK_WORDS


def _stride(strings: Strings) -> int:
    """Words of one string."""
    return 1 - -strings.length // _CHARACTERS


def _size(strings: Strings | None) -> int:
    """Words of a block of strings: its count, then address and string for each."""
    return 1 + len(strings.values) * (1 + _stride(strings)) if strings else 0


def _word(strings: Strings, base: int, offset: int) -> int:
    """One word of a block of strings that begins at `base`."""
    count, stride = len(strings.values), _stride(strings)
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


def _array_words(arrays: Sequence[Strings | None], base: int, offsets: Sequence[int]) -> list[int]:
    """Words of the table of arrays at `base` and of the arrays that follow it."""
    if not arrays:
        raise MapError(f"there is no memory at address 0x{base:X}")
    starts = list(accumulate(map(_size, arrays), initial=1 + len(arrays)))
    found, number = [], 0
    for offset in offsets:
        if offset == 0:
            found.append(len(arrays))
        elif offset <= len(arrays):
            found.append(base + starts[offset - 1] if arrays[offset - 1] else 0)
        else:
            while number < len(arrays) and starts[number + 1] <= offset:
                number += 1
            array = arrays[number] if number < len(arrays) else None
            if array is None:
                raise MapError(f"there is no memory at address 0x{base + offset:X}")
            found.append(_word(array, base + starts[number], offset - starts[number]))
    return found
