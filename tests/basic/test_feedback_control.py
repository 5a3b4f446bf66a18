"""PPU, MULT, ROTARY, RES, REN, NORM, INTCAP and MSEEK."""

import pytest
from tests.basic.motion_bench import Bench

from openacr.basic.language.registry import Level
from openacr.map.rows import motors

CURRENT, ACTUAL = 12288, 12290
PSP, JOG = 12294, 12297
IN_MOTION = 516
MOVING = "Not valid while in motion"


def rows(made: Bench, *numbers: int) -> list[float]:
    return [made.p(number) for number in numbers]


# scale


def test_ppu_leaves_pulses_and_scales_what_follows() -> None:
    made = Bench("X").all("PPU X10", "JOG VEL X5", "X7")
    made.until_clear(IN_MOTION)
    made.all("PPU X100")
    assert (made.p(CURRENT), made.type("JOG VEL X")) == (70, "5")
    made.all("X/1")
    made.until_clear(IN_MOTION)
    assert made.p(CURRENT) == 170


@pytest.mark.req("ACR-CMD-MULT", "ACR-PROF-15")
def test_mult_scales_and_turns_the_count_of_a_motor() -> None:
    made = Bench("X").all("MULT X4")
    made.memory.I[motors.kind[0]] = 1
    made.memory.F[motors.raw_count[0]] = 100.0
    made.ticks(1)
    assert made.p(ACTUAL) == 100
    made.all("MULT X-2")
    made.memory.F[motors.raw_count[0]] = 140.0
    made.ticks(1)
    assert made.p(ACTUAL) == 80


# registers


@pytest.mark.parametrize("motion", ["Y5", "JOG FWD X"])
@pytest.mark.parametrize("line", ["RES X", "RES", "REN X", "REN", "NORM X"])
def test_registers_are_not_touched_in_motion(motion: str, line: str) -> None:
    made = Bench("X", "Y").all("VEL 1", "JOG VEL X1", "P12288 = 50", motion).ticks(3)
    assert made.type(line) == MOVING
    assert made.p(CURRENT) == 50


def test_res_and_ren_without_axis_mean_the_axes_of_the_program() -> None:
    made = Bench("X", "Y").all("P12288 = 5 P12544 = 6 P12800 = 7").ticks(2)
    made.all("RES").ticks(2)
    assert rows(made, 12288, 12544, 12800) == [0, 0, 7]
    assert made.at(Level.SYS).type("RES") == "Unknown command"
    assert made.type("AXIS2 RES") == ""


def test_norm_keeps_offsets_and_does_nothing_to_a_linear_axis() -> None:
    made = Bench("X").all("ROTARY X100")
    made.place(0, position=250, jog=7)
    made.ticks(2)
    made.all("NORM X").ticks(2)
    assert rows(made, CURRENT, JOG, PSP, ACTUAL) == [50, 7, 57, 57]
    made.all("ROTARY X0", "RES X250", "NORM X")
    assert made.p(CURRENT) == 250


# capture


def test_intcap_can_be_switched_off_and_reports_all_axes() -> None:
    made = Bench("X", "Y").all("INTCAP X 0 Y 15")
    assert made.type("INTCAP") == "X 0|Y 15"
    made.all("INTCAP X OFF")
    assert made.type("INTCAP X Y : AXIS1 INTCAP") == "OFF|15|15"


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("INTCAP X16", "Invalid argument"),
        ("INTCAP X-1", "Invalid argument"),
        ("INTCAP X0 P12304", "Invalid parameter"),
        ("INTCAP X0 P0", "Invalid parameter"),
        ("INTCAP Z0", "Undefined symbol"),
    ],
)
def test_a_wrong_capture_is_refused(line: str, message: str) -> None:
    made = Bench("X")
    assert made.type(line) == message
    assert made.type("INTCAP X") == "OFF"


def test_the_copy_of_a_capture_is_for_that_capture_only() -> None:
    made = Bench("X").all("ACC 0 STP 0 VEL 10", "INTCAP X11 P38912").ticks(1)
    made.all("SET 113").ticks(1).all("P38912=-7", "MSEEK X(10,11)").ticks(50)
    made.all("SET 113").ticks(1)
    assert (made.bit(777), made.p(38912)) == (True, -7)


def seeking(line: str = "MSEEK X(1,2)") -> Bench:
    """An axis of 1000 pulses per unit that seeks the first external input."""
    return Bench("X", "Y").all("PPU X1000 Y1000", "ACC 0 DEC 0 STP 100 VEL 2", "CLR 24", line)


def test_seeks_of_several_axes_follow_one_another() -> None:
    made = seeking("MSEEK X(0.1,2) Y(0.2,2)")
    made.until_clear(IN_MOTION)
    assert (made.p(CURRENT), made.p(CURRENT + 256)) == (100, 200)


def test_mseek_waits_until_the_buffer_has_room() -> None:
    made = seeking("X1 : X2")
    made.type("MSEEK X(1,2)")
    assert made.is_waiting
    made.until_clear(IN_MOTION)
    made.ticks(2)
    made.until_clear(IN_MOTION)
    assert made.p(CURRENT) == 3000


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("MSEEK X(1,16)", "Invalid argument"),
        ("MSEEK X(1,-1)", "Invalid argument"),
        ("MSEEK X(1)", "Syntax error"),
        ("MSEEK X1", "Syntax error"),
        ("MSEEK X(1,0) Y(1,0) X(1,0)", "Invalid argument"),
    ],
)
def test_a_wrong_seek_is_refused(line: str, message: str) -> None:
    made = Bench("X", "Y")
    assert made.type(line) == message
    assert not made.bit(IN_MOTION)


def test_mseek_is_refused_by_a_kill_like_a_move() -> None:
    made = Bench("X").all("SET 8467")
    assert made.type("MSEEK X(1,0)") == "Associated Slave Kill Motion Request Active"
    assert Bench().type("MSEEK AXIS0(1,0)") == "No master attached"
