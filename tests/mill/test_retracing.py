"""Back along the path in a pause, forward again, and on from there."""

import math

import pytest
from tests.mill.shop import Shop

from openacr.errors import UserError
from openacr.mill.run.lifecycle import State

CONTOUR = "G90 F600\nG1 X2\nG3 X3 Y1 I2 J1\nG1 Y3\nM12\nX0\nM2\n"


def paused(shop: Shop, text: str = CONTOUR, after_s: float = 0.45) -> tuple[float, float]:
    shop.load(text)
    shop.pass_time(after_s)
    shop.runner.stop()
    shop.pass_time(0.6)
    assert shop.runner.state is State.PAUSED
    shop.path.clear()
    return shop.place()[:2]


def traced(shop: Shop, direction: int, seconds: float = 0.0) -> None:
    """Trace for some seconds, or to the end."""
    shop.runner.trace(direction)
    stop_s = seconds or 60.0
    for _ in range(round(stop_s / 0.005)):
        if not shop.runner.retrace.is_active:
            return
        shop.pass_time(0.005)
        shop.path.append(shop.place())
    shop.runner.trace(0)
    while shop.runner.retrace.is_active:
        shop.pass_time(0.005)
        shop.path.append(shop.place())


def off_contour(x: float, y: float) -> float:
    """How far a point is from line, arc about (2, 1), line, line."""
    if x <= 2.0 and y < 1.0:
        return abs(y)
    if y < 1.0:
        return abs(math.hypot(x - 2.0, y - 1.0) - 1.0)
    return min(abs(x - 3.0), abs(y - 3.0))


@pytest.mark.req("MILL-BEY-RETRACE", "MILL-BEY-SPEED-FB")
def test_a_trace_goes_back_along_the_path_and_forward_to_where_it_was_held() -> None:
    shop = Shop(P650_006=120.0)
    held = paused(shop)
    assert held[1] > 1.0  # after the arc
    traced(shop, -1, 0.5)
    assert shop.place()[1] < held[1]
    traced(shop, -1)
    assert shop.pulses() == (0, 0, 0)
    fastest = max(math.dist(a, b) / 0.005 for a, b in zip(shop.path, shop.path[1:], strict=False))
    assert fastest == pytest.approx(2.0, rel=0.02)
    traced(shop, 1)
    assert shop.place()[:2] == pytest.approx(held, abs=1.1e-4)
    assert max(off_contour(x, y) for x, y, _ in shop.path) < 3e-4


@pytest.mark.req("MILL-BEY-RETRACE-RESUME")
@pytest.mark.parametrize("back_s", [0.3, 0.9, 60.0])
@pytest.mark.parametrize("forward_s", [0.0, 0.2])
def test_the_program_resumes_from_a_traced_point_without_a_gap(
    back_s: float, forward_s: float
) -> None:
    shop = Shop(P650_006=120.0, P400_101=40)
    paused(shop)
    traced(shop, -1, back_s)
    if forward_s:
        traced(shop, 1, forward_s)
    left = shop.place()
    shop.runner.resume()
    shop.path[:] = [left]
    shop.until(State.IDLE)
    assert shop.pulses() == (0, 30000, 0)
    assert max(off_contour(x, y) for x, y, _ in shop.path) < 3e-4
    # No jump: at 10 units/s the tool makes 0.05 between two looks.
    assert max(math.dist(a, b) for a, b in zip(shop.path, shop.path[1:], strict=False)) < 0.0505
    assert shop.path[1] == pytest.approx(left, abs=0.002)  # and from rest


def test_what_lies_before_a_rapid_is_not_gone_back_over() -> None:
    shop = Shop()
    paused(shop, "G90 F600\nG1 X1\nG0 Y1\nG1 X5\nM2\n", 0.7)
    traced(shop, -1)
    assert shop.pulses() == (10000, 10000, 0)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.pulses() == (50000, 10000, 0)


def test_what_lies_before_a_tool_change_is_not_gone_back_over() -> None:
    shop = Shop()
    shop.runner.entry_actions.changer.confirm()
    shop.load("G90 F600\nG1 X1\nT2 M6\nG1 X5\nM2\n")
    shop.until(State.WAIT)
    shop.runner.entry_actions.changer.confirm()
    shop.pass_time(0.3)
    shop.runner.stop()
    shop.pass_time(0.5)
    traced(shop, -1)
    assert shop.pulses() == (10000, 0, 0)


def test_outputs_are_not_switched_again_and_notes_come_once() -> None:
    shop = Shop(P400_101=40, P700_004=1)
    paused(shop, "G90 F600\nG1 X1\nM12\nX2\n(MSG, two)\nX4\nM2\n", 0.17)
    assert shop.outputs((40,)) == [True]
    shop.controller.bit[40] = False
    assert shop.said == []
    traced(shop, -1)
    shop.runner.resume()
    shop.until(State.IDLE)
    assert shop.outputs((40,)) == [False]
    assert shop.said == ["two"]
    assert shop.pulses()[0] == 40000


def test_a_tool_jogged_aside_after_a_trace_comes_back_to_the_path() -> None:
    shop = Shop(P250_005=0.2)
    paused(shop, "G90 F600\nG1 X8\nM2\n", 0.5)
    traced(shop, -1, 0.5)
    left = shop.place()[0]
    shop.runner.jog(lambda jog: jog.move(1, 1.0, fast=True))
    shop.runner.jog(lambda jog: jog.move(2, 0.5, fast=True))
    shop.pass_time(3.0)
    with pytest.raises(UserError, match="off its path"):
        shop.runner.trace(-1)
    shop.runner.resume()
    shop.path.clear()
    shop.until(State.IDLE)
    assert shop.pulses() == (80000, 0, 0)
    cut = [x for x, y, z in shop.path if abs(y) < 1e-4]
    assert min(cut) == pytest.approx(left, abs=0.06)


def test_a_trace_needs_a_held_move() -> None:
    shop = Shop()
    with pytest.raises(UserError, match="cannot trace the path: the state is IDLE"):
        shop.runner.trace(-1)
    paused(shop)
    with pytest.raises(UserError, match="is where it was held"):
        shop.runner.trace(1)
    shop.runner.trace(-1)
    with pytest.raises(UserError, match="being traced"):
        shop.runner.resume()
    shop.runner.abort()
    shop.until(State.IDLE)
    shop.run_text("G90 F600\nG1 X0 Y0\nM2\n")
    assert shop.pulses() == (0, 0, 0)
