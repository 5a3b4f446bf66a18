"""FBVEL with an encoder of its own: the motor damps the loop, the load closes it.

The plant of these tests stands outside the package: a motor and a load on a shaft that twists,
or the two ends of a gear box, stepped exactly (matrix exponential) with the voltage of the last
tick. The reference is the same loop written down once more with NumPy.
"""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm
from tests.kernel.rig import Rig, T

from openacr.map.rows import axes, dacs, encoders, motors
from openacr.motion.axis import attach
from openacr.motion.axis.attach import Feedback, Signal

pytestmark = pytest.mark.evidence("oracle", "the linear system solved by scipy")

Matrix = NDArray[np.float64]
MOTOR, LOAD = 4, 0  # encoders
PGAIN, FBVEL = 0.01, 4e-4  # V per count of the load, V per count/s of the motor
PER_VOLT = 250_000.0  # counts/s2 of the motor by a volt, load included
RESONANCE, ANTIRESONANCE = 2 * math.pi * 60.0, 2 * math.pi * 45.0


def twisting_shaft() -> tuple[Matrix, Matrix]:
    """Motor and load on a spring: x = (motor, its speed, load, its speed)."""
    # k/Jl and k/Jm from the two frequencies: wa2 = k/Jl, wr2 = k/Jl + k/Jm
    load, motor = ANTIRESONANCE**2, RESONANCE**2 - ANTIRESONANCE**2
    share = RESONANCE**2 / ANTIRESONANCE**2  # of the whole inertia against the motor's
    damp = 0.02 / RESONANCE
    a = np.array([
        [0, 1, 0, 0],
        [-motor, -motor * damp, motor, motor * damp],
        [0, 0, 0, 1],
        [load, load * damp, -load, -load * damp],
    ])  # fmt: skip
    return discrete(a, np.array([0, PER_VOLT * share, 0, 0]))


def gear_box(ratio: float) -> tuple[Matrix, Matrix]:
    """A stiff gear box: the load turns `ratio` times as far as the motor."""
    a = np.zeros((4, 4))
    a[0, 1], a[2, 3] = 1, 1
    return discrete(a, np.array([0, PER_VOLT, 0, PER_VOLT * ratio]))


def discrete(a: Matrix, b: Matrix) -> tuple[Matrix, Matrix]:
    """Step of one tick with a voltage that is held."""
    whole = np.zeros((5, 5))
    whole[:4, :4], whole[:4, 4] = a * T, b * T
    step = expm(whole)
    return step[:4, :4], step[:4, 4]


class Machine(Rig):
    """Axis 0: position from the load, velocity from the motor, voltage to both through DAC 3."""

    def __init__(self, step: tuple[Matrix, Matrix], mult: int = 4, pure: bool = False) -> None:
        super().__init__(1, pure=pure)
        self.ahead, self.by_volt = step
        self.state = np.zeros(4)
        attach.axis(self.card, 0, (Feedback.ENC, LOAD), (Signal.DAC, 3), (Feedback.ENC, MOTOR))
        for encoder in (MOTOR, LOAD):
            self.I[motors.kind[encoder]] = 1
            self.I[encoders.mult[encoder]] = mult
        self.axis(proportional_gain=PGAIN, fbvel_gain_setting=FBVEL, derivative_gain=0.0)

    @property
    def volts(self) -> float:
        return float(self.S[dacs.dac_output[3]])

    def turn(self, ticks: int) -> list[tuple[float, float]]:
        """Motor and load after every tick."""
        seen = []
        for _ in range(ticks):
            self.state = self.ahead @ self.state + self.by_volt * self.volts
            for encoder, place in ((MOTOR, 0), (LOAD, 2)):
                row = motors.raw_count[encoder]
                self.F[row] = math.floor(self.state[place])
            self.ticks(1)
            seen.append((float(self.state[0]), float(self.state[2])))
        return seen


