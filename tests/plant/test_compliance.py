"""Loads on an elastic shaft against two masses and a spring, solved by scipy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.plant.conftest import DRIVE, MOTOR, Build, Rig

from openacr.controller import Controller
from openacr.controller import snapshot_file as snapshot
from openacr.map.rows import axes, compliant_loads
from openacr.plant.build.apply import put_state, take_state
from openacr.plant.describe.load import parse_world

pytestmark = pytest.mark.evidence("oracle", "differential equations of two masses solved by scipy")

MOTOR_KGM2, LOAD_KGM2 = 2e-5, 3e-5
RESONANCE_HZ, RATIO = 90.0, 0.05
SWINGS = f"resonance_hz = {RESONANCE_HZ}, damping_ratio = {RATIO}"
LOAD = f"load = {{ inertia_kgm2 = {LOAD_KGM2}, {SWINGS} }}"
COUNTS_PER_RAD = 4000 / (2 * math.pi)
PERIOD_S = 0.0005
W = 2 * math.pi * RESONANCE_HZ
REDUCED_KGM2 = MOTOR_KGM2 * LOAD_KGM2 / (MOTOR_KGM2 + LOAD_KGM2)
STIFFNESS_NM = W * W * REDUCED_KGM2
DAMPING_NMS = 2 * RATIO * W * REDUCED_KGM2


def two_masses(torques_nm: np.ndarray) -> np.ndarray:
    """Places of the motor [counts] after each period of a constant torque."""
    state, places = np.zeros(4), []
    for torque_nm in torques_nm:

        def slope(_t: float, y: np.ndarray, torque_nm: float = torque_nm) -> list[float]:
            motor, motor_speed, load, load_speed = y
            shaft = STIFFNESS_NM * (motor - load) + DAMPING_NMS * (motor_speed - load_speed)
            return [
                motor_speed, (torque_nm - shaft) / MOTOR_KGM2, load_speed, shaft / LOAD_KGM2,
            ]  # fmt: skip

        state = solve_ivp(slope, (0.0, PERIOD_S), state, rtol=1e-10, atol=1e-13).y[:, -1]
        places.append(state[0] * COUNTS_PER_RAD)
    return np.array(places)


def test_a_motor_with_an_elastic_load_moves_as_two_masses_on_a_spring(motor: Build) -> None:
    rig = motor(LOAD)
    volts = np.round(np.random.default_rng(2).uniform(-4.0, 4.0, 200) * 3276.8) / 3276.8
    found = []
    for each in volts:
        rig.turn(float(each))
        found.append(rig.position - 0.5)
    expected = two_masses(0.5 * volts)
    assert np.ptp(expected) > 100
    assert np.abs(np.array(found) - expected).max() < 1e-5


def bent_by(accel_rad_s2: float) -> float:
    """Flexion [counts] after a period in which a torque accelerates the centre so much."""
    swing = W * math.sqrt(1 - RATIO**2)
    c, d = math.cos(swing * PERIOD_S), math.sin(swing * PERIOD_S)
    kept = math.exp(-RATIO * W * PERIOD_S) * (c + RATIO * W / swing * d)
    return LOAD_KGM2 / MOTOR_KGM2 * accel_rad_s2 * COUNTS_PER_RAD / W**2 * (1 - kept)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("drive", "volts", "rad_s", "torque_nm"),
    [
        ("peak_amps = 20.0", 4.0, 50.0, 2.0),
        ("peak_amps = 2.0", 4.0, 50.0, 1.0),
        ("peak_amps = 20.0, supply_v = 80.0", 8.0, 50.0, 0.5 * (80.0 - 0.5 * 50.0) / 10.0),
        ("peak_amps = 20.0, supply_v = 80.0", 8.0, -50.0, 4.0),
        ("peak_amps = 20.0, supply_v = 80.0", 8.0, 0.0, 4.0),  # exactly what the supply gives
    ],
)
def test_the_torque_that_bends_the_shaft_has_the_limits_of_the_drive(
    drive: str, volts: float, rad_s: float, torque_nm: float, sign: float
) -> None:
    text = (MOTOR + DRIVE + LOAD).replace("peak_amps = 20.0", drive)
    rig = Rig(text.replace("0.5 }", "0.5, resistance_ohm = 10.0 }"))
    rig.throw(sign * rad_s * COUNTS_PER_RAD)
    rig.turn(sign * volts)
    found = rig.memory.F[compliant_loads.flex_cnt[0]]
    expected = bent_by(sign * torque_nm / (MOTOR_KGM2 + LOAD_KGM2))
    assert found == pytest.approx(expected, rel=1e-4)  # steps of the converter


def test_a_coasting_motor_swings_out_at_its_resonance(motor: Build) -> None:
    rig = motor(LOAD)
    rig.turn(2.0, ticks=20)
    rig.enable(0, on=False)
    flexions = []
    for _ in range(400):
        rig.turn(2.0)
        flexions.append(rig.memory.F[compliant_loads.flex_cnt[0]])
    flexion = np.array(flexions)
    t = np.arange(400) * PERIOD_S
    swing = W * math.sqrt(1 - RATIO**2)
    shape = np.exp(-RATIO * W * t) * np.array([np.cos(swing * t), np.sin(swing * t)])
    _, misfit, *_ = np.linalg.lstsq(shape.T, flexion, rcond=None)
    assert np.abs(flexion[:40]).max() > 1.0
    assert misfit[0] < 1e-18 * (flexion @ flexion)


def test_a_swing_does_not_depend_on_the_length_of_the_period(motor: Build) -> None:
    one, other = motor(LOAD), motor(LOAD)
    one.turn(2.0, ticks=60)
    other.turn(2.0, ticks=20)
    other.period_s = 0.001
    other.turn(2.0, ticks=20)
    assert other.position == pytest.approx(one.position, rel=1e-9)


def test_a_swing_that_a_snapshot_damps_beyond_measure_stays_a_number(motor: Build) -> None:
    rig = motor(LOAD)
    rig.memory.F[compliant_loads.damping_per_s[0]] = 2 * W
    rig.turn(2.0, ticks=20)
    assert math.isfinite(rig.position)


WORLD = """
[[axis]]
number = 1
counts_per_rev = 4000
[axis.motor]
inertia_kgm2 = 2e-5
torque_nm_per_a = 0.05
[axis.load]
inertia_kgm2 = 3e-5
resonance_hz = 60.0
[axis.drive]
mode = "torque"
amps_per_volt = 1.0
peak_amps = 20.0
"""
SET_UP = 'PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS1 "Y"\rPGAIN Y0.002 DGAIN Y0.00002\r'


def swinging() -> Controller:
    card = Controller(world=parse_world(WORLD))
    card.send(SET_UP)
    card.p[axes.jog_offset[1]] = 300
    card.advance(40)
    return card


def test_a_card_from_a_snapshot_swings_on_as_the_one_it_was_made_of() -> None:
    card, again = swinging(), Controller(world=parse_world(WORLD))
    again.take_over(snapshot.decode(snapshot.encode(card.snapshot())))
    assert abs(card.memory.F[compliant_loads.flex_cnt[1]]) > 0.1
    assert abs(card.memory.F[compliant_loads.flex_cps[1]]) > 1.0
    for each in (card, again):
        each.advance(200)
    assert again.memory.snapshot() == card.memory.snapshot()


def test_a_restart_of_the_card_does_not_stop_what_swings() -> None:
    card = swinging()
    state = take_state(card.memory)
    before = card.memory.F[compliant_loads.flex_cnt[1]]
    card.memory.F[compliant_loads.flex_cnt[1]] = 0.0
    put_state(card.memory, state)
    assert card.memory.F[compliant_loads.flex_cnt[1]] == before
    card.send("REBOOT\r")
    assert card.memory.F[compliant_loads.flex_cnt[1]] != 0.0
    assert card.memory.F[compliant_loads.resonance_rad_s[1]] == 2 * math.pi * 60.0
