"""A resonance found on a card, a notch proposed against it, and what both are worth there."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy import signal
from tests.tuning.test_measure import SET_UP
from tests.tuning.test_shaft import two_masses
from tests.tuning.worlds import AXIS, WORLD, elastic

import openacr
from openacr.client import Card
from openacr.errors import UserError
from openacr.map.rows import compliant_loads
from openacr.plant.describe.load import parse_world
from openacr.tuning import measure as measuring
from openacr.tuning.advice import Advice, advise, new_filters
from openacr.tuning.excitation import Excitation
from openacr.tuning.filters import Filters
from openacr.tuning.frequency import is_stable, margins
from openacr.tuning.measure import Measurement, settings_of
from openacr.tuning.motor import Motor
from openacr.tuning.notches import choose
from openacr.tuning.propose import Wish, propose
from openacr.tuning.settings import LoopSettings
from openacr.tuning.shaft import Shaft
from openacr.tuning.twin import Record, run

pytestmark = pytest.mark.evidence("oracle", "the loop with two masses on a spring, by scipy.signal")

RESONANCE_HZ = 230.0
PERIOD_S = 0.001  # a slow card: the delay of its loop turns the phase at the resonance
PRESENT = LoopSettings.of_gains(0.0005, pgain=0.006, dgain=7e-5)
STIFF = Motor(3.27e6, 5.0, 1.7e5, shaft=Shaft(420.0, 0.03, 1.0))


@dataclass(frozen=True)
class Bench:
    """A card with an elastic axis, what was measured there and what follows."""

    host: openacr.Controller
    card: Card
    advice: Advice

    def step(self, filters: Filters, height_cnt: float = 20.0) -> Measurement:
        """A step with the gains that are proposed, and these filters."""
        assert self.advice.proposal is not None
        gains, trial = self.advice.proposal.gains, Excitation("step", height_cnt, duration_s=0.3)
        return self.card.perform(
            lambda talk: measuring.measure(talk, AXIS, trial, gains=gains, filters=filters)
        )

    def swing(self) -> float:
        """How far the load swings against the motor from 0.1 s after a step on [pulses]."""
        turned = 1.0 + 1.0 / 0.5  # load and motor against each other, by the flexion of the motor
        host, seen = self.host, []
        host.p[12544 + 9] += 50
        host.advance(seconds=0.1)
        for _ in range(150):
            host.advance(1)
            seen.append(turned * host.memory.F[compliant_loads.flex_cnt[AXIS]])
        host.p[12544 + 9] -= 50
        host.advance(seconds=0.5)
        return float(np.ptp(seen))


@pytest.fixture(scope="module")
def bench() -> Iterator[Bench]:
    host = openacr.Controller(world=parse_world(elastic(RESONANCE_HZ, 0.02)))
    with Card.open(host) as card:
        for line in [f"PERIOD {PERIOD_S}", *SET_UP, "PGAIN Y0.003"]:
            card.command(line)
        card.pause(0.1)
        found = card.perform(lambda talk: measuring.measure(talk, AXIS, Excitation(high_hz=400.0)))
        yield Bench(host, card, advise(found))
    host.close()


def test_the_resonance_of_the_machine_is_found_within_two_per_cent(bench: Bench) -> None:
    shaft = bench.advice.identified.resonance.shaft
    assert shaft is not None
    assert shaft.resonance_hz == pytest.approx(RESONANCE_HZ, rel=0.02)
    assert shaft.antiresonance_hz == pytest.approx(RESONANCE_HZ / np.sqrt(1.5), rel=0.02)


def test_a_notch_is_proposed_there_and_its_loop_has_the_margins_for_both_masses(
    bench: Bench,
) -> None:
    filters = new_filters(bench.advice)
    assert filters is not None
    assert filters.lopass_hz == 0.0
    assert filters.notch_hz == pytest.approx(RESONANCE_HZ, rel=0.02)
    proposed = bench.advice.proposed
    assert proposed is not None
    # the loop of the true machine: two masses by scipy, the notch by its formula
    motor = bench.advice.identified.motor
    true = Shaft(RESONANCE_HZ, 0.02, 0.5)
    plant, _load, poles = two_masses(true, motor.accel_per_volt, PERIOD_S)
    w = 2.0 * np.pi * filters.notch_hz * PERIOD_S
    alpha = np.sin(w) * filters.notch_width_hz / (2.0 * filters.notch_hz)
    zeros, ends = [1.0, -2.0 * np.cos(w), 1.0], [1.0 + alpha, -2.0 * np.cos(w), 1.0 - alpha]
    gains = proposed.settings.gains
    hz = np.linspace(0.5, 499.0, 20000)
    z = np.exp(2j * np.pi * hz * PERIOD_S)
    pid = (
        gains["PGAIN"]
        + gains["IGAIN"] * PERIOD_S * z / (z - 1.0)
        + gains["DGAIN"] * (1.0 - 1.0 / z) / PERIOD_S
    )
    loop = pid * np.polyval(zeros, z) / np.polyval(ends, z) * np.polyval(plant, z)
    loop = loop / np.polyval(poles, z)
    crossings = np.nonzero(np.diff(np.sign(np.abs(loop) - 1.0)))[0]
    phases = 180.0 - np.abs(np.degrees(np.angle(loop[crossings])))
    assert phases.min() == pytest.approx(proposed.margins.phase_deg, abs=5.0)
    real = np.nonzero(np.diff(np.sign(loop.imag)))[0]
    outward = [-20 * np.log10(-loop[k].real) for k in real if -1.0 < loop[k].real < 0.0]
    assert min(outward) == pytest.approx(abs(proposed.margins.gain_db), abs=1.0)
    assert proposed.margins.phase_deg >= 40.0 and abs(proposed.margins.gain_db) >= 6.0


def test_filters_written_by_hand_are_known_as_such_and_not_changed(bench: Bench) -> None:
    before = bench.card.perform(lambda talk: settings_of(talk, AXIS))
    assert before.filters is not None
    bench.card.command("P12601 = 0.98")  # a0 of the first filter
    settings = bench.card.perform(lambda talk: settings_of(talk, AXIS))
    with pytest.raises(UserError, match="filters of the axis were written by hand"):
        bench.step(Filters(300.0))
    for line in ("LOPASS 0", "NOTCH (400,50)", "NOTCH (0,0)"):
        bench.card.command(f"AXIS1 {line}")
        if line.startswith("NOTCH (4"):
            bench.card.command("CLR 818")  # Biquad Filter Activate: the notch does nothing
            off = bench.card.perform(lambda talk: settings_of(talk, AXIS))
            assert (off.filters, off.is_filtering) == (None, False)
    assert settings.filters is None
    assert bench.card.perform(lambda talk: settings_of(talk, AXIS)) == before
    by_hand = replace(PRESENT, filters=None)
    wish = Wish(bandwidth_hz=20.0)
    assert choose(by_hand, STIFF, wish, measured_to_hz=490.0) == propose(by_hand, STIFF, wish)


def test_the_card_does_what_was_predicted_and_its_load_swings_a_fifth_of_that_without_a_notch(
    bench: Bench,
) -> None:
    filters = new_filters(bench.advice)
    assert filters is not None
    done = bench.step(filters)
    predicted = run(
        done.settings, bench.advice.identified.motor, done.record.setpoint_cnt, done.record
    )
    assert np.abs(predicted.actual_cnt - done.record.actual_cnt).max() <= 6.0
    for line in ("FFVEL 0", "FFACC 0"):  # a step of the setpoint only saturates them
        bench.card.command(f"AXIS1 {line}")
    with_notch = bench.swing()
    assert bench.card.command("AXIS1 NOTCH") == [f"{filters.notch_hz:g},{filters.notch_width_hz:g}"]
    bench.card.command("AXIS1 NOTCH (0,0)")
    without = bench.swing()
    bench.card.command(filters.lines(AXIS)[1])
    assert without > 5.0 * with_notch
    assert without > 1.5


def test_filters_that_are_tried_are_taken_back_with_the_gains(bench: Bench) -> None:
    before = bench.card.perform(lambda talk: settings_of(talk, AXIS))
    bad = Filters(5.0)  # so much phase that the loop swings
    with pytest.raises(UserError, match="what was changed was taken back"):
        bench.step(bad, 100.0)
    assert bench.card.perform(lambda talk: settings_of(talk, AXIS)) == before


def test_a_notch_makes_a_loop_faster_that_a_resonance_holds_back() -> None:
    plain = propose(PRESENT, STIFF, measured_to_hz=490.0)
    found = choose(PRESENT, STIFF, measured_to_hz=490.0)
    assert found.filters is not None
    assert found.filters.notch_hz == 420.0
    assert found.asked_hz > 1.8 * plain.asked_hz
    for share in (0.95, 1.0, 1.05):  # a resonance that is a little off
        off = Motor(3.27e6, 5.0, 1.7e5, shaft=Shaft(share * 420.0, 0.03, 1.0))
        assert is_stable(found.settings, off)
        assert abs(margins(found.settings, off).gain_db) > 3.0


def test_no_filter_is_proposed_where_the_motor_damps_its_load_better_without() -> None:
    motor = Motor(3.27e6, 5.0, 1.7e5, shaft=Shaft(90.0, 0.01, 1.5))
    found = choose(PRESENT, motor, Wish(bandwidth_hz=30.0), measured_to_hz=490.0)
    assert found.filters == Filters() == PRESENT.filters
    rigid = choose(PRESENT, Motor(3.27e6, 5.0), Wish(bandwidth_hz=30.0), measured_to_hz=490.0)
    assert rigid == propose(PRESENT, Motor(3.27e6, 5.0), Wish(bandwidth_hz=30.0))


def test_the_filters_of_the_model_are_those_of_the_card_bit_by_bit() -> None:
    host = openacr.Controller(world=parse_world(WORLD))
    with Card.open(host) as card:
        for line in [*SET_UP, "LOPASS Y300", "NOTCH Y(150.5,40.25)"]:
            card.command(line)
        found = card.perform(lambda talk: settings_of(talk, AXIS))
    host.close()
    modelled = PRESENT.filtered(Filters(300.0, 150.5, 40.25))
    assert found.filters == modelled.filters
    assert found.coefficients() == modelled.coefficients()
    b2, a2, b1, a1, a0 = modelled.coefficients()[1]
    zeros, poles = signal.iirnotch(150.5, 150.5 / 40.25, fs=2000.0)
    hz = [50.0, 150.5, 300.0]
    ours = signal.freqz([a0, a1, a2], [1.0, b1, b2], worN=hz, fs=2000.0)[1]
    assert abs(ours[1]) < 1e-3 > abs(signal.freqz(zeros, poles, worN=hz, fs=2000.0)[1][1])


def test_what_a_load_swings_is_its_distance_to_its_mean() -> None:
    from openacr.tuning.predict import vibration

    t = np.arange(500) * 0.0005
    swing = 3.0 * np.sin(2.0 * np.pi * 100.0 * t) * (t > 0.15) + 40.0 * t
    record = Record(0.0005, np.zeros(500), np.zeros(500), np.zeros(500), swing)
    assert vibration(record, Shaft(100.0, 0.01, 1.0)) == pytest.approx(6.0, abs=0.2)
    early = Record(
        0.0005, np.zeros(500), np.zeros(500), np.zeros(500), np.where(t < 0.09, swing, 0)
    )
    assert vibration(early, Shaft(100.0, 0.01, 1.0)) < 1e-9
