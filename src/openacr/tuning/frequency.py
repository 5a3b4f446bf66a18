"""The loop in the frequency domain: controller, open loop, margins, bandwidth, poles.

Of the sum that `kernel.axis.servo_cy` forms, with z = exp(j w T):

    C(z) = (PGAIN + IGAIN T z/(z - 1) + DGAIN D(z)) F(z)
    D(z) = (1 - z^-n)/(n T) H(z) S(z),     n periods of DWIDTH

H is the mean of the n periods during which a slope is held, S the average of DGain Smooth,
F the filters. IGAIN acts where ILIMIT allows it. The open loop is L = C G (`Motor.response`).
With n = 1 this is exact; with a DWIDTH above a period it is so far below its sample rate.
"""

import math
from dataclasses import dataclass

import numpy as np

from openacr.tuning.motor import Complexes, Motor, Reals
from openacr.tuning.settings import LoopSettings

LOWEST_HZ = 0.1
POINTS = 4000
NEAR, NEAR_POINTS = 10.0, 401  # half widths of a resonance, and the frequencies within them
FAINTEST = 1e-300  # a loop at the centre of a notch is nothing
HALF_POWER = math.sqrt(0.5)


@dataclass(frozen=True, slots=True)
class Margins:
    """How far a closed loop is from instability, and how fast it is."""

    crossover_hz: float  # where the open loop has gain 1; 0: nowhere
    phase_deg: float  # phase margin there; inf without a crossover
    gain: float  # the nearest factor on the loop gain that makes it oscillate; inf: none does
    gain_at_hz: float  # where it would oscillate
    bandwidth_hz: float  # where the closed loop, without feed-forward, falls below -3 dB
    is_stable: bool

    @property
    def gain_db(self) -> float:
        """Gain margin [dB]; negative where less gain makes the loop oscillate."""
        return 20.0 * math.log10(self.gain) if math.isfinite(self.gain) else math.inf


def points(settings: LoopSettings, frequencies_hz: Reals) -> Complexes:
    """Points z = exp(j w T) of frequencies."""
    return np.asarray(np.exp(2j * np.pi * frequencies_hz * settings.period_s))


def scale(settings: LoopSettings, motor: Motor | None = None, count: int = POINTS) -> Reals:
    """Frequencies [Hz], evenly spaced on a logarithmic scale up to half of the servo rate.

    They are closer together at the resonance and antiresonance of a motor on an elastic shaft.
    """
    highest_hz = 0.5 / settings.period_s
    found = np.geomspace(LOWEST_HZ, highest_hz, count)
    if motor is None:
        return found
    close = beside(motor, NEAR_POINTS)
    return np.union1d(found, close[(close > LOWEST_HZ) & (close < highest_hz)])


def beside(motor: Motor, count: int) -> Reals:
    """Frequencies [Hz] around resonance and antiresonance, `count` for each; none without them."""
    shaft = motor.shaft
    if shaft is None:
        return np.zeros(0)
    near = 1.0 + max(shaft.damping_ratio, 1e-3) * np.linspace(-NEAR, NEAR, count)
    return np.concatenate([near * hz for hz in (shaft.resonance_hz, shaft.antiresonance_hz)])


def controller(settings: LoopSettings, z: Complexes) -> Complexes:
    """Volts of a count of following error."""
    total = settings.gain("PGAIN") + settings.gain("DGAIN") * slope(settings, z)
    if settings.gain("ILIMIT") > 0.0:
        total = total + settings.gain("IGAIN") * settings.period_s * z / (z - 1.0)
    return np.asarray(total * filtering(settings, z))


def slope(settings: LoopSettings, z: Complexes) -> Complexes:
    """The slope of the error that DGAIN multiplies [1/s]."""
    n, m = settings.derivative_ticks, settings.derivative_samples
    held = sum(z**-k for k in range(n)) / n
    averaged = sum(z ** (-k * n) for k in range(m)) / m
    return np.asarray((1.0 - z**-n) / (n * settings.period_s) * held * averaged)


def open_loop(settings: LoopSettings, motor: Motor, frequencies_hz: Reals) -> Complexes:
    """Open loop at frequencies."""
    z = points(settings, frequencies_hz)
    return controller(settings, z) * motor.response(z, settings.period_s)


