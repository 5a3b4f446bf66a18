"""The hardware a card is fitted with: what CONFIG names, and what it leaves out.

CONFIG speaks of the first eight encoders, analog outputs, stepper outputs and analog inputs;
objects beyond belong to other boards. Outputs are numbered through both modules: with STEPPER4
on each, module 1 has steppers 4 to 7. Hardware that is left out reads 0 and is not driven.
"""

from collections.abc import Sequence

from openacr.map.numbers import (
    KRI_BASE,
    KRI_MISSING_ADCS,
    KRI_MISSING_DACS,
    KRI_MISSING_ENCODERS,
    KRI_MISSING_STEPPERS,
)
from openacr.motion.card import Card

OF_EACH = 8
_OUTPUTS = {"DAC": ("DAC",), "STEPPER": ("STEPPER",), "DACSTEP": ("DAC", "STEPPER")}


def fit(card: Card, modules: Sequence[str]) -> None:
    """Fit the card with these modules: encoders, module 0, module 1, module 2."""
    encoders, first, second, inputs = modules
    outputs = {"DAC": 0, "STEPPER": 0}
    for word, count in (_parts(first), _parts(second)):
        for kind in _OUTPUTS.get(word, ()):
            outputs[kind] += count
    rows = card.memory.I
    rows[KRI_BASE + KRI_MISSING_ENCODERS] = _behind(_parts(encoders)[1])
    rows[KRI_BASE + KRI_MISSING_DACS] = _behind(outputs["DAC"])
    rows[KRI_BASE + KRI_MISSING_STEPPERS] = _behind(outputs["STEPPER"])
    rows[KRI_BASE + KRI_MISSING_ADCS] = _behind(_parts(inputs)[1])


def _parts(module: str) -> tuple[str, int]:
    """Word and count: DAC4 is four analog outputs, NONE nothing."""
    word = module.rstrip("0123456789")
    return word, int(module[len(word) :] or 0)


def _behind(count: int) -> int:
    """The mask of all of the first eight but so many."""
    return (1 << OF_EACH) - (1 << min(count, OF_EACH))
