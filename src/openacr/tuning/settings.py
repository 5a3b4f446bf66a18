"""The settings of the servo loop of an axis, as its parameters hold them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.motion.axis.settings import DEEPEST_SMOOTHING
from openacr.tuning.filters import FILTERS, Filters, Row

BIQUAD_FLAG, FLAGS_PER_AXIS = 786, 32  # of axis 0; distance to that of the next axis

GAINS = {  # words of the language, and the row each sets
    "PGAIN": axes.proportional_gain,
    "IGAIN": axes.integral_gain,
    "ILIMIT": axes.integral_limit,
    "IDELAY": axes.integral_delay,
    "DGAIN": axes.derivative_gain,
    "DWIDTH": axes.derivative_width,
    "FFVEL": axes.feedforward_velocity,
    "FFACC": axes.feedforward_accel,
}
ROWS = (
    *GAINS.values(),
    axes.plus_torque_limit,
    axes.minus_torque_limit,
    *(row for rows in FILTERS for row in rows),
    axes.fbvel_gain_setting,
    axes.smooth_encoder_velocity,
    axes.kvp,
    axes.dgain_smooth,
    axes.dzu,
    axes.dzl,
    axes.ffvc,
)
UNMODELLED = {
    axes.kvp: "KVP: the PV loop takes the place of the gains that are tuned",
    axes.fbvel_gain_setting: "FBVEL: velocity feedback is not part of the model",
    axes.dzu: "DZU: a dead zone is not part of the model",
}


@dataclass(frozen=True)
class LoopSettings:
    """Gains, limits and filters of one axis by row (`AX_...`), and its servo period [s]."""

    rows: Mapping[Row, float]
    is_filtering: bool
    period_s: float
    filters: Filters | None = None  # what LOPASS and NOTCH were given; None: written by hand

    @classmethod
    def of_gains(cls, period_s: float, *, limit_v: float = 10.0, **gains: float) -> Self:
        """Settings with these gains (`pgain=0.002`); all others as after power-up."""
        rows = dict.fromkeys(ROWS, 0.0)
        rows |= {coefficients[-1]: 1.0 for coefficients in FILTERS}
        rows |= {axes.plus_torque_limit: limit_v, axes.minus_torque_limit: -limit_v}
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
        return min(self.rows[axes.plus_torque_limit], -self.rows[axes.minus_torque_limit])

    @property
    def derivative_ticks(self) -> int:
        """Servo periods from sample to sample of the derivative (DWIDTH)."""
        return max(1, round(self.rows[axes.derivative_width] / self.period_s))

    @property
    def derivative_samples(self) -> int:
        """Slopes that DGain Smooth averages."""
        return 1 << max(0, min(DEEPEST_SMOOTHING, int(self.rows[axes.dgain_smooth])))

    def coefficients(self) -> list[tuple[float, float, float, float, float]]:
        """Filters that act, each as b2 a2 b1 a1 a0."""
        if not self.is_filtering:
            return []
        found = []
        for coefficients in FILTERS:
            b2, a2, b1, a1, a0 = (self.rows[row] for row in coefficients)
            found.append((b2, a2, b1, a1, a0))
        return found

    def require_modelled(self) -> None:
        """Refuse settings that the model of the loop does not contain; UserError."""
        for row, reason in UNMODELLED.items():
            if self.rows[row] != 0.0:
                raise UserError(f"{reason}: it is {self.rows[row]:g}, tuning needs 0")
