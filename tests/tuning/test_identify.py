"""Motors found in records of their axes, against what they are."""

import math
from dataclasses import replace

import numpy as np
import pytest

from openacr.errors import UserError
from openacr.map.rows import axes
from openacr.tuning.identify import Spectrum, identify, spectrum
from openacr.tuning.motor import Motor
from openacr.tuning.settings import LoopSettings
from openacr.tuning.twin import Record, run

T = 0.0005
BAND_HZ = (2.0, 60.0)


def chirp(samples: int = 2400, height_cnt: float = 150.0) -> np.ndarray:
    """A sine from 2 to 60 Hz, in steps of 1.5 ms as a program writes them; rest at both ends."""
    t = (np.arange(samples) // 3) * 3 * T
    low, high = BAND_HZ
    phase = low * t + (high - low) * t * t / (2.0 * samples * T)
    return np.concatenate(([0.0], height_cnt * np.sin(2.0 * np.pi * phase), np.zeros(600)))


TORQUE = {"pgain": 0.006, "dgain": 7e-5}


@pytest.mark.parametrize(
    ("motor", "gains"),
    [
        (Motor(3.27e6, 5.0), TORQUE),
        (Motor(3.27e6, 5.0, 1.7e5), TORQUE),
        (Motor(3.27e6, 5.0, 5e4, 0.02, 1.5), TORQUE),
        (Motor(2e5, 40.0, 3e3), {"pgain": 0.05, "dgain": 8e-4}),
        (Motor(5e6, 200.0, 0.0, 0.05), {"pgain": 0.0024}),
        (Motor(3.27e6, 5.0, 1.7e5), {**TORQUE, "igain": 0.1, "ilimit": 2.0, "ffacc": 1e-8}),
    ],
)
def test_a_motor_is_found_within_a_few_per_cent(motor: Motor, gains: dict[str, float]) -> None:
    settings = LoopSettings.of_gains(T, **gains)
    found = identify(settings, run(settings, motor, chirp()), BAND_HZ)
    accel = motor.accel_per_volt
    assert found.is_sure
    assert found.error_percent < 3.0
    assert found.coherence > 0.9
    assert found.motor.accel_per_volt == pytest.approx(accel, rel=0.03)
    assert abs(found.motor.rate_per_s - motor.rate_per_s) < max(5.0, 0.03 * motor.rate_per_s)
    assert abs(found.motor.coulomb_accel - motor.coulomb_accel) < 0.02 * accel  # 20 mV
    assert found.motor.offset_v == pytest.approx(motor.offset_v, abs=0.03)
    assert found.motor.delay_tk == pytest.approx(motor.delay_tk, abs=0.3)


def test_the_measured_response_is_that_of_the_motor_where_it_is_coherent() -> None:
    motor, settings = Motor(3.27e6, 5.0), LoopSettings.of_gains(T, **TORQUE)
    measured = spectrum(run(settings, motor, chirp(4800, 150.0)))
    used = measured.is_coherent & (measured.frequencies_hz > 3) & (measured.frequencies_hz < 55)
    z = np.exp(2j * np.pi * measured.frequencies_hz[used] * T)
    ratio = measured.response[used] / motor.response(z, T)
    assert used.sum() > 30
    assert np.abs(ratio - 1.0).max() < 0.06
    assert np.median(np.abs(ratio - 1.0)) < 0.01


def test_noise_in_the_loop_does_not_pull_the_response_aside() -> None:
    motor, settings = Motor(3.27e6, 5.0), LoopSettings.of_gains(T, **TORQUE)
    clean = run(settings, motor, chirp(4800, 150.0))
    noise = np.random.default_rng(1).normal(0.0, 6.0, len(clean.actual_cnt))
    # a disturbance of the position is in the output too, through the gains
    slope = np.diff(noise, prepend=0.0) / T
    noisy = replace(
        clean,
        actual_cnt=clean.actual_cnt + noise,
        output_v=clean.output_v - 0.006 * noise - 7e-5 * slope,
    )
    measured = spectrum(noisy)
    used = (measured.frequencies_hz > 10) & (measured.frequencies_hz < 40)
    z = np.exp(2j * np.pi * measured.frequencies_hz[used] * T)
    ratio = measured.response[used] / motor.response(z, T)
    assert np.mean(measured.coherence[used]) < np.mean(spectrum(clean).coherence[used])
    assert abs(np.mean(ratio) - 1.0) < 0.03


@pytest.mark.parametrize(("noise_cnt", "least_hz", "most_hz"), [(60, 35, 45), (100, 20, 32)])
def test_what_noise_hides_counts_as_not_measured(
    noise_cnt: float, least_hz: float, most_hz: float
) -> None:
    motor, settings = Motor(3.27e6, 5.0), LoopSettings.of_gains(T, pgain=0.0015, dgain=2e-5)
    clean = run(settings, motor, chirp(4800))
    count = len(clean.actual_cnt)
    frequencies = np.fft.rfftfreq(count, T)
    size = np.convolve(np.abs(np.fft.rfft(clean.actual_cnt)) ** 2, np.full(7, 1.0 / 7.0), "same")
    # a coherence of 0.8 is four times the power of the noise
    hidden = frequencies[(frequencies > 5.0) & (size < 4.0 * count * noise_cnt**2)].min()
    assert least_hz < hidden < most_hz
    noise = np.random.default_rng(5).normal(0.0, noise_cnt, count)
    record = replace(clean, actual_cnt=clean.actual_cnt + noise)
    assert spectrum(record).measured_to_hz(BAND_HZ) == pytest.approx(hidden, rel=0.15)
    assert spectrum(clean).measured_to_hz(BAND_HZ) > 0.95 * BAND_HZ[1]


def test_a_frequency_that_is_coherent_by_chance_does_not_prolong_what_was_measured() -> None:
    coherence = np.array([0.5, 0.9, 0.9, 0.7, 0.9, 0.9, 0.9, 0.3, 0.3, 0.9, 0.3, 0.9])
    frequencies = np.arange(1.0, 13.0)
    found = Spectrum(frequencies, np.ones(12, np.complex128), coherence)
    assert found.measured_to_hz((0.0, 100.0)) == 7.0
    assert found.measured_to_hz((0.0, 6.0)) == 0.0  # too few: 5 of which one does not count
    assert found.measured_to_hz((50.0, 60.0)) == 0.0


def test_a_record_of_another_axis_is_not_explained() -> None:
    settings = LoopSettings.of_gains(T, **TORQUE)
    record = run(settings, Motor(3.27e6, 5.0), chirp())
    swapped = replace(record, actual_cnt=record.actual_cnt[::-1].copy())
    try:
        found = identify(settings, swapped, BAND_HZ)
    except UserError as refused:
        assert "at least 4 are needed" in str(refused)
    else:
        assert not found.is_sure


@pytest.mark.parametrize(
    ("record", "text"),
    [
        (
            Record(T, np.zeros(399), np.zeros(399), np.zeros(399)),
            "399 samples: at least 400 are needed",
        ),
        (
            Record(T, chirp(400), np.linspace(0.0, 9.0, 400), np.zeros(400)),
            "the axis moved by 9 counts: at least 10 are needed"
            " (a larger amplitude, higher gains, or is its drive off?)",
        ),
    ],
)
def test_too_little_is_refused(record: Record, text: str) -> None:
    with pytest.raises(UserError) as refused:
        identify(LoopSettings.of_gains(T, **TORQUE), record, BAND_HZ)
    assert str(refused.value) == text


def test_an_unmodelled_loop_is_refused() -> None:
    settings = LoopSettings.of_gains(T)
    settings.require_modelled()
    with pytest.raises(UserError, match=r"DZU: a dead zone is not part of the model: it is 3"):
        LoopSettings({**settings.rows, axes.dzu: 3.0}, False, T).require_modelled()
    assert math.isclose(settings.limit_v, 10.0)
