"""The hardware a card is fitted with: what CONFIG names, and what it leaves out.

CONFIG speaks of the first eight encoders, analog outputs, stepper outputs and analog inputs;
objects beyond belong to other boards. An output is numbered by the socket of its module: module 0
has outputs 0 to 3, module 1 has 4 to 7, so that `DAC4 STEPPER4` gives DAC0 to DAC3 and STEPPER4 to
STEPPER7 (Programmer's Guide, Output Module Software Configuration Examples 2 and 3). Hardware that
is left out reads 0 and is not driven.
"""

from collections.abc import Sequence

from openacr.map.rows import kernel
from openacr.motion.card import Card

OF_EACH = 8
OF_MODULE = 4
_OUTPUTS = {"DAC": ("DAC",), "STEPPER": ("STEPPER",), "DACSTEP": ("DAC", "STEPPER")}


def fit(card: Card, modules: Sequence[str]) -> None:
    """Fit the card with these modules: encoders, module 0, module 1, module 2."""
    for row, missing in _missing_by_row(modules).items():
        card.memory.I[row] = missing


def is_fitted(card: Card, modules: Sequence[str]) -> bool:
    """Whether the card has the hardware these modules name, no more and no less."""
    rows = _missing_by_row(modules).items()
    return all(card.memory.I[row] == missing for row, missing in rows)


def _missing_by_row(modules: Sequence[str]) -> dict[int, int]:
    """What is left out of each kind of hardware, by the row that says so."""
    encoders, first, second, inputs = modules
    present = {"DAC": 0, "STEPPER": 0}
    for socket, module in enumerate((first, second)):
        word, count = _parts(module)
        for kind in _OUTPUTS.get(word, ()):
            present[kind] |= _first(count) << socket * OF_MODULE
    return {
        kernel.missing_encoders: _missing(_first(_parts(encoders)[1])),
        kernel.missing_dacs: _missing(present["DAC"]),
        kernel.missing_steppers: _missing(present["STEPPER"]),
        kernel.missing_adcs: _missing(_first(_parts(inputs)[1])),
    }


def _parts(module: str) -> tuple[str, int]:
    """Word and count: DAC4 is four analog outputs, NONE nothing."""
    word = module.rstrip("0123456789")
    return word, int(module[len(word) :] or 0)


def _first(count: int) -> int:
    """The mask of the first `count` objects."""
    return (1 << count) - 1


def _missing(present: int) -> int:
    """The mask of the first eight that are not present."""
    return _first(OF_EACH) & ~present
