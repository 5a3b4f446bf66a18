"""The tuning session of the milling appendix: every gain set on the motor of the example.

The appendix shows scope pictures; what they show is asserted as numbers: ringing, the error
at speed, spikes in the ramps, the error at rest.
"""

import math
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import signal
from tests.examples.observe import load
from tests.system.terminal import Console

from openacr.controller import Controller
from openacr.plant.load import parse_world

pytestmark = pytest.mark.evidence("oracle", "the loop as a linear system of scipy")

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


@pytest.mark.req("MILL-TUNE-08")
def test_fifteen_turns_at_500_rpm_take_1_8_seconds_and_the_ramps() -> None:
    run = step(3)
    assert run.moving * 0.0005 == pytest.approx(15 * 60 / 500 + 500 / 60 / 500, abs=0.001)


@pytest.mark.req("MILL-TUNE-09")
def test_3000_rpm_in_a_tenth_of_a_second_needs_acc_500() -> None:
    card = load("tuning")
    card.send("PROG0\rPGAIN X0.05\rDGAIN X0.0002\rF3000\r")
    card.send("X100\r")
    start = card.tick
    assert card.until(512, timeout_s=1.0)
    assert card.until(512, is_=False, timeout_s=1.0)
    assert (card.tick - start) * card.period_s == pytest.approx(0.1, abs=0.002)
    assert card.p[8193] == pytest.approx(50.0)


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


# wiring and signs

STILL = """
[[axis]]
number = 0
counts_per_rev = 4096
drive = { mode = "ideal", revs_per_s_per_volt = 1e-6, lag_s = 0.001 }
"""


