"""G64 P on the virtual machine: corners rounded within P, at the acceleration, in less time."""

import math
import random
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.mill.planned import motion_s, recorded
from tests.mill.prediction import predicted
from tests.mill.shop import PULSES, Shop, at, end, line, rapid, src
from tests.search import sparse

from openacr.cnc import canonical as c
from openacr.cnc.loading.load import load
from openacr.controller import Controller
from openacr.mill.config.settings import Settings
from openacr.mill.plan.moves.encoding import Encoder
from openacr.mill.run.lifecycle import State
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.tabs import AXIS, SPEEDS

ACCEL = 100.0  # units/s2 of feed moves
Reals = NDArray[np.float64]
Point = tuple[float, float]


def followed(shop: Shop, *entries: c.Entry) -> Reals:
    """Where X and Y are commanded to stand, tick by tick."""
    shop.start(*entries)
    return recorded(shop, 2, ()) / PULSES


def lines(points: Sequence[Point], feed: float = 900.0, **pace: object) -> list[c.Entry]:
    moves = [line(k, at(*point), feed=feed, **pace) for k, point in enumerate(points, start=1)]
    return [*moves, end()]


def off_path(places: Reals, points: Sequence[Point]) -> float:
    """The largest distance of a place from the polyline that begins at 0."""
    best = np.full(len(places), np.inf)
    for a, b in pairwise(np.array([(0.0, 0.0), *points])):
        along = b - a
        part = np.clip(((places - a) @ along) / max(along @ along, 1e-30), 0, 1)
        best = np.minimum(best, np.linalg.norm(places - (a + part[:, None] * along), axis=1))
    return float(best.max())


def acceleration(places: Reals, period_s: float) -> float:
    return float(np.linalg.norm(np.diff(places, n=2, axis=0), axis=1).max() / period_s**2)


POCKET = [(3.0, 0.0), (3.0, 2.0), (0.5, 2.0), (0.5, 0.5), (2.0, 0.5), (2.5, 1.5), (1.0, 1.0)]


@pytest.mark.parametrize("tolerance", [0.002, 0.02, 0.1])
def test_the_path_stays_within_the_tolerance_and_saves_the_stops(tolerance: float) -> None:
    exact = followed(Shop(), *lines(POCKET, mode=c.PathMode.EXACT))
    shop = Shop()
    places = followed(shop, *lines(POCKET, tolerance_u=tolerance))
    assert len(places) < len(exact)
    assert 0.8 * tolerance < off_path(places, POCKET) <= tolerance + 1e-6
    assert acceleration(places, shop.controller.period_s) <= ACCEL * (1 + 1e-6)
    assert tuple(places[-1]) == POCKET[-1]


def test_without_a_tolerance_corners_are_passed_exactly_as_on_any_card() -> None:
    places = followed(Shop(), *lines(POCKET))
    assert off_path(places, POCKET) < 1e-6


def some_program(seed: int) -> list[c.Entry]:
    """Lines with and without tolerances, arcs, rapids and exact stops in any order."""
    chance = random.Random(seed)
    x = y = 0.0
    entries: list[c.Entry] = []
    for number in range(1, 150):
        kind = chance.choices(("line", "short", "rapid", "arc", "exact"), (8, 12, 1, 2, 1))[0]
        feed = chance.choice((120.0, 300.0, 900.0))
        reach = 0.05 if kind == "short" else 1.0
        end_x, end_y = x + chance.uniform(-reach, reach), y + chance.uniform(-reach, reach)
        if kind == "rapid":
            entries.append(rapid(number, at(end_x, end_y)))
        elif kind == "arc":
            middle = ((x + end_x) / 2, (y + end_y) / 2)
            radius = math.dist((x, y), middle)
            pace = c.Pace(feed, tolerance_u=0.01)
            entries.append(
                c.Arc(
                    src(number), at(end_x, end_y), c.Plane.XY, middle, math.pi, radius, radius, pace
                )
            )
        elif kind == "exact":
            entries.append(line(number, at(end_x, end_y), feed=feed, mode=c.PathMode.EXACT))
        else:
            tolerance = chance.choice((0.001, 0.01, 0.01, 0.05))
            entries.append(line(number, at(end_x, end_y), feed=feed, tolerance_u=tolerance))
        x, y = end_x, end_y
    return [*entries, end()]


