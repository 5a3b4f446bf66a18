"""How a row is merged that handlers have changed on a copy while the loop went on.

A handler works on a copy of the state. When it is done, each cell that is not what it was goes
into the state of the loop by the rule of its row, which is declared with the row
(`map/hidden/block.py`).
"""

from enum import IntEnum
from functools import cache

from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.hidden.block import Merge, places
from openacr.map.layout import hidden_bases
from openacr.map.numbers import FLAG_LAST, FLAG_WORD_BASE, HEAP_BYTE_BASE, HIDDEN_BASE, USER_BASE

FLAGS_END = FLAG_WORD_BASE + FLAG_LAST // 32 + 1
HEAP = HEAP_BYTE_BASE // 4


class Cell(IntEnum):
    """What a 32-bit cell of the buffer is part of, and how it is merged."""

    WORD = 0  # 32 bits; the value of the handler
    BITS = 1  # the bits that the handler has changed
    WORD_SHIFT = 2  # what the handler has added
    LOOP_WORD = 3  # the value of the loop
    ORDER_WORD = 4  # a request to the engine: at once
    NUMBER = 5  # the first half of 64 bits; the value of the handler
    NUMBER_SHIFT = 6
    LOOP_NUMBER = 7
    ORDER_NUMBER = 8


_WORDS = {
    Merge.VALUE: Cell.WORD,
    Merge.BITS: Cell.BITS,
    Merge.SHIFT: Cell.WORD_SHIFT,
    Merge.LOOP: Cell.LOOP_WORD,
    Merge.ORDER: Cell.ORDER_WORD,
}
_NUMBERS = {
    Merge.VALUE: Cell.NUMBER,
    Merge.SHIFT: Cell.NUMBER_SHIFT,
    Merge.LOOP: Cell.LOOP_NUMBER,
    Merge.ORDER: Cell.ORDER_NUMBER,
}


@cache
def cells() -> bytes:
    """A `Cell` for every 32 bits below the heap; both halves of a number have the same."""
    table = bytearray(HEAP)  # WORD
    table[FLAG_WORD_BASE:FLAGS_END] = bytes([Cell.BITS]) * (FLAGS_END - FLAG_WORD_BASE)
    table[2 * USER_BASE : 2 * HIDDEN_BASE] = bytes([Cell.NUMBER]) * (2 * (HIDDEN_BASE - USER_BASE))
    for block, real, whole in hidden_bases(HIDDEN_BLOCKS):
        for record in range(block.count):
            for name, offset, size in places(block.doubles):
                first = 2 * (real + record * block.doubles_stride + offset)
                table[first : first + 2 * size] = bytes([_NUMBERS[block.merge(name)]]) * (2 * size)
            for name, offset, size in places(block.ints):
                first = whole + record * block.ints_stride + offset
                table[first : first + size] = bytes([_WORDS[block.merge(name)]]) * size
    return bytes(table)
