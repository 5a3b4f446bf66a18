"""Drives, friction and hard stops against closed forms and an independent integrator."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.plant.conftest import Build, Rig

from openacr.map.rows import motors

pytestmark = pytest.mark.evidence("oracle", "closed forms, differential equations solved by scipy")

PER_VOLT = 1.0 * 0.5 / 2e-5 * 4000 / (2 * math.pi)  # counts/s^2
PER_NM = 4000 / (2 * math.pi * 2e-5)
IDEAL = 'drive = { mode = "ideal", revs_per_s_per_volt = 5.0, lag_s = 0.01 }\n'


def test_a_free_motor_runs_down_exponentially(motor: Build) -> None:
    rig = motor("load = { viscous_nms = 4e-4 }")  # rate 4e-4 / 2e-5 = 20 /s
    rig.throw(10_000.0)
    rig.turn(ticks=200)
    assert rig.velocity == pytest.approx(10_000 * math.exp(-20 * 0.1), rel=1e-12)
    assert rig.position == pytest.approx(0.5 + 500 * (1 - math.exp(-2)), rel=1e-12)


def test_run_down_does_not_depend_on_the_length_of_the_tick(motor: Build) -> None:
    rig = motor("load = { viscous_nms = 100.0 }", period_s=0.005)  # 5e6 /s: far beyond 1/dt
    rig.throw(10_000.0)
    rig.turn(ticks=3)
    assert rig.velocity == 0.0
    assert rig.position == pytest.approx(0.5 + 10_000 / 5e6, rel=1e-9)


def test_constant_torque_accelerates_evenly(motor: Build) -> None:
    rig = motor()
    rig.turn(1.25, ticks=100)
    assert rig.velocity == pytest.approx(1.25 * PER_VOLT * 0.05, rel=1e-12)
    assert rig.position == pytest.approx(0.5 + 1.25 * PER_VOLT * 0.05**2 / 2, rel=1e-12)


def test_coulomb_friction_stops_a_coasting_motor_at_the_computed_place(motor: Build) -> None:
    rig = motor("load = { coulomb_nm = 0.01 }")
    rig.throw(20_000.0)
    rig.turn(ticks=2000)
    assert rig.velocity == 0.0
    assert rig.position == pytest.approx(0.5 + 20_000**2 / (2 * 0.01 * PER_NM), rel=1e-9)


def test_both_frictions_stop_at_the_computed_place(motor: Build) -> None:
    rig = motor("load = { coulomb_nm = 0.01, viscous_nms = 4e-4 }")
    rig.throw(-20_000.0)
    rig.turn(ticks=2000)
    c, rate = 0.01 * PER_NM, 20.0
    t = math.log(1 + rate * 20_000 / c) / rate
    distance = (20_000 + c / rate) * (1 - math.exp(-rate * t)) / rate - c / rate * t
    assert rig.position == pytest.approx(0.5 - distance, rel=1e-9)


def test_a_motor_at_rest_does_not_creep_below_static_friction(motor: Build) -> None:
    rig = motor("load = { coulomb_nm = 0.04, static_nm = 0.05 }")
    rig.turn(0.0999, ticks=4000)
    assert (rig.position, rig.velocity) == (0.5, 0.0)
    rig.turn(0.1003, ticks=1)
    assert rig.velocity > 0.0


def test_a_reversal_within_a_tick_leaves_in_the_other_direction(motor: Build) -> None:
    rig = motor("load = { coulomb_nm = 0.05 }")
    rig.throw(100.0)
    rig.turn(-5.0)
    brake, push = 5 * PER_VOLT + 0.05 * PER_NM, 5 * PER_VOLT - 0.05 * PER_NM
    rest = 0.0005 - 100 / brake
    assert rig.velocity == pytest.approx(-push * rest, rel=1e-6)
    assert rig.position == pytest.approx(0.5 + 100**2 / 2 / brake - push * rest**2 / 2, rel=1e-6)


def test_current_is_limited_to_the_peak_of_the_drive(motor: Build) -> None:
    rig = motor(drive='drive = { mode = "torque", amps_per_volt = 10.0, peak_amps = 20.0 }\n')
    rig.turn(9.0, ticks=10)
    assert rig.velocity == pytest.approx(20 * PER_VOLT * 0.005, rel=1e-12)


def test_the_supply_limits_the_speed(rig: type[Rig]) -> None:
    run = rig("""
