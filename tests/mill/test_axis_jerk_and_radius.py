"""Max axis jerk and Tolerance radius: on planned paths, in moves of their own, and in holds."""

import math
from itertools import product

import numpy as np
import pytest
from tests.mill.planned import FEED, JERK, TOLERANCE, Reals, go_on, motion_s, stop
from tests.mill.planned_rotary import (
    BEGIN,
    PROGRAMS,
    SCALES,
    A,
    assert_limits,
    counts,
    follow,
    line,
    polyline,
    rotary_shop,
    table_store,
    to,
    turned_circle,
)
from tests.mill.prediction import predicted
from tests.mill.shop import Shop, end, src
from tests.search import sparse
from tests.trajectory.measures import off

from openacr.cnc import canonical as c
from openacr.mill.config.curves import PERIOD_S
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import JERK_SHARE
from openacr.mill.plan.curves.curve_reserve import Reserve
from openacr.mill.plan.curves.plan_metric import PlanMetric
from openacr.mill.plan.moves.encoding import Encoder
from openacr.sysvar.tabs import AXIS, CONTROL
from openacr.sysvar.values import unit_of

RADIUS, OWN_JERK = f"P{AXIS.tolerance_radius[A]}", f"P{AXIS.max_axis_jerk[A]}"
DEFAULT_U = math.degrees(1 / 32)  # the radius at which a degree is 1/32 inch
SLOW, QUICK = 5_000.0, 80_000.0
# Its legs meet at angles that the table alone makes, and that the tool hardly feels.
ZIGZAG: list[c.Entry] = [*(line(k, 3.0 * k, 0, 0, 1.0 * (k % 2)) for k in range(1, 12)), end()]


def jerks(places: Reals, period_s: float) -> Reals:
    """The highest jerk of X Y Z A, every millisecond."""
    every = round(0.001 / period_s)
    found: Reals = np.max(
        [
            np.abs(np.diff(places[phase::every], 3, axis=0)).max(axis=0) / 0.001**3
            for phase in range(every)
        ],
        axis=0,
    )
    return found


def apart(places: Reals, program: list[c.Entry], radius_u: float) -> float:
    """The largest distance from a path, turns counted as the arc at a radius."""
    factors = np.array([1.0, 1.0, 1.0, math.radians(radius_u)])
    path = polyline(program) * factors
    return off(places * factors, path[:-1], path[1:])


def rounding(places: Reals) -> Reals:
    """Of a jerk: positions have 24 bits, over the cube of 4 ms."""
    bits: Reals = np.spacing(np.abs(places).max(axis=0).astype(np.float32)).astype(np.float64)
    return 4.0 * bits / 0.004**3


def assert_jerks(shop: Shop, places: Reals, jerk: float) -> Reals:
    """The jerk of each axis, not above the limit of any."""
    found = jerks(places, shop.controller.period_s)
    assert (found <= np.array([JERK, JERK, JERK, jerk]) + rounding(places)).all(), found
    return found


@pytest.mark.parametrize(
    ("name", "radius_u"),
    sparse(list(product(["wave", "mixed", "turns", "circle", "zigzag"], [0.2, 5.0, 25.0])), 4),
)
def test_the_tool_keeps_the_tolerance_at_the_radius_of_the_table(
    name: str, radius_u: float
) -> None:
    program = PROGRAMS.get(name, ZIGZAG)
    shop = rotary_shop(**{RADIUS: radius_u})
    expected_s = predicted(program, Settings(shop.store), to()).time_s
    shop.start(*program)
    places, period_s = follow(shop), shop.controller.period_s
    assert (places[-1] * SCALES).tolist() == counts(program)
    assert apart(places, program, radius_u) <= TOLERANCE * (1 + 1e-3)
    assert_limits(places, period_s)
    took_s = motion_s(places, period_s)  # a last point may be on the same pulse as the end
    assert took_s == pytest.approx(expected_s, abs=PERIOD_S + period_s)


