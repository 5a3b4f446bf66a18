"""TANG: where the tangential axis looks."""

import math

import numpy as np
import pytest
from tests.basic.motion_bench import Bench

from openacr.basic.language.registry import Level
from openacr.map.rows import masters
from openacr.map.words import af3

IN_MOTION, TANG = 516, 2074
TANGENTIAL = (af3.word[2] - 4096) * 32 + 16
LIMIT = masters.tang_turn_limit[0]
CNT = 1000


def bench(*lines: str) -> Bench:
    """X and Y in units, C in degrees."""
    made = Bench("X", "Y", "C").all(f"PPU X{CNT} Y{CNT} C{CNT}", "ACC 1000 DEC 1000 STP 1000")
    return made.all("VEL 100", "MBUF ON", *lines, "TANG ON C")


def trace(made: Bench, *lines: str) -> np.ndarray:
    """Places in units and degrees, tick by tick."""
    found = []
    for line in lines:
        assert made.type(line) == ""
        while made.is_waiting:
            found.append(_place(made.ticks(1)))
    while made.bit(IN_MOTION):
        found.append(_place(made.ticks(1)))
    return np.array(found)


def _place(made: Bench) -> list[float]:
    return [made.psp(axis) / CNT for axis in range(3)]


def misalignment(path: np.ndarray) -> np.ndarray:
    """Degrees between C and the chord of every tick in which X or Y move."""
    steps = np.diff(path, axis=0)
    moves = np.hypot(steps[:, 0], steps[:, 1]) > 1e-3
    chord = np.degrees(np.arctan2(steps[moves, 1], steps[moves, 0]))
    look = (path[1:, 2] + path[:-1, 2])[moves] / 2
    return np.asarray(np.abs((look - chord + 180) % 360 - 180))


@pytest.mark.req("ACR-CMD-TANG")
def test_the_flags_and_the_limit() -> None:
    made = bench()
    assert (TANG, LIMIT, made.p(LIMIT)) == (2074, 8236, 0)
    assert made.bit(TANG)
    assert made.bit(TANGENTIAL)
    assert made.type("TANG") == "C"
    made.all("TANG OFF")
    assert not made.bit(TANG)
    assert not made.bit(TANGENTIAL)
    assert made.type("TANG") == "OFF"


@pytest.mark.req("ACR-CMD-TANG")
def test_each_master_has_its_own_flag_axis_and_limit() -> None:
    made = bench("P8492 = 45")
    made.attach(1, (3, "A"), (4, "B"), (5, "D"))
    assert (made.p(8236), made.p(8492)) == (0, 45)
    made.all("TANG OFF").at(Level.PROG, 1).all("TANG ON D")
    assert (made.bit(TANG), made.bit(TANG + 32), made.type("TANG")) == (False, True, "D")
    assert made.at(Level.PROG, 0).type("TANG") == "OFF"
    made.at(Level.PROG, 1).all("TANG OFF")
    assert not made.bit(TANG + 32)


@pytest.mark.req("ACR-CMD-TANG")
def test_the_axis_turns_at_corners_and_looks_along_every_side() -> None:
    made = bench()
    path = trace(made, "X10", "Y10", "X0", "Y0")
    assert np.max(misalignment(path)) < 1e-6
    assert _place(made) == [0, 0, pytest.approx(-90 + 360 * round(made.psp(2) / CNT / 360 + 0.25))]
    turning = np.abs(np.diff(path[:, 2])) > 1e-9
    moving = np.hypot(np.diff(path[:, 0]), np.diff(path[:, 1])) > 1e-9
    assert np.sum(turning & moving) <= 6  # a tick each where the one ends and the other begins


def test_it_turns_by_the_smaller_angle() -> None:
    made = bench()
    trace(made, "X1 Y-0.1", "X/-1 Y/-0.2")
    first, second = math.degrees(math.atan2(-0.1, 1)), math.degrees(math.atan2(-0.2, -1))
    assert first - 180 < second < first
    assert made.psp(2) / CNT == pytest.approx(second, abs=1e-6)


@pytest.mark.parametrize("word", ["CIRCCW", "CIRCW"])
def test_along_circles_it_turns_with_the_tangent(word: str) -> None:
    made = bench()
    path = trace(made, f"{word} X(0,10) Y(0,0)", "X5")
    assert np.max(misalignment(path)) < 0.05
    sign = 1 if word == "CIRCCW" else -1
    assert np.ptp(path[:, 2]) >= 360 - 1e-6
    assert path[-1, 2] - path[0, 2] == pytest.approx(sign * 360, abs=91)


@pytest.mark.parametrize("mode", ["SPLINE MODE 0", "SPLINE MODE 1", "NURB MODE 1"])
def test_along_splines_it_turns_with_the_tangent(mode: str) -> None:
    made = bench("VEL 20")
    points = ("X10 Y0", "X20 Y10", "X20 Y20", "X10 Y30", "X0 Y30")
    path = trace(made, mode, *points, f"{mode.split()[0]} END")
    assert np.max(misalignment(path)) < 0.1


def test_turns_below_the_limit_are_made_on_the_way() -> None:
    made = bench(f"P{LIMIT}=30")
    path = trace(made, "X10", f"X20 Y{10 * math.tan(math.radians(20)):.6f}")
    assert path[-1, 2] == pytest.approx(20, abs=1e-3)
    steps = np.diff(path, axis=0)
    still = np.hypot(steps[:, 0], steps[:, 1]) < 1e-9
    assert np.all(np.abs(steps[still, 2]) < 1e-9)
    on_the_way = path[path[:, 0] > 10]
    share = (on_the_way[:, 0] - 10) / 10
    assert on_the_way[:, 2] == pytest.approx(20 * share, abs=1e-2)


def test_the_turn_does_not_change_the_speed_of_the_path() -> None:
    made = bench(f"P{LIMIT}=30")
    trace(made, "X10")
    assert made.type("X20 Y1") == ""
    made.ticks(1)
    assert made.p(masters.vector_length[0]) == pytest.approx(math.hypot(10, 1))


def test_the_angle_is_added() -> None:
    made = bench("TANG ANG 90")
    assert trace(made, "X10")[-1] == pytest.approx([10, 0, 90])


def test_other_moves_leave_it_alone() -> None:
    made = bench()
    trace(made, "X1", "C45")
    assert _place(made) == [1, 0, 45]
    made.all("TANG OFF")
    assert trace(made, "Y1")[-1] == pytest.approx([1, 1, 45])


def test_with_look_ahead_the_path_stops_for_a_turn() -> None:
    made = bench("LOOK ON")
    path = trace(made, "X10", "Y10")
    assert np.max(misalignment(path)) < 1e-6
    corner = path[np.abs(np.diff(path[:, 2], append=path[-1, 2])) > 1]
    assert corner[:, 0] == pytest.approx(10, abs=1e-6)


@pytest.mark.parametrize("line", ["TANG ON X Y", "TANG ON"])
def test_it_takes_one_axis(line: str) -> None:
    assert bench().type(line) in ("Invalid argument", "Syntax error")
