"""The machines of the examples, moved by a bare servo loop with the manual's gains."""

import math
from pathlib import Path

import pytest

from openacr import compiled
from openacr.map import numbers as at
from openacr.map.memory import Memory
from openacr.map.rows import dacs, motors
from openacr.plant.build.apply import apply_world
from openacr.plant.describe.counts import count_of
from openacr.plant.describe.load import load_world
from openacr.plant.describe.schema import World, switches
from openacr.plant.physics.step_cy import plant_step

EXAMPLES = Path(__file__).parents[2] / "examples"
PGAIN, DGAIN, TLM = 0.002441, 1e-5, 10.0
PERIOD_S = 0.0005


def load(name: str) -> World:
    return load_world(EXAMPLES / name / "machine.toml")


class Servo:
    """P and D of the card around one axis of an example."""

    def __init__(self, world: World, axis: int) -> None:
        self.memory = Memory()
        apply_world(world, self.memory)
        self.axis = axis
        self.dac = dacs.dac_output[axis]
        self.memory.I[motors.drive_enabled[axis]] = 1
        self.error = 0.0

    def follow(self, setpoint_cnt: float) -> float:
        """Advance one tick towards a setpoint; the following error in counts."""
        m = self.memory
        error = round(setpoint_cnt) - m.F[motors.raw_count[self.axis]]
        volts = PGAIN * error + DGAIN * (error - self.error) / PERIOD_S
        m.S[self.dac] = max(-TLM, min(TLM, volts))
        self.error = error
        compiled.pick(plant_step)(m.F, m.I, m.S, 8, PERIOD_S)
        return abs(error)

    def trapezoid(self, distance: float, velocity: float, accel: float) -> float:
        """Move from rest to rest; the largest following error in counts."""
        ramp = min(velocity / accel, math.sqrt(distance / accel))
        total = distance / (accel * ramp) + ramp
        worst = 0.0
        for tick in range(int(total / PERIOD_S) + 200):
            t = min(tick * PERIOD_S, total)
            late = max(0.0, t - (total - ramp))
            s = 0.5 * accel * min(t, ramp) ** 2 + accel * ramp * max(0.0, t - ramp)
            worst = max(worst, self.follow(s - 0.5 * accel * late**2))
        return worst


@pytest.mark.parametrize(
    ("name", "axis", "per_unit", "distance", "velocity", "accel", "allowed_u", "rest_cnt"),
    [
        ("gantry", 0, 40_000, 6, 5, 10, 0.02, 4),
        ("gantry", 2, 40_000, 5, 10, 20, 0.02, 4),
        ("homing_xyz", 0, 800, 70, 300, 1000, 0.5, 4),
        ("homing_xyz", 2, 1600, 15, 100, 200, 0.5, 4),
        ("square", 0, 8000, 5, 5, 50, 0.05, 0),
        ("diamonds", 1, 40_000, 3, 2, 20, 0.02, 0),
        ("basic_motion", 0, 800, 400, 200, 1000, 1.5, 0),
        ("error_handler", 1, 8000, 5, 5, 50, 0.05, 0),
    ],
)
def test_the_gains_of_the_manual_move_the_axis_well(
    name: str,
    axis: int,
    per_unit: float,
    distance: float,
    velocity: float,
    accel: float,
    allowed_u: float,
    rest_cnt: float,
) -> None:
    world = load(name)
    assert world.axis[axis].counts_per_unit == pytest.approx(per_unit)
    servo = Servo(world, axis)
    worst = servo.trapezoid(distance * per_unit, velocity * per_unit, accel * per_unit)
    assert worst < allowed_u * per_unit
    assert abs(servo.error) <= rest_cnt
    assert servo.memory.F[motors.velocity_cps[servo.axis]] == 0.0


def test_the_gantry_has_its_limit_switches_closed_and_the_curtain_dark() -> None:
    memory = Memory()
    apply_world(load("gantry"), memory)
    assert memory.I[at.W_INPUTS] == sum(1 << n for n in (0, 1, 3, 4, 6, 7))


def test_the_light_curtain_of_the_gantry_lies_between_12_and_18_inches() -> None:
    servo = Servo(load("gantry"), 0)
    servo.trapezoid(12 * 40_000, 200_000, 400_000)
    assert not servo.memory.bit(10)
    beyond = Servo(load("gantry"), 0)
    beyond.trapezoid(18 * 40_000, 400_000, 1_600_000)
    assert beyond.memory.bit(10)


def test_the_basic_motion_axis_reaches_1200_units_to_both_sides() -> None:
    low, high = load("basic_motion").axis[0].travel or (0.0, 0.0)
    assert low < -1200 and high > 1200


@pytest.mark.parametrize(
    ("axis", "travel_u", "edge", "seek_u", "back_u"),
    [(0, 10.0, 1, 10.5, 97.0), (1, 9.4, 1, 10.5, 57.5), (2, 3.2, 0, 5.5, 4.4)],
)
def test_homing_finds_switch_and_marker_with_room_to_stop(
    axis: int, travel_u: float, edge: int, seek_u: float, back_u: float
) -> None:
    machine = load("homing_xyz").axis[axis]
    found = {switch.key: switch for switch in switches(machine)}
    home = found["home"]
    edge_u = home.high_u if edge else home.low_u
    assert home.high_u - home.low_u > travel_u / 2
    assert found["negative_limit"].high_u < edge_u - travel_u
    assert found["positive_limit"].low_u > edge_u + max(travel_u, 2 * seek_u / 2)
    assert machine.marker is not None
    assert 0.2 * seek_u < machine.marker - edge_u < 0.8 * seek_u
    assert found["negative_limit"].high_u < machine.marker - back_u
    assert count_of(machine, machine.initial) == 0.5