def test_the_tolerance_is_kept_at_the_radius_that_is_set_and_not_beyond() -> None:
    apart_u = {}
    for radius_u in (0.0, 5.0, 25.0):
        shop = rotary_shop(**{RADIUS: radius_u})
        shop.start(*ZIGZAG)
        apart_u[radius_u] = apart(follow(shop), ZIGZAG, 25.0)
    assert 0.8 * TOLERANCE < apart_u[25.0] <= TOLERANCE
    assert 3.0 * TOLERANCE < apart_u[5.0] <= 5.0 * TOLERANCE
    assert apart_u[5.0] < apart_u[0.0] <= 25.0 / DEFAULT_U * TOLERANCE


@pytest.mark.parametrize(("name", "jerk"), sparse(list(product(PROGRAMS, [SLOW, QUICK])), 3))
def test_the_table_has_its_own_jerk_and_the_tool_that_of_the_path(name: str, jerk: float) -> None:
    shop, program = rotary_shop(**{OWN_JERK: jerk}), PROGRAMS[name]
    shop.start(*program)
    places = follow(shop)
    found = assert_jerks(shop, places, jerk)
    assert found[A] > 0.8 * jerk or (name, jerk) == ("wave", QUICK)  # a wave needs less
    assert (places[-1] * SCALES).tolist() == counts(program)


@pytest.mark.parametrize(("jerk", "at_s"), sparse(list(product([SLOW, QUICK], [0.3, 0.5, 0.6])), 4))
def test_a_hold_keeps_the_jerk_of_the_table(jerk: float, at_s: float) -> None:
    shop, program = rotary_shop(**{OWN_JERK: jerk}), PROGRAMS["wave"]
    shop.start(*program)
    places = follow(shop, (at_s, stop), (at_s + 1.0, go_on))
    assert_jerks(shop, places, jerk)
    assert (places[-1] * SCALES).tolist() == counts(program)


def exact(move: c.Line | c.Arc) -> c.Line | c.Arc:
    """A move of its own."""
    return type(move)(
        **{name: getattr(move, name) for name in move.__struct_fields__ if name != "pace"},
        pace=c.Pace(move.pace.feed_upm, mode=c.PathMode.EXACT),
    )


@pytest.mark.parametrize(
    ("place", "jerk"),
    sparse(
        list(product([(0, 0, 0, 90), (3, 0, 0, 90), (20, 20, 0, 10), (20, 20, 5)], [SLOW, QUICK])),
        3,
    ),
)
def test_a_move_of_its_own_has_the_jerk_of_the_axis_that_is_first_at_its_limit(
    jerk: float, place: tuple[float, ...]
) -> None:
    shop = rotary_shop(**{OWN_JERK: jerk})
    shop.start(exact(line(1, *place)), end())
    places = follow(shop)
    found = jerks(places, shop.controller.period_s)
    tool = float(np.linalg.norm(np.array([*place, 0.0])[:3]))
    turned = float([*place, 0.0][A])
    along = min(
        JERK if tool else math.inf, jerk * (tool or turned) / turned if turned else math.inf
    )
    expected = along * np.abs([*place, *[0.0] * (4 - len(place))]) / (tool or turned)
    assert found == pytest.approx(expected, rel=0.01, abs=1.0)
    assert float(shop.card.ask("JRK", program=0)) == min(jerk, JERK)


def test_many_lines_have_the_jerk_of_each_alone_with_jerks_of_all_axes() -> None:
    cells = {AXIS.max_axis_jerk[0]: 3_000.0, AXIS.max_axis_jerk[1]: 90_000.0}
    cells[AXIS.max_axis_jerk[A]] = 7_000.0
    coder = Encoder(Settings(table_store(**{f"P{n}": value for n, value in cells.items()})))
    ends = np.array([to(1), to(1, 5), to(2, 6), to(2, 6, 0, 9), to(3, 6, 0, 9.1), to(3, 6, 0, 9.1)])
    lines = c.Polyline(src(1), ends, np.arange(1, len(ends) + 1), c.Pace(600.0))
    found = [job.jerk_ups3 for job in coder.jobs(lines, BEGIN)]
    alone = [coder.job(job.entry, job.begin).jerk_ups3 for job in coder.jobs(lines, BEGIN)]
    half = 3_000.0 * math.sqrt(2.0)
    assert found == pytest.approx([3_000.0, JERK, half, 7_000.0, 3_000.0, JERK])
    assert alone == pytest.approx(found)


