"""Hardware that CONFIG leaves out: it reads 0 and is not driven."""

from openacr.map.rows import adcs, dacs, encoders, kernel, steppers
from openacr.views import F32, I32

__all__ = ["missing_inputs_step", "missing_outputs_step"]

OF_EACH = 8


def missing_inputs_step(I: I32, S: F32) -> None:
    """Before anything is read."""
    counters: int = I[kernel.missing_encoders]
    inputs: int = I[kernel.missing_adcs]
    steps: int = I[kernel.missing_steppers]
    for n in range(OF_EACH):
        if counters >> n & 1:
            I[encoders.encoder_position[n]] = 0
            I[encoders.encoder_velocity[n]] = 0
        if inputs >> n & 1:
            S[adcs.adc_input[n]] = 0.0
        if steps >> n & 1:
            I[steppers.stepper_count[n]] = 0


def missing_outputs_step(I: I32, S: F32) -> None:
    """Before the world feels the outputs."""
    missing: int = I[kernel.missing_dacs]
    for n in range(OF_EACH):
        if missing >> n & 1:
            S[dacs.dac_output[n]] = 0.0