def stalled(*lines: str) -> Console:
    """An axis whose motor is disconnected: it never turns."""
    console = Console()
    console.card = Controller(world=parse_world(STILL))
    console.type("ECHO 4", "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', *lines)
    return console


@pytest.mark.req("MILL-TUNE-07")
def test_without_gains_the_output_is_zero_and_tlm_limits_it() -> None:
    card = load("tuning")
    card.send("PROG0\rX1\r")
    card.advance(seconds=0.5)
    assert (card.p[12319], abs(card.axis(0).actual_u)) == (0.0, 0.0)
    still = stalled("PGAIN X0.05", "TLM X4", "ACC 0 DEC 0 STP 0 VEL 1e9 X1000")
    still.card.advance(10)
    assert still.card.p[12319] == 4.0


@pytest.mark.req("MILL-TUNE-04")
def test_a_negative_mult_counts_the_other_way() -> None:
    moved = []
    for mult in ("X4", "X-4", "X4"):
        card = load("tuning")
        card.send(f"PROG0\rMULT {mult}\rTLM X1\r")
        before = card.p[6144]
        card.send("PGAIN X0.001\rX0.1\r")
        card.advance(seconds=0.02)
        moved.append(np.sign(card.p[6144] - before))
    assert moved[0] == moved[2] != 0
    assert moved[1] == -moved[0]


@pytest.mark.req("MILL-TUNE-05", "MILL-TUNE-06")
def test_the_sign_of_the_dac_gain_is_the_polarity_of_the_output() -> None:
    """An encoder that counts up, a setpoint that stays: the output turns against it."""
    volts = []
    for gain in ("3276.8", "-3276.8"):
        card = stalled(f"DAC0 GAIN {gain}", "PGAIN X0.01").card
        card.p[12288] = -100  # the motor has been turned up by 100 counts from the setpoint
        card.advance(2)
        assert card.p[12319] == pytest.approx(-1.0)
        volts.append(card.p[6400])
    assert volts[0] < 0 < volts[1]
    assert volts[0] == -volts[1]


@pytest.mark.req("MILL-TUNE-27")
def test_every_encoder_can_be_read() -> None:
    console = Console()
    rows = [6144 + 16 * n for n in range(8)]
    for n in range(8):
        console.type(f"ENC{n} RES {100 + n}")
    assert [console.card.p[row] for row in rows] == [100 + n for n in range(8)]


# filters: the axis alone, its motor disconnected, fed with a sine


def sine_at_dac(hz: float, *lines: str, period_s: float = 0.0002) -> float:
    """Amplitude [V] at the DAC for a following error of 1 V at a frequency."""
    console = stalled(f"PERIOD {period_s}", "PPU X4096", "PGAIN X0.000244140625", *lines)
    card = console.card
    amplitude = 1.0
    cycles = max(40, round(hz * 0.4))
    console.type("ACC 0 DEC 0 STP 0", f"VEL {hz * 360}")
    console.type(f"SINE X(0,0,{360 * cycles},{amplitude})")
    volts = []
    for _ in range(round(cycles / hz / period_s)):
        card.advance(1)
        volts.append(card.p[12319])
    settled = np.array(volts[len(volts) // 2 :])
    return float(np.sqrt(2 * np.mean(settled**2)))


@pytest.mark.req("MILL-TUNE-18", "MILL-TUNE-23")
def test_a_low_pass_is_3_db_down_at_its_frequency_and_bypassed_without() -> None:
    assert sine_at_dac(100) == pytest.approx(1.0, rel=0.01)
    assert sine_at_dac(1000, "LOPASS X1000") == pytest.approx(2**-0.5, rel=0.02)
    assert sine_at_dac(50, "LOPASS X1000") == pytest.approx(1.0, rel=0.02)


def clipped(amplitude: float, limit: float) -> float:
    """Amplitude of a sine with as much power as one that is cut at a limit."""
    angle = math.asin(min(1.0, limit / amplitude))
    below = amplitude**2 * (angle / 2 - math.sin(2 * angle) / 4)
    return math.sqrt(4 / math.pi * (below + limit**2 * (math.pi / 2 - angle)))


@pytest.mark.req("MILL-TUNE-23")
@pytest.mark.parametrize(
    ("hz", "filters"),
    [(200, []), (200, ["NOTCH X(100,100)"]), (400, ["LOPASS X200"]), (500, ["LOPASS X200"]),
     (300, ["NOTCH X(100,100)", "LOPASS X1000"])],
)  # fmt: skip
def test_the_torque_limit_is_that_of_the_filtered_output(hz: float, filters: list[str]) -> None:
    """A sine of 1 V that a filter makes smaller than the limit is not cut before it."""
    filtered = sine_at_dac(hz, *filters)
    assert sine_at_dac(hz, *filters, "TLM X0.5") == pytest.approx(clipped(filtered, 0.5), rel=0.01)


@pytest.mark.req("MILL-TUNE-20")
@pytest.mark.parametrize("hz", [60, 90, 110, 150])
def test_the_narrower_a_notch_is_the_less_it_takes_beside_its_centre(hz: float) -> None:
    widths = (100, 50, 20, 5, 1)
    left = [sine_at_dac(hz, f"NOTCH X(100,{width})") for width in widths]
    assert left == sorted(left)
    assert min(b - a for a, b in pairwise(left)) > 0
    assert left[-1] == pytest.approx(1.0, abs=0.02)


@pytest.mark.req("MILL-TUNE-22")
@pytest.mark.parametrize("hz", [100, 200, 400])
def test_two_equal_filters_take_twice_as_many_decibels_at_every_frequency(hz: float) -> None:
    copies = [f"P{12341 + n}=P{12336 + n}" for n in range(5)]
    once = sine_at_dac(hz, "LOPASS X200")
    assert sine_at_dac(hz, "LOPASS X200", *copies) == pytest.approx(once**2, rel=0.01)


@pytest.mark.req("MILL-TUNE-20", "ACR-CMD-NOTCH")
def test_a_notch_as_wide_as_its_centre_takes_a_sine_away() -> None:
    assert sine_at_dac(100, "NOTCH X(100,100)") < 0.01
    assert sine_at_dac(80, "NOTCH X(100,100)") < sine_at_dac(80, "NOTCH X(100,10)")
    assert sine_at_dac(80, "NOTCH X(100,10)") > 0.9


@pytest.mark.req("MILL-TUNE-22")
def test_a_low_pass_copied_to_the_other_filter_doubles_the_roll_off() -> None:
    copies = [f"P{12341 + n}=P{12336 + n}" for n in range(5)]
    once = sine_at_dac(500, "LOPASS X200")
    twice = sine_at_dac(500, "LOPASS X200", *copies)
    assert twice == pytest.approx(once**2, rel=0.05)


@pytest.mark.req("MILL-TUNE-26")
def test_a_swept_sine_dips_at_the_notch_and_falls_above_the_low_pass() -> None:
    notched = [sine_at_dac(hz, "NOTCH X(100,50)") for hz in (30, 100, 400)]
    assert notched[1] < 0.02 < 0.9 < min(notched[0], notched[2])
    passed = [sine_at_dac(hz, "LOPASS X200") for hz in (50, 200, 400, 800)]
    assert passed[0] > 0.95
    assert passed == sorted(passed, reverse=True)
    assert passed[-1] < 0.1


@pytest.mark.req("MILL-TUNE-19", "ACR-CMD-NOTCH")
def test_a_notch_has_its_centre_and_width() -> None:
    console = Console()
    console.type("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PERIOD 0.0002")
    assert console.type("NOTCH X(500,50)", "NOTCH X") == "500,50"
    rows = [console.card.p[12341 + n] for n in range(5)]
    b2, a2, b1, a1, a0 = rows
    at_hz = np.arange(400.0, 600.0, 0.5)
    _, gain = signal.freqz([a0, a1, a2], [1.0, b1, b2], worN=at_hz, fs=5000)
    assert at_hz[np.abs(gain).argmin()] == 500.0
    below = at_hz[np.abs(gain) < 2**-0.5]
    assert below[-1] - below[0] == pytest.approx(50, rel=0.1)


@pytest.mark.req("MILL-TUNE-24")
def test_coefficients_are_changed_with_the_bit_off_and_work_with_it_on() -> None:
    half = [f"P{12336 + n}={value}" for n, value in enumerate((0, 0, 0, 0, 0.5))]
    assert sine_at_dac(50, "CLR 786", *half) == pytest.approx(1.0, rel=0.01)
    both = [*half, *(f"P{12341 + n}={value}" for n, value in enumerate((0, 0, 0, 0, 1)))]
    assert sine_at_dac(50, "CLR 786", *both, "SET 786") == pytest.approx(0.5, rel=0.01)


# the other gains


@pytest.mark.req("MILL-TUNE-01")
def test_every_gain_has_its_unit_at_the_output() -> None:
    def volts(*lines: str, row: int, ticks: int, feed: str = "VEL 1000 X1000") -> float:
        console = stalled("PGAIN X0", "ACC 0 DEC 0 STP 0", *lines, feed)
        console.card.advance(ticks)
        return float(console.card.p[row])

    step_to = "VEL 1e9 X100"
    assert volts("PGAIN X0.01", row=12312, ticks=10, feed=step_to) == pytest.approx(1.0)
    integral = ("IGAIN X0.1", "ILIMIT X5")
    assert volts(*integral, row=12313, ticks=2000, feed=step_to) == pytest.approx(5.0, rel=0.01)
    assert volts(*integral, "ILIMIT X2", row=12313, ticks=2000, feed=step_to) == 2.0
    delayed = volts(*integral, "IDELAY X0.1", row=12313, ticks=400, feed=step_to)
    assert delayed == pytest.approx(10 * 0.1, rel=0.03)
    assert volts("DGAIN X0.001", row=12314, ticks=100) == pytest.approx(1.0)
    assert volts("DGAIN X0.001", "DWIDTH X0.005", row=12314, ticks=100) == pytest.approx(1.0)
    assert volts("FFVEL X0.002", row=12354, ticks=100) == pytest.approx(2.0)
    ramp = ("FFACC X0.0001", "ACC 2000")
    assert volts(*ramp, row=12355, ticks=100) == pytest.approx(0.2)
    assert volts("PGAIN X1", "TLM X3", row=12319, ticks=10, feed=step_to) == 3.0


@pytest.mark.req("MILL-TUNE-02")
def test_a_width_of_zero_samples_the_slope_every_period() -> None:
    """A step of the error is in the slope for one tick; with a width, for as long as that."""

    def seen(width: float) -> int:
        console = stalled("PGAIN X0", "DGAIN X0.001", f"DWIDTH X{width}", "ACC 0 DEC 0 STP 0")
        console.card.advance(20)
        console.type("VEL 1e9 X100")
        count = 0
        for _ in range(40):
            console.card.advance(1)
            count += console.card.p[12314] != 0
        return count

    assert (seen(0), seen(0.005)) == (1, 10)


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
