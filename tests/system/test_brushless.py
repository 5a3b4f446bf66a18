"""A motor the card commutates, in the whole card: right, off, swapped, and after RES."""

from pathlib import Path

import pytest

from openacr.controller import Controller
from openacr.map.rows import axes, encoders
from openacr.plant.describe.load import parse_world

EXAMPLES = Path(__file__).parents[2] / "examples"
MACHINE = (EXAMPLES / "brushless" / "machine.toml").read_text()
PLAIN = (EXAMPLES / "tuning" / "machine.toml").read_text()
SETUP = (EXAMPLES / "brushless" / "setup.8k").read_text().replace("\n", "\r")
TURN = 2048  # counts of one electrical turn
RIGHT = round(TURN * 47 / 360)
ACTUAL, ERROR = (
    axes.actual_position[0],
    axes.following_error[0],
)


def card(machine: str = MACHINE, *lines: str) -> Controller:
    made = Controller(world=parse_world(machine))
    made.send(SETUP)
    for line in lines:
        made.send(f"{line}\r")
    made.advance(20)
    return made


def commutated(shift: int = RIGHT, machine: str = MACHINE) -> Controller:
    return card(machine, f"CMT0 SHIFT {shift}", "CMT0 ON")


def test_a_right_commutator_moves_it_like_a_plain_motor() -> None:
    brushless, plain = commutated(), card(PLAIN, "ATTACH AXIS0 ENC0 DAC0 ENC0")
    for made in (brushless, plain):
        made.send("F500\rX1\r")
    apart = []
    for _ in range(600):
        for made in (brushless, plain):
            made.advance(1)
        apart.append(abs(brushless.p[ACTUAL] - plain.p[ACTUAL]))
    assert max(apart) <= 2  # dry friction makes the rounding of the converters felt
    assert abs(brushless.p[ACTUAL] - 4096) <= 1


@pytest.mark.parametrize("off", [TURN // 2, TURN // 3, -TURN // 3])
def test_a_field_on_the_wrong_side_makes_it_run_away(off: int) -> None:
    made = commutated(RIGHT + off)
    made.send("EXC X100\rX1\r")
    made.advance(400)
    assert made.p[ERROR] > 4096 * 3  # it runs backwards, and ever faster
    assert made.p[ACTUAL] < -4096 * 2


def test_a_field_a_quarter_of_a_turn_off_does_not_push() -> None:
    made = commutated(RIGHT + TURN // 4)
    made.send("X1\r")
    made.advance(2000)
    assert abs(made.p[ACTUAL]) < 20
    assert made.p[ERROR] > 4000


def test_swapped_phases_hold_the_rotor_somewhere() -> None:
    made = commutated(machine=MACHINE.replace("[0, 1]", "[1, 0]"))
    made.send("X1\r")
    made.advance(2000)
    stands = made.p[ACTUAL]
    assert abs(stands) < TURN
    made.send("X3\r")
    made.advance(2000)
    assert abs(made.p[ACTUAL] - stands) < TURN / 2
    assert made.p[ERROR] > 4096


def test_without_a_commutator_nothing_moves() -> None:
    made = card(MACHINE)
    made.send("X1\r")
    made.advance(1000)
    assert made.p[ACTUAL] == 0


def test_res_and_rotary_leave_the_field_where_the_rotor_is() -> None:
    made = commutated()
    made.send("X0.3\r")
    made.advance(1500)
    made.send("RES X7\rENC0 ROTARY 1000\rX8.25\r")
    made.advance(2500)
    assert abs(made.p[ACTUAL] - 8.25 * 4096) <= 1
    assert made.p[encoders.parameters[0]] == made.p[ACTUAL] % 1000
