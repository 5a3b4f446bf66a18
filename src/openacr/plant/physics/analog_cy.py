"""Voltages at the analog inputs of the card: fixed, from an axis, from an analog output."""

from openacr.map import numbers as at
from openacr.map.rows import analogs
from openacr.plant.physics.drive_cy import converter_volts
from openacr.views import F32, F64, I32


def analogs_follow(F: F64, I: I32, S: F32) -> None:
    """Update the voltages at all terminals for this tick."""
    for c in range(analogs.COUNT):
        f: int = at.PLAF_BASE + c * at.PLAF_STRIDE
        i: int = at.PLAI_BASE + c * at.PLAI_STRIDE
        volts: float = F[f + at.PLAF_BASE_V]
        if I[i + at.PLAI_AXIS] > 0:
            axis: int = at.PLF_BASE + (I[i + at.PLAI_AXIS] - 1) * at.PLF_STRIDE
            volts += F[f + at.PLAF_VOLTS_PER_CNT] * F[axis + at.PLF_POSITION_CNT]
        if I[i + at.PLAI_DAC] > 0:
            volts += converter_volts(S, I[i + at.PLAI_DAC] - 1, F[f + at.PLAF_DAC_STEP])
        F[f + at.PLAF_VOLTS] = volts
