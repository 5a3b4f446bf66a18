"""A supply that falls: the motor reaches the speed that is left, and recovers."""

from math import pi

import pytest

from openacr.controller import Controller
from openacr.errors import SourceError, UserError
from openacr.map.rows import motors
from openacr.plant.describe.load import parse_world
from openacr.scenario import parse_scenario

SUPPLY_V, TORQUE_NM_PER_A = 80.0, 0.08
MACHINE = f"""
[[axis]]
number = 1
name = "Y"
encoder_lines = 1000

[axis.motor]
inertia_kgm2 = 2.0e-5
torque_nm_per_a = {TORQUE_NM_PER_A}
resistance_ohm = 4.0

[axis.drive]
mode = "torque"
amps_per_volt = 2.0
peak_amps = 20.0
supply_v = {SUPPLY_V}
"""


SET_UP = (
    "ENC1 MULT 4", "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS1 "Y"', "PPU Y4000", "PGAIN Y0.01",
    "DGAIN Y0.00001", "TLM Y10", "DRIVE ON Y", "JOG ACC Y2000", "JOG DEC Y2000", "JOG VEL Y120",
)  # fmt: skip


def card(machine: str = MACHINE) -> Controller:
    return Controller(world=parse_world(machine))


def jogged(made: Controller) -> Controller:
    """The axis is jogged at 120 rev/s."""
    for line in SET_UP:
        made.send(f"{line}\r")
    made.advance(seconds=0.1)
    made.send("JOG FWD Y\r")
    made.advance(seconds=1.0)
    return made


def speed_rev_s(made: Controller) -> float:
    return made.memory.F[motors.velocity_cps[1]] / 4000.0


def no_load_speed_rev_s(volts: float) -> float:
    """Where the back-EMF of the motor is the voltage; its constant in SI units is Nm per A."""
    return volts / TORQUE_NM_PER_A / (2.0 * pi)


def test_a_motor_goes_no_faster_than_the_supply_that_is_left() -> None:
    made = jogged(card())
    assert speed_rev_s(made) == pytest.approx(120.0, rel=0.01)
    made.fault(1, "supply", 40.0)
    made.advance(seconds=1.0)
    assert speed_rev_s(made) == pytest.approx(no_load_speed_rev_s(40.0), rel=0.01)
    made.mend(1, "supply")
    made.advance(seconds=0.05)
    assert speed_rev_s(made) > 90.0


def test_a_supply_that_recovers_is_the_one_of_the_machine_file() -> None:
    made = card()
    full = made.memory.F[motors.supply_accel[1]]
    assert full == pytest.approx(SUPPLY_V / 4.0 * TORQUE_NM_PER_A / 2.0e-5 * 4000 / (2.0 * pi))
    made.fault(1, "supply", 20.0)
    made.fault(1, "supply", 40.0)  # it replaces the one before
    assert made.memory.F[motors.supply_accel[1]] == pytest.approx(full / 2.0)
    made.mend(1, "friction")
    assert made.memory.F[motors.supply_accel[1]] == pytest.approx(full / 2.0)
    made.mend(1)
    assert made.memory.F[motors.supply_accel[1]] == full
    made.fault(1, "supply", SUPPLY_V)
    assert made.memory.F[motors.supply_accel[1]] == full


@pytest.mark.parametrize("volts", [0.0, -1.0, 80.1])
def test_a_voltage_that_no_fault_leaves_is_refused(volts: float) -> None:
    said = f"axis Y: a supply of {volts:g} V; above 0 to 80 V "
    with pytest.raises(UserError, match=said):
        card().fault(1, "supply", volts)


@pytest.mark.parametrize("line", ["supply_v = 80.0", "resistance_ohm = 4.0\n"])
def test_an_axis_without_a_modelled_supply_refuses_the_fault_and_mends(line: str) -> None:
    text = MACHINE.replace(line, "")
    made = card(text if "supply" in line else text.replace("supply_v = 80.0", ""))
    with pytest.raises(UserError, match="axis Y: a supply that falls has no effect"):
        made.fault(1, "supply", 40.0)
    before = made.memory.F[motors.supply_accel[1]]
    made.mend(1)
    assert made.memory.F[motors.supply_accel[1]] == before


def test_a_scenario_names_the_volts() -> None:
    text = "[[at]]\ntime_s = 1.0\nfault = {axis = 1, kind = 'supply', volts = 40.0}\n"
    action = parse_scenario(text).at[0]
    assert action.fault is not None
    assert (action.fault.kind, action.fault.value) == ("supply", 40.0)
    with pytest.raises(SourceError, match="the fault supply needs `volts`"):
        parse_scenario(text.replace(", volts = 40.0", ""))
    with pytest.raises(SourceError, match="`volts` does not belong to the fault jam"):
        parse_scenario(text.replace("supply", "jam"))
