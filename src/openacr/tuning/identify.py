"""The motor of an axis from a record of its loop while its setpoint was excited.

1. The frequency response of output to position, by cross spectra with the setpoint:

       G = S_ry / S_ru,    coherence = |S_ry|^2 / (S_rr S_yy)

   The loop is closed: what is noise in both signals has no relation to the setpoint, so it
   cancels in the quotient of cross spectra, which in S_uy / S_uu it would not.
2. A first motor from this response, by least squares over its logarithm.
3. The motor whose computed axis has the recorded position most closely (`openacr.tuning.fit`):
   acceleration, rate, friction, offset and delay. Friction that does not grow with speed is in
   no frequency response; here it is.
4. The same with a load on an elastic shaft, if the record shows one (`openacr.tuning.resonance`).
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from openacr.errors import UserError
from openacr.tuning import resonance, twin
from openacr.tuning.fit import MOTOR_FIELDS, fit
from openacr.tuning.motor import Complexes, Motor, Reals
from openacr.tuning.resonance import Resonance
from openacr.tuning.settings import LoopSettings
from openacr.tuning.twin import Record

AVERAGED = 7  # neighbouring frequencies
LEAST_SAMPLES = 400
COHERENT = 0.8  # coherence from which a frequency counts
FEWEST = 4  # frequencies for a fit
LEAST_MOTION_CNT = 10.0
PERCENT = 100.0
Chosen = NDArray[np.bool_]
SURE_ERROR, SURE_SPREAD = 20.0, 10.0  # per cent; above them no gains are proposed


@dataclass(frozen=True, slots=True)
class Spectrum:
    """A frequency response that was measured: counts of a volt, with its coherence."""

    frequencies_hz: Reals
    response: Complexes
    coherence: Reals

    @property
    def is_coherent(self) -> Chosen:
        """Which frequencies count."""
        return np.asarray(self.coherence >= COHERENT)

    def measured_to_hz(self, band_hz: tuple[float, float]) -> float:
        """The highest frequency of a band up to which the response is known; 0 for none.

        It ends the run of frequencies in which those that count outnumber the others the most:
        one that is coherent by chance beyond it does not prolong it.
        """
        low, high = band_hz
        inside = (self.frequencies_hz >= low) & (self.frequencies_hz <= high)
        votes = np.where(self.is_coherent[inside], 1, -1)
        sums = np.concatenate(([0], np.cumsum(votes)))
        gains = sums[1:] - np.minimum.accumulate(sums)[:-1]  # of the best run to each frequency
        if not len(gains) or gains.max() < FEWEST:
            return 0.0
        return float(self.frequencies_hz[inside][int(gains.argmax())])


@dataclass(frozen=True, slots=True)
class Identified:
    """A motor, and how sure it is."""

    motor: Motor
    spectrum: Spectrum
    computed: Record  # the record as the motor makes it
    error_percent: float  # of the following error that the motor does not explain, RMS
    deviations: dict[str, float]  # standard deviations by field of Motor, if all errors were noise
    coherence: float  # mean where the excitation was
    measured_to_hz: float  # beyond it nothing is known of the axis
    resonance: Resonance

    @property
    def is_sure(self) -> bool:
        """Whether gains may be proposed from it."""
        return (
            self.error_percent <= SURE_ERROR
            and PERCENT * self.deviations["accel_per_volt"]
            <= SURE_SPREAD * self.motor.accel_per_volt
        )


def spectrum(record: Record) -> Spectrum:
    """The frequency response of output to position, from a record that begins and ends at rest.

    What begins and ends at rest needs no window. Averages are over neighbouring frequencies, of
    the acceleration: that of a volt changes little from one frequency to the next.
    """
    count = len(record.setpoint_cnt)
    frequencies = np.fft.rfftfreq(count, record.period_s).astype(np.float64)
    difference = 1.0 - np.exp(-2j * np.pi * frequencies * record.period_s)
    R, U, Y = (
        np.fft.rfft(each - each[0])
        for each in (record.setpoint_cnt, record.output_v, record.actual_cnt)
    )
    A = Y * difference**2
    ru, ra, rr, aa = (
        np.convolve(each, np.full(AVERAGED, 1.0 / AVERAGED), "valid")
        for each in (np.conj(R) * U, np.conj(R) * A, np.abs(R) ** 2, np.abs(A) ** 2)
    )
    middle = slice(AVERAGED // 2, -(AVERAGED // 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        coherence = np.nan_to_num(np.abs(ra) ** 2 / (np.abs(rr) * np.abs(aa)))
        response = np.nan_to_num(ra / ru) / difference[middle] ** 2
    return Spectrum(frequencies[middle], response, coherence)


def identify(settings: LoopSettings, record: Record, band_hz: tuple[float, float]) -> Identified:
    """The motor that explains a record excited within a band; UserError where none does.

    The record begins and ends at rest.
    """
    if len(record.setpoint_cnt) < LEAST_SAMPLES:
        raise UserError(f"{len(record.setpoint_cnt)} samples: at least {LEAST_SAMPLES} are needed")
    moved = float(np.ptp(record.actual_cnt))
    if moved < LEAST_MOTION_CNT:
        raise UserError(
            f"the axis moved by {moved:g} counts: at least {LEAST_MOTION_CNT:g} are needed"
            " (a larger amplitude, higher gains, or is its drive off?)"
        )
    measured = spectrum(record)
    low, high = band_hz
    inside = (measured.frequencies_hz >= low) & (measured.frequencies_hz <= high)
    first = _from_response(measured, inside & measured.is_coherent)
    rigid = fit(settings, record, replace(first, coulomb_accel=0.02 * first.accel_per_volt))
    measured_to_hz = measured.measured_to_hz(band_hz)
    found, shaft = resonance.find(settings, record, rigid, band_hz, measured_to_hz)
    error_cnt = record.error_cnt - record.error_cnt.mean()
    return Identified(
        found.motor,
        measured,
        twin.run(settings, found.motor, record.setpoint_cnt, record),
        PERCENT * found.noise_cnt / max(float(np.sqrt(np.mean(error_cnt**2))), 0.5),
        {name: found.deviations[name] for name in MOTOR_FIELDS},
        float(measured.coherence[inside].mean()) if inside.any() else 0.0,
        measured_to_hz,
        shaft,
    )


def _from_response(measured: Spectrum, used: Chosen) -> Motor:
    """The motor of torque or velocity next to a response: the rate is searched, the gain follows.

    |G| = a / (w |w - j r|) gives the logarithm of a for every r as a mean.
    """
    if used.sum() < FEWEST:
        raise UserError(
            f"the position follows the excitation clearly at {int(used.sum())} frequencies: at"
            f" least {FEWEST} are needed (a larger amplitude, a longer time, or a wider band)"
        )
    w = 2.0 * np.pi * measured.frequencies_hz[used]
    size = np.log(np.abs(measured.response[used]) * w)
    weights = measured.coherence[used]
    best = (math.inf, Motor(1.0))
    for rate in np.geomspace(0.1, 1e4, 120):
        logs = size + 0.5 * np.log(w * w + rate * rate)
        mean = float(np.average(logs, weights=weights))
        spread = float(np.average((logs - mean) ** 2, weights=weights))
        if spread < best[0]:
            best = (spread, Motor(math.exp(mean), float(rate)))
    return best[1]
