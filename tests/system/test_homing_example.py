"""Homing example 1 of the guide: X homes negative, Y positive, then X seeks its marker."""

import pytest
from tests.system.terminal import Console

from openacr.controller import Controller
from openacr.map.rows import motors
from openacr.plant.describe.counts import position_of
from openacr.plant.describe.load import parse_world

AXIS = """
[[axis]]
number = {number}
name = "{name}"
encoder_lines = 1000
units_per_rev = 1.0
initial = 0.0
marker = {marker}
travel = [-20.0, 20.0]
drive = {{ mode = "ideal", revs_per_s_per_volt = 25.0 }}
positive_limit = {{ at = 15.0 }}
negative_limit = {{ at = -15.0 }}
{home}
"""

LISTING = (
    "GOSUB HOMING",
    "END",
    "_HOMING",
    "JOG VEL X1 Y1",
    "JOG ACC X10 Y10",
    "JOG DEC X10 Y10",
    "HLBIT X0 Y3",
    "JOG HOMVF X0.1 Y0.1",
    "JOG HOME X-1 Y1",
    "WHILE (((NOT BIT 16134) AND (NOT BIT 16135)) AND ((NOT BIT 16166) AND (NOT BIT 16167)))",
    "WEND",
    'IF (BIT 16166) THEN PRINT "Y HOMING SUCCESSFUL" : SET 128',
    'IF (BIT 16167) THEN PRINT "Y HOMING UNSUCCESSFUL"',
    "ACC 10",
    "DEC 10",
    "VEL 0.5",
    "STP 10",
    "IF (BIT 16134)",
    "MSEEK X(1,0)",
    "INH -516",
    "IF (BIT 777)",
    'PRINT "X HOMING SUCCESSFUL"',
    "SET 129",
    "ENDIF",
    "ENDIF",
    'IF (BIT 16135) THEN PRINT "X HOMING UNSUCCESSFUL"',
    "RETURN",
)


def console(x_home: str, y_home: str) -> Console:
    text = AXIS.format(number=0, name="X", marker=0.3, home=x_home)
    text += AXIS.format(number=1, name="Y", marker=0.3, home=y_home)
    made = Console()
    made.card = Controller(world=parse_world(text))
    made.card.send("ECHO 4\r")
    made.type("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"')
    made.type("MULT X4 Y4", "PPU X4000 Y4000", "HLIM X3 Y3", "HLDEC X100 Y100")
    made.program(0, *LISTING)
    return made


@pytest.mark.req("ACR-APP-HOMING-01")
def test_both_axes_home_and_x_then_stands_on_its_marker() -> None:
    made = console("home = { between = [-4.0, -3.0] }", "home = { between = [3.0, 4.0] }")
    assert made.listen(0, 12.0) == "Y HOMING SUCCESSFUL|X HOMING SUCCESSFUL"
    card = made.card
    assert card.bit[128]
    assert card.bit[129]
    assert not card.bit[1024]
    assert card.p[12288] == card.p[12290] == 0
    stands_u = position_of(card.world.axis[0], card.memory.F[motors.position_cnt[0]])
    assert stands_u % 1.0 == pytest.approx(0.3, abs=1.5 / 4000)  # on the marker, not elsewhere
    assert -4.0 < stands_u < -2.0  # within one revolution of the home switch
    assert card.p[12544] == 0  # Y: rest position of the search is 0


@pytest.mark.req("ACR-SERVO-07")
def test_a_step_of_one_unit_settles_with_the_default_gains() -> None:
    made = console("", "")
    made.type("ACC 0 DEC 0 STP 0 VEL 1E6", "X1")
    made.card.advance(seconds=2.0)
    errors = []
    for _ in range(400):
        made.card.advance(5)
        errors.append(made.card.p[12291])
    assert max(map(abs, errors)) <= 2
    assert max(errors) - min(errors) <= 1
