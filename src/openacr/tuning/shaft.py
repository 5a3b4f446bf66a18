"""An elastic shaft between motor and load, as a part of what a voltage does to an axis.

Beside the movement of the common centre there is the flexion y of the motor about it
(`openacr.plant.physics.compliance_cy` has the equations), with u the acceleration of the centre:

    y'' = (J2 / J1) u - 2 s y' - w^2 y

The voltage is constant during a servo period, so that y has an exact response, too.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Shaft:
    """Motor and load against each other on a spring."""

    resonance_hz: float
    damping_ratio: float  # of the resonance; below 1
    inertia_ratio: float  # load by motor

    @property
    def antiresonance_hz(self) -> float:
        """Where the load would swing with the motor held [Hz]: the motor hardly moves there."""
        return self.resonance_hz / math.sqrt(1.0 + self.inertia_ratio)

    @property
    def resonance_rad_s(self) -> float:
        """The resonance as a rate [rad/s]."""
        return 2.0 * math.pi * self.resonance_hz

    @property
    def damping_per_s(self) -> float:
        """How fast the swing dies away [1/s]."""
        return self.damping_ratio * self.resonance_rad_s

    def fraction(self, period_s: float) -> tuple[Reals, Reals]:
        """Counts of flexion of an acceleration of the centre [counts/s^2].

        Numerator and denominator in 1/z, lowest power first.
        """
        w, s = self.resonance_rad_s, self.damping_per_s
        swing = w * math.sqrt(max(1.0 - self.damping_ratio**2, 1e-12))
        decay, c, d = (
            math.exp(-s * period_s),
            math.cos(swing * period_s),
            math.sin(swing * period_s) / swing,
        )
        first = 1.0 - decay * (c + s * d)  # its share of the rest that a constant push has
        second = decay * decay - decay * (c - s * d)
        numerator = self.inertia_ratio / (w * w) * np.array([0.0, first, second])
        return numerator, np.array([1.0, -2.0 * decay * c, decay * decay])
