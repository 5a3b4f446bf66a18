"""The analog inputs: which terminals each of them measures, and what it makes of them.

    share = (positive - negative) / 10 V, within -1 .. 1, in steps of 12 or 16 bits
    input = share * GAIN + OFFSET

The channels of ADC n are four bits each of P6918 and P6919; 15 is ground. Where nothing is wired
to any terminal the inputs keep what is written to them.
"""

from openacr.cmath import rint
from openacr.map import numbers as at
from openacr.map.rows import adcs, analogs, kernel
from openacr.views import F32, F64, I32

SCANNING = 1
BITS_EACH = 4
CHANNEL = 15
PER_VOLT = 0.1  # of full scale
FINE = 32767.0
COARSE = 2047.0


def terminal_volts(F: F64, channel: int) -> float:
    """Voltage at a terminal; 0 at ground."""
    return F[analogs.volts[channel]] if channel < analogs.COUNT else 0.0


def analog_step(F: F64, I: I32, S: F32) -> None:
    """Measure what is at the terminals."""
    if not I[at.P_ADC_STATE_CONTROL] & SCANNING:
        return
    full: float = FINE if I[kernel.adc_mode] else COARSE
    for n in range(analogs.COUNT):
        if n >= I[kernel.adc_channels]:
            return
        plus: int = I[at.P_ADC_POSITIVE_CHANNELS] >> BITS_EACH * n & CHANNEL
        minus: int = I[at.P_ADC_NEGATIVE_CHANNELS] >> BITS_EACH * n & CHANNEL
        volts: float = terminal_volts(F, plus) - terminal_volts(F, minus)
        share: float = rint(max(-1.0, min(1.0, volts * PER_VOLT)) * full) / full
        S[adcs.adc_input[n]] = share * S[adcs.adc_gain[n]] + S[adcs.adc_offset[n]]
