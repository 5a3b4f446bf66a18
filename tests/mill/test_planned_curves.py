"""Paths with a tolerance under a jerk limit: planned on the host, sent as NURBs."""

import math

import numpy as np
import pytest
from tests.mill.planned import (
    ACCEL,
    FEED,
    JERK,
    SPEED,
    SQUARE,
    TOLERANCE,
    follow,
    highest,
    motion_s,
    off_path,
    path,
    planned_shop,
    square,
    wave,
)
from tests.mill.prediction import predicted
from tests.mill.shop import PULSES, at, end, line, rapid, src

from openacr.cnc import canonical as c
from openacr.cnc.loading.load import load
from openacr.map.rows import masters
from openacr.mill.config.curves import PERIOD_S, can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.planned_path import PlannedPath
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import GENERAL, SPEEDS
from openacr.trajectory import Setpoints, evaluate

ROUNDING = 0.03  # of the jerk: positions of 24 bits over the cube of 4 ms


def circle(radius: float) -> list[c.Entry]:
    pace = c.Pace(FEED, tolerance_u=TOLERANCE)
    arc = c.Arc(src(2), at(4.0), c.Plane.XY, (4.0 + radius, 0.0), 2 * math.pi, radius, radius, pace)
    return [line(1, at(4.0), feed=FEED, tolerance_u=TOLERANCE), arc, end()]


