"""A machine in inches with a jerk limit: its path is planned, and followed tick by tick."""

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from tests.mill.shop import PULSES, Shop, at, end, line

from openacr.cnc import canonical as c
from openacr.engine.samples import Sample
from openacr.engine.watches import Watched
from openacr.map.rows import axes as axis_rows
from openacr.mill.config.overrides import Override
from openacr.mill.run.lifecycle import Options
from openacr.sysvar.tabs import FOV, SPEEDS

Reals = NDArray[np.float64]
Point = tuple[float, ...]
Action = Callable[[Shop], None]
SPEED, ACCEL, JERK = 100.0, 1000.0, 20_000.0
FEED = 60.0 * SPEED
TOLERANCE = 0.01
TICKS = 10  # between two polls
SQUARE = [(30.0, 0.0), (30.0, 30.0), (0.0, 30.0), (0.0, 0.0)]


def planned_shop(**cells: float) -> Shop:
    """A machine that plans its paths."""
    own = {
        f"P{SPEEDS.path_jerk}": JERK,
        f"P{SPEEDS.master_feed_acc_dec}": ACCEL,
        f"P{SPEEDS.master_rapid_acc_dec}": ACCEL,
        f"P{SPEEDS.max_machine_speed}": FEED,
    }
    return Shop(**own | cells)


def path(points: Sequence[Point], feed: float = FEED, tolerance: float = TOLERANCE) -> list[c.Line]:
    """Lines to points, with a tolerance."""
    return [
        line(k, at(*point), feed=feed, tolerance_u=tolerance)
        for k, point in enumerate(points, start=1)
    ]


def square(**pace: float) -> list[c.Entry]:
    return [*path(SQUARE, **pace), end()]


def wave(count: int = 100) -> list[Point]:
    """Chords of 0.4 mm along a curve in space."""
    return [(0.4 * k, 2.0 * math.sin(0.1 * k), math.cos(0.12 * k) - 1.0) for k in range(1, count)]


def stop(shop: Shop) -> None:
    """Press feed hold."""
    shop.runner.stop()


def go_on(shop: Shop) -> None:
    """Resume."""
    shop.runner.resume()


def feed(percent: float) -> Action:
    """Turn the override switch to a click of this percentage."""

    def turn(shop: Shop) -> None:
        clicks = [shop.store.read(cell) for cell in FOV.percents]
        shop.runner.overrides.choose(Override.FEED, clicks.index(percent))

    return turn


def follow(
    shop: Shop,
    *entries: c.Entry,
    options: Options | None = None,
    actions: Sequence[tuple[float, Action]] = (),
    limit_s: float = 60.0,
) -> Reals:
    """Where X Y Z are commanded to stand, tick by tick, with what is done at which second."""
    if entries:
        shop.start(*entries, options=options)
    return recorded(shop, 3, actions, limit_s) / PULSES


def recorded(
    shop: Shop, axes: int, actions: Sequence[tuple[float, Action]], limit_s: float = 60.0
) -> Reals:
    """Where axes are commanded to stand in a run, tick by tick [pulses]."""
    card, left, ticks = shop.controller, list(actions), 0
    rows = [axis_rows.psp_cnt[axis] for axis in range(axes)]
    card.record(samples=[Sample(Watched.FP64, row) for row in rows])
    while shop.runner.is_busy or left:
        card.advance(TICKS)
        ticks += TICKS
        now_s = ticks * card.period_s
        assert now_s < limit_s, shop.runner.state
        while left and left[0][0] <= now_s:
            left.pop(0)[1](shop)
        shop.runner.step()
    found: Reals = card.trace().values
    card.end_record()
    return found


def highest(places: Reals, period_s: float, every: int = 1) -> tuple[float, float, float]:
    """Speed on the path, acceleration and jerk of any axis, by differences of samples."""
    found = []
    for phase in range(every):
        samples, step_s = places[phase::every], every * period_s
        speed = np.linalg.norm(np.diff(samples, axis=0), axis=1).max() / step_s
        accel = np.abs(np.diff(samples, 2, axis=0)).max() / step_s**2
        found.append((speed, accel, np.abs(np.diff(samples, 3, axis=0)).max() / step_s**3))
    return tuple(np.array(found).max(axis=0))


def off_path(places: Reals, points: Sequence[Point]) -> float:
    """The largest distance of a place from the polyline that begins at 0."""
    best = np.full(len(places), np.inf)
    corners = np.array([(0.0, 0.0, 0.0), *((*point, 0.0, 0.0)[:3] for point in points)])
    for a, b in pairwise(corners):
        along = b - a
        part = np.clip(((places - a) @ along) / max(along @ along, 1e-30), 0, 1)
        best = np.minimum(best, np.linalg.norm(places - (a + part[:, None] * along), axis=1))
    return float(best.max())


def motion_s(places: Reals, period_s: float) -> float:
    """From the first tick in which something moves to the last."""
    moving = np.flatnonzero(np.abs(np.diff(places, axis=0)).max(axis=1) > 0.0)
    return float(moving[-1] - moving[0] + 1) * period_s
