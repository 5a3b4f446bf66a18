"""The servo loop: every term against its formula in plain Python, filters against scipy."""

import numpy as np
import pytest
from scipy import signal
from tests.kernel.rig import Rig, T

from openacr.map import numbers as at
from openacr.map.rows import axes, dacs, motors
from openacr.map.words import af1, af3

pytestmark = pytest.mark.evidence("oracle", "formulas in plain Python, filters of scipy")

f32 = np.float32
RNG = np.random.default_rng(7)


def open_loop(**gains: float) -> Rig:
    """An axis whose feedback is an encoder nothing moves: tests write positions by hand."""
    world = """
[[axis]]
number = 0
counts_per_rev = 4000
drive = { mode = "ideal", revs_per_s_per_volt = 1e-6, lag_s = 0.001 }
"""
    rig = Rig(world=world)
    rig.modelled = False  # the motor stands still
    return rig.axis(0, **{"proportional_gain": 0.0, **gains})


def follow(rig: Rig, path: np.ndarray, *names: str) -> list[np.ndarray]:
    """Set the setpoint tick by tick; the named FP32 rows after each."""
    samples = []
    for position in path:
        rig.F[axes.position_cnt[0]] = position
        rig.ticks()
        samples.append([rig.fp32(name) for name in names])
    return list(np.array(samples).T)


PATH = np.cumsum(RNG.normal(0, 5, 60)).round(2)


def test_proportional_term_and_sum() -> None:
    rig = open_loop(proportional_gain=0.01)
    term, total, out = follow(rig, PATH, "proportional_term", "summation_point", "output_signal")
    assert term == pytest.approx(0.01 * PATH, rel=1e-6)
    assert total == pytest.approx(term, rel=1e-6)
    assert out == pytest.approx(np.clip(total, -10, 10), rel=1e-6)


def test_integral_term_is_clamped() -> None:
    rig = open_loop(integral_gain=2.0, integral_limit=0.3)
    (term,) = follow(rig, np.full(1500, 1.0), "integral_term")
    assert term == pytest.approx(np.minimum(2.0 * T * np.arange(1, 1501), 0.3), abs=1e-6)
    rig.axis(integral_limit=0.0)
    assert follow(rig, np.ones(2), "integral_term")[0][-1] == 0.0


def test_integral_waits_for_idelay_after_motion_and_is_held_meanwhile() -> None:
    rig = open_loop(integral_gain=2.0, integral_limit=1.0, integral_delay=0.01)
    path = np.concatenate((np.linspace(1, 10, 10), np.full(30, 10.0)))
    (term,) = follow(rig, path, "integral_term")
    assert np.all(term[:29] == 0)
    assert term[31:] == pytest.approx(term[30] + 2.0 * 10 * T * np.arange(1, 10), rel=1e-5)


@pytest.mark.parametrize("ticks", [1, 4])
def test_derivative_term_over_its_width(ticks: int) -> None:
    rig = open_loop(derivative_gain=0.001, derivative_width=0.0 if ticks == 1 else ticks * T)
    (term,) = follow(rig, PATH, "derivative_term")
    sampled = np.concatenate(([0.0], PATH[ticks - 1 :: ticks]))
    slopes = 0.001 * np.diff(sampled) / (ticks * T)
    expected = np.repeat(slopes, ticks)[: len(PATH) - ticks + 1]
    assert term[ticks - 1 :] == pytest.approx(expected, rel=1e-5, abs=1e-9)


def test_feed_forward_terms_and_the_velocity_cutoff() -> None:
    rig = open_loop(feedforward_velocity=1e-4, feedforward_accel=1e-7)
    vel, acc = follow(rig, PATH, "ffvel_term", "ffacc_term")
    speed = np.diff(PATH, prepend=0.0) / T
    assert vel == pytest.approx(1e-4 * speed, rel=1e-5)
    assert acc == pytest.approx(1e-7 * np.diff(speed, prepend=0.0) / T, rel=1e-5)
    rig = open_loop(feedforward_velocity=1e-4, ffvc=8000)
    (vel,) = follow(rig, PATH, "ffvel_term")
    assert vel == pytest.approx(np.where(np.abs(speed) < 8000, 0, 1e-4 * speed), rel=1e-5)


@pytest.mark.parametrize("smooth", [0, 4])
def test_velocity_feedback_is_averaged(smooth: int) -> None:
    rig = open_loop(fbvel_gain_setting=1e-4, smooth_encoder_velocity=smooth)
    raw = np.cumsum(RNG.integers(-9, 10, 40)) * 4.0
    terms = []
    for count in raw:
        rig.F[motors.raw_count[0]] = count
        rig.ticks()
        terms.append(rig.fp32("fbvel_term"))
    steps = np.diff(raw / 4, prepend=0.0) / T
    size = max(smooth, 1)
    window = np.concatenate((np.full(size - 1, steps[0]), steps))
    expected = 1e-4 * np.convolve(window, np.ones(size) / size, "valid")
    assert terms == pytest.approx(expected, rel=1e-5, abs=1e-9)