def closed_loop(settings: LoopSettings, motor: Motor, frequencies_hz: Reals) -> Complexes:
    """Actual position of a setpoint, with feed-forward, at frequencies."""
    z = points(settings, frequencies_hz)
    plant = motor.response(z, settings.period_s)
    feedback = controller(settings, z) * plant
    rate = (1.0 - 1.0 / z) / settings.period_s
    forward = settings.gain("FFVEL") * rate + settings.gain("FFACC") * rate * rate
    return np.asarray((feedback + forward * plant * filtering(settings, z)) / (1.0 + feedback))


def filtering(settings: LoopSettings, z: Complexes) -> Complexes:
    """What the filters let through; 1 without any."""
    total = np.ones_like(z)
    for b2, a2, b1, a1, a0 in settings.coefficients():
        total = total * (a0 + a1 / z + a2 / z**2) / (1.0 + b1 / z + b2 / z**2)
    return total


def margins(settings: LoopSettings, motor: Motor) -> Margins:
    """Margins of the closed loop; the smallest where the open loop crosses several times."""
    frequencies = scale(settings, motor)
    loop = open_loop(settings, motor, frequencies)
    phase_deg, crossover_hz = math.inf, 0.0
    for at_hz, value in _crossings(frequencies, loop, np.log(np.maximum(np.abs(loop), FAINTEST))):
        found = math.degrees(math.remainder(np.angle(value) - math.pi, 2.0 * math.pi))
        if abs(found) < abs(phase_deg):
            phase_deg, crossover_hz = found, at_hz
    gain, gain_at_hz = math.inf, 0.0
    ends = (float(frequencies[-1]), complex(loop[-1]))  # half the servo rate: the loop is real
    for at_hz, value in [*_crossings(frequencies, loop, loop.imag), ends]:
        if value.real < 0.0 and abs(math.log(-value.real)) < abs(math.log(gain)):
            gain, gain_at_hz = -1.0 / value.real, at_hz
    plain = np.abs(loop / (1.0 + loop))
    passed = np.nonzero(plain >= HALF_POWER)[0]
    bandwidth = float(frequencies[passed[-1]]) if len(passed) else 0.0
    return Margins(crossover_hz, phase_deg, gain, gain_at_hz, bandwidth, is_stable(settings, motor))


def _crossings(frequencies: Reals, loop: Complexes, signal: Reals) -> list[tuple[float, complex]]:
    """Where a signal along the loop changes its sign: frequency and loop, interpolated."""
    found = []
    for k in np.nonzero(np.signbit(signal[:-1]) != np.signbit(signal[1:]))[0]:
        part = signal[k] / (signal[k] - signal[k + 1])
        at_hz = frequencies[k] * (frequencies[k + 1] / frequencies[k]) ** part
        found.append((float(at_hz), complex(loop[k] + part * (loop[k + 1] - loop[k]))))
    return found


def is_stable(settings: LoopSettings, motor: Motor) -> bool:
    """Whether all poles of the closed loop are inside the unit circle.

    They are the zeros of N_C N_G + D_C D_G, all polynomials in 1/z.
    """
    numerator, denominator = _controller_polynomials(settings)
    plant, poles = motor.fraction(settings.period_s)
    forward = np.convolve(numerator, plant)
    back = np.convolve(denominator, poles)
    size = max(len(forward), len(back))
    total = np.pad(forward, (0, size - len(forward))) + np.pad(back, (0, size - len(back)))
    return bool(np.all(np.abs(np.roots(np.trim_zeros(total, "b"))) < 1.0))


def _controller_polynomials(settings: LoopSettings) -> tuple[Reals, Reals]:
    """Numerator and denominator of the controller in 1/z, lowest power first."""
    n, m, period_s = settings.derivative_ticks, settings.derivative_samples, settings.period_s
    one_less = np.zeros(n + 1)
    one_less[0], one_less[-1] = 1.0, -1.0
    comb = np.zeros((m - 1) * n + 1)
    comb[::n] = 1.0 / m
    edge = np.convolve(one_less, np.ones(n) / (n * n * period_s))
    numerator = settings.gain("DGAIN") * np.convolve(edge, comb)
    numerator[0] += settings.gain("PGAIN")
    denominator = np.array([1.0])
    if settings.gain("IGAIN") != 0.0 and settings.gain("ILIMIT") > 0.0:
        numerator = np.convolve(numerator, [1.0, -1.0])
        numerator[0] += settings.gain("IGAIN") * period_s
        denominator = np.array([1.0, -1.0])
    for b2, a2, b1, a1, a0 in settings.coefficients():
        numerator = np.convolve(numerator, [a0, a1, a2])
        denominator = np.convolve(denominator, [1.0, b1, b2])
    return numerator, denominator
