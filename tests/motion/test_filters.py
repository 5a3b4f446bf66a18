"""Digital filters: coefficients, activation, and what a new servo period does to them."""

import pytest
from scipy import signal

from openacr.map.rows import axes
from openacr.motion.axis import filters
from openacr.motion.axis.filters import BYPASS, Biquad
from openacr.motion.card import Card

pytestmark = pytest.mark.evidence("oracle", "filter designs of scipy")

ACTIVE = 786


def stored(card: Card, axis: int, place: int) -> Biquad:
    row = (axes.filter0_b2, axes.filter1_b2)[place][axis]
    return Biquad(*card.memory.S[row : row + 5])


def test_the_low_pass_of_the_reference_has_its_coefficients() -> None:
    found = filters.low_pass(200.0, 0.0004)
    wanted = Biquad(b2=0.4918122, a2=0.0461318, b1=-1.3072850, a1=0.0922636, a0=0.0461318)
    assert found == pytest.approx(wanted, abs=6e-8)


def test_the_notch_of_the_reference_has_its_coefficients() -> None:
    found = filters.notch(100.0, 50.0, 0.0005)
    wanted = Biquad(b2=0.8565719, a2=0.9282860, b1=-1.7657048, a1=-1.7657048, a0=0.9282860)
    assert found == pytest.approx(wanted, abs=6e-8)


@pytest.mark.parametrize("cutoff_hz", [10.0, 100.0, 333.0, 899.0])
def test_the_low_pass_is_a_butterworth(cutoff_hz: float) -> None:
    numerator, denominator = signal.butter(2, cutoff_hz, fs=2000.0)
    found = filters.low_pass(cutoff_hz, 0.0005)
    assert [found.a0, found.a1, found.a2] == pytest.approx(numerator.tolist())
    assert [1.0, found.b1, found.b2] == pytest.approx(denominator.tolist())


def test_a_frequency_near_half_the_servo_rate_is_limited() -> None:
    assert filters.low_pass(1000.0, 0.0005) == filters.low_pass(900.0, 0.0005)
    assert filters.notch(1e6, 50.0, 0.0005) == filters.notch(900.0, 50.0, 0.0005)


@pytest.mark.parametrize(
    "found",
    [
        filters.low_pass(0.0, 0.0005),
        filters.notch(0.0, 0.0, 0.0005),
        filters.notch(100.0, 0.0, 0.0005),
    ],
)
def test_frequency_0_is_no_filter(found: Biquad) -> None:
    assert found == BYPASS


def test_filters_are_bypassed_at_power_up() -> None:
    card = Card()
    assert [stored(card, axis, place) for axis in (0, 15) for place in (0, 1)] == [BYPASS] * 4


def test_the_filter_flag_follows_whether_any_filter_acts() -> None:
    card = Card()
    filters.set_low_pass(card, 0, 100.0)
    filters.set_notch(card, 0, 50.0, 10.0)
    assert card.memory.bit(ACTIVE)
    filters.set_low_pass(card, 0, 0.0)
    assert card.memory.bit(ACTIVE)
    filters.set_notch(card, 0, 0.0, 0.0)
    assert not card.memory.bit(ACTIVE)
    assert not card.memory.bit(ACTIVE + 32)


def test_a_filter_that_is_switched_on_starts_from_rest() -> None:
    card = Card()
    card.memory.F[axes.filter_state[0]] = 5.0
    filters.set_low_pass(card, 0, 100.0)
    assert card.memory.F[axes.filter_state[0]] == 0.0


def test_a_new_period_keeps_the_frequencies() -> None:
    card = Card()
    filters.set_low_pass(card, 0, 100.0)
    filters.set_notch(card, 3, 50.0, 10.0)
    filters.change_period(card, 0.001)
    assert card.clock.period_s == 0.001
    assert stored(card, 0, 0) == pytest.approx(filters.low_pass(100.0, 0.001), rel=1e-6)
    assert stored(card, 3, 1) == pytest.approx(filters.notch(50.0, 10.0, 0.001), rel=1e-6)
    assert stored(card, 0, 1) == BYPASS


def test_a_new_period_leaves_coefficients_written_by_hand() -> None:
    card = Card()
    filters.set_low_pass(card, 0, 100.0)
    card.memory.write(12340, 0.5)
    before = stored(card, 0, 0)
    filters.change_period(card, 0.001)
    assert stored(card, 0, 0) == before
