"""Setpoints of a planned program against closed forms, and those of runs against the plan."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.mill.planned import ACCEL, JERK, SPEED, SQUARE, follow, highest, path, planned_shop, wave
from tests.mill.shop import PULSES, Shop, at, end, line, rapid, src
from tests.mill.test_predicting import some_program
from tests.search import sparse

from openacr.cnc import canonical as c
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.estimate.trajectory import Trajectory

Reals = NDArray[np.float64]
PERIOD_S = 0.0005


def sampled(
    entries: Sequence[c.Entry], period_s: float = PERIOD_S, shop: Shop | None = None
) -> tuple[Reals, float]:
    """Rows of time, position and line of a plan, and its predicted time."""
    shop = shop or Shop()
    parts: list[Reals] = []
    trajectory = Trajectory(Settings(shop.store), period_s, parts.append)
    predictor = Predictor(Settings(shop.store), at(), reader=trajectory)
    for entry in entries:
        predictor.add(entry)
    predictor.rest()
    trajectory.close()
    return np.concatenate(parts), predictor.found.time_s


def test_a_move_follows_its_trapezoid() -> None:
    # 10 units/s, 100 units/s2, 5 units: 0.1 s up, 0.4 s along, 0.1 s down
    rows, time_s = sampled([line(7, at(3, 4)), end()], 0.01)
    t = rows[:, 0]
    assert t.tolist() == pytest.approx([0.01 * k for k in range(61)])
    assert time_s == pytest.approx(0.6)
    s = np.where(t < 0.1, 50 * t**2, np.where(t < 0.5, 10 * t - 0.5, 5 - 50 * (0.6 - t) ** 2))
    assert rows[:, 1] == pytest.approx(0.6 * s)
    assert rows[:, 2] == pytest.approx(0.8 * s)
    assert set(rows[:, -1]) == {7.0}


def test_an_arc_is_followed_at_its_radius_and_a_spiral_at_its_changing_one() -> None:
    entries: list[c.Entry] = [
        rapid(2, at(1, 0)),
        c.Arc(src(3), at(0, 2), c.Plane.XY, (0.0, 0.0), math.pi / 2, 1.0, 2.0, c.Pace(600)),
        end(),
    ]
    rows, _ = sampled(entries)
    cut = rows[rows[:, -1] == 3]
    radius, angle = np.hypot(cut[:, 1], cut[:, 2]), np.arctan2(cut[:, 2], cut[:, 1])
    assert radius == pytest.approx(1 + angle / (math.pi / 2))
    assert cut[-1, 1:3] == pytest.approx([0, 2], abs=1e-12)


def test_a_dwell_keeps_the_place_and_counts_in_the_time() -> None:
    rows, time_s = sampled([line(1, at(1)), c.Dwell(src(2), 0.25), line(3, at(0)), end()])
    rests = rows[rows[:, 1] == 1.0]
    assert rests[-1, 0] - rests[0, 0] == pytest.approx(0.25, abs=PERIOD_S)
    assert rows[-1, 0] == pytest.approx(time_s)
    assert time_s == pytest.approx(2 * 0.2 + 0.25)


def test_a_rounded_corner_is_cut_by_the_tolerance_and_by_no_more() -> None:
    pace = c.Pace(600, tolerance_u=0.01)
    entries: list[c.Entry] = [c.Line(src(1), at(1), pace), c.Line(src(2), at(1, 1), pace), end()]
    shop = Shop()
    parts: list[Reals] = []
    trajectory = Trajectory(Settings(shop.store), 1e-4, parts.append)
    predictor = Predictor(Settings(shop.store), at(), rounds=True, reader=trajectory)
    for entry in entries:
        predictor.add(entry)
    predictor.rest()
    trajectory.close()
    rows = np.concatenate(parts)
    away = np.hypot(1 - rows[:, 1], rows[:, 2])
    assert away.min() == pytest.approx(0.01, rel=0.02)
    assert (rows[:, 1] <= 1 + 1e-12).all() and (rows[:, 2] >= 0).all()
    assert rows[-1, 1:3].tolist() == [1.0, 1.0]


@pytest.mark.parametrize("seed", sparse(range(8), 4))
def test_random_plans_never_jump_and_end_where_the_program_does(seed: int) -> None:
    entries = some_program(seed)
    rows, time_s = sampled(entries)
    steps = np.hypot(*np.diff(rows[:, 1:3], axis=0).T)
    rapids = [entry.source.line for entry in entries if isinstance(entry, c.Rapid)]
    at_feed = ~np.isin(rows[:, -1], rapids)
    assert steps[at_feed[1:] & at_feed[:-1]].max() <= 15.0 * PERIOD_S * 1.0001  # 900 units/min
    assert rows[-1, 0] == pytest.approx(time_s)
    last = next(e for e in reversed(entries) if isinstance(e, c.Line | c.Rapid | c.Arc))
    assert rows[-1, 1:-1].tolist() == list(last.end)[: rows.shape[1] - 2]
    assert (np.diff(rows[:, 0]) > 0).all()


def planned(*entries: c.Entry) -> tuple[Reals, float]:
    """The same on a machine that plans its paths."""
    return sampled(entries, shop=planned_shop())


def test_a_planned_curve_is_sampled_where_the_card_runs_it() -> None:
    entries: list[c.Entry] = [*path([*SQUARE, *wave(20)]), end()]
    rows, time_s = planned(*entries)
    assert rows[-1, 0] == pytest.approx(time_s)
    assert np.diff(rows[:, 0])[:-1] == pytest.approx(PERIOD_S)
    assert rows[-1, 1:4] == pytest.approx([*wave(20)[-1]], abs=1e-12)
    _, acceleration, jerk = highest(rows[:-1, 1:4], PERIOD_S, every=4)
    assert acceleration < 1.001 * ACCEL and jerk < 1.001 * JERK
    run = follow(planned_shop(), *entries)
    moving = np.flatnonzero(np.abs(np.diff(run, axis=0)).max(axis=1) > 0.0)
    run = run[moving[0] :][: len(rows)]
    assert np.abs(run - rows[: len(run), 1:4]).max() < 1.0 / PULSES


def test_curves_moves_and_dwells_follow_each_other_in_time() -> None:
    curve, alone = path([(20.0, 0.0), (20.0, 10.0)]), line(7, at(0, 10))
    _, first_s = planned(*curve, end())
    last = line(9, at(0, 10))
    rows, time_s = planned(*curve, alone, *curve, c.Dwell(src(8), 0.5), last, end())
    assert rows[-1, 0] == pytest.approx(time_s)
    assert np.diff(rows[:, 0])[:-1] == pytest.approx(PERIOD_S)
    begins = {number: rows[rows[:, -1] == number][0] for number in (1, 2, 7)}
    assert begins[7][0] == pytest.approx(first_s, abs=PERIOD_S)
    assert begins[7][1:3] == pytest.approx([20.0, 10.0], abs=1e-3)
    assert begins[2][1:3] == pytest.approx([20.0, 0.0], abs=0.05)
    steps = np.linalg.norm(np.diff(rows[:, 1:4], axis=0), axis=1)
    assert steps.max() < 1.001 * SPEED * PERIOD_S
    assert np.count_nonzero(steps == 0.0) >= 0.5 / PERIOD_S - 1


def test_nothing_planned_is_one_row_at_rest() -> None:
    rows, time_s = sampled([end()])
    assert (rows[:, 0].tolist(), time_s) == ([0.0], 0.0)
