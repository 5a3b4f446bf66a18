"""What a viewer sees of the world around a card: inputs and what drives them, faults, devices."""

from dataclasses import astuple

import pytest

from openacr.controller import Controller
from openacr.errors import UserError
from openacr.plant.describe.load import parse_world
from openacr.plant.world.fault_kinds import MachineFault

MACHINE = """
[[axis]]
number = 2
name = "X"
units = "mm"
counts_per_rev = 4000
units_per_rev = 4.0
initial = 5.0
travel = [-50.0, 50.0]
motor = { inertia_kgm2 = 2e-5, torque_nm_per_a = 0.1, resistance_ohm = 4.0 }
load = { viscous_nms = 1e-4, coulomb_nm = 0.01 }
positive_limit = { at = 20.0, input = 3 }
negative_limit = { at = -20.0, input = 4, contact = "closed" }

[axis.drive]
mode = "torque"
amps_per_volt = 2.0
peak_amps = 20.0
supply_v = 80.0
fault_input = 258

[[axis]]
number = 0
name = "C"
units = "deg"

[axis.drive]
mode = "stepper"
output = 0
steps_per_rev = 400
torque_nm = [[0.0, 1.0]]

[axis.motor]
inertia_kgm2 = 2e-5

[[wire]]
input = 256
output = 33
name = "door"
[[device]]
kind = "gripper"
outputs = { close = 34 }
inputs = { gripped = 12 }
[inputs]
on = [24]
"""


@pytest.fixture
def card() -> Controller:
    made = Controller(world=parse_world(MACHINE))
    made.advance(2)
    return made


def inputs(card: Controller) -> dict[int, tuple[bool, bool]]:
    return {each.flag: (each.is_on, each.is_forced) for each in card.world_view.now().inputs}


def faults(card: Controller) -> list[tuple[int, str, float]]:
    return [(each.axis, str(each.kind), each.value) for each in card.world_view.now().faults]


def test_every_input_is_listed_once_with_what_drives_it(card: Controller) -> None:
    listed = [astuple(each) for each in card.world_view.sources]
    assert listed[:5] == [
        (3, "positive_limit of axis X", True), (4, "negative_limit of axis X", True),
        (256, "door", True), (12, "gripped of gripper", True), (24, "the constant level on", True),
    ]  # fmt: skip
    rest = [number for number in range(32) if number not in (3, 4, 12, 24)]
    reported = (258, "drive fault of axis X", False)
    assert listed[5:] == [*((number, "", False) for number in rest), reported]


def test_the_state_of_an_input_is_its_level_and_whether_it_is_forced(card: Controller) -> None:
    assert (inputs(card)[3], inputs(card)[4], inputs(card)[24]) == (
        (False, False), (True, False), (True, False),
    )  # fmt: skip
    card.set_input(3, True)
    card.set_input(24, True)  # to the level it has
    card.set_input(5, True)  # nothing drives it: there is nothing to force
    assert (inputs(card)[3], inputs(card)[24], inputs(card)[5]) == (
        (True, True), (True, True), (True, False),
    )  # fmt: skip
    card.release_input(3)
    assert inputs(card)[3] == (False, False)


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        ("encoder-lost", 0.0), ("encoder-noise", 0.0), ("drive", 0.0), ("motor-cable", 0.0),
        ("jam", 0.0), ("obstacle", 12.5), ("obstacle", -7.25), ("friction", 0.4), ("supply", 33.0),
    ],
)  # fmt: skip
def test_a_fault_is_seen_with_its_value_until_it_is_mended(
    card: Controller, kind: str, value: float
) -> None:
    assert faults(card) == []
    card.fault(2, kind, value)
    assert faults(card) == [(2, kind, value)]
    card.advance(3)
    assert faults(card) == [(2, kind, value)]
    card.mend(2, kind)
    assert faults(card) == []


