"""Off the path in a pause, and back onto it."""

import math

import pytest
from tests.cnc.programs import run
from tests.mill.shop import Shop, at, end, line, rapid, src

from openacr.cnc import canonical as c
from openacr.errors import UserError
from openacr.mill.run.lifecycle import State
from openacr.mill.run.rejoin import apart_u

RADIUS = 0.25


def jogged(shop: Shop, x: float, y: float, z: float) -> None:
    """Moved by hand: axes are jogged by so much and the offsets become positions."""
    for name, delta in zip("XYZ", (x, y, z), strict=True):
        if delta:
            shop.card.command(f"JOG VEL {name}20 JOG INC {name}{delta}", program=0)
    shop.pass_time(2.0)
    for name in "XYZ":
        shop.card.command(f"JOG RES {name}", program=0)


def held(shop: Shop, *entries: c.Entry) -> tuple[float, float, float]:
    """Started, held on its delta along X and at rest: where."""
    shop.start(*entries, end())
    while shop.place()[0] < 1.0:
        shop.pass_time(0.02)
    shop.runner.stop()
    shop.pass_time(1.0)
    return shop.place()


def resumed(shop: Shop) -> list[tuple[float, float, float]]:
    """The path to the end of the program."""
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    return shop.path


@pytest.mark.req("MILL-RUN-RESUME-OFFPATH")
@pytest.mark.parametrize("away", [1.5, -1.5])
@pytest.mark.parametrize("side", [1, -1])
def test_a_compensated_path_is_met_on_an_arc_on_the_side_of_the_tool(
    side: int, away: float
) -> None:
    shop = Shop()
    left = held(shop, line(1, at(10, 0), side=side), line(2, at(10, 5)))
    jogged(shop, 0.5, away, 2.0)  # the operator may step aside to either side
    path = resumed(shop)
    assert shop.pulses() == (100000, 50000, 0)
    low = [p for p in path if p[2] < 1.9 and p[0] < left[0] + 0.3]
    centre = (left[0], side * RADIUS)
    start = left[0] - RADIUS
    assert low
    down = [p for p in low if p[2] > 1e-4]
    assert all((x, y) == pytest.approx((start, centre[1]), abs=2e-4) for x, y, _ in down)
    on_arc = [p for p in low if p[2] < 1e-4 and p[0] < left[0] - 0.001]
    assert len(on_arc) > 3
    for x, y, _ in on_arc:
        assert math.hypot(x - centre[0], y - centre[1]) == pytest.approx(RADIUS, abs=3e-4)
        assert y * side > 0.0
    after = path[path.index(on_arc[-1]) + 1 :]
    assert all(abs(y) < 2e-4 for x, y, _ in after if x < 9.99)


@pytest.mark.parametrize("side", [0, 1, -1])
def test_a_tool_that_was_only_raised_comes_straight_down_at_feed(side: int) -> None:
    shop = Shop()
    left = held(shop, rapid(1, at(0, 0, 3)), line(2, at(0)), line(3, at(10), side=side))
    assert 0.0 < left[0] < 10.0
    jogged(shop, 0.0, 0.0, 2.0)
    path = resumed(shop)
    assert all(p[:2] == left[:2] for p in path if p[2] > 1e-4)
    assert max(p[2] for p in path) == 2.0  # no higher than it was raised
    (down, *_) = [n for n, p in enumerate(path) if p[2] < 1.5]
    (bottom, *_) = [n for n, p in enumerate(path) if p[2] < 0.5]
    assert bottom - down == pytest.approx(1.0 / 10.0 / 0.005, abs=2)  # F600: 10 in/s


def test_a_path_without_compensation_is_met_where_it_was_left() -> None:
    shop = Shop()
    left = held(shop, line(1, at(10, 0)), line(2, at(10, 5)))
    jogged(shop, 0.5, 1.5, 2.0)
    path = resumed(shop)
    assert all(p[:2] == pytest.approx(left[:2], abs=2e-4) for p in path if 1e-4 < p[2] < 1.99)
    assert all(abs(y) < 2e-4 for x, y, z in path if z < 1e-4 and x < 9.99)
    assert shop.pulses() == (100000, 50000, 0)


def test_a_tool_beside_its_path_goes_over_at_the_level_of_the_rapids() -> None:
    shop = Shop()
    left = held(
        shop, rapid(1, at(0, 0, 3)), rapid(2, at(0, 0, 1)), line(3, at(0)), line(4, at(10))
    )  # fmt: skip
    assert 0.0 < left[0] < 10.0
    jogged(shop, 0.0, 1.0, 0.0)  # through the stock, the operator knows why
    path = resumed(shop)
    assert all(z == 3.0 for _, y, z in path if 1e-4 < y < 0.9999)
    assert shop.pulses() == (100000, 0, 0)


