"""Proposed gains on many motors, their margins measured by computing the axis."""

import numpy as np
import pytest

from openacr.errors import UserError
from openacr.tuning.frequency import is_stable
from openacr.tuning.motor import Motor
from openacr.tuning.predict import figures, move, step
from openacr.tuning.propose import Wish, propose
from openacr.tuning.settings import LoopSettings
from openacr.tuning.twin import Record

T = 0.0005
BLANK = LoopSettings.of_gains(T)
MOTORS = [
    Motor(accel, rate, friction * accel, 0.0, delay)
    for accel, rate, friction, delay in (
        (1e5, 1.0, 0.0, 0.0),
        (3.27e6, 5.0, 0.05, 0.0),
        (3.27e6, 5.0, 0.0, 2.0),
        (3e7, 50.0, 0.02, 0.0),
        (3e7, 50.0, 0.0, 1.0),
        (2e8, 0.0, 0.0, 0.0),
        (5e6, 200.0, 0.0, 0.0),
        (5e6, 200.0, 0.0, 3.0),
        (2e6, 1000.0, 0.0, 0.0),
        (1e8, 5000.0, 0.0, 1.5),
        (1e6, 20.0, 0.1, 0.5),
        (1e4, 0.1, 0.0, 0.0),
    )
]


def swings(settings: LoopSettings, motor: Motor, times: float) -> float:
    """The following error at the end of a small step with all gains times a factor."""
    gains = {name: settings.gain(name.upper()) * times for name in ("pgain", "igain", "dgain")}
    still = settings.changed(**gains, ffvel=0.0, ffacc=0.0)
    record = step(still, Motor(motor.accel_per_volt, motor.rate_per_s, 0.0, 0.0, motor.delay_tk),
                  20, 1.5)  # fmt: skip
    return float(np.abs(record.error_cnt[-200:]).max())


@pytest.mark.parametrize("motor", MOTORS)
def test_proposed_gains_have_the_margins_that_are_stated(motor: Motor) -> None:
    found = propose(BLANK, motor)
    assert found.margins.is_stable
    assert abs(found.margins.gain_db) >= 6.0
    assert found.margins.phase_deg >= 54.9
    assert found.limited_by
    if found.margins.gain > 1.0:
        assert is_stable(changed(found.settings, 0.97 * found.margins.gain), motor)
        assert not is_stable(changed(found.settings, 1.03 * found.margins.gain), motor)
    assert found.gains["FFACC"] == pytest.approx(1.0 / motor.accel_per_volt)
    assert found.gains["FFVEL"] == pytest.approx(motor.rate_per_s / motor.accel_per_volt)


def changed(settings: LoopSettings, times: float) -> LoopSettings:
    """Settings with the loop gain times a factor."""
    gains = {name: settings.gain(name.upper()) * times for name in ("pgain", "igain", "dgain")}
    return settings.changed(**gains)


@pytest.mark.parametrize("motor", MOTORS[1:6])
def test_the_computed_axis_is_at_rest_with_the_gains_and_swings_beyond_the_margin(
    motor: Motor,
) -> None:
    found = propose(BLANK, motor)
    assert swings(found.settings, motor, 1.0) <= 3.0
    if found.margins.gain > 1.0:
        assert swings(found.settings, motor, 1.3 * found.margins.gain) > 3.0


def test_the_crossover_is_where_it_was_asked_for() -> None:
    found = propose(BLANK, MOTORS[1], Wish(bandwidth_hz=30.0, phase_deg=60.0))
    assert found.margins.crossover_hz == pytest.approx(30.0, rel=1e-3)
    assert found.margins.phase_deg == pytest.approx(60.0, abs=0.1)
    assert found.limited_by == ""
    assert found.gains["IGAIN"] == pytest.approx(found.gains["PGAIN"] * 2 * np.pi * 3.0)
    assert found.gains["ILIMIT"] == 5.0
    without = propose(BLANK, MOTORS[1], Wish(bandwidth_hz=30.0, has_integral=False))
    assert (without.gains["IGAIN"], without.gains["ILIMIT"]) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("wish", "text"),
    [
        (Wish(phase_deg=39.0), "phase margin 39: from 40 to 80 degrees"),
        (Wish(phase_deg=81.0), "phase margin 81: from 40 to 80 degrees"),
        (Wish(bandwidth_hz=0.0), "bandwidth 0 Hz: above 0, below 400 Hz"),
        (Wish(bandwidth_hz=400.0), "bandwidth 400 Hz: above 0, below 400 Hz"),
    ],
)
def test_a_wish_out_of_range_is_refused(wish: Wish, text: str) -> None:
    with pytest.raises(UserError) as refused:
        propose(BLANK, MOTORS[1], wish)
    assert str(refused.value) == text


