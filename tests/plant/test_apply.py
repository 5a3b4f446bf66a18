"""A world in the units of the step, and the world of a card without a machine file."""

import math

import pytest

from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import dacs, motors, system
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.counts import count_of, position_of
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.schema import default_world
from openacr.plant.physics.step_cy import plant_step

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


def applied(text: str) -> Memory:
    memory = Memory()
    apply_world(parse_world(text), memory)
    return memory


def test_torques_become_counts_per_second_squared() -> None:
    F = applied(TEXT).F
    counts_per_nm = 2000 / (2 * math.pi * 4e-4)
    assert F[motors.accel_per_volt[2]] == pytest.approx(2.0 * 0.5 * counts_per_nm)
    assert F[motors.peak_accel[2]] == pytest.approx(8.0 * 0.5 * counts_per_nm)
    assert F[motors.coulomb_accel[2]] == pytest.approx(0.01 * counts_per_nm)
    assert F[motors.static_accel[2]] == F[motors.coulomb_accel[2]]
    assert F[motors.viscous_per_s[2]] == pytest.approx(2.0)
    assert F[motors.supply_accel[2]] == pytest.approx(40 / 2 * 0.5 * counts_per_nm)
    assert F[motors.back_emf_per_s[2]] == pytest.approx(0.5**2 / (2 * 4e-4))


def test_positions_count_from_where_the_motor_stands_at_power_up() -> None:
    F = applied(TEXT).F
    assert F[motors.position_cnt[2]] == 0.5
    assert (F[motors.low_stop_cnt[2]], F[motors.high_stop_cnt[2]]) == (-3999.5, 36_000.5)
    assert (F[motors.marker_pitch_cnt[2]], F[motors.marker_phase_cnt[2]]) == (2000, 400)


def test_an_encoder_that_counts_down_mirrors_travel_and_volts() -> None:
    F = applied(TEXT + 'encoder_direction = "down"\n').F
    assert (F[motors.low_stop_cnt[2]], F[motors.high_stop_cnt[2]]) == (-35_999.5, 4000.5)
    assert F[motors.accel_per_volt[2]] < 0


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
    assert memory.F[system.period_s] == 0.001


@pytest.mark.parametrize("mult", [1, 4])
def test_a_card_without_a_machine_file_has_axes_that_settle_with_default_gains(mult: int) -> None:
    world = default_world()
    memory = Memory()
    apply_world(world, memory)
    assert [axis.number for axis in world.axis] == list(range(8))
    memory.I[motors.drive_enabled[7]] = 1
    for _ in range(500):
        shown = memory.F[motors.raw_count[7]] * mult / 4
        error = 500 - math.floor(shown)
        memory.S[dacs.dac_output[7]] = 0.00244140625 * error
        plant_step(memory.F, memory.I, memory.S, 8, 0.0005)
        assert error >= -10
    assert error == 0
