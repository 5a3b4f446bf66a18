"""The machine of `openacr serve` without a project: moves end on their target, homing ends."""

import pytest

from openacr.cli.serve import _load
from openacr.controller import Controller
from openacr.errors import SourceError, UserError
from openacr.plant.describe.load import parse_world
from openacr.plant.describe.schema import exact_world

SETUP = (
    *("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"'),
    *("PPU X1000 Y1000", "ACC 500", "DEC 500", "STP 500", "VEL 20"),
)
ACTUAL, ERROR = 12290, 12291


def card(*lines: str, text: str = "") -> Controller:
    made = Controller(world=parse_world(text) if text else exact_world())
    made.send("".join(f"{line}\r" for line in (*SETUP, *lines)))
    return made


@pytest.mark.parametrize("mult", [1, 2, 4, -4])
@pytest.mark.parametrize("gain", [0.0001, 0.002441, 5.0])
def test_a_move_ends_on_its_target_whatever_the_gain(mult: int, gain: float) -> None:
    made = card(f"ENC0 MULT {mult}", f"AXIS0 PGAIN {gain}", "X3.217 Y-1")
    assert made.until(516, False, timeout_s=5)
    assert (made.p[ACTUAL], made.p[ERROR]) == (3217, 0)
    made.advance(1000)
    assert (made.p[ACTUAL], made.p[ERROR]) == (3217, 0)
    assert made.p[ACTUAL + 256] == -1000


def test_in_motion_it_lags_by_one_period() -> None:
    made = card("X20")
    made.advance(seconds=0.5)
    assert made.p[ERROR] == pytest.approx(20 * 1000 * made.period_s, abs=1)


@pytest.mark.parametrize(("axis", "direction"), [("X", -1), ("X", 1), ("Y", -1)])
def test_homing_ends_in_both_directions(axis: str, direction: int) -> None:
    made = card(
        "HLBIT X0 Y3", "HLIM X3 Y3", "HLDEC X500 Y500",
        "JOG VEL X50 Y50", "JOG ACC X500 Y500", "JOG DEC X500 Y500", "JOG HOMVF X1 Y1",
        f"JOG HOME {axis}{direction}",
    )  # fmt: skip
    number = "XY".index(axis)
    assert made.until(16134 + 32 * number, timeout_s=60)
    assert made.p[ACTUAL + 256 * number] == 0
    assert made.p[ERROR + 256 * number] == 0
    assert not made.bit[16135 + 32 * number]


def test_it_stays_where_it_is_without_voltage() -> None:
    made = card("TLM X0", "X3")
    made.advance(seconds=1)
    assert (made.p[ACTUAL], made.p[ERROR]) == (0, 3000)


def test_an_axis_that_is_off_is_not_moved() -> None:
    made = card("AXIS0 OFF", "P6400=5")
    made.advance(100)
    assert made.p[6144] == 0


def test_a_jam_and_a_cut_cable_hold_it() -> None:
    for kind in ("jam", "motor-cable"):
        made = card()
        made.fault(0, kind)
        made.send("X3\r")
        made.advance(seconds=1)
        assert (made.p[ACTUAL], made.p[ERROR]) == (0, 3000)
        made.mend(0)
        made.advance(2)
        assert (made.p[ACTUAL], made.p[ERROR]) == (3000, 0)


def test_the_first_axis_with_the_encoder_moves_the_motor() -> None:
    made = card("ATTACH AXIS0 ENC5 DAC5", "ATTACH AXIS5 ENC0 DAC0", "X3")
    assert made.until(516, False, timeout_s=5)
    made.advance(2)
    assert (made.p[6144 + 5 * 16], made.p[6144]) == (3000, 0)


def test_friction_and_a_motor_mean_nothing_to_it() -> None:
    with pytest.raises(UserError, match="axis 0: friction has no effect"):
        card().fault(0, "friction", 1.0)
    text = '[[axis]]\nnumber = 0\nencoder_lines = 1000\ndrive = { mode = "exact" }\n'
    assert parse_world(text).axis[0].counts == 4000
    motor = "motor = { inertia_kgm2 = 1e-5, torque_nm_per_a = 1.0 }\n"
    with pytest.raises(SourceError, match="an exact drive has no use for a motor"):
        parse_world(text + motor)


def test_serve_without_a_project_runs_it() -> None:
    made = _load(None, None, None)
    assert made.world == exact_world()
    assert {axis.number for axis in made.world.axis} == set(range(8))
    made.close()
