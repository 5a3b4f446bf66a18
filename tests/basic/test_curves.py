"""Circles, helices, spirals, arcs in space and sines: where the axes are, and how long it takes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from tests.basic.motion_bench import Bench, ticks

from openacr.map.rows import axes as axis_rows
from openacr.map.rows import masters

pytestmark = pytest.mark.evidence("oracle", "arc lengths integrated by scipy, circles by formula")

IN_MOTION = 516
LENGTH = masters.vector_length[0]
CNT = 1000  # pulses per unit


def bench(*lines: str, axes: tuple[str, ...] = ("X", "Y", "Z")) -> Bench:
    """A card at rest at 0 with moves of constant speed."""
    made = Bench(*axes)
    made.type("PPU " + " ".join(f"{name}{CNT}" for name in axes))
    return made.all("ACC 0 DEC 0 STP 0 VEL 10", *lines)


def go(made: Bench, line: str) -> Bench:
    """Make a move to its end."""
    assert made.type(line) == ""
    made.until_clear(IN_MOTION)
    return made


def points(made: Bench, line: str, every: int = 20) -> np.ndarray:
    """Positions in units along a move, the end included."""
    assert made.type(line) == ""
    found = []
    while made.bit(IN_MOTION):
        made.ticks(every)
        found.append([made.psp(axis) / CNT for axis in range(3)])
    return np.array(found)


# circles


def test_another_axis_of_the_block_makes_a_helix() -> None:
    made = bench()
    path = points(made, "CIRCCW X(0,3) Y(0,0) Z5")
    assert made.p(LENGTH) == pytest.approx(math.hypot(6 * math.pi, 5))
    turn = np.unwrap(np.arctan2(-path[:, 1], 3 - path[:, 0]))[:-1]
    assert turn / (2 * math.pi) * 5 == pytest.approx(path[:-1, 2], abs=1e-6)
    assert made.psp(2) == 5 * CNT


@pytest.mark.parametrize(("weights", "length"), [("X2", 4 * math.pi), ("Y2", 2 * math.pi)])
def test_an_arc_has_the_weight_of_its_first_axis(weights: str, length: float) -> None:
    made = bench(f"VECDEF {weights}", "CIRCCW X(0,1) Y(0,0)").ticks(1)
    assert made.p(LENGTH) == pytest.approx(length)


def test_spiral_mode_spreads_a_change_of_radius_over_the_sweep() -> None:
    made = go(bench("SET 2072"), "X2")
    path = points(made, "CIRCCW X(-4,0) Y(0,0)")
    turn = np.unwrap(np.arctan2(path[:, 1], path[:, 0]))
    assert np.hypot(path[:, 0], path[:, 1]) == pytest.approx(2 + 2 * turn / math.pi, abs=1e-6)
    assert (made.axis(0, axis_rows.start_radius), made.axis(1, axis_rows.end_radius)) == (2, 4)


def test_without_spiral_mode_a_start_beside_the_circle_jumps_onto_it() -> None:
    made = go(bench(), "X2")
    path = points(made, "CIRCCW X(-4,0) Y(0,0)")
    assert np.hypot(path[:, 0], path[:, 1]) == pytest.approx(4)
    assert (made.axis(0, axis_rows.start_radius), made.axis(1, axis_rows.end_radius)) == (2, 4)


def test_axes_of_different_and_negative_scale_make_round_circles() -> None:
    made = Bench("X", "Y").all("PPU X400 Y-250", "ACC 0 STP 0 VEL 10", "CIRCCW X(0,10) Y(0,0)")
    while made.bit(IN_MOTION):
        made.ticks(50)
        assert math.hypot(made.psp(0) / 400 - 10, made.psp(1) / -250) == pytest.approx(10)


def test_maxvel_bounds_the_speed_on_a_circle() -> None:
    made = bench("VEL 1000", "MAXVEL X5", "CIRCCW X(0,1) Y(0,0)")
    made.until_clear(IN_MOTION)
    assert made.card.clock.tick == ticks(2 * math.pi / 5)


@settings(max_examples=25, deadline=None)
@given(
    start=st.floats(-3.1, 3.1), sweep=st.floats(0.01, 6.2), radius=st.floats(0.1, 50),
    clockwise=st.booleans(),
)  # fmt: skip
def test_any_arc_ends_exactly_and_keeps_radius_and_speed(
    start: float, sweep: float, radius: float, clockwise: bool
) -> None:
    made = Bench("X", "Y").all("PPU X1000 Y1000", "VEL 1E6")
    end = start - sweep if clockwise else start + sweep
    go(made, f"X{radius * math.cos(start):.9f} Y{radius * math.sin(start):.9f}")
    made.all(f"VEL {radius * sweep / 0.05:.9f}", "ACC 0 STP 0")
    word = "CIRCW" if clockwise else "CIRCCW"
    x, y = radius * math.cos(end), radius * math.sin(end)
    made.type(f"{word} X({x:.9f},0) Y({y:.9f},0)")
    step = radius * 1000 * 2 * math.sin(sweep / 100 / 2)
    before = None
    while made.bit(IN_MOTION):
        made.ticks(1)
        now = (made.psp(0), made.psp(1))
        assert math.hypot(*now) == pytest.approx(radius * 1000, rel=1e-6, abs=1e-3)
        if before and made.bit(IN_MOTION):
            assert math.dist(before, now) == pytest.approx(step, rel=1e-5)
        before = now
    assert now == pytest.approx((x * 1000, y * 1000), abs=1e-5)


def test_a_circle_after_a_line_starts_where_the_line_ends() -> None:
    made = bench("ACC 100 STP 0")
    made.type("X10 : CIRCCW X(20,15) Y(0,0)")
    while made.p(12288) < 10 * CNT:
        made.ticks(1)
    while made.bit(IN_MOTION):
        made.ticks(5)
        assert math.hypot(made.psp(0) - 15 * CNT, made.psp(1)) == pytest.approx(5 * CNT, abs=1)
    assert (made.psp(0), made.psp(1)) == (20 * CNT, 0)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("CIRCCW X/(1,2) Y(1,2)", "Syntax error"),
        ("CIRCCW X(1,2)", "Syntax error"),
        ("CIRCCW X1 Y(1,2)", "Syntax error"),
        ("CIRCCW X(1,2) X(1,2)", "Invalid arc"),
        ("CIRCCW X(0,0) Y(0,0)", "Invalid arc"),
        ("CIRCCW X(1,2) Q(1,2)", "Syntax error"),
    ],
)
@pytest.mark.req("ACR-MOT-09")
def test_a_circle_that_is_none_is_refused(line: str, message: str) -> None:
    made = bench()
    assert made.type(line) == message
    assert not made.bit(IN_MOTION)


def test_feedhold_on_a_circle_stays_on_it_and_goes_on() -> None:
    made = bench("ACC 100 DEC 100 STP 100", "CIRCCW X(0,10) Y(0,0)")
    made.ticks(2000).all("SET 520").ticks(1500)
    assert made.bit(519)
    assert math.hypot(made.psp(0) - 10 * CNT, made.psp(1)) == pytest.approx(10 * CNT)
    made.all("SET 521").ticks(200)
    made.until_clear(IN_MOTION)
    assert (made.psp(0), made.psp(1)) == (0, 0)


# arcs in space


# sines


def test_a_sine_off_its_line_is_tilted_and_never_jumps() -> None:
    made = bench("VEL 90")
    path = points(made, "SINE X(4,30,120,2)", every=1)
    f = np.arange(1, len(path) + 1) / len(path)
    phase = math.radians(30)
    wave = 2 * np.sin(phase + math.radians(120) * f)
    first, last = 0 - 2 * math.sin(phase), 4 - 2 * math.sin(math.radians(150))
    assert path[:, 0] == pytest.approx(first + (last - first) * f + wave, abs=1e-3)
    assert made.psp(0) == 4000


def test_two_sines_a_quarter_apart_draw_a_circle() -> None:
    made = go(bench("VEL 1000"), "X7")
    made.all("VEL 360", "SINE X(7,90,360,7) Y(0,0,360,7)")
    while made.bit(IN_MOTION):
        made.ticks(40)
        assert math.hypot(made.psp(0), made.psp(1)) == pytest.approx(7000)


def test_sinusoidal_mode_turns_lines_into_half_waves() -> None:
    made = bench("SET 780", "VEL 180")
    path = points(made, "X10", every=10)
    assert made.p(LENGTH) == 180
    f = np.minimum(np.arange(1, len(path) + 1) / 200, 1)
    assert path[:, 0] == pytest.approx(5 - 5 * np.cos(math.pi * f), abs=1e-6)


def test_the_length_of_a_spiral_is_close_to_its_arc() -> None:
    made = go(bench("SET 2072"), "X10")
    made.all("CIRCCW X(-9,0) Y(0,0)").ticks(1)
    true, _ = quad(lambda t: math.hypot(10 - t / math.pi, 1 / math.pi), 0, math.pi)
    assert made.p(LENGTH) == pytest.approx(true, rel=1e-3)
