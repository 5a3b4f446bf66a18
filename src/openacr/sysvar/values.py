"""Values of cells: which are accepted, how users write them, how they are displayed.

Lengths are kept in the default unit of the store; `5mm` and `0.2in` are converted.
"""

import math
import re
from collections.abc import Callable

from openacr.errors import UserError
from openacr.sysvar.schema import ANY, CellKind, Parameter
from openacr.units import MM_PER_INCH

DIGITS = 15  # kept when lengths are converted: 0.002 inch is 0.0508 mm, not 0.05079999999999999
SHOWN_DIGITS = 12
LONGEST_TEXT = 256
ROTARY = frozenset("ABC")

Value = float | str
_LENGTH = re.compile(r"(.*?)\s*(in|inch|mm)\b\.?", re.IGNORECASE | re.DOTALL)
_TRUTHS = {"true": 1, "yes": 1, "on": 1, "false": 0, "no": 0, "off": 0}


class SettingError(UserError):
    """A value that a cell refuses, with the cell, the value and what it accepts.

    The value is None where the cell cannot be changed at present.
    """

    def __init__(self, parameter: Parameter, value: object, expected: str, hint: str = "") -> None:
        self.parameter, self.value, self.expected, self.hint = parameter, value, expected, hint
        if value is None:
            shown = "changed"
        else:
            shown = f"{value:g}" if isinstance(value, float) else f"{value!r:.60}"
        tail = f" ({hint})" if hint else ""
        super().__init__(f"{parameter} cannot be {shown}: {expected}{tail}")


def rounded(value: float, digits: int = DIGITS) -> float:
    """The value rounded to `digits` digits, without the noise of unit conversion."""
    return float(f"{value:.{digits}g}")


def scaled(parameter: Parameter, value: float, factor: float, letter: str = "") -> float:
    """A length in another unit; values of rotary axes (`letter`) are not converted."""
    if letter in ROTARY:
        return value
    if parameter.is_length:
        return rounded(value * factor)
    return rounded(value / factor) if parameter.is_per_length else value


# --- what a cell accepts --------------------------------------------------------------


def checked(parameter: Parameter, value: Value, is_metric: bool = False, letter: str = "") -> Value:
    """The value as it will be stored; SettingError if the cell refuses it.

    `is_metric` is the unit of the store, `letter` names the axis of the cell.
    """
    if parameter.is_text:
        return _text(parameter, value)
    if not (isinstance(value, str) or not math.isfinite(value)):
        number = float(value)
        if _fits(parameter, number, is_metric, letter):
            return number
    words = accepted(parameter, is_metric, letter)
    raise SettingError(parameter, value, words, parameter.row.doc)


def _text(parameter: Parameter, value: Value) -> str:
    if not isinstance(value, str):
        raise SettingError(parameter, value, "text is expected")
    if len(value) > LONGEST_TEXT or not value.isprintable():
        raise SettingError(parameter, value, f"at most {LONGEST_TEXT} printable characters")
    return value


def _fits(parameter: Parameter, number: float, is_metric: bool, letter: str) -> bool:
    row = parameter.row
    if row.kind is not CellKind.REAL and not number.is_integer():
        return False
    if row.kind is CellKind.CHOICE:
        return int(number) in row.words
    if parameter.is_per_length and number == 0:
        return False
    low, high = limits(parameter, is_metric, letter)
    return low < number <= high if row.is_low_open else low <= number <= high


def limits(parameter: Parameter, is_metric: bool, letter: str) -> tuple[float, float]:
    """The lowest and highest value; lengths are declared in inches and converted."""
    is_scaled = is_metric and parameter.is_length and letter not in ROTARY
    scale = MM_PER_INCH if is_scaled else 1.0
    return parameter.row.low * scale, parameter.row.high * scale


def typical(parameter: Parameter, is_metric: bool, letter: str) -> str:
    """The typical value; lengths are written in inches in the tables."""
    text = parameter.row.typical
    if not parameter.is_length:
        return text
    try:
        inches = float(text)
    except ValueError:  # words
        return text
    return shown(parameter, scaled(parameter, inches, MM_PER_INCH if is_metric else 1.0, letter))