def reference(
    step: tuple[Matrix, Matrix], setpoint_cnt: float, ticks: int, smooth: int = 1
) -> list[tuple[float, float]]:
    """The loop written down again: whole counts, single precision where the card has it."""
    ahead, by_volt = step
    state, volts, before = np.zeros(4), 0.0, 0
    speeds, seen = [0.0] * smooth, []
    gain, tacho = float(np.float32(PGAIN)), float(np.float32(FBVEL))
    for _ in range(ticks):
        state = ahead @ state + by_volt * volts
        motor, load = math.floor(state[0]), math.floor(state[2])
        speeds = [*speeds[1:], (motor - before) / T]
        before = motor
        wanted = gain * (setpoint_cnt - load) - tacho * sum(speeds) / smooth
        counts = max(-32767.0, min(32767.0, max(-10.0, min(10.0, wanted)) * 3276.8))
        volts = float(np.float32(counts / 3276.8))
        seen.append((float(state[0]), float(state[2])))
    return seen


def jump(made: Machine, setpoint_cnt: float) -> None:
    """Ask for another position at once."""
    made.memory.write(axes.current_position[0], setpoint_cnt)


@pytest.mark.parametrize("pure", [False, True])
def test_a_load_on_a_twisting_shaft_moves_as_the_written_down_loop(pure: bool) -> None:
    made = Machine(twisting_shaft(), pure=pure)
    jump(made, 900)
    seen = made.turn(800)
    expected = reference(twisting_shaft(), 900, 800)
    assert np.allclose(seen, expected, rtol=0, atol=0.5)
    assert abs(seen[-1][1] - 900) < 2


def test_smoothed_velocity_is_that_of_the_motor_too() -> None:
    made = Machine(twisting_shaft())
    made.axis(smooth_encoder_velocity=4)
    jump(made, 300)
    assert np.allclose(made.turn(400), reference(twisting_shaft(), 300, 400, 4), rtol=0, atol=0.5)


def test_without_the_motor_encoder_the_shaft_rings() -> None:
    """The reason for two encoders: damping from the load has the spring in between."""
    made, single = Machine(twisting_shaft()), Machine(twisting_shaft())
    attach.axis(single.card, 0, (Feedback.ENC, LOAD), (Signal.DAC, 3))
    ends = []
    for machine in (made, single):
        jump(machine, 300)
        loads = [load for _, load in machine.turn(2000)[-200:]]
        ends.append(max(loads) - min(loads))
    assert ends[0] < 3
    assert ends[1] > 300


@pytest.mark.parametrize("ratio", [0.2, 3.0])
def test_beyond_a_gear_box_the_closed_form_of_the_damped_loop(ratio: float) -> None:
    """x'' = K (P (r - x) - V x'/ratio): damping w0^2 = K P, 2 z w0 = K V / ratio, K = A ratio."""
    made = Machine(gear_box(ratio))
    made.axis(proportional_gain=PGAIN, fbvel_gain_setting=2e-4)
    jump(made, 200)
    w0, damping = math.sqrt(PER_VOLT * ratio * PGAIN), PER_VOLT * 2e-4 / 2
    time = np.arange(1, 1001) * T - 1.5 * T  # held voltage and backward difference: delays
    loads = np.array([load for _, load in made.turn(1000)])
    roots = np.roots([1, 2 * damping, w0**2]).astype(complex)
    s1, s2 = roots
    form = 1 - (s1 * np.exp(s2 * time) - s2 * np.exp(s1 * time)) / (s1 - s2)
    assert np.abs(loads[20:] - 200 * form.real[20:]).max() < 0.05 * 200
    assert abs(loads[-1] - 200) < 3


def test_the_terms_name_their_encoders() -> None:
    made = Machine(gear_box(-0.5))
    made.axis(proportional_gain=0.0, fbvel_gain_setting=1e-6)
    made.state[:] = (0, 40_000.0, 0, -20_000.0)
    made.turn(5)
    assert made.long("actual_position") in (-50, -51)
    assert made.S[axes.fbvel_term[0]] == pytest.approx(1e-6 * 40_000, rel=0.05)
