"""The mathematics of the plain build against the C library, bit for bit."""

import ctypes
import ctypes.util
import math
import struct
from collections.abc import Callable
from itertools import product

import pytest

from openacr import cmath

LIBRARY = ctypes.CDLL(ctypes.util.find_library("m"))
ONE = [
    "acos", "acosh", "asin", "asinh", "atan", "atanh", "ceil", "cos", "cosh", "exp", "fabs",
    "floor", "log", "log10", "rint", "sin", "sinh", "tan", "tanh", "trunc",
]  # fmt: skip
TWO = ["atan2", "fmod", "pow"]
NUMBERS = [
    0.0, -0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.0, -2.0, 3.0, -3.0, 709.0, 711.0, -711.0, 1e300,
    -1e300, 5e-324, -5e-324, math.inf, -math.inf, math.nan,
]  # fmt: skip


def bits(value: float) -> str:
    return struct.pack(">d", value).hex()


def of_c(name: str, count: int) -> Callable[..., float]:
    function = getattr(LIBRARY, name)
    function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * count
    return function  # type: ignore[no-any-return]


@pytest.mark.parametrize("name", ONE)
def test_a_function_of_one_number_is_that_of_the_c_library(name: str) -> None:
    function, expected = getattr(cmath, name), of_c(name, 1)
    assert [(x, bits(function(x))) for x in NUMBERS] == [(x, bits(expected(x))) for x in NUMBERS]


@pytest.mark.parametrize("name", TWO)
def test_a_function_of_two_numbers_is_that_of_the_c_library(name: str) -> None:
    function, expected = getattr(cmath, name), of_c(name, 2)
    pairs = list(product(NUMBERS, NUMBERS))
    assert [(*pair, bits(function(*pair))) for pair in pairs] == [
        (*pair, bits(expected(*pair))) for pair in pairs
    ]
