"""The text of a number as the card prints it: PRINT, queries, STR$ and PRINT USING.

Values are rounded to the digits of their kind first, and only the rounded decimal
decides between plain and exponent form: an FP32 0.0001 (stored 9.9999997e-05) prints
`0.0001`, never `1E-04`.
"""

import math
import re
import struct
from decimal import ROUND_HALF_UP, Context, Decimal
from enum import Enum

from msgspec import Struct

from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT

SINGLE_DIGITS = 7
DOUBLE_DIGITS = 10
LARGEST_PLAIN = Decimal("1e15")
SMALLEST_PLAIN = Decimal("1e-4")

# Wide enough for the largest FP64 with every decimal a 255-character line can hold.
_WIDE = Context(prec=700)
_SINGLE = struct.Struct("<f")
_USING = re.compile(r"(?P<sign>\+?)(?P<whole>0?#*)(?P<point>\.?)(?P<fraction>#*)")


class NumberKind(Enum):
    """How the value is stored, which decides the digits that are shown."""

    LONG = "LONG"
    SINGLE = "FP32"
    DOUBLE = "FP64"
    BIT = "BIT"


def number_text(value: float, kind: NumberKind = NumberKind.DOUBLE) -> str:
    """The text PRINT shows for a value of the given kind, without blanks around it."""
    if kind is NumberKind.BIT:
        return bit_text(value != 0)
    if kind is NumberKind.SINGLE:
        return single_text(value)
    return long_text(int(value)) if kind is NumberKind.LONG else double_text(value)


def long_text(value: int) -> str:
    """A LONG: always a plain integer."""
    return str(value)


def bit_text(is_set: bool) -> str:
    """A flag: -1 when set, 0 when clear."""
    return "-1" if is_set else "0"


def single_text(value: float) -> str:
    """An FP32 value: the shortest decimal that reads back as it, at most 7 digits."""
    if not math.isfinite(value):
        return _not_finite(value)
    for digits in range(1, SINGLE_DIGITS):
        text = f"{value:.{digits}g}"
        if _as_single(float(text)) == _as_single(value):
            return _decimal_text(Decimal(text))
    return _decimal_text(Decimal(f"{value:.{SINGLE_DIGITS}g}"))


def double_text(value: float) -> str:
    """An FP64 value: whole numbers below 1e15 in full, others with at most 10 digits."""
    if not math.isfinite(value):
        return _not_finite(value)
    if value == int(value) and abs(value) < LARGEST_PLAIN:
        return str(int(value))
    return _decimal_text(Decimal(f"{value:.{DOUBLE_DIGITS}g}"))


def _as_single(value: float) -> float:
    """`value` rounded to 32-bit float; beyond its range the infinity of its sign."""
    try:
        return float(_SINGLE.unpack(_SINGLE.pack(value))[0])
    except OverflowError:
        return math.copysign(math.inf, value)


def _decimal_text(rounded: Decimal) -> str:
    """Plain form, or `d.dddE-05` for sizes below 1e-4 and from 1e15 on."""
    if rounded == 0:
        return "0"
    size = abs(rounded)
    if SMALLEST_PLAIN <= size < LARGEST_PLAIN:
        plain = f"{rounded:f}"
        return plain.rstrip("0").rstrip(".") if "." in plain else plain
    mantissa, exponent = f"{rounded:e}".split("e")
    if "." in mantissa:
        mantissa = mantissa.rstrip("0").rstrip(".")
    return f"{mantissa}E{int(exponent):+03d}"


def _not_finite(value: float) -> str:
    """What only a host can write into a parameter: no expression yields it."""
    if math.isnan(value):
        return "NAN"
    return "INF" if value > 0 else "-INF"


class UsingFormat(Struct, frozen=True):
    """A PRINT USING picture: width in characters, decimals, and how the rest is filled."""

    width: int
    decimals: int
    has_sign: bool
    pads_zeros: bool
    has_point: bool

    @classmethod
    def parse(cls, picture: str) -> "UsingFormat":
        """Read `+`, a leading `0`, `#` positions and one `.`; anything else is refused."""
        match = _USING.fullmatch(picture)
        if match is None or not (match["whole"] or match["fraction"]):
            raise CardError(INVALID_ARGUMENT)
        return cls(
            width=len(picture),
            decimals=len(match["fraction"]),
            has_sign=bool(match["sign"]),
            pads_zeros=match["whole"].startswith("0"),
            has_point=bool(match["point"]),
        )

    def text(self, value: float) -> str:
        """`value` rounded (halves away from zero) into the picture; all `*` if too long."""
        if not math.isfinite(value):
            return "*" * self.width
        step = Decimal(1).scaleb(-self.decimals)
        rounded = Decimal(repr(value)).quantize(step, ROUND_HALF_UP, _WIDE)
        digits = f"{abs(rounded):f}" + ("." if self.has_point and not self.decimals else "")
        sign = "-" if rounded < 0 else "+" if self.has_sign else ""
        if len(sign + digits) > self.width and digits.startswith("0."):
            digits = digits[1:]  # a picture without whole positions, `.##`
        if len(sign + digits) > self.width:
            return "*" * self.width
        if self.pads_zeros:
            return sign + digits.rjust(self.width - len(sign), "0")
        return (sign + digits).rjust(self.width)
