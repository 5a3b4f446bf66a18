"""Circles, helix, spline, NURB and arm: the paths they are meant to draw."""

import math
from functools import lru_cache

import numpy as np
import pytest
from scipy.interpolate import BSpline
from tests.examples.observe import load

pytestmark = pytest.mark.evidence("oracle", "circles by formula, B-splines of scipy")

VELOCITY = 8193


@lru_cache
def course(example: str, seconds: float) -> np.ndarray:
    """Time, commanded places of three axes, vector velocity, tick by tick."""
    card = load(example)
    card.send("PROG0\rRUN\r")
    rows = []
    for _ in range(round(seconds / card.period_s)):
        card.advance(1)
        places = [card.axis(axis).commanded_u for axis in range(3)]
        rows.append([card.tick * card.period_s, *places, card.p[VELOCITY]])
    return np.array(rows)


def largest_jump_ups(path: np.ndarray) -> float:
    """The largest change of an axis velocity from tick to tick."""
    velocity = np.diff(path[:, 1:4], axis=0) / 0.0005
    return float(np.abs(np.diff(velocity, axis=0)).max())


def test_the_first_circle_is_round_and_the_last_one_an_ellipse() -> None:
    path = course("circles", 9.6)
    first = path[(path[:, 0] > 0.01) & (path[:, 0] < 2.56)]
    assert np.hypot(first[:, 1] - 20, first[:, 2]) == pytest.approx(20, abs=1e-9)
    last = path[(path[:, 0] > 7.34) & (path[:, 0] < 9.5)]
    ring = np.hypot((last[:, 1] - 20) / 20, (last[:, 2] - 30) / 5)
    assert ring == pytest.approx(1, abs=1e-9)


def test_a_rounded_corner_is_run_through_at_full_speed() -> None:
    path = course("circles", 9.6)
    corner = path[(np.abs(path[:, 1] - 25) < 4) & (np.abs(path[:, 2] - 3) < 3) & (path[:, 0] > 5)]
    assert len(corner) > 100
    assert corner[:, 4] == pytest.approx(50, abs=1e-3)


def test_every_turn_of_the_helix_goes_down_evenly() -> None:
    path = course("helix", 9.0)
    down = path[(path[:, 3] < -0.01) & (path[:, 3] > -5.99) & (path[:, 0] < 7)]
    turned = np.unwrap(np.arctan2(down[:, 2], down[:, 1]))
    assert np.hypot(down[:, 1], down[:, 2]) == pytest.approx(15, abs=1e-9)
    assert np.diff(down[:, 3]) == pytest.approx(-2 * np.diff(turned) / math.tau, abs=1e-9)
    assert largest_jump_ups(path) < 5.0


def test_the_camera_never_jerks_and_keeps_its_times() -> None:
    path = course("spline_curve", 15.1)
    assert largest_jump_ups(path) < 1.001 * 1000 * 0.0005 + 0.2
    second = path[(path[:, 0] > 9.0) & (path[:, 0] < 14.9)]
    speed = np.hypot(*(np.diff(second[:, 1:3], axis=0) / 0.0005).T)
    assert speed == pytest.approx(50, rel=1e-3)


def test_the_wire_follows_the_curve_of_de_boor_at_constant_speed() -> None:
    path = course("nurb_airfoil", 12.0)
    cut = path[(path[:, 0] > 1.3) & (path[:, 0] < 11.5)]
    assert cut[:, 4] == pytest.approx(20, abs=1e-4)
    points = [(100, 0), (75, 5), (40, 10), (0, 11), (0, 0), (0, -5), (40, -4), (75, -1), (100, 0)]
    weights = np.array([1, 1, 1, 1, 2, 1, 1, 1, 1.0])
    knots = [0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 6, 6, 6]
    homogeneous = np.column_stack([np.array(points) * weights[:, None], weights])
    values = BSpline(knots, homogeneous, 3)(np.linspace(0, 6 - 1e-9, 60001))
    curve = values[:, :2] / values[:, 2:]
    for place in cut[::200, 1:3]:
        assert np.hypot(*(curve - place).T).min() < 0.003


def test_the_hand_draws_straight_sides() -> None:
    path = course("invk_arm", 4.0)
    drawn = path[(path[:, 0] > 1.47) & (path[:, 0] < 3.84)]
    shoulder, elbow = np.radians(drawn[:, 1]), np.radians(drawn[:, 1] + drawn[:, 2])
    x = 200 * (np.cos(shoulder) + np.cos(elbow))
    y = 200 * (np.sin(shoulder) + np.sin(elbow))
    sides = np.minimum.reduce([np.abs(y), np.abs(x - 250), np.abs(y - 50), np.abs(x - 200)])
    assert sides.max() < 1e-3
    assert (x.max(), y.max()) == pytest.approx((250, 50), abs=1e-3)


def test_the_carriage_stays_beside_the_cut_while_the_knife_is_down() -> None:
    card = load("cam_flying_shear")
    card.send("PROG0\rRUN\r")
    distances: dict[int, list[float]] = {}
    for _ in range(14_000):
        card.advance(1)
        if card.bit[32]:
            sheet, carriage = (card.axis(axis).actual_u for axis in (0, 1))
            distances.setdefault(int(sheet // 100), []).append(sheet - carriage)
    assert len(distances) == 8
    for number, seen in distances.items():
        # What the smoothed feed-forward of the cam lags in the beginning has gone by then.
        late = seen[len(seen) // 2 :]
        assert late == pytest.approx([10 + 100 * number] * len(late), abs=0.05)


def test_the_gear_box_turns_the_encoder_into_a_distance() -> None:
    card = load("gear_box")
    card.send("PROG0\rRUN\r")
    card.advance(seconds=2.0)
    x, y = (card.axis(axis).commanded_u for axis in (0, 1))
    card.advance(seconds=0.5)
    ratio = (card.axis(1).commanded_u - y) / (card.axis(0).commanded_u - x)
    assert ratio == pytest.approx(0.5, abs=1e-3)
    card.advance(seconds=1.5)
    x, y = (card.axis(axis).commanded_u for axis in (0, 1))
    card.advance(seconds=0.5)
    ratio = (card.axis(1).commanded_u - y) / (card.axis(0).commanded_u - x)
    assert ratio == pytest.approx(-0.25, abs=1e-3)


def test_the_feet_of_the_portal_stay_together_and_closer_with_feedback() -> None:
    card = load("gantry_lock")
    card.send("PROG0\rRUN\r")
    apart = []  # pulses, largest outwards and back
    for _ in range(2):
        apart.append(0)
        for _ in range(380):
            card.advance(seconds=0.005)
            assert card.axis(0).commanded_u == pytest.approx(card.axis(1).commanded_u, abs=1e-9)
            now = abs(card.axis(0).actual_cnt - card.axis(1).actual_cnt)
            apart[-1] = max(apart[-1], now)
        card.advance(seconds=0.3)
    assert apart[0] == pytest.approx(51, abs=3)
    assert apart[1] < apart[0] / 3
