"""Paths of lines and arcs without tolerance and jerk: no sample above an acceleration limit.

The bound of the time is computed here alone: the fastest speed along the path on a fine grid,
forward and backward, under the same law of limits.
"""

import math
import random
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace
from numpy.typing import NDArray
from tests.mill.planned import Action, follow, motion_s
from tests.mill.shop import PULSES, Shop, at, end, line, src
from tests.search import search, sparse

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.estimate.trajectory import Trajectory
from openacr.mill.plan.moves import arc_law_cy
from openacr.mill.plan.moves.encoding import Encoder
from openacr.sysvar.tabs import AXIS, SPEEDS

pytestmark = pytest.mark.evidence("oracle", "finite differences of samples, a speed on a fine grid")

Reals = NDArray[np.float64]
LIMIT = 100.0  # units/s2, of every axis and of the path
PERIOD_S = 0.0005
CIRCLE = 2.0 * math.pi
TURNING = math.sqrt(0.75)


def shop(**cells: float) -> Shop:
    return Shop(**{f"P{SPEEDS.master_feed_acc_dec}": LIMIT} | cells)


def limits(*own: float) -> dict[str, float]:
    """Cells with the acceleration limits of X, Y, Z."""
    return {f"P{AXIS.max_axis_acceleration[a]}": value for a, value in enumerate(own) if value}


def arc(
    number: int, begin: c.Point, centre: tuple[float, float], sweep: float, *, rise: float = 0.0,
    growth: float = 0.0, feed: float = 6000.0, plane: c.Plane = c.Plane.XY,
) -> c.Arc:  # fmt: skip
    """An arc about a centre: a helix with `rise`, a spiral with `growth` of its radius."""
    first, second = plane.first, plane.second
    x, y = begin[first] - centre[0], begin[second] - centre[1]
    radius, angle = math.hypot(x, y), math.atan2(y, x) + sweep
    finish = [place + rise * (axis == 3 - first - second) for axis, place in enumerate(begin)]
    finish[first] = centre[0] + (radius + growth) * math.cos(angle)
    finish[second] = centre[1] + (radius + growth) * math.sin(angle)
    return c.Arc(
        src(number), tuple(finish), plane, centre, sweep, radius, radius + growth, c.Pace(feed)
    )


def smooth_chain(seed: int) -> list[c.Entry]:
    """Lines and arcs that touch each other, of any size, some slow; a stop now and then."""
    chance = random.Random(seed)
    entries: list[c.Entry] = []
    point, angle = at(), chance.uniform(0.0, CIRCLE)
    for number in range(1, 40):
        feed = chance.choice((300.0, 900.0, 6000.0, 6000.0))
        if chance.random() < 0.5:
            length = 10.0 ** chance.uniform(-2.5, 0.8)
            point = at(
                point[0] + length * math.cos(angle), point[1] + length * math.sin(angle), point[2]
            )
            entries.append(line(number, point, feed=feed))
        else:
            radius, turn = 10.0 ** chance.uniform(-1.5, 0.7), chance.choice((1.0, -1.0))
            sweep = turn * chance.uniform(0.05, CIRCLE)
            centre = (
                point[0] - turn * radius * math.sin(angle),
                point[1] + turn * radius * math.cos(angle),
            )
            turning = arc(number, point, centre, sweep, feed=feed)
            entries.append(turning)
            point, angle = turning.end, angle + sweep
        if chance.random() < 0.08:
            entries.append(c.Dwell(src(number), 0.01))
    return [*entries, end()]


def samples(machine: Shop, entries: Sequence[c.Entry], period_s: float = PERIOD_S) -> Reals:
    """Places of X, Y and Z of the plan, one each period."""
    parts: list[Reals] = []
    own = Settings(machine.store)
    trajectory = Trajectory(own, period_s, parts.append)
    predictor = Predictor(own, at(), reader=trajectory)
    for entry in entries:
        predictor.add(entry)
    predictor.close()
    trajectory.close()
    return np.concatenate(parts)[:-1, 1:4]  # the last row is the end itself, between two samples