@pytest.mark.parametrize("seed", sparse(range(4), 4))
def test_the_prediction_is_what_the_card_takes(seed: int) -> None:
    shop = Shop(P250_010=20.0, P250_011=120.0, P650_003=120.0)
    entries = some_program(seed)
    expected = predicted(entries, Settings(shop.store), at()).time_s
    assert shop.finish(*entries) == pytest.approx(expected, rel=0.01)


def test_short_segments_are_predicted_with_the_corners_that_whole_pulses_make() -> None:
    points = [(0.02 * k, 0.5 * math.sin(0.02 * k)) for k in range(1, 300)]
    shop = Shop()
    entries = lines(points, tolerance_u=0.01)
    expected = predicted(entries, Settings(shop.store), at()).time_s
    assert shop.finish(*entries) == pytest.approx(expected, rel=0.012)


def test_no_axis_exceeds_its_own_acceleration_in_a_corner() -> None:
    shop = Shop(**{f"P{AXIS.max_axis_acceleration[1]}": 30.0})
    points = [(2.0, 0.1), (4.0, 0.0), (4.2, 0.5), (5.0, 0.5), (6.0, 0.48)]
    places = followed(shop, *lines(points, tolerance_u=0.02))
    second = np.abs(np.diff(places, n=2, axis=0)).max(axis=0) / shop.controller.period_s**2
    assert 20.0 < second[1] <= 30.0 * (1 + 1e-6)
    assert off_path(places, points) <= 0.02 + 1e-6


def staircase(seed: int) -> tuple[tuple[float, float], list[Point]]:
    """Limits of X and Y, and legs along them and across."""
    chance = random.Random(seed)
    own = chance.choice([100.0, 60.0]), chance.choice([30.0, 10.0, 100.0])
    x, y, points = 0.0, 0.0, []
    for _ in range(14):
        reach = 10.0 ** chance.uniform(-2.0, 0.5)
        across = chance.uniform(-1.0, 1.0), chance.uniform(-1.0, 1.0)
        dx, dy = chance.choice([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), across])
        x, y = x + reach * dx, y + reach * dy
        points.append((x, y))
    return own, points


@pytest.mark.parametrize("seed", [9, 22, 23, 25, 58])
def test_what_one_move_does_in_a_corner_is_within_the_limit_of_the_axis_of_the_other(
    seed: int,
) -> None:
    own, points = staircase(seed)
    cells = {f"P{AXIS.max_axis_acceleration[a]}": value for a, value in enumerate(own)}
    shop = Shop(**cells)
    entries = lines(points, feed=6000.0, tolerance_u=0.05)
    expected = predicted(entries, Settings(shop.store), at()).time_s
    places = followed(shop, *entries)
    period_s = shop.controller.period_s
    second = np.abs(np.diff(places, n=2, axis=0)).max(axis=0) / period_s**2
    assert (second <= np.array(own) * (1 + 1e-6)).all()
    assert abs(motion_s(places, period_s) - expected) <= 2.0 * period_s


def test_many_lines_together_and_one_by_one_are_planned_alike() -> None:
    shop = Shop(**{f"P{AXIS.max_axis_acceleration[1]}": 30.0})
    rng = random.Random(7)
    points = [at(*(rng.uniform(-1, 1) for _ in range(3))) for _ in range(40)]
    pace = c.Pace(300.0, tolerance_u=0.01)
    together = c.Polyline(src(), np.array(points), np.arange(1, 41), pace)
    encoder = Encoder(Settings(shop.store), rounds=True)
    many = list(encoder.jobs(together, at()))
    begins = [at(), *points]
    single = [encoder.job(c.Line(src(), end, pace), begin) for begin, end in pairwise(begins)]
    for one, other in zip(many, single, strict=True):
        assert one.tolerance_u == other.tolerance_u == 0.01
        assert one.length_u == pytest.approx(math.dist(one.begin, one.finish), rel=1e-12)
        assert one.ramp_ups2 == pytest.approx(other.ramp_ups2)
        assert one.start == pytest.approx(other.start)


