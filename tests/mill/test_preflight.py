"""What `mill check` says about the machine: limits, pulses and feeds, without a machine."""

import math
from typing import Any

import pytest
from tests.cnc.programs import run
from tests.mill.shop import Shop, at, line, rapid, src

from openacr.cnc import canonical as c
from openacr.cnc.reading.findings import Finding
from openacr.mill.config.settings import Settings
from openacr.mill.plan.estimate.predicting import Predictor
from openacr.mill.plan.estimate.preflight import Preflight
from openacr.mill.run.lifecycle import State

LIMITS = {"P200_000": 2.0, "P200_001": -2.0, "P200_002": 0, "P271": 1}


def found(shop: Shop, *entries: c.Entry) -> list[Finding]:
    settings = Settings(shop.store)
    preflight = Preflight(settings)
    predictor = Predictor(settings, at(), reader=preflight)
    for entry in entries:
        predictor.add(entry)
    predictor.rest()
    return preflight.findings(lambda source: source.text)


def said(shop: Shop, *entries: c.Entry) -> list[str]:
    return [str(finding) for finding in found(shop, *entries)]


def bulge(number: int) -> c.Arc:
    return c.Arc(src(number), at(1.5, 1), c.Plane.XY, (1.5, 0.0), 3.14159265, 1.0, 1.0, c.Pace(60))


@pytest.mark.parametrize(
    ("moves", "excess"),
    [
        ([line(1, at(1)), line(2, at(3))], "axis X would go to 3, 1 beyond its limit 2"),
        (
            [line(1, at(1)), rapid(2, at(-2.25))],
            "axis X would go to -2.25, 0.25 beyond its limit -2",
        ),
        ([line(1, at(1.5, -1)), bulge(2)], "axis X would go to 2.5, 0.5 beyond its limit 2"),
    ],
)
def test_a_move_beyond_a_limit_is_found_in_the_words_of_the_alarm_of_a_run(
    moves: list[c.Entry], excess: str
) -> None:
    shop = Shop(**LIMITS)
    assert said(shop, *moves) == [f"TEST.TXT:2:1: E401 target beyond soft limit: {excess}"]
    shop.start(*moves, c.End(src(9), is_by_code=True))
    assert shop.until(State.ALARM) is State.ALARM
    assert shop.runner.alarms.active[0].text == f"Target beyond soft limit: line 2, {excess}"


def test_a_place_at_the_limit_is_none_beyond_it() -> None:
    assert said(Shop(**LIMITS), line(1, at(2)), line(2, at(-2)), line(3, at(-2, 50))) == []


def test_disabled_limits_are_not_tested() -> None:
    assert said(Shop(**{**LIMITS, "P200_002": 1}), line(1, at(300))) == []


def test_each_limit_is_reported_once_with_its_farthest_move() -> None:
    path = [line(1, at(3)), line(2, at(0)), line(3, at(5.5)), line(4, at(0)), line(5, at(-3))]
    assert said(Shop(**LIMITS), *path) == [
        "TEST.TXT:1:1: E401 target beyond soft limit: axis X would go to 3, 1 beyond its limit 2"
        " (2 moves, line 3 by 3.5)",
        "TEST.TXT:5:1: E401 target beyond soft limit: axis X would go to -3, 1 beyond its limit -2",
    ]


def test_axes_that_are_not_homed_are_tested_all_the_same_and_named_once() -> None:
    wide = {f"P20{axis}_00{k}": value for axis in (1, 2) for k, value in enumerate((9, -9, 0))}
    path = [line(1, at(0, 1)), line(2, at(1, 1)), line(3, at(3, 1)), line(4, at(2))]
    assert said(Shop(**{**LIMITS, **wide, "P271": 0}), *path) == [
        "TEST.TXT:3:1: E401 target beyond soft limit: axis X would go to 3, 1 beyond its limit 2",
        "TEST.TXT:1:1: W403 limits not testable: Y X not homed (tested as if homed)",
    ]


