"""Overrides on a planned path over a link: when they act, and that the card never lacks path."""

import itertools
import random

import numpy as np
import pytest
from tests.mill.planned import ACCEL, FEED, JERK, SPEED, TOLERANCE, Point, Reals, highest, off_path
from tests.mill.test_planned_lost_host import PULSES, Host
from tests.mill.test_planned_overrides import (
    HALF,
    KINDS_AND_TIMES,
    MOST,
    PATHS,
    ROUNDING2,
    ROUNDING3,
)
from tests.search import sparse

from openacr.cnc.occupied import RAN_SHORT
from openacr.map.rows import masters
from openacr.mill.config.overrides import Override
from openacr.mill.run.lifecycle import State
from openacr.sysvar import Store
from openacr.sysvar.tabs import FOV

ON_THE_WAY_S = 0.08  # of path beyond what waits on the card: what is taken, and two polls
RISES_S = 0.08  # from one speed to another that is 0.1 % more, and the spline in time


def turn(host: Host, percent: float) -> None:
    """Turn the override switch to a click of this percentage."""
    clicks = [Store().read(cell) for cell in FOV.percents]
    host.session.runner.overrides.choose(Override.FEED, clicks.index(percent))


def speeds(host: Host) -> Reals:
    """The speed along the path, tick by tick [mm/s]."""
    found: Reals = np.linalg.norm(np.diff(host.places, axis=0), axis=1) / host.card.period_s
    return found


def waiting_s(host: Host) -> float:
    """How much of the path waits on the card."""
    return 0.004 * float(host.card.p[masters.mbuf_filled[0]])


def require_path(host: Host, points: list[Point], tolerance: float = TOLERANCE) -> None:
    """Assert that no limit is exceeded in any tick, and that the card never lacked path."""
    speed, accel, jerk = highest(host.places, host.card.period_s)
    assert speed <= SPEED * (1 + 1e-4)
    assert accel <= ACCEL * (1 + ROUNDING2)
    assert jerk <= JERK * (1 + ROUNDING3)
    assert off_path(host.places, points) <= tolerance
    assert not host.card.bit[RAN_SHORT]
    assert host.said == []


def require_end(host: Host, points: list[Point]) -> None:
    assert host.session.runner.state is State.IDLE
    assert host.places[-1] == pytest.approx([*points[-1], 0.0, 0.0][:3], abs=0.5 / PULSES)


@pytest.mark.parametrize(("kind", "at_s"), KINDS_AND_TIMES)
def test_a_faster_feed_acts_after_what_waits_on_the_card(kind: str, at_s: float) -> None:
    host = Host(PATHS[kind], 0.5 * FEED)
    host.live(at_s)
    now, waits_s = len(host.places), waiting_s(host)
    turn(host, MOST)
    host.finish()
    faster = np.flatnonzero(speeds(host) > 1.001 * HALF)[0] - now
    acts_s = faster * host.card.period_s
    assert waits_s < acts_s <= waits_s + ON_THE_WAY_S + RISES_S
    assert acts_s <= 0.6
    require_path(host, PATHS[kind])
    require_end(host, PATHS[kind])
    assert speeds(host).max() == pytest.approx(0.01 * MOST * HALF, rel=2e-3)


@pytest.mark.parametrize(("kind", "percent"), [("leg", 30.0), ("chords", 70.0), ("bent", 30.0)])
def test_a_slower_feed_acts_after_what_waits_on_the_card(kind: str, percent: float) -> None:
    host = Host(PATHS[kind], 0.5 * FEED)
    host.live(0.627)
    now, waits_s = len(host.places), waiting_s(host)
    turn(host, percent)
    host.live(1.2)
    slower = np.flatnonzero(speeds(host)[now:] < 0.999 * HALF)[0]
    assert waits_s - 0.01 < slower * host.card.period_s <= waits_s + ON_THE_WAY_S + RISES_S
    assert speeds(host)[-1] == pytest.approx(0.01 * percent * HALF, rel=1e-3)
    require_path(host, PATHS[kind])


@pytest.mark.parametrize(("kind", "seed"), sparse(list(itertools.product(PATHS, range(3))), 3))
def test_a_host_that_is_a_little_late_keeps_path_and_limits_under_any_overrides(
    kind: str, seed: int
) -> None:
    chance, host = random.Random(seed), Host(PATHS[kind], 0.5 * FEED)
    for _ in range(10):
        host.live(chance.uniform(0.02, 0.5))
        turn(host, chance.choice([MOST, MOST, 120.0, 100.0, 70.0, 30.0]))
        host.silent(chance.uniform(0.0, 0.06))
    turn(host, 100.0)
    host.finish()
    require_path(host, PATHS[kind])
    require_end(host, PATHS[kind])


@pytest.mark.parametrize(
    ("kind", "hold_s"), sparse(list(itertools.product(["leg", "chords"], [0.05, 0.5, 0.6, 0.8])), 3)
)
def test_a_feed_hold_after_a_faster_feed_keeps_path_and_limits(kind: str, hold_s: float) -> None:
    host = Host(PATHS[kind], 0.5 * FEED)
    host.live(0.6)
    turn(host, MOST)
    host.live(hold_s)
    before = len(host.places)
    host.session.runner.stop()
    host.live(1.0)
    still = np.flatnonzero(speeds(host)[before:] == 0.0)[0] * host.card.period_s
    assert still <= 0.35
    host.session.runner.resume()
    host.finish()
    require_path(host, PATHS[kind], 2 * TOLERANCE)
    require_end(host, PATHS[kind])