def accelerations(places: Reals, period_s: float = PERIOD_S) -> Reals:
    """The highest acceleration of each axis."""
    found = np.abs(np.diff(places, n=2, axis=0)).max(axis=0) / period_s**2
    return np.asarray(found)


@pytest.mark.parametrize("own", [(), (60.0, 60.0), (0.0, 35.0), (140.0, 50.0)])
@search(12)
@given(seed=st.integers(0, 10**9))
def test_no_sample_of_lines_and_arcs_is_above_the_limit_of_an_axis(
    own: tuple[float, ...], seed: int
) -> None:
    found = accelerations(samples(shop(**limits(*own)), smooth_chain(seed)))
    for axis, limit in enumerate([*own, 0.0, 0.0, 0.0][:3]):
        assert found[axis] <= min(limit or LIMIT, LIMIT) * (1 + 1e-6)


@search(40)
@given(
    sweep=st.floats(0.2, CIRCLE),
    radius=st.floats(0.05, 5.0),
    growth=st.floats(-0.9, 4.0),
    rise=st.sampled_from([0.0, 0.3, -4.0]),
    plane=st.sampled_from(list(c.Plane)),
    feed=st.sampled_from([120.0, 900.0, 6000.0]),
)
def test_spirals_and_helices_of_every_plane_stay_within_the_limits_too(
    sweep: float, radius: float, growth: float, rise: float, plane: c.Plane, feed: float
) -> None:
    begin = [0.0] * 8
    begin[plane.first] = radius
    reach = line(1, tuple(begin), mode=c.PathMode.EXACT)
    spiral = arc(
        2, reach.end, (0.0, 0.0), sweep, rise=rise, growth=growth * radius, plane=plane, feed=feed
    )
    found = accelerations(samples(shop(**limits(80.0, 100.0, 60.0)), [reach, spiral, end()]))
    assert (found <= np.array([80.0, 100.0, 60.0]) * (1 + 1e-6)).all()


FINE = 1e7  # pulses per unit: whole pulses are no corners of their own
FINELY = {f"P{AXIS.pulses_per_unit[a]}": FINE for a in range(3)}


def run(
    entries: Sequence[c.Entry], *actions: tuple[float, Action], **cells: float
) -> tuple[Reals, float]:
    """Where the axes are commanded to be in a run on the virtual machine, and its period."""
    machine = shop(**FINELY | cells)
    places = follow(machine, *entries, actions=actions) * PULSES / FINE
    return places, machine.controller.period_s


@pytest.mark.parametrize("seed", [0, 3, 6])
def test_the_setpoints_of_a_run_keep_the_limits_and_take_the_predicted_time(seed: int) -> None:
    entries = [each for each in smooth_chain(seed) if not isinstance(each, c.Dwell)]
    predictor = Predictor(Settings(shop(**FINELY).store), at())
    for entry in entries:
        predictor.add(entry)
    predictor.close()
    places, period_s = run(entries)
    assert (accelerations(places, period_s) <= LIMIT * (1 + 1e-4)).all()
    assert 0.0 <= motion_s(places, period_s) - predictor.found.feed_s <= period_s


@pytest.mark.parametrize("at_s", [0.05, 0.31, 0.42, 0.55, 0.7])
def test_a_feed_hold_on_an_arc_keeps_the_limits_and_goes_on(at_s: float) -> None:
    into = line(1, at(2.0), feed=6000.0)
    turn = arc(2, into.end, (2.0, 1.0), 0.75 * CIRCLE)
    away = line(3, at(turn.end[0], turn.end[1] - 2.0))

    def stop(shop: Shop) -> None:
        shop.runner.stop()

    def go_on(shop: Shop) -> None:
        shop.runner.resume()

    places, period_s = run([into, turn, away, end()], (at_s, stop), (at_s + 0.8, go_on))
    assert (accelerations(places, period_s) <= LIMIT * (1 + 1e-4)).all()
    speeds = np.abs(np.diff(places, axis=0)).max(axis=1) / period_s
    rests = np.flatnonzero(speeds == 0.0) * period_s
    first_s = rests[rests > at_s][0] - at_s
    assert first_s <= 10.0 * math.sqrt(2.0) / (0.5 * LIMIT) + 0.03  # twice a ramp from 14 u/s
    assert places[-1] == pytest.approx(away.end[:3], abs=1e-6)


