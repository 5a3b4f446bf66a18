"""Planned paths with a rotary axis: limits of every axis in its own unit, ends, times, holds."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mill.planned import FEED, SPEED, TOLERANCE, Reals, motion_s
from tests.mill.planned_rotary import (
    MOST,
    PROGRAMS,
    SCALES,
    TURN_SPEED,
    A,
    assert_limits,
    counts,
    follow,
    line,
    polyline,
    rotary_shop,
    table_store,
    to,
)
from tests.mill.prediction import predicted
from tests.mill.shop import end, src
from tests.search import search
from tests.trajectory.measures import off

from openacr.cnc import canonical as c
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.plan_metric import PlanMetric
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.plan.moves.geometry import weights
from openacr.mill.plan.moves.phases import Phases
from openacr.mill.run.lifecycle import Options, State
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS
from openacr.trajectory import Setpoints


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_axis_keeps_its_limits_ends_on_its_count_and_takes_the_time_predicted(
    name: str,
) -> None:
    shop, program = rotary_shop(), PROGRAMS[name]
    expected_s = predicted(program, Settings(shop.store), to()).time_s
    shop.start(*program)
    places, period_s = follow(shop), shop.controller.period_s
    assert (places[-1] * SCALES).tolist() == counts(program)
    assert_limits(places, period_s)
    assert motion_s(places, period_s) == pytest.approx(expected_s, abs=2 * period_s)
    turned = np.abs(np.diff(places[:, A])).max() / period_s
    assert turned == pytest.approx(TURN_SPEED, rel=1e-3)  # one of the limits is reached


@pytest.mark.parametrize(
    ("place", "seconds"),
    [((30.0, 40.0, 0.0, 50.0), 2.0), ((0.0, 0.0, 0.0, 50.0), 2.0), ((30.0, 40.0), 2.0)],
)
def test_the_feed_is_that_of_the_tool_and_of_the_turn_where_it_rests(
    place: tuple[float, ...], seconds: float
) -> None:
    shop = rotary_shop()
    shop.start(line(1, *place, feed=60.0 * 50.0 / seconds), end())
    places = follow(shop)
    rates = np.diff(places, axis=0) / shop.controller.period_s
    wanted = np.array([*place, *[0.0] * (4 - len(place))]) / seconds
    assert rates.max(axis=0) == pytest.approx(wanted, rel=1e-3, abs=1e-9)


def test_single_block_rests_at_the_end_of_every_turn() -> None:
    shop, moves = rotary_shop(), [e for e in PROGRAMS["mixed"] if isinstance(e, c.Line)]
    blocks: list[c.Entry] = []
    for move in moves:
        blocks += [move, c.BlockEnd(move.source)]
    shop.start(*blocks, end(), options=Options(is_single=True))
    for move in moves:
        assert shop.until(State.HOLD) is State.HOLD
        assert shop.runner.stream.host.position()[: A + 1] == move.end[: A + 1]
        shop.runner.start()
    assert shop.until(State.IDLE) is State.IDLE


@pytest.mark.parametrize(("is_metric", "degree_u"), [(True, 1.0), (False, 1 / 32)])
def test_a_degree_counts_as_a_length_that_keeps_every_bit(is_metric: bool, degree_u: float) -> None:
    store = Store(is_metric=is_metric)
    store.write(AXIS.configured[A], 1.0)
    settings = Settings(store)
    assert weights(settings) == (1.0, 1.0, 1.0, degree_u, 1.0, 1.0, 1.0, 1.0)
    place = (0.1, 0.2, 0.3, 123.456)
    planned = PlanMetric(settings).place(place)
    assert planned == (0.1, 0.2, 0.3, 123.456 * degree_u)
    assert planned[A] / degree_u == place[A]


class Curves:
    """Collects the control points of curves."""

    def __init__(self) -> None:
        self.points: list[Reals] = []

    def read(self, job: Job) -> None: ...

    def passed(self, job: Job, phases: Phases) -> None: ...

    def rested(self, seconds: float) -> None: ...

    def curve(self, points: Reals) -> None:
        self.points.append(points)


@st.composite
def chains(draw: st.DrawFn) -> list[c.Entry]:
    """Lines and helices that turn a table, with turns alone among them."""
    chance = np.random.default_rng(draw(st.integers(0, 500)))
    length, bend = (
        draw(st.sampled_from([0.4, 2.0, 10.0])),
        draw(st.sampled_from([5.0, 20.0, 120.0])),
    )
    twist = draw(st.sampled_from([0.2, 2.0, 10.0]))
    angle, place, found = 0.0, np.zeros(4), list[c.Entry]()
    for k in range(draw(st.integers(2, 12))):
        pace = c.Pace(FEED if chance.random() < 0.8 else 0.2 * FEED, tolerance_u=TOLERANCE)
        kind, reach = chance.random(), length * chance.uniform(0.2, 2.0)
        angle += math.radians(chance.uniform(-bend, bend))
        centre = place[:2] + reach * np.array([-math.sin(angle), math.cos(angle)])
        place = place + np.array([0.0, 0.0, 0.0, reach * chance.uniform(-twist, twist)])
        if 0.1 <= kind < 0.75:
            place[:2] += reach * np.array([math.cos(angle), math.sin(angle)])
        if kind < 0.75:
            found.append(c.Line(src(k), to(*map(float, place)), pace))
            continue
        sweep = float(chance.uniform(0.3, 4.0))
        angle += sweep
        place[:2] = centre + reach * np.array([math.sin(angle), -math.cos(angle)])
        middle = float(centre[0]), float(centre[1])
        finish = to(*map(float, place))
        found.append(c.Arc(src(k), finish, c.Plane.XY, middle, sweep, reach, reach, pace))
    return found


@search(12, derandomize=True)
@given(chains())
def test_chains_of_lines_helices_and_turns_keep_limits_and_tolerances(
    program: list[c.Entry],
) -> None:
    curves = Curves()
    predictor = Predictor(Settings(table_store()), to(), reader=curves)
    for entry in program:
        predictor.add(entry)
    predictor.close()
    (points,) = curves.points
    for k in (1, 2, 3):  # differences of control points bound every sample of every phase
        rates = np.abs(np.diff(points, k, axis=0)).max(axis=0) / PERIOD_S**k
        assert (rates <= MOST[k - 1] * (1 + 1e-6)).all(), (k, rates)
    speeds = np.linalg.norm(np.diff(points[:, :A], axis=0), axis=1) / PERIOD_S
    assert speeds.max() <= SPEED * (1 + 1e-6)
    path = polyline(program)
    middles = (points[:-2] + 4 * points[1:-1] + points[2:]) / 6
    assert off(middles, path[:-1], path[1:]) <= TOLERANCE + 1e-4  # 1 degree counts as 1 mm
    assert (points[-1] * SCALES).tolist() == pytest.approx(counts(program), abs=1e-6)


def test_setpoints_and_limits_are_converted_with_their_units() -> None:
    settings = Settings(rotary_shop().store)  # in inches: a degree counts as 1/32
    metric = PlanMetric(settings)
    assert metric.limits().velocity_ups[A] == TURN_SPEED / 32
    metric.note(2.0, 64.0)
    metric.note(3.0, 3.0)
    rows = np.array([[1.0, 0.0, 0.0, 2.0]])
    lines = np.ones(1, np.int64)
    found = metric.of_machine(
        Setpoints(0, 0.004, rows, lines, np.array([1.0]), 2 * rows, 3.5, np.ones(1))
    )
    assert found.points.tolist() == [[1.0, 0.0, 0.0, 64.0]]
    assert found.rest.tolist() == [[2.0, 0.0, 0.0, 128.0]]
    assert (found.path_u.tolist(), found.rest_path_u) == ([32.0], 65.5)
