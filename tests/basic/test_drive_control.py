"""DRIVE ON, OFF, RES and the report."""

import pytest
from tests.basic.motion_bench import Bench

from openacr.basic.language.registry import Level
from openacr.map.words import ef

ENABLED = 8465
MOVING = "Not valid while in motion"


def test_the_report_names_axes_as_they_were_named() -> None:
    made = Bench("X", "Y").all("DRIVE ON X").seconds(0.02)
    assert made.type("DRIVE X") == "DRIVE ON X"
    assert made.type("DRIVE") == "DRIVE ON X|DRIVE OFF Y DRIVEN"
    assert made.type("DRIVE Y AXIS0") == "DRIVE OFF Y DRIVEN|DRIVE ON AXIS0"
    assert made.type("AXIS0 DRIVE") == "DRIVE ON AXIS0"
    assert made.at(Level.SYS).type("DRIVE AXIS1") == "DRIVE OFF AXIS1 DRIVEN"
    assert made.type("AXIS1 DRIVE") == "DRIVE OFF AXIS1 DRIVEN"
    assert made.type("DRIVE") == "Syntax error"
    assert made.type("DRIVE ON X") == "Unknown command"
    assert made.type("DRIVE X") == "Unknown command"


def test_a_fault_is_appended_to_the_report() -> None:
    made = Bench("X").all("SET 8477")
    assert made.type("DRIVE X") == "DRIVE OFF X FAULT DRIVEN"
    made.all("CLR 8477", "SET 8479")
    assert made.type("DRIVE X") == "DRIVE OFF X FAULT DRIVEN"


@pytest.mark.parametrize("line", ["DRIVE ON", "DRIVE OFF", "DRIVE RES"])
def test_an_axis_is_needed(line: str) -> None:
    assert Bench("X").type(line) == "Syntax error"


def test_with_drive_io_the_status_follows_after_10_ms() -> None:
    made = Bench("X").all("SET 8468", "DRIVE ON X").ticks(19)
    assert not made.bit(ENABLED)
    made.ticks(1)
    assert made.bit(ENABLED)
    made.all("DRIVE OFF X")
    assert not made.bit(ENABLED)


def test_without_drive_io_the_status_follows_the_command() -> None:
    made = Bench("X").all("AXIS0 DRIVE ON").ticks(1)
    assert made.bit(ENABLED)


@pytest.mark.parametrize("motion", ["X10", "JOG FWD X", "SET 788"])
@pytest.mark.parametrize("line", ["DRIVE ON X", "DRIVE OFF X", "DRIVE OFF Y X"])
def test_drives_are_not_switched_in_motion(motion: str, line: str) -> None:
    made = Bench("X", "Y").all("DRIVE ON X Y").seconds(0.02)
    made.all("JOG VEL X1", "VEL 1", motion).ticks(2)
    assert made.type(line) == MOVING
    assert (made.bit(ENABLED), made.bit(ENABLED + 32)) == (True, True)


def test_drive_on_takes_the_actual_position_as_setpoint() -> None:
    made = Bench("X").all("SET 8468", "X100", "P12290 = 7").seconds(0.2)
    assert made.p(12290) == 7
    made.all("DRIVE ON X")
    assert (made.p(12288), made.p(12295)) == (7, 7)


def test_drive_res_pulses_its_request_for_50_ms_and_clears_the_fault() -> None:
    made = Bench("X").all("SET 8468 SET 8477", "DRIVE RES X").ticks(99)
    assert (made.bit(8466), made.bit(8477)) == (True, False)
    made.ticks(1)
    assert not made.bit(8466)


@pytest.mark.parametrize("flag", [5645, 5646])
def test_an_open_enable_input_keeps_the_drive_off_silently(flag: int) -> None:
    made = Bench("X").all(f"SET {flag}", "DRIVE ON X").seconds(0.02)
    assert not made.bit(ENABLED)
    assert made.type("DRIVE X") == ("DRIVE OFF X" if flag == 5646 else "DRIVE OFF X DRIVEN")


def test_an_encoder_fault_keeps_the_drive_off_until_it_is_reset() -> None:
    made = Bench("X")
    made.memory.I[ef.word[0]] |= ef.ENCODER_SIGNAL_LOST
    made.all("DRIVE ON X").seconds(0.02)
    assert not made.bit(ENABLED)
    made.all("ENC0 RES", "DRIVE ON X").seconds(0.02)
    assert made.bit(ENABLED)


def test_the_report_marks_axes_that_are_driven_without_having_been_enabled() -> None:
    made = Bench("X", "Y").all("DRIVE OFF Y").ticks(1)
    assert made.type("DRIVE") == "DRIVE OFF X DRIVEN|DRIVE OFF Y"
    made.all("SET 8477")
    assert made.type("DRIVE X") == "DRIVE OFF X FAULT DRIVEN"
    made.all("SET 8468")
    assert made.type("DRIVE X") == "DRIVE OFF X FAULT"
    made.all("DRIVE ON Y").ticks(1)
    assert made.type("DRIVE Y") == "DRIVE ON Y"


def test_the_motor_flag_that_a_host_reads_follows_the_drive() -> None:
    """Bit 28 of P4360 + n, undocumented: a host of real cards takes it for "motor on"."""
    made = Bench("X", "Y")
    motors = (8448 + 28, 8480 + 28)

    def on() -> list[bool]:
        return [made.card.memory.bit(flag) for flag in motors]

    assert on() == [False, False]
    made.all("DRIVE ON Y").seconds(0.02)
    assert on() == [False, True]
    made.all("DRIVE ON X").seconds(0.02)
    made.all("DRIVE OFF Y").seconds(0.02)
    assert on() == [True, False]
    made.card.memory.set_bit(8448 + 17, False)
    made.seconds(0.02)
    assert on() == [False, False], "also where a host clears Drive Enabled"