def test_chords_of_an_arc_that_the_card_cannot_run_are_as_fast_as_the_arc() -> None:
    one = arc(1, at(2.0), (0.0, 0.0), 1.0)
    whole = Encoder(Settings(shop().store)).job(one, at(2.0))
    unequal = shop(**{f"P{AXIS.pulses_per_unit[1]}": 2000.0})
    chords = list(Encoder(Settings(unequal.store)).jobs(one, at(2.0)))
    assert len(chords) > 10
    assert {job.feed_ups for job in chords} == {whole.feed_ups}
    assert {job.ramp_ups2 for job in chords} == {whole.ramp_ups2}


def test_chords_whose_corners_are_rounded_get_their_speed_from_the_corners() -> None:
    pace = c.Pace(6000.0, tolerance_u=0.01)
    one = replace(arc(1, at(2.0), (0.0, 0.0), 1.0), pace=pace)
    unequal = shop(**{f"P{AXIS.pulses_per_unit[1]}": 2000.0})
    chords = list(Encoder(Settings(unequal.store), rounds=True).jobs(one, at(2.0)))
    assert {(job.feed_ups, job.ramp_ups2) for job in chords} == {(100.0, LIMIT)}


# --- what is needed and no more ------------------------------------------------------------------


def test_half_of_the_limit_is_left_to_change_speed_at_the_highest_speed_of_an_arc() -> None:
    encoder = Encoder(Settings(shop().store))
    job = encoder.job(arc(1, at(2.0), (0.0, 0.0), 1.0), at(2.0))
    assert job.feed_ups == pytest.approx(math.sqrt(TURNING * LIMIT * 2.0), rel=1e-14)
    assert job.ramp_ups2 == pytest.approx(0.5 * LIMIT, rel=1e-14)


def test_a_slow_arc_has_the_ramp_that_its_turn_leaves() -> None:
    encoder = Encoder(Settings(shop().store))
    job = encoder.job(arc(1, at(0.5), (0.0, 0.0), 1.0, feed=300.0), at(0.5))  # 5^2 / 0.5 = 50
    assert job.feed_ups == 5.0
    assert job.ramp_ups2 == pytest.approx(math.sqrt(LIMIT**2 - 50.0**2), rel=1e-14)


def test_the_weaker_axis_of_the_plane_rules_and_one_without_a_limit_does_not() -> None:
    for own, least in [((30.0, 70.0), 30.0), ((70.0, 30.0), 30.0), ((0.0, 0.0, 5.0), LIMIT)]:
        encoder = Encoder(Settings(shop(**limits(*own)).store))
        job = encoder.job(arc(1, at(2.0), (0.0, 0.0), 1.0), at(2.0))
        assert job.feed_ups == pytest.approx(math.sqrt(TURNING * least * 2.0), rel=1e-14)
        assert job.ramp_ups2 == pytest.approx(0.5 * least, rel=1e-14)


def test_arc_acceleration_counts_turn_and_change_of_speed_together() -> None:
    encoder = Encoder(Settings(shop(**{f"P{SPEEDS.arc_acceleration}": 40.0}).store))
    job = encoder.job(arc(1, at(2.0), (0.0, 0.0), 1.0), at(2.0))
    assert job.feed_ups == pytest.approx(math.sqrt(TURNING * 40.0 * 2.0), rel=1e-14)
    assert job.ramp_ups2 == pytest.approx(20.0, rel=1e-14)


