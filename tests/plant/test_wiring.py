"""Switches, markers, regions and wires: levels, and edges exact to the count."""

import math

import pytest
from tests.plant.conftest import Rig

from openacr.map.numbers import W_INPUTS
from openacr.map.rows import motors, plant

AXIS = """[[axis]]
number = %d
name = "%s"
counts_per_rev = 4000
drive = { mode = "ideal", revs_per_s_per_volt = 500.0, lag_s = 0.0 }
"""
X, Y = AXIS % (0, "X"), AXIS % (1, "Y")
TICK_CNT = 1000.0  # counts per tick at 1 V: 500 rev/s/V * 4000 / 2000


def inputs(run: Rig) -> int:
    return run.memory.I[W_INPUTS]


def move(run: Rig, counts: float, axis: int = 0) -> None:
    """Move exactly `counts` within one tick: the coarse converter is bypassed by the offset."""
    run.put(motors.offset_v, counts / TICK_CNT, axis)
    for n in range(8):
        if n != axis:
            run.put(motors.offset_v, 0.0, n)
    run.turn(0.0)


def fraction(run: Rig, row: int, number: int) -> float:
    return run.memory.F[row + number]


def test_limit_switches_are_on_at_and_beyond_their_position_on_inputs_3n(rig: type[Rig]) -> None:
    run = rig(Y + "positive_limit = { at = 1.0 }\nnegative_limit = { at = -0.5 }\n")
    assert inputs(run) == 0
    move(run, 3999.4, axis=1)
    assert inputs(run) == 0
    move(run, 1.0, axis=1)
    assert inputs(run) == 1 << 3
    move(run, 10_000.0, axis=1)
    assert inputs(run) == 1 << 3
    move(run, -17_000.0, axis=1)
    assert inputs(run) == 1 << 4
    assert run.general(plant.falls) == 1 << 3
    assert run.general(plant.rises) == 1 << 4


def test_a_normally_closed_switch_is_on_until_it_is_reached(rig: type[Rig]) -> None:
    run = rig(X + 'positive_limit = { at = 1.0, input = 7, contact = "closed" }\n')
    assert inputs(run) == 1 << 7
    move(run, 4100.0)
    assert inputs(run) == 0
    assert run.general(plant.falls) == 1 << 7


def test_switches_are_right_before_the_first_tick(rig: type[Rig]) -> None:
    run = rig(X + "initial = 2.0\npositive_limit = { at = 1.0 }\nhome = { between = [1.5, 2.5] }\n")
    assert inputs(run) == 0b101
    run.turn()
    assert inputs(run) == 0b101
    assert run.general(plant.rises) == 0


@pytest.mark.parametrize("speed", [3.3, 77.7, 1234.5, 54_321.0])
def test_the_count_at_a_switch_edge_is_exact_at_any_speed(rig: type[Rig], speed: float) -> None:
    run = rig(X + "home = { between = [25.0, 50.0] }\n")
    run.put(motors.position_cnt, 1e5 - 2.5 * speed)
    while not run.general(plant.rises):
        move(run, speed)
    part = fraction(run, plant.rise_fraction, 2)
    old, new = run.get(motors.previous_cnt), run.position
    assert 0.0 <= part <= 1.0
    assert math.floor(old + part * (new - old)) == 100_000


def test_a_switch_crossed_within_one_tick_shows_both_edges(rig: type[Rig]) -> None:
    run = rig(X + "home = { between = [0.1, 0.2] }\n")
    move(run, 1000.0)
    assert inputs(run) == 0
    assert run.general(plant.rises) == run.general(plant.falls) == 1 << 2
    assert fraction(run, plant.rise_fraction, 2) == pytest.approx(0.4, abs=0.001)
    assert fraction(run, plant.fall_fraction, 2) == pytest.approx(0.8, abs=0.001)
    move(run, 1.0)
    assert run.general(plant.rises) == run.general(plant.falls) == 0


def test_an_encoder_that_counts_down_keeps_switches_where_they_are(rig: type[Rig]) -> None:
    run = rig(X + 'encoder_direction = "down"\npositive_limit = { at = 1.0 }\n')
    run.turn(1.0, ticks=3)
    assert inputs(run) == 0
    run.turn(1.0, ticks=2)
    assert inputs(run) == 1
    assert run.get(motors.raw_count) < -4000


