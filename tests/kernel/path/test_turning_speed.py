"""Speeds under a jerk limit at the ends of a length: the slowest begin, and what is reached."""

import numpy as np
import pytest
from tests.kernel.rig import Rig

from openacr.kernel.path.lookahead_cy import ramp_start
from openacr.kernel.path.round_run_cy import round_turning
from openacr.kernel.path.round_settle_cy import round_reached
from openacr.map.rows import profiles


@pytest.mark.parametrize("length_u", [0.01, 0.1, 1.0, 10.0])
@pytest.mark.parametrize("rate_ups2", [100.0, 1000.0])
def test_no_other_end_speed_lets_a_ramp_begin_slower(length_u: float, rate_ups2: float) -> None:
    jerk_ups3 = 20_000.0
    speed = round_turning(length_u, rate_ups2, jerk_ups3)
    assert speed > 0.0
    slowest = ramp_start(length_u, speed, rate_ups2, jerk_ups3)
    for other in np.linspace(0.0, 4.0 * speed, 401):
        assert ramp_start(length_u, float(other), rate_ups2, jerk_ups3) >= slowest * (1 - 1e-9)


@pytest.mark.parametrize(("length_u", "rate_ups2"), [(0.0, 1000.0), (1.0, 0.0)])
def test_without_a_length_or_a_rate_there_is_no_such_speed(
    length_u: float, rate_ups2: float
) -> None:
    assert round_turning(length_u, rate_ups2, 20_000.0) == 0.0


@pytest.mark.parametrize(("room", "fits"), [(0.999, False), (1.001, True)])
def test_an_acceleration_that_cannot_be_taken_back_in_time_leaves_no_speed(
    room: float, fits: bool
) -> None:
    """From v with a it takes a/J, in which the path goes v t + a t^2/3 and comes to v + a t/2."""
    made = Rig()
    velocity, accel, jerk = 30.0, 800.0, 20_000.0
    made.F[profiles.velocity[0]] = velocity
    made.F[profiles.accel[0]] = accel
    time = accel / jerk
    distance = velocity * time + accel * time**2 / 3
    reached = round_reached(made.F, 0, room * distance, 100.0, 1000.0, jerk)
    expected = velocity + accel * time / 2 if fits else -1.0
    assert reached == pytest.approx(expected, rel=0.01)
