"""Everything that follows from one measurement: motor, present loop, proposed loop, predictions.

What the command line prints and what the screens draw is this, as plain data.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from openacr.errors import UserError
from openacr.tuning import predict
from openacr.tuning.curves import curves, rounded
from openacr.tuning.filters import Filters
from openacr.tuning.frequency import LOWEST_HZ, Margins, beside, margins, open_loop
from openacr.tuning.identify import Identified, identify
from openacr.tuning.measure import Measurement
from openacr.tuning.notches import choose
from openacr.tuning.propose import Proposal, Wish
from openacr.tuning.resonance import Resonance
from openacr.tuning.settings import LoopSettings
from openacr.tuning.twin import Record, run

STEP_S = 0.25
BODE_POINTS = 160
PEAK_POINTS = 41  # beside, for each peak of a shaft
BODE_SHARE = 0.45  # of the servo rate: at half of it the response is 0, its phase nothing
NO_FEEDFORWARD = {"ffvel": 0.0, "ffacc": 0.0}  # a step of the setpoint only saturates it
# A figure is worse from these differences on, or from a share of it.
WORSE_BY = {"overshoot_percent": 1.0, "rise_s": 0.0005, "settling_s": 0.002}  # of a step
WORSE_ERROR_CNT = 0.5
WORSE_SHARE = 0.05
# A margin or bandwidth that has become less is worse below this: a faster loop has smaller margins.
ENOUGH = {"phase_deg": 45.0, "gain_db": 8.0, "bandwidth_hz": math.inf}


@dataclass(frozen=True, slots=True)
class Move:
    """A move whose following error is predicted: pulses, pulses/s, pulses/s^2."""

    distance_cnt: float
    velocity_cps: float
    accel_cps2: float


@dataclass(frozen=True, slots=True)
class Outlook:
    """A loop as the identified motor lets expect it."""

    settings: LoopSettings
    margins: Margins
    step: Record
    figures: predict.StepFigures
    move_error_cnt: float | None
    rms_error_cnt: float | None = None  # of the sweep


@dataclass(frozen=True, slots=True)
class Advice:
    """A measurement with what follows from it; no proposal where the motor is not sure."""

    measurement: Measurement
    identified: Identified
    present: Outlook
    proposal: Proposal | None
    proposed: Outlook | None
    refusal: str  # why there is no proposal


def advise(measurement: Measurement, wish: Wish | None = None, move: Move | None = None) -> Advice:
    """Identify the motor, judge the present loop and propose a better one."""
    excitation, settings = measurement.excitation, measurement.settings
    found = identify(settings, measurement.record, (excitation.low_hz, excitation.high_hz))
    present = outlook(measurement, found, settings, move)
    try:
        if not found.is_sure:
            raise UserError(
                f"the motor is not sure: {found.error_percent:.0f} % of the response is"
                " unexplained (a larger amplitude, or is something loose?)"
            )
        proposal = choose(settings, found.motor, wish, measured_to_hz=found.measured_to_hz)
    except UserError as refused:
        return Advice(measurement, found, present, None, None, str(refused))
    proposed = outlook(measurement, found, proposal.settings, move)
    return Advice(measurement, found, present, proposal, proposed, "")


def new_filters(advice: Advice) -> Filters | None:
    """The filters to set with the gains that are proposed; None where they stay as they are."""
    proposal = advice.proposal
    if proposal is None or proposal.filters == advice.measurement.settings.filters:
        return None
    return proposal.filters


def worse(advice: Advice) -> dict[str, tuple[float | None, float | None]]:
    """Figures that are predicted worse with the proposed gains than with the present ones.

    By name, present and proposed [%, s, pulses, degrees, dB, Hz]; None: it does not get there.
    """
    if advice.proposed is None:
        return {}
    found = {}
    for name, noise in WORSE_BY.items():
        before = getattr(advice.present.figures, name)
        after = getattr(advice.proposed.figures, name)
        if _is_more(before, after, noise):
            found[name] = (before, after)
    before, after = advice.present.rms_error_cnt, advice.proposed.rms_error_cnt
    if _is_more(before, after, WORSE_ERROR_CNT):
        found["rms_error_cnt"] = (before, after)
    for name, enough in ENOUGH.items():
        margins = (advice.present.margins, advice.proposed.margins)
        before, after = (_margin(each, name) for each in margins)
        if after < enough and after < before * (1.0 - WORSE_SHARE):
            found[name] = (_finite(before), after)
    return found


def _margin(margins: Margins, name: str) -> float:
    """A margin; that of the gain to whichever side it is, which its sign tells."""
    value = float(getattr(margins, name))
    return abs(value) if name == "gain_db" else value


def _is_more(before: float | None, after: float | None, noise: float) -> bool:
    """Whether a figure has grown by more than its noise; None is beyond all others."""
    least = math.inf if before is None else before + max(noise, WORSE_SHARE * before)
    return (math.inf if after is None else after) > least


def outlook(
    measurement: Measurement, found: Identified, settings: LoopSettings, move: Move | None
) -> Outlook:
    """What a loop would do with the motor; its step without feed-forward.

    With the settings of the measurement the error of the sweep is the one that was recorded.
    """
    record = measurement.record
    if settings is not measurement.settings:
        record = run(settings, found.motor, record.setpoint_cnt, record)
    height = round(measurement.excitation.height_cnt)
    step = predict.step(settings.changed(**NO_FEEDFORWARD), found.motor, height, STEP_S)
    error = None
    if move is not None:
        moved = predict.move(
            settings, found.motor, move.distance_cnt, move.velocity_cps, move.accel_cps2
        )
        error = float(np.abs(moved.error_cnt).max())
    return Outlook(
        settings,
        margins(settings, found.motor),
        step,
        predict.figures(step, found.motor.shaft),
        error,
        float(np.sqrt(np.mean(np.square(record.error_cnt)))),
    )


def advice_data(advice: Advice) -> dict[str, Any]:
    """The advice as plain data: numbers, and curves of a bounded length."""
    measurement, found = advice.measurement, advice.identified
    measured, modelled = curves(measurement.record, found.computed)
    return {
        "axis": measurement.axis,
        "period_s": measurement.settings.period_s,
        "motor": {
            **_plain(asdict(found.motor), "shaft"),
            "time_constant_s": _finite(found.motor.time_constant_s),
            "deviations": found.deviations,
        },
        "resonance": _resonance_data(found.resonance),
        "is_sure": found.is_sure,
        "error_percent": found.error_percent,
        "coherence": found.coherence,
        "measured_to_hz": found.measured_to_hz,
        "limited_by": advice.proposal.limited_by if advice.proposal else "",
        "refusal": advice.refusal,
        "time_s": measurement.excitation.duration_s,
        "amplitude_cnt": measurement.excitation.height_cnt,
        "band_hz": [measurement.excitation.low_hz, measurement.excitation.high_hz],
        "worse": worse(advice),
        "measured": measured,
        "modelled": modelled,
        "bode": _bode(advice),
        "present": _outlook_data(advice.present),
        "proposed": _outlook_data(advice.proposed) if advice.proposed else None,
    }


def _plain(data: dict[str, Any], *without: str) -> dict[str, Any]:
    return {name: value for name, value in data.items() if name not in without}


def _resonance_data(found: Resonance) -> dict[str, Any]:
    """The shaft that was found, its numbers None where there is none."""
    shaft = found.shaft
    return {
        "resonance_hz": shaft.resonance_hz if shaft else None,
        "antiresonance_hz": shaft.antiresonance_hz if shaft else None,
        "damping_ratio": shaft.damping_ratio if shaft else None,
        "inertia_ratio": shaft.inertia_ratio if shaft else None,
        "deviations": found.deviations,
        "searched_hz": list(found.searched_hz),
        "reason": found.reason,
    }


def _outlook_data(found: Outlook) -> dict[str, Any]:
    judged = {name: _finite(value) for name, value in asdict(found.margins).items()}
    return {
        "gains": found.settings.gains,
        "filters": asdict(found.settings.filters) if found.settings.filters else None,
        "margins": {**judged, "gain_db": _finite(found.margins.gain_db)},
        "figures": asdict(found.figures),
        "move_error_cnt": found.move_error_cnt,
        "rms_error_cnt": found.rms_error_cnt,
        "step": curves(found.step)[0],
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _bode(advice: Advice) -> dict[str, Any]:
    """Measured response of the motor with its coherence; the open loops by the motor."""
    measured, motor = advice.identified.spectrum, advice.identified.motor
    excitation = advice.measurement.excitation
    chosen = (measured.frequencies_hz >= excitation.low_hz) & (
        measured.frequencies_hz <= excitation.high_hz
    )
    settings = advice.measurement.settings
    ends = (10 * LOWEST_HZ, BODE_SHARE / settings.period_s)
    peaks = np.clip(beside(motor, PEAK_POINTS), *ends)
    frequencies = np.union1d(np.geomspace(*ends, BODE_POINTS), peaks)
    found = {
        "measured": {
            "frequency_hz": rounded(measured.frequencies_hz[chosen]),
            **_polar(measured.response[chosen]),
            "coherence": rounded(measured.coherence[chosen]),
        },
        "frequency_hz": rounded(frequencies),
        "motor": _polar(
            motor.response(np.exp(2j * np.pi * frequencies * settings.period_s), settings.period_s)
        ),
        "present": _polar(open_loop(settings, motor, frequencies)),
    }
    if advice.proposal is not None:
        found["proposed"] = _polar(open_loop(advice.proposal.settings, motor, frequencies))
    return found


def _polar(response: "np.ndarray[Any, np.dtype[np.complex128]]") -> dict[str, list[float]]:
    """Magnitude [dB] and phase [degrees], without jumps, from -360 to 0 where it begins."""
    phase = np.degrees(np.unwrap(np.angle(response)))
    if len(phase) and phase[0] > 0.0:
        phase = phase - 360.0
    with np.errstate(divide="ignore"):
        size = np.maximum(20.0 * np.log10(np.abs(response)), -200.0)
    return {"magnitude_db": rounded(size), "phase_deg": rounded(phase)}
