"""The resonance of an elastic shaft in a record, with its uncertainty; or why there is none.

1. A first shaft by search: of every resonance and damping on a grid the response

       Y = (a G1 + a rho E) U

   of centre and flexion is linear in acceleration a and inertia ratio rho. The best pair is
   that with the smallest rest of Y, over all frequencies up to which the axis was measured. The
   spectra are those of the whole record, not averaged: a narrow peak stays narrow.
2. The motor with this shaft is fitted to the record as the rigid one is (`openacr.tuning.fit`).
3. It counts where it explains clearly more than the rigid motor, within the band in which the
   response was heard, and where its numbers are sure.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from openacr.tuning.fit import Fit, fit
from openacr.tuning.motor import Complexes, Motor, Reals
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft
from openacr.tuning.twin import Record

FINENESS = 1.01  # of the grid of resonances
DAMPINGS = (0.004, 0.015, 0.05, 0.15)
FEWEST_TURNS = 8.0  # of a swing within a record
LEAST_RATIO = 0.02  # load by motor: what is smaller swings nothing
EXPLAINED = 0.8  # of what the rigid motor leaves: more than this is no resonance
SURE_HZ_SHARE = 0.02
SURE_RATIO_SHARE = 0.3
MOST_DAMPING = 0.5
WIDEST_SHARE = 0.97  # of the frequency up to which was measured: a peak has two sides


@dataclass(frozen=True, slots=True)
class Resonance:
    """What is known of the shaft of an axis."""

    shaft: Shaft | None
    deviations: dict[str, float]  # standard deviations by field of Shaft
    searched_hz: tuple[float, float]
    reason: str  # why there is none; empty where one was found


def find(
    settings: LoopSettings,
    record: Record,
    rigid: Fit,
    band_hz: tuple[float, float],
    measured_to_hz: float,
) -> tuple[Fit, Resonance]:
    """The fit that counts, with the resonance in it; `rigid` and the reason where there is none.

    A band is searched up to the frequency up to which the response is known.
    """
    searched = (band_hz[0], min(band_hz[1], measured_to_hz))
    where = f"from {searched[0]:.3g} to {searched[1]:.3g} Hz"
    if measured_to_hz < band_hz[1] * WIDEST_SHARE:
        where += ", beyond which the coherence is too low"
    first = _search(record, rigid.motor, searched)
    if first is None:
        return rigid, Resonance(None, {}, searched, f"nothing was measured {where}")
    bent = fit(settings, record, first)
    shaft = bent.motor.shaft
    reason = "" if shaft is not None and _counts(rigid, bent, shaft, searched) else where
    if reason or shaft is None:
        return rigid, Resonance(None, {}, searched, f"none was found {reason}")
    return bent, Resonance(shaft, _spread(bent, shaft, record), searched, "")


def _spread(bent: Fit, shaft: Shaft, record: Record) -> dict[str, float]:
    """Standard deviations of a shaft, by field.

    None is finer than half of what the length of the record resolves: what the model does not
    contain shifts a peak by as much.
    """
    half_hz = 0.5 / (len(record.setpoint_cnt) * record.period_s)
    least = {
        "resonance_hz": half_hz,
        "damping_ratio": half_hz / shaft.resonance_hz,
        "inertia_ratio": 2.0 * (1.0 + shaft.inertia_ratio) * half_hz / shaft.antiresonance_hz,
    }
    return {name: max(bent.deviations[name], value) for name, value in least.items()}


def _counts(rigid: Fit, bent: Fit, shaft: Shaft, searched_hz: tuple[float, float]) -> bool:
    """Whether a shaft that was fitted is there."""
    low, high = searched_hz
    return (
        bent.noise_cnt < EXPLAINED * rigid.noise_cnt
        and low < shaft.resonance_hz < high * WIDEST_SHARE
        and 0.0 < shaft.damping_ratio < MOST_DAMPING
        and shaft.inertia_ratio > LEAST_RATIO
        and bent.deviations["resonance_hz"] < SURE_HZ_SHARE * shaft.resonance_hz
        and bent.deviations["inertia_ratio"] < SURE_RATIO_SHARE * shaft.inertia_ratio
    )


def _search(record: Record, rigid: Motor, searched_hz: tuple[float, float]) -> Motor | None:
    """The motor on a shaft whose response is next to that of a record; None without any."""
    low, high = searched_hz
    frequencies = np.fft.rfftfreq(len(record.setpoint_cnt), record.period_s)
    used = (frequencies >= low) & (frequencies <= high)
    if used.sum() < 2 * len(DAMPINGS):
        return None
    z = np.exp(2j * np.pi * frequencies[used] * record.period_s)
    speed = 1.0 - 1.0 / z  # errors count as speeds: neither drift nor noise rules
    U, Y = (
        np.fft.rfft(each - each[0])[used] * speed for each in (record.output_v, record.actual_cnt)
    )
    unit = replace(rigid, accel_per_volt=1.0)
    centre = unit.response(z, record.period_s) * U
    delayed = U * _delay(rigid, z)
    best = (math.inf, rigid)
    lowest = max(low, FEWEST_TURNS / (len(record.setpoint_cnt) * record.period_s))
    steps = max(1, math.ceil(math.log(high / lowest) / math.log(FINENESS)))
    for resonance_hz in np.geomspace(lowest, high, steps + 1).tolist():
        for damping in DAMPINGS:
            shaft = Shaft(resonance_hz, damping, 1.0)
            b, a = (np.polyval(each[::-1], 1.0 / z) for each in shaft.fraction(record.period_s))
            rest, accel, swing = _two(centre, b / a * delayed, Y)
            if rest < best[0] and accel > 0.0 and swing > 0.0:
                bent = replace(shaft, inertia_ratio=swing / accel)
                best = (rest, replace(rigid, accel_per_volt=accel, shaft=bent))
    return best[1] if best[1].shaft is not None else None


def _delay(motor: Motor, z: Complexes) -> Complexes:
    """The delay of a motor at z."""
    whole = math.floor(motor.delay_tk)
    part = motor.delay_tk - whole
    return np.asarray(z**-whole * ((1.0 - part) + part / z))


def _two(one: Complexes, other: Complexes, wanted: Complexes) -> tuple[float, float, float]:
    """Real factors of two responses whose sum is next to a third, and the rest of it."""
    left = np.concatenate(([one.real, other.real], [one.imag, other.imag]), axis=1).T
    right: Reals = np.concatenate((wanted.real, wanted.imag))
    normal, side = left.T @ left, left.T @ right
    factors = np.linalg.lstsq(normal, side, rcond=None)[0]
    rest = float(right @ right - factors @ side)
    return rest, float(factors[0]), float(factors[1])