def accepted(parameter: Parameter, is_metric: bool = False, letter: str = "") -> str:
    """The values a cell accepts, in words."""
    row = parameter.row
    if row.kind is CellKind.TEXT:
        return "text"
    if row.kind in (CellKind.CHOICE, CellKind.BOOLEAN):
        return "one of " + ", ".join(_choice(value, word) for value, word in row.words.items())
    kind = "whole number" if row.kind is CellKind.INTEGER else "number"
    reach = span(parameter, is_metric, letter)
    unit = f" [{unit_of(parameter, is_metric, letter)}]" if row.unit else ""
    names = "".join(f"; {value} = {word}" for value, word in row.words.items())
    if row.noun:
        names += f"; {row.noun}4 = 4"
    return f"a {kind} {reach}{unit}{names}" if reach else f"any {kind}{unit}{names}"


def _choice(value: int, word: str) -> str:
    return word if word == str(value) else f"{value} ({word})"


def span(parameter: Parameter, is_metric: bool = False, letter: str = "") -> str:
    """The range of a number in words, empty where it is unlimited."""
    if parameter.is_per_length:
        return "other than 0"
    low, high = limits(parameter, is_metric, letter)
    if low == -ANY and high == ANY:
        return ""
    begin = f"{'above' if parameter.row.is_low_open else 'from'} {plain(low)}"
    if high == ANY:
        return begin if parameter.row.is_low_open else f"{begin} up"
    return f"{begin} {'up ' if parameter.row.is_low_open else ''}to {plain(high)}"


# --- how users write and read values ----------------------------------------------------


def parsed(parameter: Parameter, text: str, is_metric: bool = False, letter: str = "") -> Value:
    """A user's text as a value for the store: a number, the word of a choice, a length."""
    if parameter.is_text:
        return text
    plain = text.strip()
    word = _word(parameter, plain.lower())
    if word is not None:
        return word
    convert: Callable[[float], float] = float
    has_length = parameter.is_length or parameter.is_per_length
    length = _LENGTH.fullmatch(plain) if has_length and letter not in ROTARY else None
    if length:
        plain = length[1]
        factor = _factor(length[2], is_metric)

        def convert(number: float) -> float:
            return scaled(parameter, number, factor)

    try:
        return convert(float(plain))
    except ValueError:
        words = accepted(parameter, is_metric, letter)
        raise SettingError(parameter, text, words, parameter.row.doc) from None


def _word(parameter: Parameter, text: str) -> float | None:
    for value, word in parameter.row.words.items():
        if word.lower() == text:
            return float(value)
    noun = parameter.row.noun.lower()
    if noun and text.startswith(noun) and text.removeprefix(noun).isdecimal():
        return float(text.removeprefix(noun))
    if parameter.kind is CellKind.BOOLEAN:
        return _TRUTHS.get(text)
    return -1.0 if text in ("disable", "none") and -1 in parameter.row.words else None


def _factor(unit: str, is_metric: bool) -> float:
    is_given_metric = unit.lower() == "mm"
    if is_given_metric == is_metric:
        return 1.0
    return MM_PER_INCH if is_metric else 1.0 / MM_PER_INCH


def shown(parameter: Parameter, value: Value) -> str:
    """A value as displayed to a user: `2 (absolute)`, `0.0508`."""
    if isinstance(value, str):
        return value
    number = plain(rounded(value, SHOWN_DIGITS))
    word = parameter.row.words.get(int(value)) if value.is_integer() else None
    if word is None and parameter.row.noun:
        word = parameter.row.noun + number
    return number if word is None or word == number else f"{number} ({word})"


def plain(value: float) -> str:
    """A number without needless digits."""
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


def unit_of(parameter: Parameter, is_metric: bool, letter: str = "") -> str:
    """The unit of a cell in words: `mm/min`, `deg` on a rotary axis."""
    unit = parameter.row.unit
    if not (parameter.is_length or parameter.is_per_length):
        return unit.replace("deg/m", "deg/min")
    name = "deg" if letter in ROTARY else ("mm" if is_metric else "in")
    words = {"u/m": f"{name}/min", "pulse/u": f"pulse/{name}", "u per click": f"{name}/click"}
    return words.get(unit) or unit.replace("u", name, 1)