def test_a_bandwidth_beyond_the_encoder_is_refused_with_the_reason() -> None:
    with pytest.raises(UserError, match=r"at 150 Hz a single count changes the output by .* V"):
        propose(BLANK, Motor(1e5, 1.0), Wish(bandwidth_hz=150.0))


def test_feed_forward_takes_the_following_error_of_a_move_away() -> None:
    motor = Motor(3.27e6, 50.0)
    found = propose(BLANK, motor, Wish(bandwidth_hz=20.0)).settings
    with_it = move(found, motor, 40_000, 200_000, 2e6)
    without = move(found.changed(ffvel=0.0, ffacc=0.0), motor, 40_000, 200_000, 2e6)
    assert np.abs(with_it.error_cnt).max() < 0.1 * np.abs(without.error_cnt).max()
    assert with_it.setpoint_cnt.max() == 40_000 == with_it.setpoint_cnt[-1]


def test_a_move_at_constant_speed_lags_by_speed_over_gain() -> None:
    # a quick drive of velocity of 50 000 counts/s per volt: e = v / (PGAIN K)
    settings = LoopSettings.of_gains(T, pgain=0.002)
    record = move(settings, Motor(5e11, 1e7), -50_000, 50_000, 1e6)
    middle = record.error_cnt[len(record.error_cnt) // 2]
    assert middle == pytest.approx(-50_000 / (0.002 * 50_000), abs=30)


def test_figures_of_a_step_are_those_of_its_curve() -> None:
    settings = LoopSettings.of_gains(T, pgain=0.002)
    record = step(settings, Motor(5e11, 1e7), 1000, 0.2)  # 1 - 0.95^k: a factor of 1 - P K T
    found = figures(record)
    assert found.overshoot_percent == 0.0
    assert found.rise_s == pytest.approx(np.log(9) / -np.log(0.95) * T, abs=1.5 * T)
    assert found.settling_s == pytest.approx(np.log(0.02) / np.log(0.95) * T, abs=2 * T)
    unsettled = figures(step(settings, Motor(5e11, 1e7), 1000, 0.01))
    assert (unsettled.rise_s, unsettled.settling_s) == (None, None)


@pytest.mark.parametrize(("left_cnt", "is_settled"), [(102, True), (98, True), (103, False)])
def test_a_step_has_settled_within_two_per_cent_of_its_height_that_included(
    left_cnt: int, is_settled: bool
) -> None:
    setpoint = np.array([0.0, 0.0, 100.0, 100.0, 100.0, 0.0, 0.0])
    actual = np.array([0.0, 0.0, 60.0, left_cnt, left_cnt, 10.0, 0.0])
    found = figures(Record(T, setpoint, actual, np.zeros(7)))
    assert found.settling_s == (pytest.approx(T) if is_settled else None)
    assert found.overshoot_percent == pytest.approx(max(0.0, left_cnt - 100.0))


@pytest.mark.parametrize("wrong", [(0, 1, 1), (1, 0, 1), (1, 1, 0)])
def test_a_move_needs_distance_speed_and_acceleration(wrong: tuple[int, int, int]) -> None:
    with pytest.raises(UserError, match="a move needs a distance"):
        move(BLANK, MOTORS[0], *wrong)


def test_the_crossover_is_at_most_where_the_response_was_measured() -> None:
    free, limited = propose(BLANK, MOTORS[1]), propose(BLANK, MOTORS[1], measured_to_hz=20.0)
    assert free.margins.crossover_hz > 40.0
    assert 20.0 / 1.05 < limited.margins.crossover_hz <= 20.0
    assert "nothing was measured: the response is known up to 20 Hz" in limited.limited_by
    barely = propose(BLANK, MOTORS[1], Wish(bandwidth_hz=20.0), measured_to_hz=20.0)
    assert barely.margins.crossover_hz == pytest.approx(20.0, rel=1e-3)
    with pytest.raises(UserError, match=r"at 20\.1 Hz nothing was measured"):
        propose(BLANK, MOTORS[1], Wish(bandwidth_hz=20.1), measured_to_hz=20.0)


def test_nothing_is_proposed_where_nothing_was_measured() -> None:
    with pytest.raises(UserError, match="no gains have the margins"):
        propose(BLANK, MOTORS[1], measured_to_hz=0.0)
