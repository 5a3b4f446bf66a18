"""A motor with its load on an elastic shaft, against two masses on a spring."""

import math

import numpy as np
import pytest
from scipy import signal
from tests.tuning.test_twin import PERIOD_S, recorded
from tests.tuning.worlds import elastic, true_motor

from openacr.tuning.frequency import is_stable, margins, open_loop
from openacr.tuning.motor import Motor
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft
from openacr.tuning.twin import run

pytestmark = pytest.mark.evidence("oracle", "two masses on a spring, by scipy.signal")

T = 0.0005
A = 3.2e6
HZ = np.geomspace(1.0, 950.0, 60)
SHAFT = Shaft(90.0, 0.02, 1.5)
NOTCHED = "PGAIN X0.004 DGAIN X0.00005 LOPASS X400 NOTCH X(90,60)"


def two_masses(
    shaft: Shaft, accel: float = A, period_s: float = T
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Motor and load in counts of a volt, as numerators and denominator in z, by scipy.

    The motor has the inertia 1, the load that of the ratio.
    """
    load = shaft.inertia_ratio
    reduced = load / (1.0 + load)
    w = 2.0 * math.pi * shaft.resonance_hz
    spring, damper = w * w * reduced, 2.0 * shaft.damping_ratio * w * reduced
    force = accel * (1.0 + load)  # both together accelerate by `accel` of a volt
    slope = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-spring, -damper, spring, damper],
            [0.0, 0.0, 0.0, 1.0],
            [spring / load, damper / load, -spring / load, -damper / load],
        ]
    )
    push = np.array([[0.0], [force], [0.0], [0.0]])
    seen = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
    held = signal.cont2discrete((slope, push, seen, np.zeros((2, 1))), period_s)
    numerators, denominator = signal.ss2tf(*held[:4])
    return numerators[0], numerators[1], denominator


@pytest.mark.parametrize("shaft", [SHAFT, Shaft(35.0, 0.005, 0.3), Shaft(400.0, 0.1, 4.0)])
def test_a_motor_responds_as_the_first_of_two_masses_on_a_spring(shaft: Shaft) -> None:
    motor, z = Motor(A, shaft=shaft), np.exp(2j * np.pi * HZ * T)
    numerator, _of_load, denominator = two_masses(shaft)
    expected = np.polyval(numerator, z) / np.polyval(denominator, z)
    assert motor.response(z, T) == pytest.approx(expected, rel=1e-5)
    b, a = motor.fraction(T)
    exact = np.polyval(b[::-1], 1.0 / z) / np.polyval(a[::-1], 1.0 / z)
    assert motor.response(z, T) == pytest.approx(exact, rel=1e-7)


def test_the_motor_hardly_moves_at_the_antiresonance() -> None:
    fine_hz = np.linspace(40.0, 120.0, 8001)
    response = Motor(A, shaft=SHAFT).response(np.exp(2j * np.pi * fine_hz * T), T)
    size = np.abs(response) * fine_hz**2
    assert fine_hz[size.argmin()] == pytest.approx(90.0 / math.sqrt(2.5), rel=2e-3)
    assert SHAFT.antiresonance_hz == pytest.approx(56.921, abs=1e-3)
    assert fine_hz[size.argmax()] == pytest.approx(90.0, rel=2e-3)


@pytest.mark.parametrize("dgain", [1e-5, 1.2e-4])
@pytest.mark.parametrize("delay", [0.0, 2.0])
def test_the_gain_margin_is_where_the_poles_of_both_masses_leave_the_circle(
    dgain: float, delay: float
) -> None:
    settings = LoopSettings.of_gains(T, pgain=0.002, dgain=dgain)
    motor = Motor(A, 20.0, delay_tk=delay, shaft=Shaft(260.0, 0.02, 1.5))
    found = margins(settings, motor)
    larger = max(found.gain, 1.0 / found.gain)
    for factor in (0.995 * larger, 1.005 * larger):
        times = factor if found.gain > 1.0 else 1.0 / factor
        changed = settings.changed(pgain=0.002 * times, dgain=dgain * times)
        assert is_stable(changed, motor) is (found.is_stable == (factor < larger))
    limit = open_loop(settings, motor, np.array([found.gain_at_hz]))[0] * found.gain
    assert limit == pytest.approx(-1.0, abs=5e-3)


@pytest.mark.parametrize("lines", ["PGAIN X0.005 DGAIN X0.00005 IGAIN X0.04 ILIMIT X0.4", NOTCHED])
def test_the_computed_axis_with_an_elastic_load_is_that_of_the_card(lines: str) -> None:
    setpoint = np.concatenate((np.zeros(3), np.full(300, 200.0), np.full(300, -31.0)))
    world = elastic(90.0, 0.02)
    settings, card = recorded(lines, setpoint, world)
    computed = run(settings, true_motor(world), setpoint)
    assert np.ptp(card.actual_cnt) > 150
    assert np.array_equal(computed.actual_cnt, card.actual_cnt)
    assert np.array_equal(computed.output_v, card.output_v)
    rigid = run(settings, true_motor(elastic(90.0, 0.02).replace("resonance_hz", "#")), setpoint)
    assert not np.array_equal(rigid.actual_cnt, card.actual_cnt)
    assert rigid.load_cnt is None


def test_the_load_swings_as_the_second_mass_does() -> None:
    # a gain so small that the axis of a single volt is pushed by its offset alone
    motor = Motor(A, offset_v=1.0, shaft=SHAFT)
    settings = LoopSettings.of_gains(PERIOD_S, pgain=1e-12)
    found = run(settings, motor, np.zeros(400))
    _of_motor, of_load, denominator = two_masses(SHAFT)
    expected = signal.lfilter(of_load, denominator, np.ones(400))
    assert found.load_cnt is not None
    assert np.abs(found.load_cnt - expected).max() < 1e-9 * np.abs(expected).max()
    assert np.abs(found.load_cnt - found.actual_cnt).max() > 5.0
