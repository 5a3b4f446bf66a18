"""Resonances of elastic shafts found in records of their axes, and not where there are none."""

from dataclasses import replace

import numpy as np
import pytest

from openacr.tuning.fit import Fit, fit
from openacr.tuning.identify import Identified, identify
from openacr.tuning.motor import Motor
from openacr.tuning.resonance import _counts
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft
from openacr.tuning.twin import Record, run

T = 0.0005
SETTINGS = LoopSettings.of_gains(T, pgain=0.006, dgain=7e-5)
BAND_HZ = (2.0, 500.0)
RIGID = Motor(3.27e6, 5.0, 1.7e5)


def sweep(high_hz: float = 500.0, samples: int = 3000, height_cnt: float = 100.0) -> np.ndarray:
    """A sweep as the card plays it: its frequency by the square of the time, then rest."""
    t = np.arange(samples) * T
    span_s = samples * T
    hz = 2.0 + (high_hz - 2.0) * (t / span_s) ** 2
    turns = 2.0 * t + (high_hz - 2.0) * t**3 / (3.0 * span_s**2)
    height = height_cnt * np.minimum(1.0, 60.0 / hz)
    return np.concatenate((np.trunc(height * np.sin(2.0 * np.pi * turns)), np.zeros(600)))


def found(motor: Motor, high_hz: float = 500.0) -> Identified:
    return identify(SETTINGS, run(SETTINGS, motor, sweep(high_hz)), (2.0, high_hz))


@pytest.mark.parametrize(
    "shaft",
    [
        Shaft(35.0, 0.02, 0.5),
        Shaft(90.0, 0.01, 1.5),
        Shaft(140.0, 0.05, 0.2),
        Shaft(420.0, 0.03, 1.0),
    ],
)
def test_a_resonance_is_found_within_one_per_cent(shaft: Shaft) -> None:
    result = found(replace(RIGID, shaft=shaft))
    assert result.is_sure
    assert result.resonance.reason == ""
    swings, spread = result.resonance.shaft, result.resonance.deviations
    assert swings is not None
    assert swings == result.motor.shaft
    assert swings.resonance_hz == pytest.approx(shaft.resonance_hz, rel=0.01)
    assert swings.antiresonance_hz == pytest.approx(shaft.antiresonance_hz, rel=0.03)
    assert abs(swings.damping_ratio - shaft.damping_ratio) < max(0.005, 0.3 * shaft.damping_ratio)
    share = 0.06 if shaft.resonance_hz < 400.0 else 0.15  # a count is much of a swing there
    assert swings.inertia_ratio == pytest.approx(shaft.inertia_ratio, rel=share)
    assert abs(swings.resonance_hz - shaft.resonance_hz) < 4.0 * spread["resonance_hz"]
    assert spread["resonance_hz"] == pytest.approx(0.5 / 1.8, rel=1.0)  # of a record of 1.8 s


@pytest.mark.parametrize(
    "motor",
    [RIGID, Motor(3.27e6, 50.0), Motor(3.27e6, 5.0, 5e4, 0.02, 1.5)],
)
def test_an_axis_with_a_rigid_load_has_none(motor: Motor) -> None:
    result = found(motor)
    assert (result.resonance.shaft, result.motor.shaft) == (None, None)
    assert result.resonance.reason.startswith("none was found from 2 to ")


def test_a_resonance_beyond_the_band_is_none_of_the_band() -> None:
    result = found(replace(RIGID, shaft=Shaft(300.0, 0.02, 0.5)), 150.0)
    assert (result.resonance.shaft, result.resonance.reason) == (
        None,
        "none was found from 2 to 150 Hz",
    )


def noisy(record: Record, noise_cnt: float) -> Record:
    noise = np.random.default_rng(4).normal(0.0, noise_cnt, len(record.actual_cnt))
    return replace(record, actual_cnt=record.actual_cnt + noise)


def test_where_noise_hides_it_none_is_found_and_the_report_says_how_far_was_heard() -> None:
    record = run(SETTINGS, replace(RIGID, shaft=Shaft(300.0, 0.02, 0.5)), sweep())
    result = identify(SETTINGS, noisy(record, 60.0), BAND_HZ)
    assert result.measured_to_hz < 200.0
    assert result.resonance.shaft is None
    assert result.resonance.reason == (
        f"none was found from 2 to {result.measured_to_hz:.3g} Hz,"
        " beyond which the coherence is too low"
    )
    assert result.resonance.searched_hz == (2.0, result.measured_to_hz)


def test_noise_below_the_peak_leaves_it_found_and_makes_it_less_sure() -> None:
    motor = replace(RIGID, shaft=Shaft(90.0, 0.02, 0.5))
    record = run(SETTINGS, motor, sweep())
    rough = identify(SETTINGS, noisy(record, 8.0), BAND_HZ).resonance
    assert rough.shaft is not None
    assert rough.shaft.resonance_hz == pytest.approx(90.0, rel=0.02)
    clean, shaken = (fit(SETTINGS, each, motor) for each in (record, noisy(record, 8.0)))
    for name in ("damping_ratio", "inertia_ratio"):
        assert shaken.deviations[name] > 3.0 * clean.deviations[name]


@pytest.mark.parametrize(
    ("resonance_hz", "is_there"), [(1.9, False), (2.1, True), (96.9, True), (97.1, False)]
)
def test_a_peak_counts_only_within_what_was_searched(resonance_hz: float, is_there: bool) -> None:
    shaft = Shaft(resonance_hz, 0.02, 0.5)
    sure = dict.fromkeys(("resonance_hz", "damping_ratio", "inertia_ratio"), 0.001)
    rigid, bent = Fit(RIGID, np.ones(9), {}), Fit(RIGID, np.full(9, 0.1), sure)
    assert _counts(rigid, bent, shaft, (2.0, 100.0)) is is_there