[[axis]]
number = 0
counts_per_rev = 4000
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.5, resistance_ohm = 4.0 }
drive = { mode = "torque", amps_per_volt = 1.0, peak_amps = 20.0, supply_v = 50.0 }
""")
    run.turn(10.0, ticks=2000)
    no_load_cps = 50.0 / 0.5 * 4000 / (2 * math.pi)
    assert run.velocity == pytest.approx(no_load_cps, rel=1e-6)


def test_a_velocity_drive_ramps_with_peak_torque_then_settles(motor: Build) -> None:
    drive = (
        'drive = { mode = "velocity", revs_per_s_per_volt = 5.0, peak_amps = 2.0, lag_s = 0.001 }\n'
    )
    rig = motor("load = { coulomb_nm = 0.3 }", drive=drive)
    accel = 2.0 * PER_VOLT
    rig.turn(5.0, ticks=4)
    assert rig.velocity == pytest.approx(accel * 0.002, rel=1e-12)
    rig.turn(5.0, ticks=400)
    assert rig.velocity == pytest.approx(5.0 * 5.0 * 4000, rel=1e-4)
    rig.enable(0, on=False)
    rig.turn(5.0, ticks=400)
    assert rig.velocity == 0.0


def test_a_velocity_drive_switches_from_ramp_to_lag_within_a_tick(motor: Build) -> None:
    drive = (
        'drive = { mode = "velocity", revs_per_s_per_volt = 5.0, peak_amps = 2.0, lag_s = 0.001 }\n'
    )
    rig = motor(drive=drive)
    accel = 2.0 * PER_VOLT

    def slope(_t: float, y: list[float]) -> list[float]:
        return [y[1], max(-accel, min(accel, (25_000.0 - y[1]) / 0.001))]

    rig.turn(1.25, ticks=10)
    truth = solve_ivp(slope, (0, 0.005), [0.5, 0.0], rtol=1e-10, atol=1e-8, max_step=1e-5)
    assert rig.velocity == pytest.approx(truth.y[1][-1], rel=1e-6)
    assert rig.position == pytest.approx(truth.y[0][-1], rel=1e-6)


def test_an_ideal_drive_reaches_its_speed_with_the_lag(rig: type[Rig]) -> None:
    run = rig("[[axis]]\nnumber = 0\ncounts_per_rev = 4000\n" + IDEAL)
    run.turn(1.25, ticks=20)
    assert run.velocity == pytest.approx(25_000 * (1 - math.exp(-1)), rel=1e-12)
    run.turn(0.0, ticks=2000)
    assert run.velocity == 0.0


def test_a_disabled_drive_gives_no_torque_and_the_motor_coasts(motor: Build) -> None:
    rig = motor("load = { viscous_nms = 4e-4 }")
    rig.enable(0, on=False)
    rig.throw(1000.0)
    rig.turn(10.0, ticks=100)
    assert rig.velocity == pytest.approx(1000 * math.exp(-1), rel=1e-12)
    assert rig.flag(motors.drive_ready) == 0


def test_a_drive_with_an_active_fault_line_gives_no_torque(motor: Build) -> None:
    drive = 'drive = { mode = "torque", amps_per_volt = 1.0, peak_amps = 20.0, fault_input = 16 }\n'
    rig = motor(drive=drive)
    rig.turn(1.0)
    assert (rig.flag(motors.drive_ready), rig.flag(motors.drive_fault)) == (1, 0)
    speed = rig.velocity
    rig.memory.set_bit(16, True)
    rig.turn(1.0, ticks=10)
    assert (rig.flag(motors.drive_ready), rig.flag(motors.drive_fault)) == (0, 1)
    assert rig.velocity == speed


def test_a_hard_stop_takes_all_speed_and_is_left_freely(motor: Build) -> None:
    rig = motor("travel = [-1.0, 2.0]")
    rig.turn(1.0, ticks=1000)
    assert (rig.position, rig.velocity) == (8000.5, 0.0)
    rig.turn(-1.0, ticks=2)
    assert rig.position < 8000.5
    rig.turn(-1.0, ticks=1000)
    assert (rig.position, rig.velocity) == (-3999.5, 0.0)


def test_the_encoder_shows_whole_counts_rounded_down(motor: Build) -> None:
    rig = motor()
    rig.throw(-700.0)
    rig.turn(ticks=3)  # 0.5 - 1.05
    assert rig.get(motors.raw_count) == -1.0
    rig.turn(ticks=2)  # -1.25
    assert rig.get(motors.raw_count) == -2.0


def test_the_encoder_of_a_motor_starts_at_zero_wherever_it_stands(motor: Build) -> None:
    rig = motor("initial = 12.25")
    rig.turn()
    assert rig.get(motors.raw_count) == 0.0


def test_a_positive_voltage_makes_the_encoder_count_up_or_down_as_wired(motor: Build) -> None:
    up, down = motor(), motor('encoder_direction = "down"')
    up.turn(1.0, ticks=50)
    down.turn(1.0, ticks=50)
    assert up.get(motors.raw_count) > 100
    assert down.position - 0.5 == -(up.position - 0.5)


@pytest.mark.parametrize(
    ("bits", "asked", "given"),
    [
        (16, 1.0, 3277 / 3276.8),
        (16, 1.25, 1.25),
        (16, 0.00031, 1 / 3276.8),
        (16, 50.0, 32767 / 3276.8),
        (16, math.nan, 0.0),
        (12, 0.004, 16 / 3276.8),
        (12, 0.002, 0.0),
        (12, 9.9999, 32752 / 3276.8),
    ],
)
def test_volts_come_in_steps_of_the_converter(
    motor: Build, bits: int, asked: float, given: float
) -> None:
    rig = motor(tables=f"[card]\ndac_bits = {bits}\n")
    rig.turn(asked)
    assert rig.get(motors.volts) == pytest.approx(given, rel=1e-12)


def test_the_offset_of_a_drive_makes_the_motor_drift(motor: Build) -> None:
    rig = motor(
        drive='drive = { mode = "torque", amps_per_volt = 1.0, peak_amps = 2.0, offset_v = 0.01 }\n'
    )
    rig.turn(0.0, ticks=100)
    assert rig.velocity == pytest.approx(0.01 * PER_VOLT * 0.05, rel=1e-12)


def test_a_motor_may_hang_on_another_converter(motor: Build) -> None:
    rig = motor("dac = 5")
    rig.turn(1.0, axis=5)
    assert rig.velocity > 0


def test_a_servo_loop_behaves_as_an_independent_integration_says(motor: Build) -> None:
    """PD loop at 2 kHz with hold, friction and limited torque; only encoder and DAC are finer."""
    rig = motor("load = { viscous_nms = 4e-4, coulomb_nm = 0.005 }")
    p, d, period, target = 0.002, 1.5e-5, 0.0005, 3000.0

    def volts(position: float, old: float) -> float:
        error = target - (position - 0.5)
        return max(-10.0, min(10.0, p * error - d * (position - old) / period))

    def slope(_t: float, y: list[float], u: float) -> list[float]:
        friction = 20 * y[1] + 0.005 * PER_NM * math.tanh(y[1] / 5.0)
        return [y[1], PER_VOLT * u - friction]

    truth, old_truth, old = np.array([0.5, 0.0]), 0.5, 0.5
    for _ in range(240):
        u = volts(truth[0], old_truth)
        old_truth = truth[0]
        truth = solve_ivp(slope, (0, period), truth, args=(u,), rtol=1e-8, atol=1e-6).y[:, -1]
        now = rig.position
        rig.turn(volts(now, old))
        old = now
        assert rig.position == pytest.approx(truth[0], abs=8.0)
    assert rig.position == pytest.approx(3000.5, abs=15)


@pytest.mark.parametrize(("fault", "edges"), [(0, 3), (1, 3), (2, 0), (4, 0)])
def test_an_encoder_without_signals_has_no_marker(motor: Build, fault: int, edges: int) -> None:
    rig = motor("marker = 0.0\n")
    rig.memory.I[motors.encoder_fault[0]] = fault
    rig.throw(4000 / 0.0005)  # a turn in a period
    rig.turn(ticks=1)
    assert rig.flag(motors.marker_edges) == edges
