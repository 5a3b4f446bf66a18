"""MBUF and LOOK: long buffers, corners at their speeds, short segments without loss."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.basic.motion_bench import Bench, ticks

from openacr.basic.language.registry import Level
from openacr.map.rows import masters
from openacr.motion.path import moves
from openacr.motion.path.move_request import Target

IN_MOTION = 516
LOOK_MODE, NEGLECT, SLOWDOWN = (5888 + n for n in (5, 11, 1))
FILLED = masters.mbuf_filled[0]
VELOCITY = masters.vector_velocity[0]
ANGLE = masters.look_ahead_vector_angle[0]
PERIOD_S = 0.0005
Point = tuple[float, float]


def bench(*lines: str) -> Bench:
    """A card with axes of 10000 pulses per unit that looks ahead over ten moves."""
    made = Bench("X", "Y").all("PPU X10000 Y10000", "ACC 100 DEC 100 STP 100 VEL 10")
    return made.all("MBUF ON", "LOOK ON", *lines)


class Path:
    """What a fed path did, tick by tick."""

    def __init__(self, made: Bench, points: Sequence[Point]) -> None:
        self.made = made
        self.speeds: list[float] = []
        self.places: list[Point] = []
        left = list(points)[::-1]
        while left or made.bit(IN_MOTION):
            while left and moves.has_room(made.card, 0):
                x, y = left.pop()
                moves.issue(made.card, 0, [Target(0, x), Target(1, y)])
            self.tick()

    def tick(self) -> None:
        self.made.ticks(1)
        self.speeds.append(self.made.p(VELOCITY))
        self.places.append((self.made.psp(0) / 10000, self.made.psp(1) / 10000))

    @property
    def ticks(self) -> int:
        return len(self.speeds)

    def steepest(self) -> float:
        """The largest change of speed per second; the last one may be a rest of a tick."""
        return float(np.max(np.abs(np.diff([0.0, *self.speeds])))) / PERIOD_S


# MBUF


def test_long_buffers_of_two_masters_do_not_meet_and_a_third_is_refused() -> None:
    made = Bench("X").all("DIM MBUF(200)", "MBUF ON", "VEL 100")
    made.attach(1, (1, "Y"))
    made.attach(2, (2, "Z"))
    made.at(Level.PROG, 1).all("DIM MBUF(200)", "MBUF ON", "VEL 100")
    made.at(Level.PROG, 2).all("DIM MBUF(200)")
    assert made.type("MBUF ON") == "Out of memory"
    for program, name in ((0, "X"), (1, "Y")):
        made.at(Level.PROG, program)
        for number in range(150):
            made.type(f"{name}{number % 7 + program}")
    made.until_clear(IN_MOTION, IN_MOTION + 32)
    assert (made.p(12288), made.p(12544)) == (149 % 7, 149 % 7 + 1)


def test_a_kill_empties_the_buffer() -> None:
    made = Bench("X").all("MBUF ON", "VEL 1", "X1", "X2", "X3").ticks(10)
    made.all("SET 522").ticks(110).all("CLR 522").ticks(1)
    assert (made.p(FILLED), made.bit(IN_MOTION)) == (0, False)


# LOOK


def test_look_is_reported_and_a_flag() -> None:
    made = Bench("X")
    assert made.type("LOOK") == "OFF"
    assert made.type("LOOK ANG") == "0,90"
    made.all("LOOK ON", "LOOK ANG (5,60)", "LOOK MINVEL 2")
    assert made.bit(LOOK_MODE)
    assert made.type("LOOK") == "ON"
    assert made.type("LOOK ANG") == "5,60"
    assert (made.type("LOOK MINVEL"), made.p(8233)) == ("2", 2.0)
    assert made.type("LOOK ANG (60,5)") == "Invalid argument"
    assert made.type("LOOK MINVEL -1") == "Invalid argument"


@pytest.mark.parametrize("jerk", [0, 1000])
@pytest.mark.req("ACR-CMD-LOOK")
def test_a_straight_chain_takes_as_long_as_one_move(jerk: int) -> None:
    single = bench(f"JRK {jerk}", "X10").until_clear(IN_MOTION)
    path = Path(bench(f"JRK {jerk}"), [(number / 10, 0.0) for number in range(1, 101)])
    if jerk:
        path = Path(
            bench(f"JRK {jerk}", "MBUF OFF", "DIM MBUF(60)", "MBUF ON"),
            [(number / 10, 0.0) for number in range(1, 101)],
        )
        assert path.ticks == single
    else:
        assert path.ticks <= single + ticks(0.02)
    assert path.made.psp(0) == 100000
    assert path.steepest() <= 100.001


def test_the_angle_of_the_present_corner_is_shown() -> None:
    made = bench("X5", "X5 Y5").ticks(10)
    assert made.p(ANGLE) == pytest.approx(90)
    assert not made.bit(SLOWDOWN) or made.p(VELOCITY) < 10


def test_arcs_join_lines_along_their_tangents() -> None:
    made = bench()
    made.type("X5 : CIRCCW X(5,5) Y(4,2) : X0")
    found = []
    while made.bit(IN_MOTION):
        made.ticks(1)
        found.append(made.p(VELOCITY))
    slow = [value for value in found[ticks(0.11) : -ticks(0.11)] if value < 9.99]
    assert slow == []
    assert (made.psp(0), made.psp(1)) == (0, 40000)


def test_neglect_suspends_look_ahead_on_the_fly() -> None:
    made = bench(f"SET {NEGLECT}", "X5", "X10")
    slowest = 10.0
    while made.p(12288) < 60000:
        made.ticks(1)
        if made.p(12288) > 40000:
            slowest = min(slowest, made.p(VELOCITY))
    assert slowest < 0.1


def test_a_starved_buffer_stops_and_goes_on() -> None:
    path = Path(bench("MBUF OFF"), [(number / 50, 0.0) for number in range(1, 101)])
    assert path.made.psp(0) == 20000
    assert path.steepest() <= 100.1


def test_feedhold_stops_across_junctions_and_goes_on() -> None:
    made = bench()
    for number in range(1, 11):
        made.type(f"X{number / 5} Y{number / 5}")
    made.ticks(ticks(0.15)).all("SET 520")
    speeds = [made.ticks(1).p(VELOCITY) for _ in range(ticks(0.4))]
    assert made.bit(519)
    assert np.max(np.abs(np.diff(speeds))) <= 0.0501
    assert made.psp(0) == made.psp(1)
    made.all("SET 521")
    made.ticks(200)
    made.until_clear(IN_MOTION)
    assert (made.psp(0), made.psp(1)) == (20000, 20000)


def test_trj_turns_back_out_of_a_merged_chain() -> None:
    made = bench()
    for number in range(1, 10):
        made.type(f"X{number / 5}")
    made.ticks(ticks(0.1)).all("TRJ X0")
    speeds = []
    while made.bit(IN_MOTION):
        speeds.append(made.ticks(1).p(VELOCITY))
    assert made.psp(0) == 0
    assert np.max(np.abs(np.diff(speeds))) <= 0.0501
    assert made.p(FILLED) == 0


def test_an_override_change_in_a_chain_keeps_the_ramps() -> None:
    made = bench("MBUF OFF", "DIM MBUF(100)", "MBUF ON")
    for number in range(1, 100):
        made.type(f"X{number / 5}")
    speeds = [made.ticks(1).p(VELOCITY) for _ in range(500)]
    made.all("FOV 0.3")
    speeds += [made.ticks(1).p(VELOCITY) for _ in range(500)]
    assert speeds[-1] == pytest.approx(3.0)
    made.all("FOV 1.5")
    while made.bit(IN_MOTION):
        speeds.append(made.ticks(1).p(VELOCITY))
    assert max(speeds) == pytest.approx(15)
    assert np.max(np.abs(np.diff(speeds))) <= 0.0501
    assert made.psp(0) == 198000


def law(points: Sequence[Point], vel: float, slowest: float) -> list[float]:
    """Junction speeds of a polyline by the law, rest at both ends."""
    found = [0.0]
    for a, b, c in zip(points, points[1:], points[2:], strict=False):
        first, second = np.subtract(b, a), np.subtract(c, b)
        cosine = first @ second / np.linalg.norm(first) / np.linalg.norm(second)
        turn = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
        found.append(max(slowest, vel - (vel - slowest) * turn / 90))
    return [*found, 0.0]


def brute_force_s(points: Sequence[Point], vel: float, rate: float, slowest: float) -> float:
    """Shortest time along a polyline: both passes over all junctions, then trapezoids."""
    lengths = [math.dist(a, b) for a, b in pairwise(points)]
    speeds = law(points, vel, slowest)
    for k in reversed(range(len(lengths))):
        speeds[k] = min(speeds[k], math.sqrt(speeds[k + 1] ** 2 + 2 * rate * lengths[k]))
    for k, length in enumerate(lengths):
        speeds[k + 1] = min(speeds[k + 1], math.sqrt(speeds[k] ** 2 + 2 * rate * length))
    total = 0.0
    for k, length in enumerate(lengths):
        v, w = speeds[k], speeds[k + 1]
        peak = min(vel, math.sqrt((2 * rate * length + v * v + w * w) / 2))
        total += (2 * peak - v - w) / rate
        total += (length - (2 * peak**2 - v * v - w * w) / (2 * rate)) / peak
    return total


coordinate = st.integers(-40, 40).map(lambda value: value / 10)


@settings(max_examples=25, deadline=None)
@given(
    points=st.lists(st.tuples(coordinate, coordinate), min_size=2, max_size=10),
    slowest=st.sampled_from([0.0, 0.5, 3.0]),
)
def test_a_polyline_is_as_fast_as_brute_force(points: list[Point], slowest: float) -> None:
    corners = [(0.0, 0.0)]
    for point in points:
        if point != corners[-1]:
            corners.append(point)
    assume(len(corners) > 1)
    path = Path(bench(f"LOOK MINVEL {slowest}"), corners[1:])
    assert path.steepest() <= 101
    assert abs(path.ticks - ticks(brute_force_s(corners, 10, 100, slowest))) <= 1
    assert path.places[-1] == corners[-1]


@settings(max_examples=12, deadline=None)
@given(
    points=st.lists(st.tuples(coordinate, coordinate), min_size=2, max_size=10),
    jerk=st.sampled_from([500, 5000]),
    hold=st.integers(1, 2000),
)
def test_invariants_hold_with_jerk_override_and_hold(
    points: list[Point], jerk: int, hold: int
) -> None:
    assume(any(point != (0.0, 0.0) for point in points))
    made = bench(f"JRK {jerk}", "LOOK MINVEL 1", "MAXVEL X7")
    for x, y in points:
        moves.issue(made.card, 0, [Target(0, x), Target(1, y)])
    places, speeds = [(0.0, 0.0)], [0.0]
    count = 0
    while made.bit(IN_MOTION):
        count += 1
        if count == hold:
            made.all("SET 520")
        if count == hold + 1500:
            made.all("SET 521", "FOV 0.5")
        made.ticks(1)
        places.append((made.psp(0) / 10000, made.psp(1) / 10000))
        speeds.append(made.p(VELOCITY))
    steps = np.abs(np.diff(places, axis=0)) / PERIOD_S
    assert np.max(steps[:, 0]) <= 7.001
    assert np.max(np.hypot(steps[:, 0], steps[:, 1])) <= 10.001
    assert np.max(np.abs(np.diff(speeds))) / PERIOD_S <= 101
    assert places[-1] == pytest.approx(points[-1])


def ellipse(count: int, turns: float) -> list[Point]:
    """Short segments along an ellipse that begins at 0."""
    angles = np.linspace(0, 2 * math.pi * turns, count + 1)[1:]
    return [(4 * math.sin(a), 2 * (1 - math.cos(a))) for a in angles]


def keeps_feed(count: int, turns: float, jerk: int) -> None:
    """A path of short segments holds its feed from the first ramp to the last."""
    made = Bench("X", "Y").all("PPU X10000 Y10000", "ACC 100 DEC 100 STP 100 VEL 5")
    made.all(f"JRK {jerk}", "DIM MBUF(200)", "MBUF ON", "LOOK ON", "LOOK ANG (3,90)", "MAXVEL X6")
    path = Path(made, ellipse(count, turns))
    ramp = ticks(5 / 100 + (100 / jerk if jerk else 0)) + 2
    assert min(path.speeds[ramp:-ramp]) == pytest.approx(5, rel=1e-6)
    assert max(path.speeds) <= 5.000001
    steps = np.hypot(*np.diff(path.places, axis=0).T)
    assert np.max(steps) <= 5.001 * PERIOD_S
    assert path.steepest() <= 100.1
    assert path.places[-1] == pytest.approx(ellipse(count, turns)[-1])


@pytest.mark.parametrize("jerk", [0, 2000])
@pytest.mark.req("ACR-CMD-LOOK")
def test_short_segments_keep_the_feed(jerk: int) -> None:
    keeps_feed(2000, 1.0, jerk)


@pytest.mark.soak
def test_a_hundred_thousand_short_segments_keep_the_feed() -> None:
    keeps_feed(100_000, 20.0, 2000)


def test_look_tol_sets_the_tolerance_of_the_moves_to_come() -> None:
    made = bench()
    assert made.type("LOOK TOL") == "0"
    assert made.type("LOOK TOL -1") == "Invalid argument"
    made.all("LOOK TOL 0.25")
    assert made.type("LOOK TOL") == "0.25"
    path = Path(made, [(2, 0), (2, 2)])
    assert min(math.dist(place, (2, 0)) for place in path.places) == pytest.approx(0.25, rel=0.02)
    made.all("LOOK TOL 0")
    assert (4, 2) in Path(made, [(4, 2), (4, 4)]).places


# Turns that the first three slaves do not show


@pytest.mark.parametrize("turn_deg", [0.0, 30.0, 90.0, 180.0])
@pytest.mark.parametrize("times", [1, 2])
@pytest.mark.parametrize("tolerance", [0.0, 0.05])
def test_a_point_given_again_changes_nothing_of_the_path(
    turn_deg: float, times: int, tolerance: float
) -> None:
    """Exact corners: the path is the same, tick by tick; with a tolerance it stays on its line."""
    corner = (3.0, 0.0)
    turn = math.radians(turn_deg)
    end = (3.0 + 2 * math.cos(turn), 2 * math.sin(turn))
    made = bench(*([f"LOOK TOL {tolerance}"] if tolerance else []))
    once = Path(bench(), [corner, end])
    again = Path(made, [corner, *[corner] * times, end])
    if not tolerance:
        np.testing.assert_allclose(again.places, once.places, rtol=0, atol=1e-9)
    elif turn_deg:
        assert corner in again.places
        changes = np.linalg.norm(np.diff(again.places, n=2, axis=0), axis=1)
        assert changes.max() <= 100 * PERIOD_S**2 * (1 + 1e-6)
    else:
        assert again.ticks == once.ticks
    assert again.places[-1] == once.places[-1]
    assert again.steepest() <= 100 * (1 + 1e-5)


def test_the_speed_at_a_turn_of_axes_beyond_the_first_three_is_that_of_its_angle() -> None:
    """A turns back, C alone follows A, X follows C, and A follows X: each ends a motion."""
    made = Bench("X", "Y", "Z", "A", "C").all("PPU X1000 Y1000 Z1000 A1000 C1000")
    made.all("ACC 100 DEC 100 STP 100 VEL 10", "MBUF ON", "LOOK ON")
    made.all("A5", "A2", "A8", "C4", "X3", "A10")
    places = [[made.psp(axis) / 1000 for axis in (0, 3, 4)]]
    while made.bit(IN_MOTION):
        made.ticks(1)
        places.append([made.psp(axis) / 1000 for axis in (0, 3, 4)])
    assert places[-1] == [3.0, 10.0, 4.0]
    assert np.abs(np.diff(places, n=2, axis=0)).max() <= 100 * PERIOD_S**2 * (1 + 1e-6)


def test_axes_beyond_the_first_three_run_on_through_a_point_that_does_not_turn() -> None:
    made = Bench("X", "Y", "Z", "A", "C").all("PPU X1000 Y1000 Z1000 A1000 C1000")
    made.all("ACC 100 DEC 100 STP 100 VEL 10", "MBUF ON", "LOOK ON", "A3 C4", "A6 C8")
    speeds = []
    while made.bit(IN_MOTION):
        made.ticks(1)
        speeds.append(made.p(VELOCITY))
    assert speeds.count(10.0) == 1801