def test_a_position_without_pulses_is_an_error() -> None:
    assert said(Shop(), rapid(1, at(1)), rapid(7, at(2**31 / 10000))) == [
        "TEST.TXT:7:1: E403 position beyond 32 bits of pulses: axis X at 214748 inch"
    ]


def test_a_position_without_pulses_is_in_the_unit_of_the_machine_with_the_letter_of_the_axis() -> (
    None
):
    assert said(Shop(P250_001=1), rapid(7, at(0, 2.5e7)))[0].endswith("axis Y at 2.5e+07 mm")
    shop = Shop(P203_012=1, P203_003=1000.0)
    assert said(shop, rapid(7, (0.0, 0.0, 0.0, 1e9, *(0.0,) * 4)))[0].endswith(
        "axis A at 1e+09 degrees"
    )


def test_a_feed_that_no_move_of_a_path_reaches_is_reported_once() -> None:
    # a = 100 units/s2: 0.04 units from rest to rest come to sqrt(100 x 0.04) = 2 of 10 units/s
    path: list[c.Entry] = [
        line(1, at(5)),
        rapid(2, at(0)),
        line(3, at(0.04)),
        rapid(4, at(0)),
        line(5, at(0.01)),
    ]
    assert said(Shop(), *path) == [
        "TEST.TXT:3:1: W402 feed never reached: 2 moves (line 5 reaches 10 % of F)"
    ]


def test_short_pieces_of_a_long_path_reach_their_feed() -> None:
    assert said(Shop(), *(line(n, at(n / 200)) for n in range(1, 1001))) == []


def test_a_feed_above_the_machine_is_never_reached() -> None:
    # 3000 per minute are 50 units/s, the machine makes 100 units/s, axis X 40 of them
    assert said(Shop(P200_015=2400.0), line(1, at(50), feed=3000.0)) == [
        "TEST.TXT:1:1: W402 feed never reached: 1 move (line 1 reaches 80 % of F)"
    ]


def test_limits_are_those_of_the_machine_in_a_rotated_work_system() -> None:
    wide = {f"P201_00{k}": value for k, value in enumerate((2.0, -2.0, 0))}
    program = "G10 L2 P1 R90\nG0 X1.5 Y1.5\nX1.75\nX3\nM2"  # X3 is Y3 of the machine
    entries = run(program, dialect="rs274ngc").entries
    assert said(Shop(**{**LIMITS, **wide, "P271": 3}), *entries) == [
        "PROGRAM:4:1: E401 target beyond soft limit: axis Y would go to 3, 1 beyond its limit 2"
    ]


def corners(jerk: float, turn_deg: float = 90.0, **pace: Any) -> list[str]:
    """What is said of two corners between lines at 10 units/s."""
    points, heading = [(0.0, 0.0)], 0.0
    for _ in range(3):
        x, y = points[-1]
        points.append((x + 5.0 * math.cos(heading), y + 5.0 * math.sin(heading)))
        heading += math.radians(turn_deg)
    moves = [line(n, at(*point), **pace) for n, point in enumerate(points[1:], start=1)]
    return [each for each in said(Shop(P650_015=jerk), *moves) if "W407" in each]


def test_corners_at_speed_with_a_jerk_limit_and_no_tolerance_are_doubtful() -> None:
    assert corners(20_000.0) == [
        "TEST.TXT:2:1: W407 corner passed with a jerk limit and no tolerance: 2 corners"
        " (with one (G64 P, or P650018) the path keeps its acceleration)"
    ]
    assert corners(0.0) == []
    assert corners(20_000.0, mode=c.PathMode.EXACT) == []
    assert corners(20_000.0, tolerance_u=0.01) == []
    assert corners(20_000.0, turn_deg=1.1) != []
    assert corners(20_000.0, turn_deg=0.9) == []


def test_rapids_and_the_first_move_are_no_corners() -> None:
    jerk = Shop(P650_015=20_000.0)
    assert (
        said(jerk, rapid(1, at(5)), rapid(2, at(5, 5)), line(3, at(0, 5)), line(4, at(-5, 5))) == []
    )