def test_the_part_of_a_helix_along_its_axis_does_not_turn() -> None:
    encoder = Encoder(Settings(shop().store))
    sweep = 1.5
    flat = encoder.job(arc(1, at(2.0), (0.0, 0.0), sweep), at(2.0))
    steep = encoder.job(arc(1, at(2.0), (0.0, 0.0), sweep, rise=4.0), at(2.0))  # 3 along, 4 up
    assert steep.length_u == pytest.approx(5.0)
    assert steep.feed_ups == pytest.approx(flat.feed_ups * 5.0 / 3.0, rel=1e-12)
    assert steep.ramp_ups2 == pytest.approx(flat.ramp_ups2, rel=1e-12)


def test_a_spiral_is_the_same_from_either_end() -> None:
    assert arc_law_cy.arc_skew(2.0, 1.0, 5.0) == arc_law_cy.arc_skew(1.0, 2.0, -5.0)
    assert arc_law_cy.arc_skew(1.0, 2.0, 5.0) == pytest.approx(0.2 / math.sqrt(1.04 * 1.16))
    assert arc_law_cy.arc_skew(1.0, 9.0, 5.0) == 1.0 / 3.0
    assert arc_law_cy.arc_skew(2.0, 2.0, 5.0) == 0.0


@pytest.mark.parametrize("seed", range(60))
def test_the_law_of_a_spiral_holds_for_its_acceleration_vector(seed: int) -> None:
    chance = random.Random(seed)
    begin, last = (10.0 ** chance.uniform(-1, 1) for _ in range(2))
    sweep, limit = chance.uniform(0.3, 9.0), 50.0
    bend = arc_law_cy.arc_bend(begin, last, sweep, 1.0)
    widening = arc_law_cy.arc_widening(begin, last, sweep)
    skew = arc_law_cy.arc_skew(begin, last, sweep)
    top = arc_law_cy.arc_speed(limit, bend)
    speed = chance.uniform(0.05, 1.0) * top
    ramp = arc_law_cy.arc_ramp(limit, bend, widening, skew, speed)
    mean, growth = 0.5 * (begin + last), (last - begin) / sweep
    radius = np.linspace(begin, last, 201)[:, None]
    spin, change = speed / mean, np.array([-ramp, ramp]) / mean
    across = change * growth - spin**2 * radius
    along = change * radius + 2.0 * spin**2 * growth
    worst = np.hypot(across, along).max()
    assert 0.8 * limit < worst <= limit * (1 + 1e-12)


# --- how long it takes ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Piece:
    """A move of the fine grid: its length, the highest squared speed, the ramp."""

    length_u: float
    top_v2: float
    ramp_ups2: float


def piece(entry: c.Entry, begin: c.Point, limit: float) -> Piece:
    """The law by its formulas, for one limit of all axes."""
    if isinstance(entry, c.Arc):
        feed, radius = entry.pace.feed_upm / 60.0, entry.start_radius
        top2 = min(feed * feed, TURNING * limit * radius)
        return Piece(
            radius * abs(entry.sweep_rad), top2, math.sqrt(limit**2 - (top2 / radius) ** 2)
        )
    assert isinstance(entry, c.Line)
    return Piece(math.dist(begin, entry.end), (entry.pace.feed_upm / 60.0) ** 2, limit)


def bound_s(pieces: Sequence[Piece], cells: int = 400) -> float:
    """The least time from rest to rest: squared speed on a grid, forward and backward."""
    step = np.concatenate([np.full(cells, one.length_u / cells) for one in pieces])
    ramp = np.repeat([one.ramp_ups2 for one in pieces], cells)
    top = np.repeat([one.top_v2 for one in pieces], cells)
    w = np.concatenate([[0.0], np.minimum(top[:-1], top[1:]), [0.0]])
    for k, rise in enumerate(2.0 * ramp * step):
        w[k + 1] = min(w[k + 1], w[k] + rise)
    for k, rise in reversed(list(enumerate(2.0 * ramp * step))):
        w[k] = min(w[k], w[k + 1] + rise)
    v = np.sqrt(w)
    return float(np.sum(2.0 * step / (v[:-1] + v[1:])))


