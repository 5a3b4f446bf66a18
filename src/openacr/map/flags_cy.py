"""State of a flag by its number, for the compiled sources; the number must be that of a flag."""

from openacr.map.numbers import FLAG_WORD_BASE
from openacr.views import I32

__all__ = ["flag_bit", "put_flag"]


def flag_bit(I: I32, number: int) -> int:
    """State of flag `number`, 1 or 0."""
    return (I[FLAG_WORD_BASE + (number >> 5)] >> (number & 31)) & 1


def put_flag(I: I32, number: int, on: bool) -> None:
    """Set or clear flag `number`."""
    word: int = FLAG_WORD_BASE + (number >> 5)
    bit: int = number & 31
    mask: int = 1
    mask = -2147483648 if bit == 31 else mask << bit
    I[word] = I[word] | mask if on else I[word] & ~mask