def test_without_a_path_jerk_the_jerk_of_an_axis_does_nothing() -> None:
    cells = {OWN_JERK: 7_000.0, "P650015": 0.0}
    settings = Settings(table_store(**cells))
    assert settings.lowest_jerk_ups3 == 0.0
    assert Encoder(settings).job(line(1, 3, 0, 0, 90), BEGIN).jerk_ups3 == 0.0


def test_the_plan_has_the_limits_of_each_axis_in_its_own_measure() -> None:
    """Radians of a degree at 100 mm are 1.745 mm."""
    settings = Settings(table_store(**{RADIUS: 100.0, OWN_JERK: 5_000.0}))
    limits = PlanMetric(settings).limits()
    assert limits.jerk_ups3 is not None
    assert limits.jerk_ups3[A] == pytest.approx(JERK_SHARE * 5_000.0 * 1.7453292519943295)
    assert limits.jerk_ups3[0] == JERK_SHARE * JERK
    assert limits.velocity_ups[A] == pytest.approx(90.0 * 1.7453292519943295)


def test_the_reserve_of_a_link_is_that_of_the_axis_with_the_least_jerk() -> None:
    def kept(**cells: float) -> int:
        """Pieces that the card keeps to come to rest on."""
        found = Reserve(Settings(table_store(**cells)))
        for step in range(500):
            found.note(np.array([0.4 * step, 0.0, 0.0, 0.0]))
        return found.pieces - found.hold_at

    assert kept(**{OWN_JERK: 5_000.0}) > kept() == kept(**{OWN_JERK: 80_000.0})


def test_two_tables_have_a_radius_each() -> None:
    cells = {RADIUS: 100.0, f"P{AXIS.tolerance_radius[5]}": 50.0, f"P{AXIS.configured[5]}": 1.0}
    cells |= {f"P{AXIS.configured[4]}": 1.0}
    settings = Settings(table_store(**cells))
    coder, place = Encoder(settings), (3.0, 0.0, 0.0, 30.0, 7.0, 20.0, 0.0, 0.0)
    pace = c.Pace(FEED, tolerance_u=TOLERANCE)
    job = coder.job(c.Line(src(1), place, pace), BEGIN)
    arcs = (math.radians(30) * 100, 7.0, math.radians(20) * 50)
    assert job.turns == pytest.approx([arc / 3.0 for arc in arcs])
    assert PlanMetric(settings).length_ratio(job) == pytest.approx(math.hypot(3.0, *arcs) / 3.0)
    metric, where = PlanMetric(settings), (3.0, 0.0, 0.0, 30.0, 7.0, 20.0)
    planned = np.array(metric.place(where))
    assert planned == pytest.approx([3.0, 0.0, 0.0, arcs[0], 7.0, arcs[2]])
    assert metric.of_plan(planned) == pytest.approx(where, rel=1e-15)


def test_a_turned_circle_rests_on_its_pulse_with_a_radius_that_is_no_power_of_two() -> None:
    shop = rotary_shop(**{RADIUS: 3.3})
    program: list[c.Entry] = [line(1, 4), turned_circle(2), end()]
    shop.start(*program)
    places = follow(shop, (0.9, stop), (1.6, go_on))
    assert (places[-1] * SCALES).tolist() == counts(program)


def test_the_radius_is_a_length_of_the_tool_in_the_unit_of_the_machine() -> None:
    """100 mm are 3.937 inches; the jerk of the table stays one in degrees."""
    store = table_store(**{RADIUS: 100.0, OWN_JERK: 5_000.0})
    radius, jerk = (store.parameter(row[A]) for row in (AXIS.tolerance_radius, AXIS.max_axis_jerk))
    assert unit_of(radius, True, store.letter_of(radius)) == "mm"
    assert unit_of(jerk, True, store.letter_of(jerk)) == "deg/s3"
    store.write(CONTROL.default_units, 0.0)
    assert store.read(radius.number) == pytest.approx(100.0 / 25.4)
    assert store.read(jerk.number) == 5_000.0
