"""Units of parameters, and the suffixes that carry them in names.

A number in the code says its unit in its name: `_cnt` pulses, `_u` programming units,
`_ups`, `_ups2`, `_ups3` units per second, squared, cubed, `_cps` pulses per second,
`_tk` ticks, `_s` seconds, `_deg` degrees, `_v` volts, `_r` ratio.

The tables write units of parameters as products and quotients of the words below.
"""

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