def test_at_the_level_of_the_cut_the_tool_does_not_go_back_over_the_part() -> None:
    shop = Shop()
    left = held(shop, line(1, at(10, 0)))
    jogged(shop, 0.0, 1.0, 0.0)
    with pytest.raises(UserError, match=r"off its path.*raise Z by hand first"):
        shop.runner.resume()
    shop.pass_time(0.5)
    assert (shop.runner.state, shop.place()) == (State.PAUSED, (left[0], 1.0, 0.0))
    jogged(shop, 0.0, 0.0, 0.5)
    path = resumed(shop)
    assert all(z == 0.5 for _, y, z in path if 1e-4 < y < 0.9999)


def test_a_rapid_at_a_level_below_zero_counts() -> None:
    shop = Shop()
    held(shop, rapid(1, at(0, 0, -1)), line(2, at(0, 0, -2)), line(3, at(10, 0, -2)))
    jogged(shop, 0.0, 1.0, 0.0)
    path = resumed(shop)
    assert {z for _, y, z in path if 1e-4 < y < 0.9999} == {-1.0}


def test_after_a_stop_the_tool_does_not_come_back_over_the_part_either() -> None:
    shop = Shop()
    stop = c.Stop(src(2), c.Pause.STOP)
    shop.start(line(1, at(1, 0, -1)), stop, line(3, at(2, 0, -1)), end())
    shop.until(State.HOLD)
    jogged(shop, 0.0, 1.0, 0.0)
    with pytest.raises(UserError, match="raise Z by hand first"):
        shop.runner.start()
    assert shop.runner.state is State.HOLD
    jogged(shop, 0.0, 0.0, 2.0)
    shop.runner.start()
    shop.path.clear()
    shop.until(State.IDLE)
    assert {z for _, y, z in shop.path if 1e-4 < y < 0.9999} == {1.0}
    assert shop.pulses() == (20000, 0, -10000)


@pytest.mark.parametrize(
    ("code", "radius", "side"),
    [("G41", 0.25, 1), ("G42", 0.25, -1), ("G41", 0.0, 1), ("G42", -0.25, 0), ("G40", 0.25, 0)],
)
def test_the_program_says_on_which_side_the_tool_is(code: str, radius: float, side: int) -> None:
    text = f"F10 D1\n{code} G1 X1 Y1\nX3\nY4\nG40 X9 Y9\nM2"
    done = run(text, {1001: radius})
    sides = [entry.pace.side for entry in done.of(c.Line) if isinstance(entry, c.Line)]
    assert sides == [side, side, side, 0]


def test_a_side_in_another_plane_says_nothing_of_xy() -> None:
    done = run("F10 D1 G18\nG41 G1 X1 Z1\nX3\nG40 Z9 X9\nM2", {1001: 0.25})
    assert {entry.pace.side for entry in done.of(c.Line) if isinstance(entry, c.Line)} == {0}


def test_without_a_jog_the_held_move_simply_goes_on() -> None:
    shop = Shop()
    shop.start(line(1, at(10, 0)), end())
    shop.pass_time(0.4)
    shop.runner.stop()
    shop.pass_time(0.5)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert all(y == 0.0 for _, y, _ in shop.path)
    assert shop.runner.stream.moves == 1


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


@pytest.mark.parametrize("turn", [1.0, -1.0])
@pytest.mark.parametrize(("radius", "apart"), [(2.0, 0.0), (2.3, 0.3), (1.9, 0.1)])
def test_a_point_is_as_far_from_an_arc_as_from_its_circle(
    turn: float, radius: float, apart: float
) -> None:
    """From (2, 0) to (0, 2) or (0, -2) about 0: a point at a third of it."""
    sweep_rad = turn * math.pi / 2
    finish = at(0.0, 2.0 * turn)
    arc = c.Arc(src(1), finish, c.Plane.XY, (0.0, 0.0), sweep_rad, 2.0, 2.0, c.Pace(10.0))
    angle = turn * math.pi / 6
    here = at(radius * math.cos(angle), radius * math.sin(angle))
    assert apart_u(arc, at(2.0, 0.0), here, [1.0] * c.AXES) == pytest.approx(apart, abs=1e-12)


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
    shop.start(line(1, at(10, 0), side=1), end())
    shop.pass_time(0.4)
    shop.runner.stop()
    shop.pass_time(0.5)
    jogged(shop, 0.0, 0.05, 1.0)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    assert shop.pulses() == (100000, 0, 0)
    assert max(y for _, y, _ in shop.path) < 0.051
