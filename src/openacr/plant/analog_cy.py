"""Voltages at the analog inputs of the card: fixed, from an axis, from an analog output."""

from openacr.map.numbers import (
    PLA_COUNT,
    PLAF_BASE,
    PLAF_BASE_V,
    PLAF_DAC_STEP,
    PLAF_STRIDE,
    PLAF_VOLTS,
    PLAF_VOLTS_PER_CNT,
    PLAI_AXIS,
    PLAI_BASE,
    PLAI_DAC,
    PLAI_STRIDE,
    PLF_BASE,
    PLF_POSITION_CNT,
    PLF_STRIDE,
)
from openacr.plant.drive_cy import converter_volts
from openacr.views import F32, F64, I32


def analogs_follow(F: F64, I: I32, S: F32) -> None:
    """Update the voltages at all terminals for this tick."""
    for c in range(PLA_COUNT):
        f: int = PLAF_BASE + c * PLAF_STRIDE
        i: int = PLAI_BASE + c * PLAI_STRIDE
        volts: float = F[f + PLAF_BASE_V]
        if I[i + PLAI_AXIS] > 0:
            axis: int = PLF_BASE + (I[i + PLAI_AXIS] - 1) * PLF_STRIDE
            volts += F[f + PLAF_VOLTS_PER_CNT] * F[axis + PLF_POSITION_CNT]
        if I[i + PLAI_DAC] > 0:
            volts += converter_volts(S, I[i + PLAI_DAC] - 1, F[f + PLAF_DAC_STEP])
        F[f + PLAF_VOLTS] = volts
