"""Clocks of the card: simulated time, millisecond counter, clock pulse flags."""

from openacr.cmath import floor
from openacr.map.numbers import P_GLOBAL_SYSTEM_CLOCK, W_MISC_INPUTS
from openacr.map.rows import kernel, system
from openacr.views import F64, I32

__all__ = ["clock_step"]

LAST_MS = 2147483647
PULSE_20MS = 65536  # BIT80
PULSE_100MS = 131072
PULSE_1S = 262144
PULSE_1MIN = 524288
PULSES = PULSE_20MS | PULSE_100MS | PULSE_1S | PULSE_1MIN
EPS_MS = 1e-9


def pulse_on(clock_ms: int, cycle_ms: float) -> bool:
    """A square wave of the millisecond counter: on for the first half of each cycle."""
    within: float = clock_ms - floor(clock_ms / cycle_ms) * cycle_ms
    return within < cycle_ms / 2.0


def clock_step(F: F64, I: I32, period_s: float) -> None:
    """Advance time by one servo period."""
    low: int = I[system.tick_low] + 1
    if low > LAST_MS:
        low = 0
        I[system.tick_high] += 1
    I[system.tick_low] = low
    F[system.time_s] = (I[system.tick_high] * 2147483648.0 + low) * period_s
    phase: float = F[kernel.millisecond_phase] + period_s * 1000.0
    if phase < 1.0 - EPS_MS:
        F[kernel.millisecond_phase] = phase
        return
    clock: int = I[P_GLOBAL_SYSTEM_CLOCK]
    while phase >= 1.0 - EPS_MS:
        phase -= 1.0
        clock = 0 if clock >= LAST_MS else clock + 1
    F[kernel.millisecond_phase] = max(phase, 0.0)
    I[P_GLOBAL_SYSTEM_CLOCK] = clock
    pulses: int = 0
    if pulse_on(clock, 20.0):
        pulses |= PULSE_20MS
    if pulse_on(clock, 100.0):
        pulses |= PULSE_100MS
    if pulse_on(clock, 1000.0):
        pulses |= PULSE_1S
    if pulse_on(clock, 60000.0):
        pulses |= PULSE_1MIN
    I[W_MISC_INPUTS] = (I[W_MISC_INPUTS] & ~PULSES) | pulses
