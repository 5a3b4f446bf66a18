"""Hardware that CONFIG leaves out: it reads 0 and is not driven."""

from openacr.kernel.feedback_cy import encoder_row
from openacr.map.numbers import (
    ADC_ADC_INPUT,
    ADC_BASE,
    ADC_STRIDE,
    DAC_BASE,
    DAC_DAC_OUTPUT,
    DAC_STRIDE,
    ENC_ENCODER_POSITION,
    ENC_ENCODER_VELOCITY,
    KRI_BASE,
    KRI_MISSING_ADCS,
    KRI_MISSING_DACS,
    KRI_MISSING_ENCODERS,
    KRI_MISSING_STEPPERS,
    STPR_BASE,
    STPR_STEPPER_COUNT,
    STPR_STRIDE,
)
from openacr.views import F32, I32

__all__ = ["missing_inputs_step", "missing_outputs_step"]

OF_EACH = 8


def missing_inputs_step(I: I32, S: F32) -> None:
    """Before anything is read."""
    encoders: int = I[KRI_BASE + KRI_MISSING_ENCODERS]
    inputs: int = I[KRI_BASE + KRI_MISSING_ADCS]
    steppers: int = I[KRI_BASE + KRI_MISSING_STEPPERS]
    for n in range(OF_EACH):
        if encoders >> n & 1:
            I[encoder_row(n) + ENC_ENCODER_POSITION] = 0
            I[encoder_row(n) + ENC_ENCODER_VELOCITY] = 0
        if inputs >> n & 1:
            S[ADC_BASE + n * ADC_STRIDE + ADC_ADC_INPUT] = 0.0
        if steppers >> n & 1:
            I[STPR_BASE + n * STPR_STRIDE + STPR_STEPPER_COUNT] = 0


def missing_outputs_step(I: I32, S: F32) -> None:
    """Before the world feels the outputs."""
    missing: int = I[KRI_BASE + KRI_MISSING_DACS]
    for n in range(OF_EACH):
        if missing >> n & 1:
            S[DAC_BASE + n * DAC_STRIDE + DAC_DAC_OUTPUT] = 0.0
