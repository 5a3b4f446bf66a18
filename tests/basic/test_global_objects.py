"""Objects by number: AXIS, MASTER, ENC, STEPPER, DAC, ADC."""

import pytest
from tests.basic.motion_bench import Bench

from openacr.basic.language.registry import Level
from openacr.map.rows import axes, motors
from openacr.motion.axis import attach
from openacr.motion.axis.attach import Feedback, Signal

LEVELS = [Level.SYS, Level.PROG, Level.PLC]


@pytest.mark.parametrize("level", LEVELS)
def test_objects_are_known_at_every_level(level: Level) -> None:
    made = Bench().at(level)
    assert made.type("AXIS3 : MASTER2 : ENC1 : DAC0 : ADC0 : STEPPER0") == "ON|MASTER2|0|0|0|0"


@pytest.mark.parametrize(
    "line",
    ["AXIS8", "AXIS8 ON", "MASTER8", "ENC20", "ENC20 MULT", "DAC16", "ADC16 GAIN", "STEPPER8"],
)
def test_an_object_the_card_does_not_have_is_refused(line: str) -> None:
    assert Bench().type(line) == "Invalid argument"


def test_a_master_reports_its_program() -> None:
    made = Bench("X")
    made.attach(3, (1, "Y"))
    assert made.type("MASTER0 : MASTER3 : MASTER1") == "MASTER0 PROG0|MASTER3 PROG3|MASTER1"


# AXIS ON and OFF


def test_an_axis_that_is_off_does_not_move_and_puts_out_nothing() -> None:
    made = Bench("X").all("TLM X5", "PGAIN X0.01")
    made.memory.I[motors.kind[0]] = 1
    made.all("X100")
    made.until_clear(516)
    made.ticks(2)
    assert made.type("DAC0") == "1"
    made.all("AXIS0 OFF")
    assert made.type("AXIS0 : DAC0") == "OFF|0"
    assert made.type("X1") == made.type("JOG FWD X") == "Axis is off"
    made.ticks(10)
    assert made.p(12319) == 0.0
    made.all("AXIS0 ON")
    assert made.type("AXIS0 : JOG INC X0") == "ON"


@pytest.mark.parametrize("line", ["AXIS0 ON", "AXIS0 OFF"])
def test_an_axis_is_not_switched_in_motion(line: str) -> None:
    made = Bench("X").all("VEL 1 X10").ticks(2)
    assert made.type(line) == "Not valid while in motion"
    assert made.type("AXIS0") == "ON"


# encoders


def test_encoder_settings_are_reported() -> None:
    made = Bench()
    assert made.type("ENC0 SRC : ENC0 MULT") == "0|1"
    assert made.type("ENC 0 SRC 2 : ENC0 MULT -4 : ENC0 SRC : ENC0 MULT") == "2|-4"
    for wrong in ("SRC 3", "SRC -1", "MULT 3"):
        assert made.type(f"ENC0 {wrong}") == "Invalid argument"


def test_enc_res_sets_the_actual_position_only() -> None:
    made = Bench("X").all("TLM X0", "P12288 = 5").ticks(2)
    made.all("ENC0 RES 100").ticks(2)
    assert (made.type("ENC0"), made.p(12290), made.p(12288)) == ("100", 100, 5)
    made.all("ENC0 RES")
    assert made.type("ENC0") == "0"
    assert made.type("ENC0 RES 3e9") == "Invalid argument"


def test_encoders_beyond_16_have_their_own_rows() -> None:
    made = Bench().all("ENC18 RES 77")
    assert (made.type("ENC18"), made.p(24576 + 32)) == ("77", 77)


def test_a_locked_encoder_counts_along_from_where_it_is() -> None:
    made = Bench("X").all("PPU X1000", "X0.5").ticks(4000)
    made.all("ENC17 LOCK 16", "ENC16 LOCK 0", "ENC16 RES 7", "X0.75").ticks(4000)
    assert [made.type(f"ENC{n}") for n in (0, 16, 17)] == ["750", "257", "250"]
    made.all("ENC16 UNLOCK", "X0").ticks(4000)
    assert [made.type(f"ENC{n}") for n in (0, 16, 17)] == ["0", "257", "250"]


def test_an_axis_sees_what_its_locked_encoder_counts() -> None:
    made = Bench("X").all("ENC4 LOCK 0", "X40").ticks(4000)
    assert (made.axis(4, axes.actual_position), made.axis(4, axes.primary_setpoint)) == (40, 0)


def test_a_preset_of_the_leading_encoder_is_not_counted() -> None:
    made = Bench("X").all("ENC4 LOCK 0").ticks(2).all("RES X500").ticks(5)
    assert (made.type("ENC0"), made.type("ENC4")) == ("500", "0")


def test_locks_are_reported_and_circles_refused() -> None:
    made = Bench().all("ENC1 LOCK 0", "ENC2 LOCK 1")
    assert [made.type(f"ENC{n} LOCK") for n in (0, 1, 2)] == ["OFF", "ENC0", "ENC1"]
    for line in ("ENC0 LOCK 2", "ENC3 LOCK 3", "ENC3 LOCK 24", "ENC3 LOCK -1"):
        assert made.type(line) == "Invalid argument", line


def test_the_position_of_an_encoder_is_copied_in_every_servo_period() -> None:
    made = Bench().all("ENC3 DST P4100", "P6192 = 1234").ticks(1)
    assert (made.type("ENC3 DST"), made.p(4100)) == ("P4100", 1234)
    made.all("ENC3 DST OFF", "P6192 = 1").ticks(2)
    assert (made.type("ENC3 DST"), made.p(4100)) == ("OFF", 1234)
    for line in ("ENC3 DST P12304", "ENC3 DST P1"):
        assert made.type(line) == "Invalid parameter", line


# analog outputs and inputs


def test_the_offset_is_added_to_the_output_of_an_axis() -> None:
    made = Bench().all("DAC0 OFFSET 0.5").ticks(2)
    assert made.type("DAC0") == "0.5"


# steppers


def test_a_stepper_shows_the_steps_of_its_axis() -> None:
    made = Bench("X")
    attach.axis(made.card, 0, (Feedback.STEPPER, 0), (Signal.STEPPER, 0))
    made.all("X25")
    made.until_clear(516)
    assert (made.type("STEPPER0"), made.p(6156)) == ("25", 25)


def test_a_stepper_count_can_be_set() -> None:
    made = Bench().all("STEPPER3 RES 40")
    assert made.type("STEPPER3") == "40"
    made.all("STEPPER3 RES")
    assert made.type("STEPPER3") == "0"
