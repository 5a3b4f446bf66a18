"""What a loop would do: step, sine, and following error of a move."""

from dataclasses import dataclass

import numpy as np

from openacr.errors import UserError
from openacr.tuning.motor import Motor, Reals
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft
from openacr.tuning.twin import Record, run

REST_TK = 4  # before a step
FIRST, LAST = 0.1, 0.9
SETTLED_SHARE = 0.02
CALM_S = 0.1  # after a step: from here on what swings is vibration
PERCENT = 100.0
LONGEST_TK = 200_000


@dataclass(frozen=True, slots=True)
class StepFigures:
    """The figures of a step response; None where it does not get there."""

    overshoot_percent: float
    rise_s: float | None  # from 10 % to 90 %
    settling_s: float | None  # until it stays within 2 %, or a count
    vibration_cnt: float | None  # of a load on an elastic shaft afterwards, from peak to peak


def step(settings: LoopSettings, motor: Motor, height_cnt: int, duration_s: float) -> Record:
    """The response to a step of the setpoint."""
    return run(settings, motor, step_setpoint(height_cnt, duration_s, settings.period_s))


def step_setpoint(height_cnt: int, duration_s: float, period_s: float) -> Reals:
    """A setpoint that rests for REST_TK periods and then is `height_cnt` further."""
    setpoint = np.full(REST_TK + _ticks(duration_s, period_s), float(height_cnt))
    setpoint[:REST_TK] = 0.0
    return setpoint


def vibration(record: Record, shaft: Shaft) -> float:
    """How far the load swings from peak to peak [counts], from CALM_S after a step on.

    It is the distance to its mean over one turn of the resonance: what moves slowly is no swing.
    """
    if record.load_cnt is None:
        return 0.0
    turn = max(2, round(1.0 / (shaft.resonance_hz * record.period_s)))
    mean = np.convolve(record.load_cnt, np.full(turn, 1.0 / turn), "valid")
    place = record.load_cnt[turn // 2 :][: len(mean)]
    begin = REST_TK + round(CALM_S / record.period_s)
    swing = (place - mean)[begin - turn // 2 :]
    return float(np.ptp(swing))


def figures(record: Record, shaft: Shaft | None = None) -> StepFigures:
    """Overshoot, rise and settling of a recorded step, until the setpoint moves again.

    With the shaft of a computed axis also what its load swings.
    """
    changes = np.nonzero(np.diff(record.setpoint_cnt))[0] + 1
    begin, end = int(changes[0]), int(changes[1]) if len(changes) > 1 else None
    height = float(record.setpoint_cnt[begin] - record.setpoint_cnt[begin - 1])
    share = (record.actual_cnt[begin:end] - record.actual_cnt[begin - 1]) / height
    reached = [np.nonzero(share >= part)[0] for part in (FIRST, LAST)]
    rise = None
    if len(reached[1]):
        rise = float(reached[1][0] - reached[0][0]) * record.period_s
    error_cnt = record.actual_cnt[begin:end] - record.actual_cnt[begin - 1] - height
    away = np.nonzero(np.abs(error_cnt) > max(SETTLED_SHARE * abs(height), 1.5))[0]
    settling = 0.0 if not len(away) else float(away[-1] + 1) * record.period_s
    is_settled = not len(away) or away[-1] + 1 < len(share)
    overshoot = PERCENT * max(0.0, float(share.max()) - 1.0)
    swing = None if shaft is None else vibration(record, shaft)
    return StepFigures(overshoot, rise, settling if is_settled else None, swing)


def move(
    settings: LoopSettings,
    motor: Motor,
    distance_cnt: float,
    velocity_cps: float,
    accel_cps2: float,
) -> Record:
    """A move with ramps of constant acceleration, and a quarter of its time at rest after it."""
    if distance_cnt == 0.0 or velocity_cps <= 0.0 or accel_cps2 <= 0.0:
        raise UserError("a move needs a distance, a velocity above 0 and an acceleration above 0")
    distance = abs(distance_cnt)
    top = min(velocity_cps, (distance * accel_cps2) ** 0.5)
    ramp_s = top / accel_cps2
    total_s = distance / top + ramp_s
    t = np.arange(_ticks(1.25 * total_s, settings.period_s)) * settings.period_s
    up = 0.5 * accel_cps2 * np.minimum(t, ramp_s) ** 2
    even = top * np.clip(t - ramp_s, 0.0, total_s - 2.0 * ramp_s)
    left = np.clip(total_s - t, 0.0, ramp_s)
    down = 0.5 * accel_cps2 * (ramp_s**2 - left**2)
    return run(settings, motor, np.copysign(1.0, distance_cnt) * (up + even + down))


def _ticks(duration_s: float, period_s: float) -> int:
    count = round(duration_s / period_s)
    if not 1 <= count <= LONGEST_TK:
        raise UserError(
            f"{duration_s:g} s are {count} servo periods: 1 to {LONGEST_TK} are computed"
        )
    return count
