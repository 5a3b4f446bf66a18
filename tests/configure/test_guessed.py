"""The first machine.toml of a card: a twin of it runs, and every guess is marked."""

from pathlib import Path

import pytest

from openacr.client import Card
from openacr.configure.guessed import first_machine
from openacr.configure.queries import Virtual
from openacr.controller import Controller
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.schema import Contact, ExactDrive, StepperDrive, World
from openacr.project import find_project

EXAMPLES = Path(__file__).parents[2] / "examples"


def guessed(*lines: str, model: str = "ACR9000") -> tuple[World, str]:
    controller = Controller(model)
    for line in lines:
        controller.send(f"{line}\r")
    text = first_machine(Virtual(controller), model)
    return parse_world(text), text


ONE = (
    *(f"AXIS{number} OFF" for number in range(8) if number != 1),
    "DETACH ALL", "ATTACH AXIS1 ENC2 DAC3 ENC2", "AXIS1 PPU 800",
    "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS1 "X"', "SYS",
)  # fmt: skip


def test_motor_output_name_and_scale_are_those_of_the_set_up() -> None:
    world, text = guessed(*ONE, "ENC2 MULT 4")
    (axis,) = world.axis
    assert (axis.number, axis.dac, axis.name) == (2, 3, "X")
    assert axis.counts_per_unit == 800
    assert isinstance(axis.drive, ExactDrive)
    assert world.card.model == "ACR9000"
    assert "exact" in next(line for line in text.splitlines() if "# guess: follows" in line)


def test_an_encoder_of_which_the_card_counts_one_edge_has_four_times_the_counts() -> None:
    world, _ = guessed(*ONE, "ENC2 MULT 1")
    assert world.axis[0].counts_per_unit == 3200


@pytest.mark.parametrize(("invert", "contact"), [("SET", Contact.CLOSED), ("CLR", Contact.OPEN)])
def test_contacts_and_inputs_of_switches_are_those_of_the_set_up(
    invert: str, contact: Contact
) -> None:
    flags = (f"{invert} BIT16176", "CLR BIT16177", f"{invert} BIT16178")
    world, _ = guessed(*ONE, "AXIS1 HLBIT 9", *flags, "AXIS1 HLIM 3", "AXIS1 SLM (300,-20)")
    (axis,) = world.axis
    assert axis.positive_limit and axis.negative_limit and axis.home
    assert (axis.positive_limit.input, axis.positive_limit.contact) == (9, contact)
    assert (axis.negative_limit.input, axis.negative_limit.contact) == (10, Contact.OPEN)
    assert (axis.home.input, axis.home.contact) == (11, contact)
    room = max(3 * axis.units_per_rev, 0.05 * 320)
    assert (axis.positive_limit.at, axis.negative_limit.at) == (300 + room, -20 - room)


def test_a_switch_that_is_not_enabled_is_left_out() -> None:
    world, _ = guessed(*ONE, "AXIS1 HLIM 2")
    assert world.axis[0].positive_limit is None
    assert world.axis[0].negative_limit is not None


def test_without_soft_limits_the_switches_are_far_away() -> None:
    world, _ = guessed(*ONE, "AXIS1 HLIM 3")
    (axis,) = world.axis
    assert axis.positive_limit and axis.negative_limit
    assert axis.positive_limit.at == 100 * axis.units_per_rev == -axis.negative_limit.at


def test_an_input_has_one_switch_only() -> None:
    world, text = guessed(*ONE, "ATTACH AXIS3 ENC3 DAC4 ENC3", "AXIS3 ON", "AXIS1 HLIM 3",
                          "AXIS3 HLIM 3", "AXIS3 HLBIT 3")  # fmt: skip
    assert [axis.positive_limit is None for axis in world.axis] == [False, True]
    assert "# input 3 has another switch: positive_limit = " in text


def test_axes_that_share_an_encoder_have_one_motor() -> None:
    world, text = guessed(*ONE, "ATTACH AXIS3 ENC2 DAC4 ENC2", "AXIS3 ON")
    assert [axis.number for axis in world.axis] == [2]
    assert "# axis 3 shares the motor of number 2" in text


def test_a_stepper_without_encoder_gets_a_motor_that_loses_no_step() -> None:
    world, _ = guessed(*ONE, "ATTACH AXIS1 STEPPER4 STEPPER4 STEPPER4")
    (axis,) = world.axis
    assert isinstance(axis.drive, StepperDrive)
    assert (axis.number, axis.drive.output, axis.has_encoder) == (4, 4, False)
    assert axis.counts_per_unit == 800


def test_a_commutator_is_named_and_left_to_the_user() -> None:
    world, text = guessed(*ONE, "ATTACH AXIS1 ENC2 CMT0 ENC2")
    assert world.axis == ()
    assert "# axis 1 (X) has ENC2 and CMT0: no motor is guessed for these" in text


def test_inputs_that_programs_read_are_listed_with_them() -> None:
    _, text = guessed(
        *ONE, "PROG3", "10 INH 24", "20 IF (BIT 25) THEN P0=1", "30 INH -1", "40 SET 40"
    )
    listed = [line for line in text.splitlines() if line.startswith("#   ")]
    assert listed == ["#   1: PROG3", "#   24: PROG3", "#   25: PROG3"]


def test_the_twin_of_a_machine_with_closed_switches_moves(tmp_path: Path) -> None:
    source = EXAMPLES / "gantry"
    with Card.open(Controller.from_project(source)) as card:
        card.backup(tmp_path)
    (tmp_path / "machine.toml").write_text(
        first_machine(Virtual(Controller.from_project(tmp_path)), "ACR9000")
    )
    twin, refused = Controller.load(find_project(tmp_path))
    assert refused == []
    twin.send("PROG0\r")
    twin.send("DRIVE ON X Y\r")
    twin.send("X5 Y3\r")
    twin.advance(20_000)
    assert [twin.p[12290 + 256 * number] / 40000 for number in (0, 1)] == [5, 3]