def test_velocity_loop_takes_the_place_of_the_pid_sum() -> None:
    gains = {"proportional_gain": 2.0, "kvp": 1e-3, "kvi": 0.5, "kvf": 0.1}
    rig = open_loop(**gains)
    (total,) = follow(rig, PATH, "summation_point")
    speed = np.diff(PATH, prepend=0.0) / T
    wanted = f32(2.0) * PATH + f32(0.1) * speed
    expected = f32(1e-3) * wanted + f32(0.5) * np.cumsum(wanted) * T
    assert total == pytest.approx(expected, rel=1e-5)


def test_filters_follow_their_transfer_function() -> None:
    rig = open_loop(proportional_gain=0.01)
    first = [0.3, 0.2, 0.1, -0.4, 0.15]  # a0 a1 a2 b1 b2
    second = [0.9, -0.3, 0.2, 0.25, -0.1]
    for n, row in enumerate((first, second)):
        for name, value in zip(("a0", "a1", "a2", "b1", "b2"), row, strict=True):
            rig.axis(0, **{f"filter{n}_{name}": value})
    rig.I[4120] |= af1.BIQUAD_FILTER_ACTIVATE
    (out,) = follow(rig, PATH, "filter_output_signal")
    x = np.float32(0.01).astype(float) * PATH
    for a0, a1, a2, b1, b2 in (first, second):
        x = signal.lfilter(np.array([a0, a1, a2], f32), [1.0, f32(b1), f32(b2)], x)
    assert out == pytest.approx(x, rel=1e-4, abs=1e-7)


def test_torque_limit_clips_and_says_so() -> None:
    rig = open_loop(proportional_gain=1.0, plus_torque_limit=2.0, minus_torque_limit=-3.0)
    (out,) = follow(rig, np.array([1.0, 5.0, -5.0, 0.0]), "output_signal")
    assert out.tolist() == [1.0, 2.0, -3.0, 0.0]
    for position, clipped in ((5.0, True), (1.0, False)):
        follow(rig, np.full(101, position), "output_signal")
        assert rig.bit(772) == (not clipped)
        assert rig.bit(532) == (not clipped)  # the master: all of its axes


def test_clamped_open_or_disabled_loops_put_out_nothing() -> None:
    for flag in (af1.OPEN_SERVO_LOOP, af1.CLAMP_OUTPUT_SIGNAL):
        rig = open_loop(proportional_gain=1.0)
        rig.I[4120] |= flag
        assert follow(rig, np.array([3.0]), "output_signal")[0].tolist() == [0.0]
    rig = open_loop(proportional_gain=1.0)
    rig.bit(8468, True)  # drive I/O in use, drive not enabled
    assert follow(rig, np.array([3.0]), "output_signal")[0].tolist() == [0.0]


def test_the_dead_zone_rests_the_loop_until_it_is_left() -> None:
    rig = open_loop(proportional_gain=0.1, integral_gain=1.0, integral_limit=5.0)
    rig.axis(dzl=4, dzu=8, dip=0.5, din=-0.25)
    follow(rig, np.array([3.0, 3.0]), "output_signal")
    assert rig.bit(in_dead_band())
    assert rig.fp32("proportional_term") == 0.0
    held = rig.fp32("integral_term")
    follow(rig, np.array([7.0] * 5), "output_signal")
    assert rig.fp32("integral_term") == held
    follow(rig, np.array([9.0]), "output_signal")
    assert not rig.bit(in_dead_band())
    assert rig.fp32("integral_term") == pytest.approx(0.5 + 9 * T)
    follow(rig, np.array([-3.0, -3.0, -9.0]), "output_signal")
    assert rig.fp32("integral_term") == pytest.approx(-0.25 - 9 * T)


def in_dead_band() -> int:
    return (af3.word[0] - 4096) * 32 + af3.IN_DEAD_BAND.bit_length() - 1


def test_the_converter_shows_gain_and_offset_and_saturates() -> None:
    rig = open_loop(proportional_gain=1.0)
    dac = dacs.parameters[0]
    rig.S[dac + at.DAC_DAC_OFFSET] = 0.5
    follow(rig, np.array([2.0]), "output_signal")
    assert rig.S[dac + at.DAC_DAC_OUTPUT] == pytest.approx(2.5)
    follow(rig, np.array([20.0]), "output_signal")
    assert rig.S[dac + at.DAC_DAC_OUTPUT] == pytest.approx(32767 / 3276.8)


def test_a_gain_that_is_no_number_leaves_no_trace() -> None:
    rig = open_loop(proportional_gain=1.0, kvp=1.0)
    rig.axis(kvi=float("nan"))
    follow(rig, np.array([1.0, 2.0]), "output_signal")
    rig.axis(kvi=0.0, kvp=0.0)
    assert follow(rig, np.array([1.0, 2.0]), "output_signal")[0][-1] == 2.0


@pytest.mark.parametrize("setting", ["proportional_gain", "integral_limit", "derivative_gain"])
@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_setting_that_is_no_number_puts_out_nothing_or_the_limit(
    setting: str, value: float
) -> None:
    rig = open_loop(proportional_gain=1.0)
    rig.axis(0, **{setting: value})
    voltages, *_ = follow(rig, np.array([1.0, 2.0, 3.0]), "output_signal")
    assert all(abs(volts) <= 10.0 for volts in voltages)
    rig.axis(0, **{setting: 0.0})
    assert all(volts in (0.0, 1.0) for volts in follow(rig, np.array([1.0]), "output_signal")[0])
