"""Units of parameters, and the suffixes that carry them in names.

A number in the code says its unit in its name: `_cnt` pulses, `_u` programming units,
`_ups`, `_ups2`, `_ups3` units per second, squared, cubed, `_cps` pulses per second,
`_tk` ticks, `_s` seconds, `_deg` degrees, `_v` volts, `_r` ratio.

The tables write units of parameters as products and quotients of the words below.
"""

import math
import re

MM_PER_INCH = 25.4
WORDS = {
    "A": "ampere",
    "V": "volt",
    "byte": "byte",
    "count": "converter count",
    "cycle": "cam cycle",
    "deg": "degree",
    "kbit": "1000 bits",
    "min": "minute",
    "ms": "millisecond",
    "pulse": "encoder pulse",
    "rev": "revolution",
    "s": "second",
    "samples": "samples",
    "tick": "servo period",
    "unit": "programming unit (PPU pulses)",
}


def words_of(unit: str) -> list[str]:
    """Words a unit is made of: `V s²/pulse` has V, s and pulse."""
    return re.findall(r"[A-Za-z]+", unit)


def explain(unit: str) -> str:
    """Meaning of the words of a unit."""
    return ", ".join(WORDS[word] for word in words_of(unit))


# Quantities as users write them: 10min, 5 cm, 90deg; each family by its smallest usual unit.
_FAMILIES: tuple[dict[str, float], ...] = (
    {"us": 1e-6, "ms": 1e-3, "s": 1.0, "sec": 1.0, "min": 60.0, "h": 3600.0},
    {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": MM_PER_INCH, "inch": MM_PER_INCH},
    {"deg": 1.0, "rad": 180.0 / math.pi, "rev": 360.0},
)
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([A-Za-z]*)\s*")


def quantity(text: str, unit: str) -> float:
    """The number of `unit` that a text such as `10min`, `5 cm` or `30` says; ValueError.

    A number alone is in `unit`. The error names the units that can be written.
    """
    family = next(each for each in _FAMILIES if unit in each)
    found = _QUANTITY.fullmatch(text)
    word = (found[2] or unit) if found else ""
    if found is None or word not in family:
        raise ValueError(f"a number, with or without a unit ({', '.join(family)})")
    if word == unit:
        return float(found[1])
    return float(found[1]) * family[word] / family[unit]
