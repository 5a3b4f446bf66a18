"""Moves of their own that turn a table, on a machine with a jerk limit: each axis keeps its own."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from tests.mill.planned import ACCEL, JERK, Reals, go_on, stop
from tests.mill.planned_rotary import (
    BEGIN,
    PROGRAMS,
    SCALES,
    A,
    assert_limits,
    counts,
    follow,
    line,
    rotary_shop,
    table_store,
    to,
    turned_circle,
)
from tests.mill.prediction import corner_speed
from tests.mill.shop import Shop, end, src

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.moves.encoding import Encoder
from openacr.mill.plan.moves.geometry import weights
from openacr.mill.plan.moves.planning import CornerRules
from openacr.sysvar.tabs import AXIS, SPEEDS


def exact(*moves: c.Line | c.Arc) -> list[c.Entry]:
    """Moves that end at rest."""
    return [
        *(replace(move, pace=replace(move.pace, mode=c.PathMode.EXACT)) for move in moves),
        end(),
    ]


def jerk_of_card(shop: Shop) -> float:
    """The jerk of the moves to come (JRK)."""
    return float(shop.card.ask("JRK", program=0))


OWN: dict[str, list[c.Entry]] = {
    "mixed": exact(line(1, 2, 0, 0, 30), line(2, 20, 10, 0, 60), line(3, 20, 10, 3), line(4)),
    "rapids": [c.Rapid(src(1), to(1, 2, 3, 100)), c.Rapid(src(2), to(30, 2, 3, 90)), end()],
    "circle": exact(line(1, 4), turned_circle(2)),
}


@pytest.mark.parametrize("name", OWN)
def test_a_table_that_turns_faster_than_the_tool_goes_keeps_its_own_limits(name: str) -> None:
    shop = rotary_shop()
    shop.start(*OWN[name])
    places, period_s = follow(shop), shop.controller.period_s
    assert_limits(places, period_s)
    last = next(move for move in reversed(OWN[name]) if not isinstance(move, c.End))
    assert isinstance(last, c.Line | c.Arc | c.Rapid)
    assert (places[-1] * SCALES).tolist() == np.round(np.array(last.end[: A + 1]) * SCALES).tolist()
    assert jerk_of_card(shop) == JERK


@pytest.mark.parametrize("name", OWN)
def test_a_table_without_an_acceleration_of_its_own_has_the_ramp_of_the_machine(name: str) -> None:
    shop = rotary_shop(**{f"P{AXIS.max_axis_acceleration[A]}": 0.0})
    shop.start(*OWN[name])
    places, period_s = follow(shop), shop.controller.period_s
    fastest = np.abs(np.diff(places[:, A], 2)).max() / period_s**2
    assert fastest == pytest.approx(ACCEL, rel=2e-3)


def reached(places: Reals, period_s: float) -> float:
    """The highest jerk of the table."""
    return float(np.abs(np.diff(places[:, A], 3)).max()) / period_s**3


def test_a_turned_circle_is_traced_within_the_jerk_of_the_table_and_uses_it() -> None:
    shop = rotary_shop(**{f"P{SPEEDS.forward_backward_speed}": 600.0})
    shop.start(*PROGRAMS["circle"])
    places = follow(
        shop, (1.2, stop), (1.7, lambda shop: shop.runner.trace(-1)),
        (2.1, lambda shop: shop.runner.trace(0)), (2.5, lambda shop: shop.runner.trace(1)),
        (3.7, go_on),
    )  # fmt: skip
    period_s = shop.controller.period_s
    assert_limits(places, period_s)
    begin, over = (round(at_s / period_s) for at_s in (1.7, 3.6))
    assert reached(places[begin:over], period_s) == pytest.approx(JERK, rel=0.01)
    assert (places[-1] * SCALES).tolist() == counts(PROGRAMS["circle"])


@given(
    ends=st.lists(
        st.tuples(*[st.floats(-20, 20)] * 3, st.sampled_from([0.0, 5.0, 90.0])),
        min_size=1,
        max_size=4,
    )
)
def test_the_jerk_of_a_move_is_that_of_its_fastest_axis(ends: list[tuple[float, ...]]) -> None:
    coder = Encoder(Settings(table_store(**{f"P{AXIS.max_axis_acceleration[A]}": 0.0})))
    places = np.array([to(*place) for place in ends])
    lines = c.Polyline(src(1), places, np.arange(1, len(ends) + 1), c.Pace(600.0))
    for job in coder.jobs(lines, BEGIN):
        alone = coder.job(job.entry, job.begin)
        assert job.jerk_ups3 == pytest.approx(alone.jerk_ups3, rel=1e-12)
        assert job.ramp_ups2 == pytest.approx(alone.ramp_ups2, rel=1e-12)
        share = np.abs(np.subtract(job.finish, job.begin))[A] / max(job.length_u, 1e-300)
        assert job.jerk_ups3 == pytest.approx(JERK / max(share, 1.0), rel=1e-9)
        if job.finish[A] == job.begin[A]:
            assert (job.jerk_ups3, job.ramp_ups2) == (JERK, ACCEL)


@pytest.mark.parametrize("is_metric", [True, False])
@pytest.mark.parametrize("rate", [0.5, 4.0])  # degrees by length
def test_a_turn_that_changes_counts_as_corner_step(rate: float, is_metric: bool) -> None:
    cells = {f"P{SPEEDS.corner_step}": 2.0}
    store = table_store(**cells) if is_metric else rotary_shop(**cells).store
    settings = Settings(store)
    assert settings.is_metric is is_metric
    coder, degree_u = Encoder(settings), weights(settings)[A]
    turning = coder.job(line(1, 10, 0, 0, 10 * rate), BEGIN)
    turning_back = coder.job(line(2, 20, 0, 0), turning.finish)
    tilted = coder.job(line(3, 20, 10, 0), turning_back.finish)
    rules = CornerRules.of(settings.speeds)
    most_ups = min(turning.feed_ups, turning_back.feed_ups)
    back = corner_speed(turning, turning_back, rules)
    assert back == pytest.approx(min(2.0 / (2 * rate * degree_u), most_ups))
    ends = corner_speed(turning_back, tilted, rules)
    assert ends == pytest.approx(min(2.0 / max(1.0, rate * degree_u), most_ups))


def test_the_speed_of_the_table_steps_by_the_corner_step_at_most() -> None:
    step_ups, speed_upm = 0.05, 600.0
    cells = {SPEEDS.forward_backward_speed: speed_upm, SPEEDS.corner_step: step_ups}
    shop = rotary_shop(**{f"P{cell}": value for cell, value in cells.items()})
    shop.start(*(line(k, k / 2, 0, 0, 4.0 * (k % 2)) for k in range(1, 20)), end())
    places = follow(
        shop, (0.8, stop), (1.3, lambda shop: shop.runner.trace(-1)),
        (2.3, lambda shop: shop.runner.trace(0)), (2.9, go_on),
    )  # fmt: skip
    period_s = shop.controller.period_s
    begin, over = (round(at_s / period_s) for at_s in (1.3, 2.8))
    assert np.abs(places[begin] - places[over])[0] > 1.0  # some corners
    lengths = np.array(weights(shop.runner.settings)[: A + 1])
    steps = np.abs(np.diff(places[begin:over], 2, axis=0)) / period_s * lengths
    ramp_ups = ACCEL * period_s  # within one period, where no corner is
    assert steps[:, :A].max() <= step_ups + ramp_ups
    assert steps[:, A].max() <= step_ups + ramp_ups * lengths[A]
