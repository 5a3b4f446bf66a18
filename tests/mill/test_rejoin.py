"""Off the path in a pause, and back onto it."""

import math

import pytest
from tests.mill.shop import Shop, at, end, line, rapid, src

from openacr.cnc import canonical as c
from openacr.mill.states import State

RADIUS = 0.25


def jogged(shop: Shop, x: float, y: float, z: float) -> None:
    """Moved by hand: axes are jogged by so much and the offsets become positions."""
    for name, way in zip("XYZ", (x, y, z), strict=True):
        if way:
            shop.card.command(f"JOG VEL {name}20 JOG INC {name}{way}", program=0)
    shop.pass_time(2.0)
    for name in "XYZ":
        shop.card.command(f"JOG RES {name}", program=0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_comes_back_on_an_arc_that_touches_the_path(side: float) -> None:
    shop = Shop()
    shop.start(line(1, at(10, 0)), line(2, at(10, 5)), end())
    shop.pass_time(0.4)
    shop.runner.stop()
    shop.pass_time(0.5)
    left = shop.place()
    jogged(shop, 0.5, side * 1.5, 2.0)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    assert shop.pulses() == (100000, 50000, 0)
    centre = (left[0], side * RADIUS)
    on_arc = [p for p in shop.path if p[0] < left[0] - 0.001 and abs(p[1]) < RADIUS - 0.001]
    assert len(on_arc) > 3
    for x, y, z in on_arc:
        assert math.hypot(x - centre[0], y - centre[1]) == pytest.approx(RADIUS, abs=3e-4)
        assert z == pytest.approx(0.0, abs=1e-4)
    off = [p for p in shop.path if p[2] > 0.001 and p[0] > left[0] + 0.2]
    assert off  # the drill axis stays up on the way to the arc
    behind = shop.path[shop.path.index(on_arc[-1]) + 1 :]
    assert all(abs(y) < 2e-4 for x, y, _ in behind if x < 9.99)


def test_without_a_jog_the_held_move_simply_goes_on() -> None:
    shop = Shop()
    shop.start(line(1, at(10, 0)), end())
    shop.pass_time(0.4)
    shop.runner.stop()
    shop.pass_time(0.5)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert all(y == 0.0 for _, y, _ in shop.path)
    assert shop.runner.course.moves == 1


def test_the_rest_of_an_arc_keeps_its_centre() -> None:
    shop = Shop()
    turn = c.Arc(src(2), at(2, 0), c.Plane.XY, (0.0, 0.0), 2 * math.pi, 2, 2, c.Pace(600.0))
    shop.start(rapid(1, at(2, 0)), turn, end())
    shop.pass_time(1.2)
    shop.runner.stop()
    shop.pass_time(0.5)
    left = shop.place()
    assert math.hypot(left[0], left[1]) == pytest.approx(2.0, abs=3e-4)
    jogged(shop, 0.0, 0.0, 1.0)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    assert shop.pulses() == (20000, 0, 0)
    angle = math.atan2(left[1], left[0]) % (2 * math.pi)
    later = [p for p in shop.path if angle + 0.05 < math.atan2(p[1], p[0]) % (2 * math.pi) < 6.2]
    assert len(later) > 10
    assert all(math.hypot(x, y) == pytest.approx(2.0, abs=3e-4) for x, y, _ in later)


def test_in_a_rapid_it_comes_back_straight() -> None:
    shop = Shop()
    shop.start(rapid(1, at(30, 0)), end())
    shop.pass_time(0.5)
    shop.runner.stop()
    shop.pass_time(1.5)
    left = shop.place()
    jogged(shop, 0.0, 1.0, 0.0)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    assert shop.pulses() == (300000, 0, 0)
    assert all(x == pytest.approx(left[0], abs=1.01e-4) for x, y, _ in shop.path if y > 0.001)


def test_an_arc_that_would_leave_the_limits_is_not_taken() -> None:
    shop = Shop(P201_000=0.1, P201_001=-5.0, P201_002=0, P271=2)
    shop.start(line(1, at(10, 0)), end())
    shop.pass_time(0.4)
    shop.runner.stop()
    shop.pass_time(0.5)
    jogged(shop, 0.0, 0.05, 0.0)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    assert shop.pulses() == (100000, 0, 0)
    assert max(y for _, y, _ in shop.path) < 0.051
