"""Kind of a parameter number, for the compiled sources.

The map itself holds the table: two bits per number, sixteen numbers to a word.
"""

from openacr.map.numbers import KIND_BASE, KIND_NONE, PUBLIC_COUNT
from openacr.views import I32

__all__ = ["kind_of"]


def kind_of(I: I32, number: int) -> int:
    """KIND_LONG, KIND_FP32, KIND_FP64, or KIND_NONE where no parameter is defined."""
    if number < 0 or number >= PUBLIC_COUNT:
        return KIND_NONE
    return (I[KIND_BASE + (number >> 4)] >> ((number & 15) * 2)) & 3
