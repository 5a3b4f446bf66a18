"""SERVO and AXES settings of the store, as the servo loops of the card use them."""

from collections.abc import Callable
from itertools import pairwise

import pytest
from tests.mill.shop import Shop, at, end, line

from openacr.map import numbers as n

SERVO, TICKS = 150_000, 300
ERROR, P, I, D = (
    n.AX_FOLLOWING_ERROR,
    n.AX_PROPORTIONAL_TERM,
    n.AX_INTEGRAL_TERM,
    n.AX_DERIVATIVE_TERM,
)
Row = tuple[float, ...]


def recorded(
    rows: tuple[int, ...],
    cells: dict[str, float] | None = None,
    ticks: int = TICKS,
    x: float = 1.0,
) -> tuple[Shop, list[Row]]:
    """Rows of axis 0, tick by tick, during a move of one unit at 600 units per minute."""
    shop = Shop(**(cells or {}))
    shop.start(line(1, at(x), 600.0), end())
    found = []
    for tick in range(ticks):
        shop.controller.advance(seconds=shop.controller.period_s)
        if tick % 10 == 0:
            shop.runner.step()
        found.append(tuple(float(shop.controller.p[n.AX_BASE + row]) for row in rows))
    return shop, found


@pytest.mark.req("MILL-SYS-SERVO-PGAIN")
@pytest.mark.parametrize("gain", [None, 0.001, 0.002])
def test_p_gain_is_volts_per_pulse_of_error(gain: float | None) -> None:
    cells = {} if gain is None else {f"P{SERVO}": gain}
    _, samples = recorded((ERROR, P), cells)
    assert max(abs(error) for error, _ in samples) > 100
    for error, term in samples:
        # The row of the error is whole pulses, the loop works with fractions.
        assert term == pytest.approx((gain or 0.00244) * error, abs=(gain or 0.00244))


@pytest.mark.req("MILL-SYS-SERVO-IGAIN", "MILL-SYS-SERVO-ILIMIT")
def test_the_integral_ramps_at_gain_times_error_up_to_its_limit() -> None:
    gain, limit = 0.02, 0.25
    cells = {f"P{SERVO + 1}": gain, f"P{SERVO + 3}": limit}
    shop, samples = recorded((ERROR, I), cells)
    period_s = shop.controller.period_s
    ramps = 0
    for (_, before), (error, now) in pairwise(samples):
        assert abs(now) <= limit
        if abs(now) < limit and abs(before) < limit:
            assert now - before == pytest.approx(gain * error * period_s, abs=gain * period_s)
            ramps += abs(error) > 100
    assert ramps > 20
    assert max(abs(term) for _, term in samples) == limit
    assert all(term == 0 for _, term in recorded((ERROR, I))[1])  # the default gain is 0


@pytest.mark.req("MILL-SYS-SERVO-IDELAY")
@pytest.mark.parametrize("delay_s", [0.0, 0.03])
def test_integration_begins_a_delay_after_the_command_has_stopped(delay_s: float) -> None:
    # Too little gain to arrive: an error stays when the move has ended.
    cells = {f"P{SERVO}": 0.0005, f"P{SERVO + 1}": 0.05, f"P{SERVO + 2}": delay_s}
    cells[f"P{SERVO + 3}"] = 1.0
    shop, samples = recorded((n.AX_VELOCITY, I), cells, 700, x=0.2)
    moving = [tick for tick, (velocity, _) in enumerate(samples) if velocity]
    ramping = next(tick for tick, (_, term) in enumerate(samples) if term)
    if delay_s == 0.0:
        assert ramping <= moving[0] + 5
    else:
        stopped_s = (ramping - moving[-1]) * shop.controller.period_s
        assert stopped_s == pytest.approx(delay_s, abs=0.002)


@pytest.mark.req("MILL-SYS-SERVO-DGAIN", "MILL-SYS-SERVO-DTIME")
@pytest.mark.parametrize("periods", [0, 4])
def test_the_derivative_is_gain_times_the_rate_of_the_error_over_its_time(periods: int) -> None:
    gain, period_s = 0.00002, 0.0005
    cells = {f"P{SERVO + 4}": gain, f"P{SERVO + 5}": periods * period_s}
    shop, samples = recorded((ERROR, D), cells)
    assert shop.controller.period_s == period_s
    every = periods or 1
    changes = [
        tick
        for tick in range(1, len(samples))
        if samples[tick][1] != samples[tick - 1][1] and samples[tick][1]
    ]
    assert len(changes) > 30
    assert {tick % every for tick in changes} == {changes[0] % every}
    for tick in changes[5:60]:
        rate = (samples[tick][0] - samples[tick - every][0]) / (every * period_s)
        assert samples[tick][1] == pytest.approx(gain * rate, abs=2 * gain / (every * period_s))


@pytest.mark.req("MILL-SYS-SERVO-ACCFF", "MILL-SYS-SERVO-VELFF")
@pytest.mark.parametrize(
    ("k", "term", "of"),
    [
        (6, n.AX_FFACC_TERM, n.AX_ACCELERATION),
        (7, n.AX_FFVEL_TERM, n.AX_VELOCITY),
    ],
)
def test_feed_forward_is_gain_times_commanded_acceleration_or_velocity(
    k: int, term: int, of: int
) -> None:
    gain = 0.00001
    _, samples = recorded((term, of), {f"P{SERVO + k}": gain})
    assert max(abs(commanded) for _, commanded in samples) > 10_000
    for volts, commanded in samples:
        assert volts == pytest.approx(gain * commanded, rel=1e-5, abs=1e-9)
    assert all(
        volts == 0 for volts, _ in recorded((term, of), ticks=50)[1]
    )  # the default gain is 0


@pytest.mark.req("MILL-SYS-SERVO-TLM")
@pytest.mark.parametrize("limit", [None, 0.25, 0.5])
def test_the_output_is_clamped_to_the_torque_limit(limit: float | None) -> None:
    cells = {} if limit is None else {f"P{SERVO + 8}": limit}
    wanted = limit or 10.0
    _, samples = recorded((n.AX_SUMMATION_POINT, n.AX_OUTPUT_SIGNAL), cells)
    assert max(abs(volts) for _, volts in samples) <= wanted + 1e-6
    for summed, volts in samples:
        assert volts == pytest.approx(max(-wanted, min(wanted, summed)), abs=1e-3)
    if limit is not None:
        assert max(abs(volts) for _, volts in samples) == pytest.approx(limit)


def moved(test: Callable[[Shop], float], **cells: float) -> float:
    """What one unit in plus direction does."""
    shop = Shop(**cells)
    shop.finish(line(1, at(1.0), 100.0), end())
    shop.pass_time(0.2)
    return test(shop)


@pytest.mark.req("MILL-SYS-AXES-PPU")
@pytest.mark.parametrize("pulses", [10_000, 2_500])
def test_one_unit_is_as_many_pulses_of_the_encoder_as_the_store_says(pulses: int) -> None:
    row = n.AX_BASE + n.AX_ACTUAL_POSITION
    found = moved(lambda shop: float(shop.controller.p[row]), P200006=pulses)
    assert found == pytest.approx(pulses, abs=5)


@pytest.mark.req("MILL-SYS-AXES-DACPOL")
def test_negative_polarity_turns_the_drive_output_round() -> None:
    rows = (n.AX_OUTPUT_SIGNAL, n.AX_ACTUAL_POSITION)
    _, plain = recorded(rows, ticks=40)
    _, turned = recorded(rows, {"P200005": 1}, ticks=40)
    assert plain[-1][1] > 0  # the motor goes where it is sent
    assert turned[-1][1] < 0  # and here the other way
