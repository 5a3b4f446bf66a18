"""The analog inputs: which terminals each of them measures, and what it makes of them.

    share = (positive - negative) / 10 V, within -1 .. 1, in steps of 12 or 16 bits
    input = share * GAIN + OFFSET

The channels of ADC n are four bits each of P6918 and P6919; 15 is ground. Where nothing is wired
to any terminal the inputs keep what is written to them.
"""

from openacr.cmath import rint
from openacr.map.numbers import (
    ADC_ADC_GAIN,
    ADC_ADC_INPUT,
    ADC_ADC_OFFSET,
    ADC_BASE,
    ADC_STRIDE,
    KRI_ADC_CHANNELS,
    KRI_ADC_MODE,
    KRI_BASE,
    P_ADC_NEGATIVE_CHANNELS,
    P_ADC_POSITIVE_CHANNELS,
    P_ADC_STATE_CONTROL,
    PLA_COUNT,
    PLAF_BASE,
    PLAF_STRIDE,
    PLAF_VOLTS,
)
from openacr.views import F32, F64, I32

SCANNING = 1
BITS_EACH = 4
CHANNEL = 15
PER_VOLT = 0.1  # of full scale
FINE = 32767.0
COARSE = 2047.0


def terminal_volts(F: F64, channel: int) -> float:
    """Voltage at a terminal; 0 at ground."""
    return F[PLAF_BASE + channel * PLAF_STRIDE + PLAF_VOLTS] if channel < PLA_COUNT else 0.0


def analog_step(F: F64, I: I32, S: F32) -> None:
    """Measure what is at the terminals."""
    if not I[P_ADC_STATE_CONTROL] & SCANNING:
        return
    full: float = FINE if I[KRI_BASE + KRI_ADC_MODE] else COARSE
    for n in range(PLA_COUNT):
        if n >= I[KRI_BASE + KRI_ADC_CHANNELS]:
            return
        plus: int = I[P_ADC_POSITIVE_CHANNELS] >> BITS_EACH * n & CHANNEL
        minus: int = I[P_ADC_NEGATIVE_CHANNELS] >> BITS_EACH * n & CHANNEL
        volts: float = terminal_volts(F, plus) - terminal_volts(F, minus)
        share: float = rint(max(-1.0, min(1.0, volts * PER_VOLT)) * full) / full
        row: int = ADC_BASE + n * ADC_STRIDE
        S[row + ADC_ADC_INPUT] = share * S[row + ADC_ADC_GAIN] + S[row + ADC_ADC_OFFSET]
