"""Stepper motors in the machine: following, stalls, limits, homing, maintenance."""

import math

import pytest

from openacr.controller import Controller
from openacr.errors import SourceError, UserError
from openacr.map.rows import motors
from openacr.plant.describe.load import parse_world
from openacr.protocol.events import ControlKey

MACHINE = """
[[axis]]
number = 4
name = "X"
units = "mm"
units_per_rev = 5.0
initial = 10.0
travel = [-5.0, 105.0]
positive_limit = { at = 100.0, input = 12 }
negative_limit = { at = 0.0, input = 13 }
home = { between = [4.0, 6.0], input = 14 }

[axis.motor]
inertia_kgm2 = 3.0e-5

[axis.load]
inertia_kgm2 = 2.0e-5
viscous_nms = 1.0e-4
coulomb_nm = 0.02

[axis.drive]
mode = "stepper"
output = 5
steps_per_rev = 2000
torque_nm = [[0.0, 0.5], [5.0, 0.5], [20.0, 0.1]]
"""
WITH_ENCODER = MACHINE.replace('units = "mm"', 'units = "mm"\nencoder_lines = 500')
OPEN_LOOP = "ATTACH AXIS4 STEPPER5 STEPPER5"
PPU = 400  # pulses in a millimetre


def card(*lines: str, machine: str = MACHINE, attach: str = OPEN_LOOP) -> Controller:
    """A card whose axis 4 drives the motor; the machine stands at 10 mm, the card counts from 0."""
    made = Controller(world=parse_world(machine))
    made.send("CONFIG ENC8 DAC4 STEPPER4 NONE\rESAVE\rREBOOT\r")
    made.advance(1)
    setup = (
        *(attach, "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS4 "X"', f"PPU X{PPU}"),
        *("VEL 20", "ACC 200", "DEC 200", "STP 200", "HLBIT X12"),
    )
    made.send("".join(f"{line}\r" for line in (*setup, *lines)))
    made.advance(20)
    return made


def load_mm(made: Controller) -> float:
    """Where the load is, by the machine's own zero."""
    row = motors.position_cnt[4]
    return 10.0 + (made.memory.F[row] - 0.5) / PPU


def pulses(made: Controller) -> float:
    return made.p[6156 + 5 * 16]


def actual_mm(made: Controller) -> float:
    return made.p[12290 + 4 * 256] / PPU


def test_the_load_goes_where_the_pulses_lead_and_back() -> None:
    made = card("X30")
    made.advance(seconds=3)
    assert pulses(made) == 12000
    assert load_mm(made) == pytest.approx(40.0, abs=0.005)
    made.send("X-5.5\r")
    made.advance(seconds=3)
    assert pulses(made) == -2200
    assert load_mm(made) == pytest.approx(4.5, abs=0.005)


def test_the_load_follows_in_motion_within_a_step() -> None:
    made = card("X30")
    for _ in range(15):
        made.advance(seconds=0.1)
        assert load_mm(made) == pytest.approx(10 + pulses(made) / PPU, abs=5.0 / 200)


@pytest.mark.parametrize(("velocity", "stalls"), [(75, False), (90, True)])
def test_it_stalls_beyond_the_speed_at_which_its_torque_is_enough(
    velocity: int, stalls: bool
) -> None:
    # 75 mm/s are 15 rev/s: 0.23 Nm are left; at 18 rev/s 0.15 Nm, too few for the acceleration
    made = card(f"VEL {velocity}", "ACC 5000", "DEC 300", "STP 300", "X80")
    made.advance(seconds=4)
    assert pulses(made) == 32000  # nothing tells the card
    assert (load_mm(made) < 80.0) is stalls
    if not stalls:
        assert load_mm(made) == pytest.approx(90.0, abs=0.005)


def test_a_stalled_motor_comes_to_rest_in_one_of_its_stable_positions_and_can_move_again() -> None:
    made = card("VEL 90", "ACC 5000", "DEC 300", "STP 300", "X80")
    made.advance(seconds=4)
    lost_mm = 90.0 - load_mm(made)
    turn_mm = 5.0 * 4 / 200  # four full steps
    assert lost_mm / turn_mm == pytest.approx(round(lost_mm / turn_mm), abs=0.03)
    made.send("VEL 20\rACC 200\rX70\r")
    made.advance(seconds=3)
    assert load_mm(made) == pytest.approx(80.0 - lost_mm, abs=0.005)


def test_res_sets_the_count_and_moves_nothing() -> None:
    made = card("X10")
    made.advance(seconds=2)
    made.send("RES X3\rX4\r")
    made.advance(seconds=1)
    assert pulses(made) == 1600
    assert load_mm(made) == pytest.approx(21.0, abs=0.005)


def test_a_limit_switch_stops_it_and_it_gets_out_again() -> None:
    made = card("HLDEC X2000", "HLIM X3", "X95")
    made.advance(seconds=6)
    assert made.bit[16260]  # met the positive limit
    assert 100.0 < load_mm(made) < 101.0
    assert load_mm(made) == pytest.approx(10 + actual_mm(made), abs=0.01)
    made.press(ControlKey.CTRL_Y)
    made.send("X50\r")
    made.advance(seconds=4)
    assert actual_mm(made) == pytest.approx(50.0, abs=0.2)
    assert load_mm(made) == pytest.approx(10 + actual_mm(made), abs=0.005)


@pytest.mark.parametrize(("backs_up", "at_mm"), [(False, 5.9), (True, 6.0)])
def test_it_homes_on_its_switch(backs_up: bool, at_mm: float) -> None:
    made = card("JOG VEL X10", "JOG ACC X500", "JOG DEC X500", "JOG HOMVF X1")
    made.bit[16152 + 128] = backs_up
    made.send("JOG HOME X-1\r")
    assert made.until(16262, timeout_s=20)
    made.advance(seconds=1)
    assert (actual_mm(made), pulses(made)) == (0, 0)
    assert load_mm(made) == pytest.approx(at_mm, abs=0.005)  # 0.1 mm is the ramp of 10 mm/s


def test_a_drive_without_power_lets_it_coast_and_the_pulses_go_on() -> None:
    made = card("SET 8596", "DRIVE ON X")
    made.advance(100)
    made.send("X2\r")
    made.advance(seconds=1)
    assert load_mm(made) == pytest.approx(12.0, abs=0.005)
    made.send("DRIVE OFF X\r")
    made.advance(100)
    made.drag(4, 7.0)
    made.advance(100)
    assert load_mm(made) == pytest.approx(19.0, abs=0.005)


def test_a_jam_loses_steps_and_an_encoder_tells() -> None:
    made = card(machine=WITH_ENCODER, attach="ATTACH AXIS4 ENC4 STEPPER5")
    made.send("ENC4 MULT 4\rX10\r")
    made.advance(seconds=0.3)
    made.fault(4, "jam")
    made.advance(seconds=1)
    made.mend(4, "jam")
    made.advance(seconds=1)
    assert pulses(made) == 4000
    assert actual_mm(made) < 8.0
    assert load_mm(made) == pytest.approx(10 + actual_mm(made), abs=0.005)


def test_position_maintenance_puts_lost_steps_out_again() -> None:
    made = card(machine=WITH_ENCODER, attach="ATTACH AXIS4 ENC4 STEPPER5")
    made.send("ENC4 MULT 4\rPM DB X0.02\rPM VEL X10\rPM ACC X100\rPM TIME X0.2\rPM ON X\rX10\r")
    made.advance(seconds=0.3)
    made.fault(4, "jam")
    made.advance(seconds=0.7)
    made.mend(4)
    made.advance(seconds=5)
    assert load_mm(made) == pytest.approx(20.0, abs=0.03)
    assert actual_mm(made) == pytest.approx(10.0, abs=0.02)
    assert pulses(made) > 4000


def test_res_with_an_encoder_as_feedback_moves_nothing() -> None:
    made = card(machine=WITH_ENCODER, attach="ATTACH AXIS4 ENC4 STEPPER5")
    made.send("ENC4 MULT 4\rX10\r")
    made.advance(seconds=2)
    made.send("RES X\rX-3\r")
    made.advance(seconds=2)
    assert load_mm(made) == pytest.approx(17.0, abs=0.005)
    assert actual_mm(made) == pytest.approx(-3.0, abs=0.01)


def test_a_motor_without_encoder_counts_nothing() -> None:
    made = card("X10")
    made.advance(seconds=2)
    assert made.p[6144 + 4 * 16] == 0


def test_a_restart_of_the_card_does_not_move_the_load() -> None:
    made = card("X10")
    made.advance(seconds=2)
    before = load_mm(made)
    made.send("REBOOT\r")
    made.advance(200)
    assert load_mm(made) == pytest.approx(before, abs=0.001)


def test_a_snapshot_holds_field_and_rotor() -> None:
    made = card("X30")
    made.advance(seconds=0.5)
    kept = made.snapshot()
    made.advance(seconds=2)
    end = made.digest()
    made.restore(kept)
    made.advance(seconds=2)
    assert made.digest() == end


@pytest.mark.parametrize("kind", ["encoder-lost", "encoder-noise"])
def test_an_encoder_that_is_not_there_cannot_fail(kind: str) -> None:
    with pytest.raises(UserError, match="axis X: it has no encoder"):
        card().fault(4, kind)


def test_an_encoder_that_counts_down_goes_with_the_load() -> None:
    machine = WITH_ENCODER.replace("encoder_lines", 'encoder_direction = "down"\nencoder_lines')
    made = card("X10", machine=machine)
    made.advance(seconds=2)
    row = motors.position_cnt[4]
    assert made.memory.F[row] == pytest.approx(-4000, abs=2)


@pytest.mark.parametrize(
    ("speed_rps", "torque_nm"),
    [(0.0, 0.5), (4.0, 0.5), (5.0, 0.5), (12.5, 0.3), (20.0, 0.1), (50.0, 0.1)],
)
def test_the_torque_lies_on_lines_between_the_points_of_the_curve(
    speed_rps: float, torque_nm: float
) -> None:
    from openacr.plant.physics.stepper_cy import pull_out_accel

    memory = card().memory
    per_nm = 2000 / (2 * math.pi * 5e-5)
    found = pull_out_accel(memory.F, memory.I, 4, speed_rps * 2000)
    assert found == pytest.approx(torque_nm * per_nm)


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("[5.0, 0.5]", "[0.0, 0.5]", r"the speeds of torque_nm go from 0 to 0 rev/s"),
        ("[[0.0, 0.5], [5.0, 0.5], [20.0, 0.1]]", "[[0.0, 0.0]]", "has no torque at all"),
        ("[[0.0, 0.5], [5.0, 0.5], [20.0, 0.1]]", "[]", "a list of 1 to 8 values"),
        ("initial = 10.0", "initial = 10.0\ndac = 4", "takes pulses, no voltage"),
        ("initial = 10.0", "initial = 10.0\nmarker = 0.0", "no encoder that had a marker"),
        ("[axis.motor]\ninertia_kgm2 = 3.0e-5", "", "the motor is missing"),
        ("steps_per_rev = 2000", "offset_v = 1.0\nsteps_per_rev = 2000", "unknown key 'offset_v'"),
        ('"stepper"\noutput = 5', '"stepper"', "lacks the key 'output'"),
    ],
)
def test_what_does_not_fit_a_stepper_is_refused(old: str, new: str, text: str) -> None:
    assert old in MACHINE
    with pytest.raises(SourceError, match=text):
        parse_world(MACHINE.replace(old, new))


def test_a_motor_with_a_current_needs_its_torque_constant() -> None:
    text = MACHINE[: MACHINE.index("[axis.drive]")] + (
        '[axis.drive]\nmode = "torque"\namps_per_volt = 1.0\npeak_amps = 5.0\n'
    )
    text = text.replace('units = "mm"', "encoder_lines = 500")
    with pytest.raises(SourceError, match="the motor lacks torque_nm_per_a"):
        parse_world(text)