# what is asked for, and who is asked


SQUARE = "G20 G90 G94 F600\n{}\nG1 X1\nY1\nX0\nY0\nM2\n"


def ran(shop: MillSession, text: str) -> float:
    """Time of a program in the other dialect."""
    made = load(SQUARE.format(text).encode(), shop.cells, "rs274ngc")
    assert made.errors == []
    shop.start(made, Start(dialect="rs274ngc", is_repeated=False))
    while shop.runner.is_busy:
        shop.step()
    assert shop.runner.state is State.IDLE
    return shop.runner.run_s


def test_g64_p_rounds_on_the_virtual_machine() -> None:
    times = [ran(MillSession.virtual(Store(), say=silent), text) for text in ("G61", "G64 P.1")]
    assert times[1] < times[0] - 0.05
    metric = "G21\nG64 P2.54\nG20"
    assert ran(MillSession.virtual(Store(), say=silent), metric) == times[1]


def silent(_text: str) -> None:
    """Say nothing."""


class Listener(Controller):
    """A card that keeps what it is sent."""

    def __init__(self) -> None:
        super().__init__()
        self.heard = b""

    def receive(self, stream: int, data: bytes) -> None:
        self.heard += data
        super().receive(stream, data)


def test_a_card_at_the_other_end_of_a_link_never_hears_of_a_tolerance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What it is sent is that of G64 without P, byte for byte."""
    heard = []
    monkeypatch.setattr("openacr.mill.card.owner.SystemRandom", lambda: random.Random(1))
    for text in ("G64 P0.02", "G64"):
        card, store = Listener(), Store()
        for axis in range(3):
            store.write(AXIS.home_required[axis], 0)  # need not be homed
        shop = MillSession.real(card, store, say=silent)
        shop.card.command("DRIVE ON X Y Z", program=0)
        ran(shop, text)
        heard.append(card.heard)
    assert heard[0] == heard[1]
    assert len(heard[0]) > 1000


def test_with_a_jerk_limit_the_path_is_planned_within_the_tolerance() -> None:
    places = followed(Shop(**{f"P{SPEEDS.path_jerk}": 1000.0}), *lines(POCKET, tolerance_u=0.05))
    assert 0.02 < off_path(places, POCKET) <= 0.05


def test_with_a_jerk_limit_and_no_tolerance_corners_stay_exact() -> None:
    places = followed(Shop(**{f"P{SPEEDS.path_jerk}": 1000.0}), *lines(POCKET, tolerance_u=0.0))
    assert off_path(places, POCKET) < 1e-6


@pytest.mark.parametrize("after_s", [0.1, 0.35, 0.36, 0.37, 0.6])
def test_a_pause_keeps_the_tolerance_and_the_end(after_s: float) -> None:
    shop = Shop()
    shop.start(*lines(POCKET, tolerance_u=0.1))
    shop.pass_time(after_s)
    shop.runner.stop()
    shop.pass_time(0.6)
    assert shop.runner.state is State.PAUSED
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses()[:2] == tuple(round(value * PULSES) for value in POCKET[-1])
    assert off_path(np.array(shop.path)[:, :2], POCKET) <= 0.1 + 1e-4


def test_the_path_back_and_forth_along_rounded_corners_ends_where_it_should() -> None:
    shop = Shop()
    shop.start(*lines(POCKET, tolerance_u=0.1))
    shop.pass_time(0.9)
    shop.runner.stop()
    shop.pass_time(0.6)
    assert shop.runner.state is State.PAUSED
    shop.runner.trace(-1)
    shop.pass_time(0.6)
    shop.runner.trace(0)
    shop.pass_time(0.5)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses()[:2] == tuple(round(value * PULSES) for value in POCKET[-1])
    assert off_path(np.array(shop.path)[:, :2], POCKET) <= 0.1 + 1e-4
