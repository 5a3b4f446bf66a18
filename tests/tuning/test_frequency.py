"""Controller, margins and poles of the loop against scipy."""

import math

import numpy as np
import pytest
from scipy import signal

from openacr.map.rows import axes
from openacr.tuning.filters import FILTERS
from openacr.tuning.frequency import (
    closed_loop,
    controller,
    is_stable,
    margins,
    open_loop,
    points,
)
from openacr.tuning.motor import Motor
from openacr.tuning.settings import LoopSettings
from openacr.tuning.twin import run

pytestmark = pytest.mark.evidence("oracle", "transfer functions and responses of scipy.signal")

T = 0.0005
A, RATE = 3.2e6, 40.0
HZ = np.geomspace(1.0, 900.0, 40)


def filtered(settings: LoopSettings, *, low_pass_hz: float) -> LoopSettings:
    """Settings with a Butterworth low-pass of scipy as filter 1."""
    b, a = signal.butter(2, low_pass_hz, fs=1.0 / T)
    rows = dict(settings.rows)
    rows.update(zip(FILTERS[1], (a[2], b[2], a[1], b[1], b[0]), strict=True))
    return LoopSettings(rows, True, T)


@pytest.mark.parametrize(("rate", "delay"), [(RATE, 0), (RATE, 2), (5000.0, 0), (0.0, 1)])
def test_the_motor_responds_as_its_equation_with_the_voltage_held(rate: float, delay: int) -> None:
    b, a, _dt = signal.cont2discrete(([A], [1.0, rate, 0.0]), T)
    _w, expected = signal.freqz(b.ravel(), np.pad(a, (0, delay)), worN=HZ, fs=1.0 / T)
    expected = expected if delay == 0 else _delayed(b.ravel(), a, delay)
    z = np.exp(2j * np.pi * HZ * T)
    assert Motor(A, rate, delay_tk=delay).response(z, T) == pytest.approx(expected, rel=1e-6)


def _delayed(b: np.ndarray, a: np.ndarray, delay: int) -> np.ndarray:
    found = signal.freqz(np.concatenate((np.zeros(delay), b)), a, worN=HZ, fs=1.0 / T)[1]
    return np.asarray(found)


def test_half_a_period_of_delay_is_the_mean_of_none_and_one() -> None:
    z = np.exp(2j * np.pi * HZ * T)
    none, half, one = (Motor(A, RATE, delay_tk=d).response(z, T) for d in (0.0, 0.5, 1.0))
    assert half == pytest.approx((none + one) / 2.0, rel=1e-12)


@pytest.mark.parametrize(
    ("gains", "smooth"),
    [
        ({"pgain": 0.002, "dgain": 3e-5, "igain": 0.05, "ilimit": 8.0}, 0),
        ({"pgain": 0.002, "dgain": 3e-5, "igain": 0.05, "ilimit": 0.0}, 0),
        ({"pgain": 0.002, "dgain": 3e-5}, 2),
    ],
)
@pytest.mark.parametrize("low_pass_hz", [0.0, 150.0])
def test_the_controller_is_what_the_servo_loop_puts_out(
    gains: dict[str, float], smooth: int, low_pass_hz: float
) -> None:
    settings = LoopSettings.of_gains(T, **gains)
    settings = LoopSettings({**settings.rows, axes.dgain_smooth: smooth}, False, T)
    if low_pass_hz:
        settings = filtered(settings, low_pass_hz=low_pass_hz)
    error = np.zeros(4096)
    error[1] = 30.0
    held = run(settings, Motor(1e-9), error)  # a motor that does not move: the loop is open
    decay = np.exp(-np.arange(4096) / 300.0)  # so that the integral ends within the record
    z = np.exp(2j * np.pi * np.fft.rfftfreq(4096)[20:800]) * math.exp(1.0 / 300.0)
    measured = np.fft.rfft(held.output_v * decay)[20:800] / np.fft.rfft(error * decay)[20:800]
    assert measured == pytest.approx(controller(settings, z), rel=2e-5)


