"""A motor with its drive and load, as the card sees it: volts in, counts out.

    v' = a u(t - delay) + offset - r v - c sign(v)

A drive of torque has a = acceleration of a volt and r = viscous friction per inertia; one of
velocity with the speed K of a volt and the lag T is the same equation with a = K/T, r = 1/T. The
voltage is constant during a servo period, so positions at the servo interrupts follow exactly:
`openacr.plant.physics.drive_cy` has the equations.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from openacr.tuning.shaft import Shaft

Reals = NDArray[np.float64]
Complexes = NDArray[np.complex128]
SMALL = 1e-4  # of rate times period: below it the series are exact to a double


@dataclass(frozen=True, slots=True)
class Motor:
    """What a voltage does to an axis; counts and seconds."""

    accel_per_volt: float  # counts/s^2 of a volt
    rate_per_s: float = 0.0  # 1/s; the inverse is the time constant of the speed
    coulomb_accel: float = 0.0  # counts/s^2
    offset_v: float = 0.0  # volts that act beside the output
    delay_tk: float = 0.0  # servo periods, beside the one that the loop itself takes
    shaft: Shaft | None = None  # to the load; None: it is rigid

    @property
    def time_constant_s(self) -> float:
        """Time constant of the speed after a step of the voltage [s]; inf without friction."""
        return 1.0 / self.rate_per_s if self.rate_per_s > 0.0 else math.inf

    @property
    def speed_per_volt_cps(self) -> float:
        """Final speed of a constant volt [counts/s]; inf without friction."""
        return self.accel_per_volt * self.time_constant_s

    def response(self, z: Complexes, period_s: float) -> Complexes:
        """Counts of a volt at z = exp(j w T), voltage held for a period, linear part.

            G(z) = (b1 z + b2) / ((z - 1) (z - p)) of delayed volts

        with p = exp(-r T), b1 = a T^2 phi2, b2 = a T^2 (phi1^2 - p phi2): from position and
        speed after one period of constant voltage.
        """
        b1, b2, pole = self.coefficients(period_s)
        whole = math.floor(self.delay_tk)
        part = self.delay_tk - whole
        delay = z**-whole * ((1.0 - part) + part / z)
        centre = (b1 * z + b2) / ((z - 1.0) * (z - pole))
        return (centre + self._flexion(z, period_s)) * delay

    def fraction(self, period_s: float) -> tuple[Reals, Reals]:
        """Numerator and denominator of `response` in 1/z, lowest power first."""
        b1, b2, pole = self.coefficients(period_s)
        numerator, denominator = np.array([0.0, b1, b2]), np.convolve([1.0, -1.0], [1.0, -pole])
        if self.shaft is not None:
            swing, poles = self.shaft.fraction(period_s)
            numerator = np.convolve(numerator, poles) + np.convolve(
                self.accel_per_volt * swing, denominator
            )
            denominator = np.convolve(denominator, poles)
        whole = math.floor(self.delay_tk)
        part = self.delay_tk - whole
        delay = np.array([*[0.0] * whole, 1.0 - part, part])
        return np.convolve(numerator, delay), denominator

    def _flexion(self, z: Complexes, period_s: float) -> Complexes:
        """Counts of flexion of the shaft of a volt."""
        if self.shaft is None:
            return np.zeros_like(z)
        b, a = (np.polyval(each[::-1], 1.0 / z) for each in self.shaft.fraction(period_s))
        return np.asarray(self.accel_per_volt * b / a)

    def coefficients(self, period_s: float) -> tuple[float, float, float]:
        """B1, b2 and the pole of `response`."""
        x = self.rate_per_s * period_s
        pole = math.exp(-x)
        if x < SMALL:
            first, second = 1.0 - x / 2.0 + x * x / 6.0, 0.5 - x / 6.0 + x * x / 24.0
        else:
            first = (1.0 - pole) / x
            second = (1.0 - first) / x
        unit = self.accel_per_volt * period_s * period_s
        return unit * second, unit * (first * first - pole * second), pole
