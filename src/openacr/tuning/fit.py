"""The motor whose computed axis (`twin.run`) has a recorded position most closely.

Gauss-Newton over the numbers of the motor, those of its shaft included where it has one, with
slopes by probes that become smaller: sticking has an edge, and is seen by a large probe first.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from openacr.tuning import twin
from openacr.tuning.motor import Motor, Reals
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft
from openacr.tuning.twin import Record

STEPS = 12  # at most, for each of PROBES
SETTLED = 1e-3  # relative change at which a fit ends
PROBES = (0.4, 0.2, 0.1, 0.05)  # changes by which slopes are found
ATTEMPTS = 6
SMOOTHED = 10  # frequencies to both sides over which a spectrum of errors is averaged
TINY = 1e-12
LONGEST_DELAY_TK = 20.0
LEAST_HZ, MOST_DAMPING, LEAST_RATIO = 0.1, 0.9, 1e-6
MOTOR_FIELDS = ("accel_per_volt", "rate_per_s", "coulomb_accel", "offset_v", "delay_tk")
SHAFT_FIELDS = ("resonance_hz", "damping_ratio", "inertia_ratio")
Residual = Callable[[Motor], Reals]


@dataclass(frozen=True, slots=True)
class Fit:
    """A motor, the position it does not explain [counts], and deviations if that were noise."""

    motor: Motor
    residual_cnt: Reals
    deviations: dict[str, float]  # by the fields of Motor and Shaft

    @property
    def noise_cnt(self) -> float:
        """RMS of what is not explained [counts]."""
        return float(np.sqrt(np.mean(self.residual_cnt**2)))


def fit(settings: LoopSettings, record: Record, first: Motor) -> Fit:
    """The motor next to a first one that explains a record."""

    def residual(motor: Motor) -> Reals:
        computed = twin.run(settings, motor, record.setpoint_cnt, record)
        return np.asarray(computed.actual_cnt - record.actual_cnt)

    motor, left = first, residual(first)
    slopes = np.zeros((len(left), len(_vector(motor))))
    for probe in PROBES:
        damping = 1e-3
        for _each in range(STEPS):
            slopes = _slopes(motor, left, residual, probe)
            before = motor
            motor, left, damping = _better(motor, left, slopes, residual, damping)
            gap = np.abs(_vector(motor) - _vector(before)) / _units(before)
            if float(gap.max()) < SETTLED:
                break
    spread = np.sqrt(np.maximum(np.diag(_covariance(slopes, left)), 0.0)) * _units(motor)
    names = MOTOR_FIELDS if motor.shaft is None else MOTOR_FIELDS + SHAFT_FIELDS
    return Fit(motor, left, dict(zip(names, spread.tolist(), strict=True)))


def _covariance(slopes: Reals, left: Reals) -> Reals:
    """Covariance of what was fitted, with what is left as noise of the spectrum that it has.

    What is not explained is hardly white: neighbouring samples have the same error, and weigh
    less than as many that are independent. Whole counts are noise at least.
    """
    count = len(left)
    power = np.abs(np.fft.fft(left - left.mean())) ** 2 / count
    around = np.concatenate((power[-SMOOTHED:], power, power[:SMOOTHED]))
    smooth = np.convolve(around, np.full(2 * SMOOTHED + 1, 1.0 / (2 * SMOOTHED + 1)), "valid")
    bent = np.fft.fft(slopes, axis=0)
    noise = np.maximum(smooth, 1.0 / 12.0)[:, None]
    middle = np.real(np.conj(bent).T @ (noise * bent)) / count
    normal = np.linalg.pinv(slopes.T @ slopes)
    return np.asarray(normal @ middle @ normal)


def _vector(motor: Motor) -> Reals:
    numbers = [getattr(motor, name) for name in MOTOR_FIELDS]
    if motor.shaft is not None:
        numbers += [getattr(motor.shaft, name) for name in SHAFT_FIELDS]
    return np.array(numbers, dtype=np.float64)


def _motor(vector: Reals) -> Motor:
    """A motor of these numbers, within what a motor and a shaft can be."""
    accel, rate, friction, offset, delay, *swing = vector.tolist()
    shaft = None
    if swing:
        hz, damping, ratio = swing
        shaft = Shaft(
            max(hz, LEAST_HZ), min(max(damping, 0.0), MOST_DAMPING), max(ratio, LEAST_RATIO)
        )
    return Motor(
        accel,
        max(rate, 0.0),
        max(friction, 0.0),
        offset,
        min(max(delay, 0.0), LONGEST_DELAY_TK),
        shaft,
    )


def _better(
    motor: Motor, left: Reals, slopes: Reals, residual: Residual, damping: float
) -> tuple[Motor, Reals, float]:
    """A motor with a smaller residual, that residual, and the damping of the next step.

    The same motor where no step along the slopes makes it smaller.
    """
    normal, gradient = slopes.T @ slopes, slopes.T @ left
    for _attempt in range(ATTEMPTS):
        damped = normal + damping * np.diag(np.diag(normal) + TINY)
        change = -np.linalg.lstsq(damped, gradient, rcond=None)[0] * _units(motor)
        tried = _motor(_vector(motor) + change)
        new = residual(tried)
        if new @ new < left @ left:
            return tried, new, damping / 5.0
        damping *= 5.0
    return motor, left, damping


def _units(motor: Motor) -> Reals:
    """By how much each number of a motor changes in a step of 1."""
    a, shaft = motor.accel_per_volt, motor.shaft
    units = [a, max(motor.rate_per_s, 5.0), max(motor.coulomb_accel, 0.02 * a), 0.05, 1.0]
    if shaft is not None:
        units += [
            0.05 * shaft.resonance_hz,
            max(shaft.damping_ratio, 0.01),
            max(shaft.inertia_ratio, 0.05),
        ]
    return np.array(units)


def _slopes(motor: Motor, left: Reals, residual: Residual, probe: float) -> Reals:
    """How the residual changes with each number, in its units."""
    found = []
    vector, units = _vector(motor), _units(motor)
    for k in range(len(vector)):
        probed = vector.copy()
        probed[k] += probe * units[k]
        found.append((residual(_motor(probed)) - left) / probe)
    return np.asarray(np.array(found).T)
