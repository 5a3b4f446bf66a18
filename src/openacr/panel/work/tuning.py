"""What records of servo tuning mean: seconds of computing, as functions for another process."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from openacr.tuning.advice import advice_data, advise, new_filters
from openacr.tuning.curves import curves
from openacr.tuning.excitation import Excitation
from openacr.tuning.filters import Filters
from openacr.tuning.measure import Measurement
from openacr.tuning.motor import Motor
from openacr.tuning.predict import figures
from openacr.tuning.propose import Wish
from openacr.tuning.twin import run

Data = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Advised:
    """What is kept of a measurement, and what the screens show of it."""

    excitation: Excitation
    motor: Motor
    gains: dict[str, float] | None  # None: nothing is proposed
    filters: Filters | None  # None: they stay as they are
    data: Data


def advised(measurement: Measurement, wish: Wish) -> Advised:
    """Identify the motor of a measurement, judge its loop and propose gains; UserError."""
    advice = advise(measurement, wish)
    gains = None if advice.proposal is None else advice.proposal.gains
    motor = advice.identified.motor
    return Advised(measurement.excitation, motor, gains, new_filters(advice), advice_data(advice))


def stepped(measurement: Measurement, gains: Mapping[str, float], motor: Motor | None) -> Data:
    """What an axis did with a step; what was to be expected of a motor that is known."""
    records = [measurement.record]
    if motor is not None:
        setpoint_cnt = measurement.record.setpoint_cnt
        records.append(run(measurement.settings, motor, setpoint_cnt, measurement.record))
    measured, *predicted = curves(*records)
    return {
        "gains": dict(gains),
        "figures": asdict(figures(measurement.record)),
        "measured": measured,
        "predicted": predicted[0] if predicted else None,
    }