def test_a_derivative_of_three_periods_is_a_staircase_of_mean_slopes() -> None:
    settings = LoopSettings.of_gains(T, dgain=3e-5, dwidth=3 * T)
    z = points(settings, np.array([20.0]))
    ideal = 3e-5 * 2j * np.pi * 20.0
    lag = np.exp(-2j * np.pi * 20.0 * 2.5 * T)  # half of the difference, and of the hold
    assert controller(settings, z)[0] == pytest.approx(ideal * lag, rel=0.01)


@pytest.mark.parametrize("delay", [0.0, 1.5])
@pytest.mark.parametrize("igain", [0.0, 0.3])
def test_with_the_gain_margin_the_poles_are_on_the_unit_circle(igain: float, delay: float) -> None:
    settings = LoopSettings.of_gains(T, pgain=0.01, dgain=1e-4, igain=igain, ilimit=5.0)
    motor = Motor(A, RATE, delay_tk=delay)
    found = margins(settings, motor)
    assert found.is_stable
    assert found.gain_db == pytest.approx(20 * math.log10(found.gain))
    for factor, stable in ((0.998, True), (1.002, False)):
        times = found.gain * factor if found.gain > 1 else found.gain / factor
        changed = settings.changed(pgain=0.01 * times, dgain=1e-4 * times, igain=igain * times)
        assert is_stable(changed, motor) is stable
    at_limit = open_loop(settings, motor, np.array([found.gain_at_hz]))[0] * found.gain
    assert at_limit == pytest.approx(-1.0, abs=2e-3)


def test_the_phase_margin_is_the_angle_to_minus_one_where_the_gain_is_one() -> None:
    settings = LoopSettings.of_gains(T, pgain=0.01, dgain=1e-4)
    found = margins(settings, Motor(A, RATE))
    b, a, _dt = signal.cont2discrete(([A], [1.0, RATE, 0.0]), T)
    c = ([0.01 + 1e-4 / T, -1e-4 / T], [1.0, 0.0])
    loop = (np.convolve(b.ravel(), c[0]), np.convolve(a, c[1]))
    at_crossover = signal.freqz(*loop, worN=[found.crossover_hz], fs=1.0 / T)[1][0]
    assert abs(at_crossover) == pytest.approx(1.0, abs=2e-4)
    assert 180.0 + math.degrees(np.angle(at_crossover)) == pytest.approx(found.phase_deg, abs=0.02)


def test_a_loop_of_first_order_has_its_closed_form() -> None:
    # a quick drive of velocity: L = P K T w / (1 - w) with w = 1/z, K = a / rate
    settings, motor = LoopSettings.of_gains(T, pgain=0.01), Motor(5e11, 1e7)
    found = margins(settings, motor)
    gain = 0.01 * 5e4 * T  # L = gain / (z - 1)
    assert found.crossover_hz == pytest.approx(math.asin(gain / 2) / (math.pi * T), rel=1e-4)
    assert found.gain == pytest.approx(2.0 / gain, rel=1e-3)  # z = -1
    assert found.is_stable


def test_a_sine_that_is_computed_follows_the_closed_loop() -> None:
    settings = LoopSettings.of_gains(T, pgain=0.001, dgain=3e-5, ffvel=2e-6, ffacc=1e-8)
    motor, hz = Motor(A, RATE), 20.0
    t = np.arange(2000) * T
    record = run(settings, motor, 1000.0 * np.sin(2 * np.pi * hz * t))
    last = slice(1000, 2000)  # ten periods, after what dies away
    tone = np.exp(-2j * np.pi * hz * t[last])
    measured = (record.actual_cnt[last] @ tone) / (record.setpoint_cnt[last] @ tone)
    assert measured == pytest.approx(closed_loop(settings, motor, np.array([hz]))[0], abs=2e-3)


def test_a_motor_knows_its_time_constant_and_its_speed() -> None:
    assert Motor(1000.0, 4.0).time_constant_s == 0.25
    assert Motor(1000.0, 4.0).speed_per_volt_cps == 250.0
    assert Motor(1000.0).time_constant_s == math.inf
