"""Arrays of numbers in the form that compiled functions take."""

from array import array
from collections.abc import Iterable
from typing import cast

from openacr.trajectory.path.setpoints import Reals
from openacr.views import F64, I32


def flat(values: Reals) -> F64:
    """The numbers of an array, row after row; writing to them changes the array."""
    return cast("F64", memoryview(values.reshape(-1)))  # type: ignore[arg-type]


def numbers(values: Iterable[float]) -> F64:
    """A row of numbers."""
    return cast("F64", memoryview(array("d", values)))


def room(count: int) -> F64:
    """Room for numbers, all 0."""
    return cast("F64", memoryview(array("d", bytes(8 * count))))


def whole(count: int) -> I32:
    """Room for whole numbers, all 0."""
    return cast("I32", memoryview(array("i", bytes(4 * count))))
