"""Gains for a motor: as fast as asked, or as margins, encoder and what was measured allow.

At the crossover w the open loop has to have gain 1 and the phase -180 degrees + margin:

    C(w) = P (1 + I(w)) + D slope(w) = exp(j (margin - pi)) / G(w)

Two real equations with the unknowns P and D; the integral takes part as a fixed share
I = w_i T z/(z - 1) with w_i = w / INTEGRAL_SHARE. A drive of velocity needs no D: where it comes
out negative it is 0, and P alone sets the gain. Feed-forward follows from the motor:
FFVEL = rate / a holds a speed, FFACC = 1 / a makes an acceleration.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from openacr.errors import UserError
from openacr.tuning.filters import Filters
from openacr.tuning.frequency import (
    Margins,
    controller,
    is_stable,
    margins,
    points,
    slope,
)
from openacr.tuning.motor import Motor
from openacr.tuning.settings import LoopSettings

INTEGRAL_SHARE = 10.0  # of the crossover: where the integral ends
INTEGRAL_LIMIT_SHARE = 0.5  # of the output
LEAST_GAIN_DB = 6.0
LEAST_PHASE_DEG = 40.0
NOISE_SHARE = 0.05  # of the output, for the edge of a count
SLOWEST_HZ, FINENESS = 0.1, 1.05


@dataclass(frozen=True, slots=True)
class Wish:
    """What the loop should be."""

    bandwidth_hz: float | None = None  # crossover of the open loop; None: the highest allowed
    phase_deg: float = 55.0
    has_integral: bool = True


@dataclass(frozen=True, slots=True)
class Proposal:
    """Gains, and the margins that they have with the motor."""

    settings: LoopSettings
    margins: Margins
    limited_by: str  # what bars a higher crossover; empty where one was asked for
    asked_hz: float  # the crossover that the gains are made for

    @property
    def filters(self) -> Filters | None:
        """The filters that belong to the gains; None for those that were written by hand."""
        return self.settings.filters

    @property
    def gains(self) -> dict[str, float]:
        """All gains by their words."""
        return self.settings.gains


def propose(
    present: LoopSettings,
    motor: Motor,
    wish: Wish | None = None,
    *,
    measured_to_hz: float = math.inf,
    others: Sequence[Motor] = (),
    slowest_hz: float = SLOWEST_HZ,
) -> Proposal:
    """Gains for a motor; UserError where what is asked for has too little margin.

    With the motors of `others` the loop has to be stable with half of the gain margin, too. A
    crossover below `slowest_hz` is not tried, unless it is asked for.

    The crossover is at most where the motor was measured: beyond it nothing was seen of what
    may swing there.
    """
    wish = wish or Wish()
    if not LEAST_PHASE_DEG <= wish.phase_deg <= 80.0:
        raise UserError(f"phase margin {wish.phase_deg:g}: from {LEAST_PHASE_DEG:g} to 80 degrees")
    if wish.bandwidth_hz is not None:
        _require_measured(wish.bandwidth_hz, measured_to_hz)
        return _of_bandwidth(present, motor, wish, wish.bandwidth_hz, others)
    best: Proposal | None = None
    reason = "the servo rate"
    crossover_hz = slowest_hz
    while crossover_hz < 0.2 / present.period_s:
        try:
            _require_measured(crossover_hz, measured_to_hz)
            best = _of_bandwidth(present, motor, wish, crossover_hz, others)
        except UserError as limit:
            if best is not None:
                reason = str(limit)
                break
        crossover_hz *= FINENESS
    if best is None:
        raise UserError("no gains have the margins: is the motor identified well?")
    return replace(best, limited_by=reason)


def _require_measured(crossover_hz: float, measured_to_hz: float) -> None:
    """Refuse a crossover at which nothing was measured."""
    if crossover_hz > measured_to_hz:
        raise UserError(
            f"at {crossover_hz:.3g} Hz nothing was measured: the response is known up to"
            f" {measured_to_hz:.3g} Hz (a band that reaches further, or a larger amplitude)"
        )


def _of_bandwidth(
    present: LoopSettings, motor: Motor, wish: Wish, crossover_hz: float, others: Sequence[Motor]
) -> Proposal:
    if not 0.0 < crossover_hz < 0.2 / present.period_s:
        most_hz = 0.2 / present.period_s
        raise UserError(f"bandwidth {crossover_hz:g} Hz: above 0, below {most_hz:g} Hz")
    settings = _designed(present, motor, wish, crossover_hz)
    found = margins(settings, motor)
    _require(settings, found, crossover_hz)
    if not all(is_stable(_louder(settings), other) for other in others):
        raise UserError(
            f"at {crossover_hz:.3g} Hz the loop does not bear a resonance that is a little off"
        )
    return Proposal(settings, found, "", crossover_hz)


def _louder(settings: LoopSettings) -> LoopSettings:
    """Settings with the loop gain raised by half of the gain margin that is needed."""
    factor = 10.0 ** (LEAST_GAIN_DB / 40.0)
    return settings.changed(
        **{name: factor * settings.gain(name.upper()) for name in ("pgain", "igain", "dgain")}
    )


def _designed(present: LoopSettings, motor: Motor, wish: Wish, crossover_hz: float) -> LoopSettings:
    """Gains that put the crossover where it is asked for, with the phase there."""
    clean = present.changed(**dict.fromkeys(present.gains, 0.0))
    z = points(clean, np.array([crossover_hz]))
    plant = complex(motor.response(z, clean.period_s)[0])
    filters = complex(controller(clean.changed(pgain=1.0), z)[0])
    integral_rate = 2.0 * math.pi * crossover_hz / INTEGRAL_SHARE if wish.has_integral else 0.0
    share = 1.0 + complex((integral_rate * clean.period_s * z / (z - 1.0))[0])
    steep = complex(slope(clean, z)[0])
    phase = math.radians(wish.phase_deg) - math.pi
    wanted = complex(math.cos(phase), math.sin(phase)) / (plant * filters)
    pgain, dgain = np.linalg.solve(
        [[share.real, steep.real], [share.imag, steep.imag]], [wanted.real, wanted.imag]
    ).tolist()
    if dgain < 0.0:
        pgain, dgain = abs(wanted) / abs(share), 0.0
    return clean.changed(
        pgain=pgain,
        igain=pgain * integral_rate,
        ilimit=INTEGRAL_LIMIT_SHARE * clean.limit_v if wish.has_integral else 0.0,
        dgain=dgain,
        ffvel=motor.rate_per_s / motor.accel_per_volt,
        ffacc=1.0 / motor.accel_per_volt,
    )


def _require(settings: LoopSettings, found: Margins, crossover_hz: float) -> None:
    """Refuse gains with too little margin, or an output that every count shakes."""
    where = f"at {crossover_hz:.3g} Hz"
    if settings.gain("PGAIN") <= 0.0 or not found.is_stable:
        raise UserError(f"{where} the loop is not stable")
    if abs(found.gain_db) < LEAST_GAIN_DB:
        raise UserError(
            f"{where} the gain margin is {abs(found.gain_db):.1f} dB,"
            f" at least {LEAST_GAIN_DB:g} are needed"
        )
    if found.phase_deg < LEAST_PHASE_DEG:
        raise UserError(
            f"{where} the phase margin is {found.phase_deg:.0f} degrees,"
            f" at least {LEAST_PHASE_DEG:.0f} are needed"
        )
    edge_v = settings.gain("PGAIN") + settings.gain("DGAIN") / (
        settings.period_s * settings.derivative_ticks * settings.derivative_samples
    )
    if edge_v > NOISE_SHARE * settings.limit_v:
        raise UserError(
            f"{where} a single count changes the output by {edge_v:.2g} V,"
            f" at most {NOISE_SHARE * settings.limit_v:.2g} V are good"
        )
