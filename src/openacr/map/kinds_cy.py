"""Kind of a parameter number, for the compiled sources.

The map itself holds the table: two bits per number, sixteen numbers to a word.
"""

from openacr.map import numbers as at
from openacr.views import I32

__all__ = ["is_read_only", "kind_of", "store_long"]


def kind_of(I: I32, number: int) -> int:
    """KIND_LONG, KIND_FP32, KIND_FP64, or KIND_NONE where no parameter is defined."""
    if number < 0 or number >= at.PUBLIC_COUNT:
        return at.KIND_NONE
    return (I[at.KIND_BASE + (number >> 4)] >> ((number & 15) * 2)) & 3


def is_read_only(number: int) -> bool:
    """Whether stores leave parameter `number` as it is: the board information, P7040 to P7046.

    The other parameters without write access need no guard: the card writes them anew.
    """
    return at.P_CARD_SERIAL_NUMBER <= number <= at.P_IO_CONFIGURATION


def store_long(I: I32, number: int, value: int) -> None:
    """LONG parameter `number` := value, unless it is read-only."""
    if not is_read_only(number):
        I[number] = value
