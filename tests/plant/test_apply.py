"""A world in the units of the step, and the world of a card without a machine file."""

import math

import pytest

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.plant.apply import apply_world
from openacr.plant.counts import count_of, position_of
from openacr.plant.load import parse_world
from openacr.plant.schema import default_world
from openacr.plant.step_cy import plant_step

TEXT = """
[card]
period_s = 0.001
[[axis]]
number = 2
encoder_lines = 500
units_per_rev = 5.0
initial = 10.0
marker = 11.0
travel = [0.0, 100.0]
motor = { inertia_kgm2 = 1e-4, torque_nm_per_a = 0.5, resistance_ohm = 2.0 }
load = { inertia_kgm2 = 3e-4, viscous_nms = 8e-4, coulomb_nm = 0.01 }
drive = { mode = "torque", amps_per_volt = 2.0, peak_amps = 8.0, supply_v = 40.0 }
"""


def rows(text: str, axis: int = 2) -> list[float]:
    memory = Memory()
    apply_world(parse_world(text), memory)
    base = at.PLF_BASE + axis * at.PLF_STRIDE
    return list(memory.F[base : base + at.PLF_STRIDE])


def test_torques_become_counts_per_second_squared() -> None:
    row = rows(TEXT)
    counts_per_nm = 2000 / (2 * math.pi * 4e-4)
    assert row[at.PLF_ACCEL_PER_VOLT] == pytest.approx(2.0 * 0.5 * counts_per_nm)
    assert row[at.PLF_PEAK_ACCEL] == pytest.approx(8.0 * 0.5 * counts_per_nm)
    assert row[at.PLF_COULOMB_ACCEL] == pytest.approx(0.01 * counts_per_nm)
    assert row[at.PLF_STATIC_ACCEL] == row[at.PLF_COULOMB_ACCEL]
    assert row[at.PLF_VISCOUS_PER_S] == pytest.approx(2.0)
    assert row[at.PLF_SUPPLY_ACCEL] == pytest.approx(40 / 2 * 0.5 * counts_per_nm)
    assert row[at.PLF_BACK_EMF_PER_S] == pytest.approx(0.5**2 / (2 * 4e-4))


def test_positions_count_from_where_the_motor_stands_at_power_up() -> None:
    row = rows(TEXT)
    assert row[at.PLF_POSITION_CNT] == 0.5
    assert (row[at.PLF_LOW_STOP_CNT], row[at.PLF_HIGH_STOP_CNT]) == (-3999.5, 36_000.5)
    assert (row[at.PLF_MARKER_PITCH_CNT], row[at.PLF_MARKER_PHASE_CNT]) == (2000, 400)


def test_an_encoder_that_counts_down_mirrors_travel_and_volts() -> None:
    row = rows(TEXT + 'encoder_direction = "down"\n')
    assert (row[at.PLF_LOW_STOP_CNT], row[at.PLF_HIGH_STOP_CNT]) == (-35_999.5, 4000.5)
    assert row[at.PLF_ACCEL_PER_VOLT] < 0


def test_positions_convert_both_ways() -> None:
    for direction in ("up", "down"):
        axis = parse_world(TEXT + f'encoder_direction = "{direction}"\n').axis[0]
        assert position_of(axis, count_of(axis, 33.3)) == pytest.approx(33.3)


def test_a_world_replaces_the_one_before() -> None:
    memory = Memory()
    apply_world(parse_world(TEXT + 'positive_limit = { at = 5.0, contact = "closed" }\n'), memory)
    apply_world(default_world(), memory)
    fresh = Memory()
    apply_world(default_world(), fresh)
    memory.I[at.W_INPUTS] = 0
    assert memory.digest() == fresh.digest()


def test_the_servo_period_comes_from_the_machine_file() -> None:
    memory = Memory()
    apply_world(parse_world(TEXT), memory)
    assert memory.F[at.SYSF_BASE + at.SYSF_PERIOD_S] == 0.001


@pytest.mark.parametrize("mult", [1, 4])
def test_a_card_without_a_machine_file_has_axes_that_settle_with_default_gains(mult: int) -> None:
    world = default_world()
    memory = Memory()
    apply_world(world, memory)
    assert [axis.number for axis in world.axis] == list(range(8))
    row, dac = at.PLF_BASE + 7 * at.PLF_STRIDE, at.DAC_BASE + 7 * at.DAC_STRIDE
    memory.I[at.PLI_BASE + 7 * at.PLI_STRIDE + at.PLI_DRIVE_ENABLED] = 1
    for _ in range(500):
        shown = memory.F[row + at.PLF_RAW_COUNT] * mult / 4
        error = 500 - math.floor(shown)
        memory.S[dac + at.DAC_DAC_OUTPUT] = 0.00244140625 * error
        plant_step(memory.F, memory.I, memory.S, 8, 0.0005)
        assert error >= -10
    assert error == 0
