"""The settings of the servo loop of an axis, as its parameters hold them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

from openacr.errors import UserError
from openacr.map import numbers as at
from openacr.motion.axis.settings import DEEPEST_SMOOTHING
from openacr.tuning.filters import COEFFICIENTS, FILTERS, Filters

BIQUAD_FLAG, FLAGS_PER_AXIS = 786, 32  # of axis 0; distance to that of the next axis

GAINS = {  # words of the language, and the row each sets
    "PGAIN": at.AX_PROPORTIONAL_GAIN,
    "IGAIN": at.AX_INTEGRAL_GAIN,
    "ILIMIT": at.AX_INTEGRAL_LIMIT,
    "IDELAY": at.AX_INTEGRAL_DELAY,
    "DGAIN": at.AX_DERIVATIVE_GAIN,
    "DWIDTH": at.AX_DERIVATIVE_WIDTH,
    "FFVEL": at.AX_FEEDFORWARD_VELOCITY,
    "FFACC": at.AX_FEEDFORWARD_ACCEL,
}
ROWS = (
    *GAINS.values(),
    at.AX_PLUS_TORQUE_LIMIT,
    at.AX_MINUS_TORQUE_LIMIT,
    *(first + k for first in FILTERS for k in range(COEFFICIENTS)),
    at.AX_FBVEL_GAIN_SETTING,
    at.AX_SMOOTH_ENCODER_VELOCITY,
    at.AX_KVP,
    at.AX_DGAIN_SMOOTH,
    at.AX_DZU,
    at.AX_DZL,
    at.AX_FFVC,
)
UNMODELLED = {
    at.AX_KVP: "KVP: the PV loop takes the place of the gains that are tuned",
    at.AX_FBVEL_GAIN_SETTING: "FBVEL: velocity feedback is not part of the model",
    at.AX_DZU: "DZU: a dead zone is not part of the model",
}


@dataclass(frozen=True)
class LoopSettings:
    """Gains, limits and filters of one axis by row (`AX_...`), and its servo period [s]."""

    rows: Mapping[int, float]
    is_filtering: bool
    period_s: float
    filters: Filters | None = None  # what LOPASS and NOTCH were given; None: written by hand

    @classmethod
    def of_gains(cls, period_s: float, *, limit_v: float = 10.0, **gains: float) -> Self:
        """Settings with these gains (`pgain=0.002`); all others as after power-up."""
        rows = dict.fromkeys(ROWS, 0.0)
        rows |= {first + COEFFICIENTS - 1: 1.0 for first in FILTERS}
        rows |= {at.AX_PLUS_TORQUE_LIMIT: limit_v, at.AX_MINUS_TORQUE_LIMIT: -limit_v}
        return cls(rows, False, period_s, Filters()).changed(**gains)

    def changed(self, **gains: float) -> Self:
        """The same settings with other gains."""
        named = {GAINS[name.upper()]: value for name, value in gains.items()}
        return replace(self, rows={**self.rows, **named})

    def filtered(self, filters: Filters) -> Self:
        """The same settings with other filters, as LOPASS and NOTCH set them."""
        rows = {**self.rows, **filters.rows(self.period_s)}
        return replace(self, rows=rows, is_filtering=filters.is_filtering, filters=filters)

    def gain(self, name: str) -> float:
        """A gain by its word, such as PGAIN."""
        return self.rows[GAINS[name]]

    @property
    def gains(self) -> dict[str, float]:
        """All gains by their words."""
        return {name: self.rows[row] for name, row in GAINS.items()}

    @property
    def limit_v(self) -> float:
        """The voltage that the output reaches in both directions [V]."""
        return min(self.rows[at.AX_PLUS_TORQUE_LIMIT], -self.rows[at.AX_MINUS_TORQUE_LIMIT])

    @property
    def derivative_ticks(self) -> int:
        """Servo periods from sample to sample of the derivative (DWIDTH)."""
        return max(1, round(self.rows[at.AX_DERIVATIVE_WIDTH] / self.period_s))

    @property
    def derivative_samples(self) -> int:
        """Slopes that DGain Smooth averages."""
        return 1 << max(0, min(DEEPEST_SMOOTHING, int(self.rows[at.AX_DGAIN_SMOOTH])))

    def coefficients(self) -> list[tuple[float, float, float, float, float]]:
        """Filters that act, each as b2 a2 b1 a1 a0."""
        if not self.is_filtering:
            return []
        found = []
        for first in FILTERS:
            b2, a2, b1, a1, a0 = (self.rows[first + k] for k in range(COEFFICIENTS))
            found.append((b2, a2, b1, a1, a0))
        return found

    def require_modelled(self) -> None:
        """Refuse settings that the model of the loop does not contain; UserError."""
        for row, reason in UNMODELLED.items():
            if self.rows[row] != 0.0:
                raise UserError(f"{reason}: it is {self.rows[row]:g}, tuning needs 0")