PROGRAMS: dict[str, list[c.Entry]] = {
    "square": square(),
    "wave": [*path(wave()), end()],
    "circle": circle(5.0),
    "rapids": [*path(SQUARE[:2]), rapid(3, at(1.0, 2.0, 3.0)), *path(SQUARE[2:]), end()],
    "plunge": [
        *path([(10.0, 0.0)], 0.5 * FEED), rapid(2, at(30.0)), rapid(3, at(30.0, 30.0, 5.0)),
        rapid(4, at(30.0, 30.0, 2.0)), line(5, at(30.0, 30.0), feed=600.0, tolerance_u=TOLERANCE),
        end(),
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_card_keeps_every_limit_in_every_tick_and_ends_on_the_pulse(name: str) -> None:
    shop, program = planned_shop(), PROGRAMS[name]
    places = follow(shop, *program)
    last = next(e for e in reversed(program) if isinstance(e, c.Line | c.Arc | c.Rapid))
    assert shop.pulses() == tuple(round(value * PULSES) for value in last.end[:3])
    period_s = shop.controller.period_s
    for every in (1, round(0.001 / period_s)):
        speed, accel, jerk = highest(places, period_s, every)
        assert 0.5 * SPEED < speed <= SPEED * (1 + 1e-4)
        assert 0.7 * ACCEL < accel <= ACCEL
        assert 0.7 * JERK < jerk <= JERK * (1 + ROUNDING)


@pytest.mark.parametrize("points", [SQUARE, wave()])
def test_the_path_stays_within_the_tolerance(points: list[tuple[float, ...]]) -> None:
    places = follow(planned_shop(), *path(points), end())
    assert off_path(places, points) <= TOLERANCE


def test_the_setpoints_of_the_card_are_those_of_the_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[Setpoints] = []
    take = PlannedPath.take

    def noted(self: PlannedPath, most: int) -> Setpoints | None:
        found = take(self, most)
        taken.extend([found] if found is not None else [])
        return found

    monkeypatch.setattr(PlannedPath, "take", noted)
    shop = planned_shop()
    places = follow(shop, *path(wave()), end())
    points = np.concatenate(
        [taken[0].points[:1], *(found.points for found in taken), taken[-1].rest]
    )
    period_s = shop.controller.period_s
    planned = evaluate(points, np.arange(0.0, len(points), period_s / PERIOD_S))[0]
    begin = int(np.flatnonzero((places != 0.0).any(axis=1))[0])
    count = min(len(places) - begin, len(planned) - 1)
    apart = np.linalg.norm(places[begin : begin + count] - planned[1 : 1 + count], axis=1)
    assert count > 1000
    assert apart.max() * PULSES < 0.1


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_prediction_is_the_time_of_the_card_to_two_ticks(name: str) -> None:
    shop, program = planned_shop(), PROGRAMS[name]
    expected_s = predicted(program, Settings(shop.store), at()).time_s
    period_s = shop.controller.period_s
    assert motion_s(follow(shop, *program), period_s) == pytest.approx(expected_s, abs=2 * period_s)


def test_a_larger_tolerance_saves_time() -> None:
    times = []
    for tolerance in (0.001, 0.01, 0.05):
        shop = planned_shop()
        places = follow(shop, *square(tolerance=tolerance))
        times.append(motion_s(places, shop.controller.period_s))
        assert 0.5 * tolerance < off_path(places, SQUARE) <= tolerance
    assert times[0] > times[1] + 0.03
    assert times[1] > times[2] + 0.03


def test_the_tolerance_of_the_machine_holds_where_the_program_gives_none() -> None:
    shop = planned_shop(**{f"P{SPEEDS.path_tolerance}": 0.05})
    places = follow(shop, *square(tolerance=0.0))
    assert 0.03 < off_path(places, SQUARE) <= 0.05
    shop = planned_shop(**{f"P{SPEEDS.path_tolerance}": 0.05})
    corner = [line(k, at(*p), feed=FEED, mode=c.PathMode.CORNER) for k, p in enumerate(SQUARE, 1)]
    assert (follow(shop, *corner, end()) == places).all()


@pytest.mark.parametrize(
    "pace", [{"mode": c.PathMode.EXACT}, {"is_confirmed": True}, {"is_locked": True}]
)
def test_exact_stops_and_locked_feeds_are_no_part_of_a_curve(pace: dict[str, object]) -> None:
    shop = planned_shop(**{f"P{SPEEDS.path_tolerance}": 0.05})
    moves = [line(k, at(*p), feed=FEED, **pace) for k, p in enumerate(SQUARE, 1)]
    assert off_path(follow(shop, *moves, end()), SQUARE) < 1e-9


def test_without_a_jerk_limit_nothing_is_planned() -> None:
    places = follow(planned_shop(**{f"P{SPEEDS.path_jerk}": 0.0}), *square())
    assert highest(places, 0.0005)[2] > 10 * JERK


def test_a_card_without_nurbs_gets_moves() -> None:
    store = Store()
    store.write(SPEEDS.path_jerk, JERK)
    store.write(SPEEDS.path_tolerance, 0.05)
    assert can_plan(Settings(store))
    store.write_text(GENERAL.card_model, "ACR1500")
    assert not can_plan(Settings(store))
    made = load(b"G21 G64 P0.1\nG1 X10 F3000\nY10\nM2\n", store, "rs274ngc")
    session = MillSession.virtual(store, say=lambda _text: None)
    session.start(made, Start(dialect="rs274ngc", is_repeated=False))
    while session.runner.is_busy:
        session.step()
    assert session.runner.state is State.IDLE
    assert session.runner.stream.host.position()[:2] == (0.3937, 0.3937)


def test_exact_moves_curves_dwells_and_rapids_follow_each_other() -> None:
    shop = planned_shop()
    places = follow(
        shop,
        line(1, at(10.0), feed=FEED, mode=c.PathMode.EXACT),
        *path([(10.0, 10.0), (0.0, 10.0)]),
        c.Dwell(src(3), 0.1),
        *path([(0.0, 20.0), (5.0, 20.0)]),
        rapid(4, at(5.0, 0.0)),
        line(5, at(0.0, 0.0), feed=FEED, mode=c.PathMode.EXACT),
        end(),
    )
    assert tuple(places[-1]) == (0.0, 0.0, 0.0)
    corners = [(10, 0), (10, 10), (0, 10), (0, 20), (5, 20), (5, 0), (0, 0)]
    assert off_path(places, corners) <= TOLERANCE
    for rest in [(10.0, 0.0, 0.0), (0.0, 10.0, 0.0), (5.0, 0.0, 0.0)]:
        assert np.linalg.norm(places - rest, axis=1).min() == 0.0


def test_the_executing_line_follows_the_tool() -> None:
    shop, seen = planned_shop(), []
    shop.start(*square())
    while shop.runner.is_busy:
        shop.pass_time(0.005)
        source = shop.runner.source
        if source is not None:
            seen.append((source.line, shop.place()))
    for number, (x, y) in enumerate(SQUARE, start=1):
        places = [place for line_number, place in seen if line_number == number]
        assert len(places) > 50
        assert math.dist(places[-1][:2], (x, y)) < 1.5
    assert [a for a, _ in seen] == sorted(a for a, _ in seen)


def test_notes_act_when_their_move_is_done() -> None:
    shop = planned_shop()
    first, second, *others = square()
    follow(shop, first, second, c.Say(src(2), "half"), *others)
    assert shop.said == ["half"]


def test_the_card_never_runs_out_of_points() -> None:
    shop, filled = planned_shop(), []
    shop.start(*path(wave()), end())
    while shop.runner.is_busy:
        shop.pass_time(0.005)
        if shop.controller.p[masters.vector_velocity[0]] > 0.0:
            filled.append(shop.controller.p[masters.mbuf_filled[0]])
    middle = filled[3:-12]
    assert min(middle) >= 7
    assert max(middle) <= 10


def test_a_second_program_begins_where_the_first_one_ended() -> None:
    shop = planned_shop()
    follow(shop, *path(SQUARE[:2]), end())
    follow(shop, *path([(0.0, 0.0)]), end())
    assert shop.pulses() == (0, 0, 0)
