"""The tuning session of the milling appendix: the gains set in turn on the motor of the example.

The appendix shows scope pictures; what they show is asserted as numbers: ringing, the error
at speed, spikes in the ramps, the error at rest.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.examples.observe import load

from openacr.controller import Controller
from openacr.plant.describe.load import parse_world

Reals = NDArray[np.float64]
MOTION = 516
COUNTS = 4096
TERMS = ("PGAIN", "DGAIN", "IGAIN", "IDELAY", "ILIMIT", "FFVEL", "FFACC")
STEPS: tuple[tuple[float, ...], ...] = (
    (0.001, 0.000002, 0, 0, 0, 0, 0),
    (0.001, 0.000008, 0, 0, 0, 0, 0),
    (0.001, 0.00005, 0, 0, 0, 0, 0),
    (0.05, 0.00005, 0, 0, 0, 0, 0),
    (0.05, 0.00005, 0.1, 0.01, 1, 0, 0),
    (0.05, 0.00005, 0.1, 0.01, 1, 0.00001, 0),
    (0.05, 0.00005, 0.1, 0.01, 1, 0.0000015, 0),
    (0.05, 0.00005, 0.1, 0.01, 1, 0.0000015, 0.0000001),
    (0.05, 0.00005, 0.1, 0.01, 1, 0.0000015, 0.000000199),
    (0.05, 0.00021, 0.1, 0.01, 1, 0.0000015, 0.000000199),
    (0.08, 0.00021, 0.1, 0.01, 1, 0.0000015, 0.000000199),
    (0.08, 0.00021, 2, 0, 2, 0.0000015, 0.000000199),
)  # fmt: skip


@dataclass(frozen=True)
class Index:
    """The following error of an index [counts], tick by tick, and its parts."""

    error: Reals
    moving: int  # ticks of the move
    ramp: int  # ticks of its ramp

    @property
    def at_speed(self) -> float:
        """Mean error in the second half of the cruise."""
        return float(self.error[self.moving // 2 : self.moving - self.ramp].mean())

    @property
    def spike(self) -> float:
        """Largest deviation from the error at speed in the ramp up and just after it."""
        return float(np.abs(self.error[: 6 * self.ramp] - self.at_speed * 0.5).max())

    @property
    def ringing(self) -> float:
        """Swing of the error about its mean soon after the ramp, peak to peak."""
        part = self.error[self.ramp + 40 : self.ramp + 400]
        return float(np.ptp(part))

    @property
    def at_rest(self) -> float:
        """Largest error in the last fifth of a second."""
        return float(np.abs(self.error[-400:]).max())


def index(gains: tuple[float, ...], *, rpm: float = 500.0, turns: float = 15.0) -> Index:
    """Run one index of the procedure."""
    card = load("tuning")
    sets = "".join(f"{word} X{value:.12f}\r" for word, value in zip(TERMS, gains, strict=True))
    card.send(f"PROG0\r{sets}F{rpm:g}\r")
    card.record(1)
    card.send(f"X{turns:g}\r")
    assert card.until(MOTION, is_=False, timeout_s=10.0)
    moving = card.tick
    card.advance(seconds=0.5)
    error = card.trace().axes[0].following_error_u * COUNTS
    return Index(error, len(error) - (card.tick - moving), round(rpm / 60 / 500 / card.period_s))


@cache
def step(number: int) -> Index:
    """The index after change `number` of the session."""
    return index(STEPS[number - 1])


@pytest.mark.req("MILL-TUNE-10")
def test_ringing_goes_as_the_derivative_gain_grows() -> None:
    assert step(1).ringing > 60
    assert step(2).ringing < 0.7 * step(1).ringing
    assert step(3).ringing < 0.15 * step(1).ringing
    later = step(3).error[step(3).ramp * 12 : step(3).moving - step(3).ramp]
    assert np.ptp(later) <= 3


@pytest.mark.req("MILL-TUNE-11")
def test_the_error_at_speed_is_about_a_hundred_pulses_and_falls_with_pgain() -> None:
    assert step(3).at_speed == pytest.approx(100, abs=8)
    assert 0 < step(4).at_speed < step(3).at_speed / 10


@pytest.mark.req("MILL-TUNE-12")
def test_the_integral_brings_the_error_at_rest_to_one_pulse_after_its_delay() -> None:
    soft = index((0.005, 0.00005, 0, 0, 0, 0, 0))
    helped = index((0.005, 0.00005, 0.1, 0.01, 1, 0, 0))
    assert soft.at_rest > 2
    assert step(5).at_rest <= 1
    assert abs(helped.error[-1]) < abs(soft.error[-1])
    first = helped.moving + 20  # 10 ms after the profile has ended
    assert np.array_equal(helped.error[:first], soft.error[:first])


@pytest.mark.req("MILL-TUNE-13")
def test_too_much_feedforward_turns_the_error_round() -> None:
    assert step(5).at_speed > 1
    assert step(6).at_speed < -1
    assert abs(step(7).at_speed) <= 1.1


@pytest.mark.req("MILL-TUNE-14")
def test_the_formula_gives_the_feedforward() -> None:
    plain = step(4).at_speed
    velocity = 500 / 60 * COUNTS
    gains = list(STEPS[3])
    gains[5] = 0.05 * plain / velocity
    assert abs(index(tuple(gains)).at_speed) < 0.3


@pytest.mark.req("MILL-TUNE-15")
def test_acceleration_feedforward_takes_the_spikes_away() -> None:
    assert step(8).spike < 0.75 * step(7).spike
    assert step(9).spike < 0.5 * step(7).spike


@pytest.mark.req("MILL-TUNE-16")
def test_without_delay_the_integral_works_during_motion_too() -> None:
    moved = slice(400, step(11).moving - step(11).ramp)
    assert np.abs(step(12).error[moved].mean()) < np.abs(step(11).error[moved].mean())
    held, always = load("tuning"), load("tuning")
    held.send("PROG0\rPGAIN X0.05\rDGAIN X0.0002\rIGAIN X2\rIDELAY X0.01\rILIMIT X2\rX15\r")
    always.send("PROG0\rPGAIN X0.05\rDGAIN X0.0002\rIGAIN X2\rIDELAY X0\rILIMIT X2\rX15\r")
    for card in (held, always):
        card.advance(seconds=1.0)
    assert (held.p[12313], abs(always.p[12313]) > 0.05) == (0.0, True)


@pytest.mark.req("MILL-TUNE-17")
@pytest.mark.parametrize(("rpm", "turns"), [(500, 15), (4000, 100)])
def test_the_final_gains_keep_five_counts_at_all_speeds(rpm: float, turns: float) -> None:
    settled = index(STEPS[-1], rpm=rpm, turns=turns)
    assert np.abs(settled.error).max() <= 5


def test_the_example_prints_what_each_step_did() -> None:
    card = load("tuning")
    card.advance(seconds=0.2)
    text = card.send("PROG0\rLRUN\r")
    card.advance(seconds=35.0)
    text += card.take_output(card.console).decode("latin-1")
    rows = [line.split() for line in text.splitlines() if line[:1].isdigit()]
    assert [int(row[0]) for row in rows] == list(range(1, 14))
    worst = [float(row[1]) for row in rows]
    assert worst[0] > worst[1] > worst[2] > worst[3]
    assert max(worst[8:]) <= 5


DUAL = """
[[axis]]
number = 0
counts_per_rev = 4096

[axis.motor]
inertia_kgm2 = 2.0e-5
torque_nm_per_a = 0.0771

[axis.drive]
mode = "torque"
amps_per_volt = 2.0
peak_amps = 20.0
"""


@pytest.mark.req("MILL-TUNE-25")
def test_fbvel_damps_the_loop() -> None:
    swings = []
    for gain in (0.0, 0.00005):
        card = Controller(world=parse_world(DUAL))
        card.send("ATTACH AXIS0 ENC0 DAC0 ENC0\rAXIS0 MULT 4\rAXIS0 PGAIN 0.001\rAXIS0 DGAIN 0\r")
        card.send(f"AXIS0 FBVEL {gain:.6f}\r")
        card.record(1)
        card.p[12288] = 200
        card.advance(seconds=1.0)
        swings.append(float(np.ptp(card.trace().axes[0].actual_u[-400:])))
        summed = card.p[12317]
        assert np.isfinite(summed)
    assert swings[0] > 100
    assert swings[1] < 0.05 * swings[0]