def chains(entries: Sequence[c.Entry], limit: float) -> list[list[Piece]]:
    """The pieces between stops."""
    found: list[list[Piece]] = [[]]
    point = at()
    for entry in entries:
        if isinstance(entry, c.Line | c.Arc):
            found[-1].append(piece(entry, point, limit))
            point = entry.end
        elif found[-1]:
            found.append([])
    return [chain for chain in found if chain]


@pytest.mark.parametrize("seed", sparse(range(12)))
def test_the_time_is_that_of_the_fastest_speed_under_the_same_law(seed: int) -> None:
    entries = smooth_chain(seed)
    predictor = Predictor(Settings(shop().store), at())
    for entry in entries:
        predictor.add(entry)
    predictor.close()
    fastest_s = sum(bound_s(chain) for chain in chains(entries, LIMIT))
    assert 0.999 * fastest_s <= predictor.found.feed_s <= 1.001 * fastest_s


def free_bound_s(pieces: Sequence[c.Arc], limit: float, cells: int = 4000) -> float:
    """The least time of arcs from rest to rest if the ramp could change with the speed."""
    step = np.concatenate(
        [np.full(cells, one.start_radius * abs(one.sweep_rad) / cells) for one in pieces]
    )
    radius = np.repeat([one.start_radius for one in pieces], cells)
    most = np.minimum(limit * radius[:-1], limit * radius[1:])
    w = np.concatenate([[0.0], most, [0.0]])
    for k in range(len(step)):
        rest = max(limit**2 - (w[k] / radius[k]) ** 2, 0.0)
        w[k + 1] = min(w[k + 1], w[k] + 2.0 * math.sqrt(rest) * step[k])
    for k in reversed(range(len(step))):
        rest = max(limit**2 - (w[k + 1] / radius[k]) ** 2, 0.0)
        w[k] = min(w[k], w[k + 1] + 2.0 * math.sqrt(rest) * step[k])
    v = np.sqrt(w)
    return float(np.sum(2.0 * step / (v[:-1] + v[1:])))


def test_a_circle_from_rest_takes_a_sixth_longer_than_with_a_ramp_that_follows_the_speed() -> None:
    circle = arc(1, at(2.0), (0.0, 0.0), CIRCLE)
    predictor = Predictor(Settings(shop().store), at(2.0))
    for entry in (circle, end()):
        predictor.add(entry)
    predictor.close()
    assert predictor.found.feed_s / free_bound_s([circle], LIMIT) == pytest.approx(1.174, abs=0.001)


def test_on_a_planned_path_the_turn_of_an_arc_takes_arc_acceleration_alone() -> None:
    cells = {f"P{SPEEDS.path_jerk}": 800.0, f"P{SPEEDS.path_tolerance}": 0.001}
    encoder = Encoder(Settings(shop(**cells, **limits(30.0)).store))
    job = encoder.job(arc(1, at(2.0), (0.0, 0.0), 1.0), at(2.0))
    assert job.path_tolerance_u == 0.001
    assert job.feed_ups == pytest.approx(math.sqrt(LIMIT * 2.0), rel=1e-14)


def test_the_tangents_of_an_arc_are_a_quarter_turn_ahead_of_its_radii() -> None:
    end_u = (0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    job = Encoder(Settings(shop().store)).job(
        c.Arc(src(1), end_u, c.Plane.XY, (0.0, 0.0), 0.5 * math.pi, 2.0, 2.0, c.Pace(60.0)),
        at(2.0),
    )
    assert job.start == pytest.approx((0.0, 1.0, 0.0), abs=1e-15)
    assert job.end == pytest.approx((-1.0, 0.0, 0.0), abs=1e-15)
