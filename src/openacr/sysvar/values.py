"""Values: what a cell accepts, how users write values, how they are shown.

Lengths are kept in the default unit of the store; `5mm` and `0.2in` are converted.
"""

import math
import re
from collections.abc import Callable

from openacr.errors import UserError
from openacr.sysvar.schema import ANY, Kind, Parameter

MM_PER_INCH = 25.4
DIGITS = 15  # kept when lengths are converted: 0.002 inch is 0.0508 mm, not 0.05079999999999999
SHOWN_DIGITS = 12
LONGEST_TEXT = 256
ROTARY = frozenset("ABC")

Value = float | str
_LENGTH = re.compile(r"(.*?)\s*(in|inch|mm)\b\.?", re.IGNORECASE | re.DOTALL)
_TRUTHS = {"true": 1, "yes": 1, "on": 1, "false": 0, "no": 0, "off": 0}


class SettingError(UserError):
    """A value a cell cannot take: which one, what was given, what it accepts."""

    def __init__(self, parameter: Parameter, value: object, expected: str, hint: str = "") -> None:
        self.parameter, self.value, self.expected, self.hint = parameter, value, expected, hint
        shown = f"{value:g}" if isinstance(value, float) else f"{value!r:.60}"
        tail = f" ({hint})" if hint else ""
        super().__init__(f"{parameter} cannot be {shown}: {expected}{tail}")


def rounded(value: float, digits: int = DIGITS) -> float:
    """Without the noise of a conversion in its last digits."""
    return float(f"{value:.{digits}g}")


def scaled(parameter: Parameter, value: float, factor: float, letter: str = "") -> float:
    """A length value in another unit; `letter` names the axis, rotary ones stay as they are."""
    if letter in ROTARY:
        return value
    if parameter.is_length:
        return rounded(value * factor)
    return rounded(value / factor) if parameter.is_per_length else value


# --- what a cell accepts --------------------------------------------------------------


def checked(parameter: Parameter, value: Value, factor: float = 1.0) -> Value:
    """The value as it is stored; SettingError if the cell cannot hold it.

    `factor` is that of a metric store: the ranges of lengths are declared in inches.
    """
    if parameter.is_text:
        return _text(parameter, value)
    if isinstance(value, str) or not math.isfinite(value):
        raise SettingError(parameter, value, accepted(parameter, factor), parameter.row.doc)
    number = float(value)
    if not _fits(parameter, number, factor):
        raise SettingError(parameter, number, accepted(parameter, factor), parameter.row.doc)
    return number


def _text(parameter: Parameter, value: Value) -> str:
    if not isinstance(value, str):
        raise SettingError(parameter, value, "it takes text")
    if len(value) > LONGEST_TEXT or not value.isprintable():
        raise SettingError(parameter, value, f"at most {LONGEST_TEXT} printable characters")
    return value


def _fits(parameter: Parameter, number: float, factor: float) -> bool:
    row = parameter.row
    if row.kind is not Kind.REAL and not number.is_integer():
        return False
    if row.kind is Kind.CHOICE:
        return int(number) in row.words
    low, high = limits(parameter, factor)
    if parameter.is_per_length and number == 0:
        return False
    return low < number <= high if row.is_low_open else low <= number <= high


def limits(parameter: Parameter, factor: float = 1.0) -> tuple[float, float]:
    """The lowest and highest value; lengths in the unit of the store."""
    scale = factor if parameter.is_length else 1.0
    return parameter.row.low * scale, parameter.row.high * scale


def accepted(parameter: Parameter, factor: float = 1.0) -> str:
    """The values a cell accepts, in words."""
    row = parameter.row
    if row.kind is Kind.TEXT:
        return "text"
    if row.kind in (Kind.CHOICE, Kind.BOOLEAN):
        return "one of " + ", ".join(_choice(value, word) for value, word in row.words.items())
    kind = "a whole number" if row.kind is Kind.INTEGER else "a number"
    span = _span(parameter, factor)
    unit = f" {unit_of(parameter, factor != 1.0)}" if row.unit else ""
    names = "".join(f"; {value} = {word}" for value, word in row.words.items())
    return f"{kind}{span}{unit}{names}"


def _choice(value: int, word: str) -> str:
    return word if word == str(value) else f"{value} ({word})"


def _span(parameter: Parameter, factor: float) -> str:
    low, high = limits(parameter, factor)
    is_open = parameter.row.is_low_open
    if parameter.is_per_length:
        return " other than 0"
    if low == -ANY and high == ANY:
        return ""
    if high == ANY:
        return f" above {low:g}" if is_open else f" from {low:g} up"
    return f" above {low:g} up to {high:g}" if is_open else f" from {low:g} to {high:g}"


# --- how users write and read values ----------------------------------------------------


def parsed(parameter: Parameter, text: str, is_metric: bool = False) -> Value:
    """What a user wrote, as a value for the store: numbers, words of choices, lengths."""
    if parameter.is_text:
        return text
    plain = text.strip()
    word = _word(parameter, plain.lower())
    if word is not None:
        return word
    convert: Callable[[float], float] = float
    length = _LENGTH.fullmatch(plain) if parameter.is_length or parameter.is_per_length else None
    if length:
        plain = length[1]
        factor = _factor(length[2], is_metric)

        def convert(number: float) -> float:
            return scaled(parameter, number, factor)

    try:
        return convert(float(plain))
    except ValueError:
        raise SettingError(parameter, text, accepted(parameter), parameter.row.doc) from None


def _word(parameter: Parameter, text: str) -> float | None:
    for value, word in parameter.row.words.items():
        if word.lower() == text:
            return float(value)
    if parameter.kind is Kind.BOOLEAN:
        return _TRUTHS.get(text)
    return -1.0 if text in ("disable", "none") and -1 in parameter.row.words else None


def _factor(unit: str, is_metric: bool) -> float:
    is_given_metric = unit.lower() == "mm"
    if is_given_metric == is_metric:
        return 1.0
    return MM_PER_INCH if is_metric else 1.0 / MM_PER_INCH


def shown(parameter: Parameter, value: Value) -> str:
    """A value as a user reads it: `2 (absolute)`, `0.0508`."""
    if isinstance(value, str):
        return value
    number = plain(rounded(value, SHOWN_DIGITS))
    word = parameter.row.words.get(int(value)) if value.is_integer() else None
    return number if word is None or word == number else f"{number} ({word})"


def plain(value: float) -> str:
    """A number with as many digits as it needs."""
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


def unit_of(parameter: Parameter, is_metric: bool, letter: str = "") -> str:
    """The unit of a cell in words: `mm/min`, `deg` on a rotary axis."""
    unit = parameter.row.unit
    if not (parameter.is_length or parameter.is_per_length):
        return unit.replace("deg/m", "deg/min")
    name = "deg" if letter in ROTARY else ("mm" if is_metric else "in")
    words = {"u/m": f"{name}/min", "pulse/u": f"pulse/{name}", "u per click": f"{name}/click"}
    return words.get(unit) or unit.replace("u", name, 1)
