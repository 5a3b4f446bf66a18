"""Programs on the virtual machine: where it goes, how long it takes, when it stops."""

import math

import pytest
from tests.mill.shop import Shop, at, end, line, rapid, src

from openacr.cnc import canonical as c
from openacr.mill.run.lifecycle import Options, State


def test_a_square_is_followed_to_the_pulse() -> None:
    shop = Shop()
    shop.finish(
        line(1, at(1, 0)), line(2, at(1, 1)), line(3, at(0, 1)), line(4, at(0.12345, 0)), end()
    )
    assert shop.pulses() == (1235, 0, 0)  # 1234.5, half away from zero
    assert shop.runner.stream.moves == 4


def test_moves_without_corners_run_at_constant_speed() -> None:
    shop = Shop()
    # 10 units at 10 units/s with 100 units/s2: 1 s and one ramp of 0.1 s
    took_s = shop.finish(*(line(n, at(n / 100)) for n in range(1, 1001)), end())
    assert shop.pulses() == (100000, 0, 0)
    assert took_s == pytest.approx(1.1, abs=0.02)


@pytest.mark.parametrize("plane", list(c.Plane))
def test_arcs_run_in_every_plane(plane: c.Plane) -> None:
    shop = Shop()
    start, finish = [0.0] * 8, [0.0] * 8
    start[plane.first] = finish[plane.second] = 0.5
    quarter = c.Arc(src(2), tuple(finish), plane, (0.0, 0.0), math.pi / 2, 0.5, 0.5, c.Pace(300.0))
    shop.finish(rapid(1, tuple(start)), quarter, end())
    assert shop.pulses() == tuple(round(10000 * each) for each in finish[:3])
    radii = [math.hypot(p[plane.first], p[plane.second]) for p in shop.path[-20:]]
    assert radii == pytest.approx([0.5] * 20, abs=3e-4)


def test_an_arc_the_card_does_not_know_becomes_chords() -> None:
    shop = Shop(P201_006=5000)  # Y has other pulses per unit
    quarter = c.Arc(src(2), at(0, 1), c.Plane.XY, (0.0, 0.0), math.pi / 2, 1, 1, c.Pace(300.0))
    shop.finish(rapid(1, at(1, 0)), quarter, end())
    assert shop.runner.stream.moves > 40  # 0.0001 of height over 90 degrees
    assert shop.pulses() == (0, 5000, 0)


@pytest.mark.parametrize(("stops", "state"), [(True, State.HOLD), (False, State.IDLE)])
def test_m1_holds_only_with_optional_stop(stops: bool, state: State) -> None:
    shop = Shop()
    shop.start(
        line(1, at(1)), c.Stop(src(2), c.Pause.OPTIONAL), end(),
        options=Options(stops_optionally=stops),
    )  # fmt: skip
    assert shop.until(State.HOLD, State.IDLE) is state


def test_single_block_switched_on_in_a_run_finishes_the_block_that_runs() -> None:
    shop = Shop()
    blocks = [entry for n in range(1, 30) for entry in (line(n, at(n / 2)), c.BlockEnd(src(n)))]
    shop.start(*blocks, end())
    shop.pass_time(0.33)
    shop.runner.block(True)
    shop.until(State.HOLD)
    x = shop.pulses()[0]
    assert x % 5000 == 0
    assert 20000 <= x <= 50000
    shop.runner.start()
    shop.until(State.HOLD)
    assert shop.pulses()[0] == x + 5000
    shop.runner.block(False)
    shop.runner.start()
    shop.until(State.IDLE)
    assert shop.pulses()[0] == 145000


def test_what_is_said_is_said_when_the_motion_gets_there() -> None:
    shop = Shop()
    shop.start(line(1, at(1)), c.Say(src(2), "half"), line(3, at(2)), c.Say(src(4), "done"), end())
    shop.pass_time(0.05)
    assert shop.said == []
    shop.pass_time(0.11)
    assert shop.said == ["half"]
    shop.until(State.IDLE)
    assert shop.said == ["half", "done"]


def test_the_line_of_the_move_being_made_is_always_known() -> None:
    shop = Shop()
    shop.start(*(line(10 * n, at(n / 5)) for n in range(1, 20)), end())
    shop.pass_time(0.2)
    while shop.runner.state is State.RUN:
        x = shop.place()[0]
        source = shop.runner.source
        assert source is not None
        if x < 3.7:
            assert source.line == pytest.approx(10 * math.ceil(5 * x), abs=10)
        shop.pass_time(0.02)