def test_an_axis_without_motor_and_load_has_the_faults_that_it_can_have() -> None:
    made = Controller(
        world=parse_world('[[axis]]\nnumber = 0\nencoder_lines = 1\ndrive = { mode = "exact" }\n')
    )
    assert faults(made) == []
    made.fault(0, "jam")
    assert faults(made) == [(0, "jam", 0.0)]


def test_several_faults_are_seen_together_also_after_a_snapshot_is_restored(
    card: Controller,
) -> None:
    card.fault(2, "friction", 0.25)
    card.fault(2, "encoder-lost")
    card.fault(0, "jam")
    seen = [(2, "encoder-lost", 0.0), (2, "friction", 0.25), (0, "jam", 0.0)]
    assert faults(card) == seen
    kept = card.snapshot()
    card.mend(2)
    assert faults(card) == [(0, "jam", 0.0)]
    card.restore(kept)
    assert faults(card) == seen


def test_which_faults_an_axis_can_have_is_what_injecting_them_says(card: Controller) -> None:
    assert {(each.axis, each.kind) for each in card.world_view.choices} == {
        (axis, kind) for axis in (0, 2) for kind in MachineFault
    }
    for each in card.world_view.choices:
        value = {"at": 1.0, "torque_nm": 0.1, "volts": 40.0}.get(each.key, 0.0)
        if each.why_not:
            with pytest.raises(UserError) as refused:
                card.fault(each.axis, each.kind, value)
            assert str(refused.value) == f"axis C: {each.why_not}"
        else:
            card.fault(each.axis, each.kind, value)
    of_x = {str(e.kind): (e.key, e.unit, e.range) for e in card.world_view.choices if e.axis == 2}
    assert of_x["obstacle"] == ("at", "mm", "")
    assert of_x["friction"] == ("torque_nm", "Nm", "it is 0 or more")
    assert of_x["supply"] == ("volts", "V", "above 0 to 80 V")
    assert of_x["jam"] == ("", "", "")
    cannot = [str(e.kind) for e in card.world_view.choices if e.axis == 0 and e.why_not]
    assert cannot == ["encoder-lost", "encoder-noise", "supply"]


@pytest.mark.parametrize(("volts", "is_taken"), [(0.0, False), (80.0, True), (80.1, False)])
def test_the_limits_of_a_supply_are_above_0_up_to_its_own(
    card: Controller, volts: float, is_taken: bool
) -> None:
    if is_taken:
        card.fault(2, "supply", volts)
        return
    with pytest.raises(UserError, match=f"a supply of {volts:g} V; above 0 to 80 V"):
        card.fault(2, "supply", volts)


def test_positions_are_those_of_the_world_whatever_the_card_calls_them(card: Controller) -> None:
    names = [link.name for link in card.world_view.links]
    assert names == ["X", "C"]
    assert card.world_view.now().positions == (5.0, 0.0)
    card.send("ATTACH AXIS2 ENC2\rENC2 MULT 4\rAXIS2 PPU 1000\r")
    card.drag(2, 2.5)
    card.advance(1)
    assert card.world_view.now().positions == (7.5, 0.0)
    card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS2 "X"\rRES X100\r')
    card.advance(10)
    assert card.p[12290 + 512] == pytest.approx(100_000, abs=500)
    assert card.world_view.now().positions[0] == pytest.approx(7.5, abs=0.5)


def test_a_device_shows_its_commands_and_signals(card: Controller) -> None:
    (gripper,) = card.world_view.now().devices
    assert gripper.commands == {"close": False, "part": False}
    assert gripper.signals == {"opened": True, "closed": False, "gripped": False}
    card.command("gripper", "part", 1.0)
    card.send("SET 34\r")
    card.advance(seconds=0.15)
    (gripper,) = card.world_view.now().devices
    assert gripper.commands == {"close": True, "part": True}
    assert gripper.signals == {"opened": False, "closed": False, "gripped": True}
