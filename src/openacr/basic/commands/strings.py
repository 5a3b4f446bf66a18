"""String functions and rules: one decorated function per row, pure in its arguments.

A string of the card is a Python string of characters 0..255, one per byte. Functions
that look at a device (INKEY$, GETCH, KBHIT) belong to the executor, which knows the
devices of the program.
"""

import math
import re
from collections.abc import Callable
from typing import TypeVar

from openacr.basic.language.registry import function
from openacr.basic.memory.string_storage import LONGEST_STRING
from openacr.errors import CardError
from openacr.messages import MATH_ERROR, TYPE_MISMATCH

_NUMBER = re.compile(
    r"[ \t]*(?P<sign>[+-]?)[ \t]*"
    r"(?:&[Hh](?P<hex>[0-9A-Fa-f]{1,8})|(?P<decimal>(?:\d+\.?\d*|\.\d+)(?:[Ee][+-]?\d+)?))"
)


_Function = TypeVar("_Function", bound=Callable[..., str | float])


def _function(
    name: str, takes: str, *, fewest: int | None = None
) -> Callable[[_Function], _Function]:
    """Enter the decorated function under `name`; its first line is what HELP tools show."""

    def enter(apply: _Function) -> _Function:
        summary = (apply.__doc__ or "").split("\n")[0]
        function(name, takes, fewest=fewest, apply=apply, summary=summary)
        return apply

    return enter


@_function("ASC", "s")
def asc(text: str) -> float:
    """Code of the first character; 0 for an empty string."""
    return float(ord(text[0])) if text else 0.0


@_function("CHR$", "n")
def chr_(code: float) -> str:
    """One character; the code is taken modulo 256."""
    return chr(whole(code) % 256)


@_function("LEFT$", "sn")
def left(text: str, count: float) -> str:
    """First `count` characters."""
    return text[: max(whole(count), 0)]


@_function("RIGHT$", "sn")
def right(text: str, count: float) -> str:
    """Last `count` characters."""
    return text[max(len(text) - max(whole(count), 0), 0) :]


@_function("MID$", "snn", fewest=2)
def mid(text: str, start: float, count: float = LONGEST_STRING) -> str:
    """`count` characters from position `start` (1 is the first); without count to the end."""
    first = max(whole(start), 1) - 1
    return text[first : first + max(whole(count), 0)]


@_function("LEN", "s")
def len_(text: str) -> float:
    """Number of characters."""
    return float(len(text))


@_function("INSTR", "ees", fewest=2)
def instr(*arguments: str | float) -> float:
    """Position of the second string in the first, 0 if absent; an empty one is at start."""
    first, text, find = arguments if len(arguments) == 3 else (1, *arguments)
    if not isinstance(text, str) or not isinstance(find, str) or isinstance(first, str):
        raise CardError(TYPE_MISMATCH)
    start = max(whole(first), 1)
    return float(text.find(find, start - 1) + 1) if find else float(start)


@_function("STR$", "p")
def str_(shown: str) -> str:
    """The text PRINT shows for the value."""
    return shown  # as `p` hands it over


@_function("VAL", "s")
def val(text: str) -> float:
    """Leading number of the text: blanks, sign, decimals, exponent or &H; none gives 0."""
    match = _NUMBER.match(text)
    if match is None:
        return 0.0
    if match["hex"]:
        size = float(wrap_signed(int(match["hex"], 16)))
    else:
        size = float(match["decimal"])
    if not math.isfinite(size):
        raise CardError(MATH_ERROR)
    return 0.0 - size if match["sign"] == "-" else size


@_function("UCASE$", "s")
def ucase(text: str) -> str:
    """The letters A to Z in upper case."""
    return text.encode("latin-1").upper().decode("latin-1")


@_function("LCASE$", "s")
def lcase(text: str) -> str:
    """The letters A to Z in lower case."""
    return text.encode("latin-1").lower().decode("latin-1")


@_function("SPACE$", "n")
def space(count: float) -> str:
    """`count` blanks."""
    return " " * min(whole(count), LONGEST_STRING)


@_function("STRING$", "ne")
def string(count: float, character: str | float) -> str:
    """`count` times a character, given by its code or as the first of a string."""
    one = character[:1] if isinstance(character, str) else chr_(character)
    return one * min(whole(count), LONGEST_STRING)


@_function("HEX$", "n")
def hex_(value: float) -> str:
    """Hexadecimal digits of the 32-bit value."""
    return f"{whole(value) & 0xFFFFFFFF:X}"


def whole(value: float) -> int:
    """`value` without its fraction; refused outside the 32-bit range."""
    if not -2147483649 < value < 4294967296:
        raise CardError(MATH_ERROR)
    return int(value)


def wrap_signed(value: int) -> int:
    """The low 32 bits of `value` as a signed number."""
    return ((value + 0x80000000) & 0xFFFFFFFF) - 0x80000000