def test_a_program_cannot_override_a_wired_input_but_any_other(rig: type[Rig]) -> None:
    run = rig(X + "positive_limit = { at = 1.0 }\n")
    run.memory.set_bit(0, True)
    run.memory.set_bit(9, True)
    run.turn()
    assert inputs(run) == 1 << 9


def test_constant_inputs_stay_on_or_off(rig: type[Rig]) -> None:
    run = rig(X + "[inputs]\non = [5, 31, 256]\noff = [6]\n")
    run.memory.set_bit(6, True)
    run.memory.set_bit(5, False)
    run.turn()
    assert [run.memory.bit(n) for n in (5, 31, 256, 6)] == [True, True, True, False]


def test_a_region_is_where_all_its_ranges_hold(rig: type[Rig]) -> None:
    run = rig(X + Y + "[[wire]]\ninput = 10\nregion = { X = [1.0, 2.0], Y = [-3.0, -1.0] }\n")
    move(run, 6000.0, axis=0)
    assert not run.memory.bit(10)
    move(run, -6000.0, axis=1)
    assert run.memory.bit(10)
    assert fraction(run, plant.rise_fraction, 10) == pytest.approx(4000 / 6000, abs=0.001)
    move(run, 9000.0, axis=0)
    assert not run.memory.bit(10)
    assert fraction(run, plant.fall_fraction, 10) == pytest.approx(2000 / 9000, abs=0.001)


def test_passing_one_range_of_a_region_while_outside_another_shows_nothing(rig: type[Rig]) -> None:
    run = rig(X + Y + "[[wire]]\ninput = 10\nregion = { X = [1.0, 2.0], Y = [-3.0, -1.0] }\n")
    move(run, 20_000.0, axis=0)
    assert run.general(plant.rises) == run.general(plant.falls) == 0


@pytest.mark.parametrize(("units", "ends"), [("counts", "[4000, 8000]"), ("revs", "[1, 2]")])
def test_ranges_may_be_given_in_counts_or_revolutions(
    rig: type[Rig], units: str, ends: str
) -> None:
    axis = X + "units_per_rev = 5.0\n"
    run = rig(axis + f'[[wire]]\ninput = 10\nunits = "{units}"\nregion = {{ X = {ends} }}\n')
    move(run, 3999.0)
    assert not run.memory.bit(10)
    move(run, 1.0)
    assert run.memory.bit(10)


def test_an_output_drives_an_input_after_its_delay(rig: type[Rig]) -> None:
    run = rig(X + "[[wire]]\ninput = 12\noutput = 40\ndelay_s = 0.002\n")
    run.memory.set_bit(40, True)
    run.turn(ticks=3)
    assert not run.memory.bit(12)
    run.turn()
    assert run.memory.bit(12)
    run.memory.set_bit(40, False)
    run.turn(ticks=2)
    run.memory.set_bit(40, True)
    run.turn(ticks=10)
    assert run.memory.bit(12)


def test_an_output_through_a_closed_contact_switches_its_input_off(rig: type[Rig]) -> None:
    run = rig(X + '[[wire]]\ninput = 12\noutput = 40\ncontact = "closed"\n')
    assert run.memory.bit(12)
    run.memory.set_bit(40, True)
    run.turn()
    assert not run.memory.bit(12)


@pytest.mark.parametrize("step", [0.3, 1.0, 700.0, 3999.0])
def test_the_marker_is_present_in_one_count_of_each_revolution(rig: type[Rig], step: float) -> None:
    run = rig(X + "marker = 0.25\n")
    for _ in range(30):
        move(run, step)
        assert run.flag(motors.marker) == (run.get(motors.raw_count) % 4000 == 1000)


def test_marker_edges_give_the_count_after_the_edge_in_both_directions(rig: type[Rig]) -> None:
    run = rig(X + "marker = 0.25\n")
    move(run, 999.7)
    assert run.flag(motors.marker_edges) == 1
    assert (run.get(motors.marker_rise_cnt), run.flag(motors.marker)) == (1000.0, 1)
    move(run, 1000.0)
    assert run.flag(motors.marker_edges) == 2
    assert run.get(motors.marker_fall_cnt) == 1001.0
    move(run, -2000.0)
    assert run.flag(motors.marker_edges) == 3
    assert run.get(motors.marker_rise_cnt) == 1000.0
    assert run.get(motors.marker_fall_cnt) == 999.0
    assert run.get(motors.marker_rise_fraction) == pytest.approx((2000.2 - 1001) / 2000)
    run.turn()
    move(run, -1.0)
    assert run.flag(motors.marker_edges) == 0
