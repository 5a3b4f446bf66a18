"""Jog commands: profile, flags, targets, registers; jog and coordinated motion together."""

import pytest
from tests.basic.motion_bench import Bench, largest, ticks

from openacr.basic.language.registry import Level
from openacr.map import numbers as at

ACTIVE, DIRECTION, AT_SPEED, STOPPING, FORWARD, REVERSE, LIMIT_CHECK, LOCKOUT = range(792, 800)
HOMING, HOME_REQUEST, VELOCITY = 16131, 17160, 12346
CURRENT, PSP, GEAR, JOG, CAM = 12288, 12294, 12296, 12297, 12298


def bench(*lines: str) -> Bench:
    """Axes X and Y of 1000 pulses per unit."""
    return Bench("X", "Y").all("PPU X1000 Y1000", *lines)


def flags(made: Bench) -> dict[str, bool]:
    names = ("active", "direction", "at_speed", "stopping", "forward", "reverse")
    return {name: made.bit(ACTIVE + place) for place, name in enumerate(names)}


def on(**names: bool) -> dict[str, bool]:
    known = ("active", "direction", "at_speed", "stopping", "forward", "reverse")
    return {name: names.get(name, False) for name in known}


# values


@pytest.mark.parametrize(
    ("word", "default", "row"),
    [
        pytest.param("JOG VEL", "0", 12348, marks=pytest.mark.req("ACR-CMD-JOG-VEL")),
        pytest.param("JOG ACC", "10", 12349, marks=pytest.mark.req("ACR-CMD-JOG-ACC")),
        pytest.param("JOG DEC", "10", 12350, marks=pytest.mark.req("ACR-CMD-JOG-DEC")),
        pytest.param("JOG JRK", "0", 12351, marks=pytest.mark.req("ACR-CMD-JOG-JRK")),
    ],
)
def test_a_jog_value_is_its_parameter(word: str, default: str, row: int) -> None:
    made = bench()
    assert made.type(f"{word} X Y") == f"{default}|{default}"
    assert made.type(f"{word} X2.5 Y7") == ""
    assert (made.p(row), made.p(row + 256)) == (2.5, 7.0)
    assert made.type(word) == "X 2.5|Y 7"
    assert made.type(f"{word} X-1") == "Invalid argument"
    assert made.at(Level.SYS).type(f"{word} AXIS1") == "7"
    assert made.type(f"AXIS0 {word}") == "2.5"
    assert made.type(word) == "Unknown command"


def test_homvf_has_a_value_too() -> None:
    made = bench("JOG HOMVF X0.1")
    assert made.type("JOG HOMVF") == "X 0.1|Y 0"
    assert made.type("JOG HOMVF X-1") == "Invalid argument"


def test_a_refused_value_leaves_the_others_of_the_statement() -> None:
    made = bench("JOG VEL X1 Y1")
    assert made.type("JOG VEL X5 Y-1") == "Invalid argument"
    assert made.type("JOG VEL X Y") == "1|1"


@pytest.mark.parametrize("line", ["JOG", "JOG FWD", "JOG ABS X", "JOG INC", "JOG ABS"])
def test_a_malformed_jog_is_a_syntax_error(line: str) -> None:
    assert bench().type(line) == "Syntax error"


# continuous jogs


@pytest.mark.req("ACR-CMD-JOG")
def test_jogs_move_one_axis_whatever_the_others_do() -> None:
    made = bench("JOG VEL X10 Y5 : JOG ACC X0 Y0 : JOG DEC X0 Y0", "JOG FWD X", "JOG ABS Y-2")
    made.seconds(0.2)
    assert (made.bit(792), made.bit(824)) == (True, True)
    made.seconds(0.3).all("JOG OFF X").ticks(1)
    assert not made.bit(792)
    assert not made.bit(824)
    assert not made.bit(516)  # nothing coordinated
    assert made.type("JOG VEL X Y") == "10|5"


@pytest.mark.req("ACR-HOME-18")
def test_homing_speeds_up_with_ten_units_a_second_squared_by_default() -> None:
    made = bench("JOG VEL X5", "JOG HOME X1").seconds(0.2)
    moved = made.axis(0, at.AX_VELOCITY)
    made.seconds(0.1)
    scale = made.axis(0, at.AX_PPU)
    assert (made.axis(0, at.AX_VELOCITY) - moved) / scale == pytest.approx(10 * 0.1)


@pytest.mark.req("ACR-HOME-02")
def test_homing_on_a_voltage_makes_its_register_zero() -> None:
    made = bench("AXIS0 OFF", "ATTACH AXIS0 ADC3 DAC0", "AXIS0 ON", "JOG VEL X5")
    made.memory.S[at.ADC_BASE + 3 * at.ADC_STRIDE + at.ADC_ADC_INPUT] = 2.5
    made.ticks(2)
    assert made.axis(0, at.AX_ACTUAL_POSITION) == 2500
    made.all("JOG HOME X1").seconds(0.2)
    made.all("SET 2")
    made.until_clear(792)
    made.ticks(200)
    assert made.bit(16134)
    assert made.axis(0, at.AX_ACTUAL_POSITION) == 0


@pytest.mark.req("ACR-CMD-JOG-FWD", "ACR-CMD-JOG-OFF", "ACR-JOG-08")
def test_a_forward_jog_shows_its_phases_in_the_flags() -> None:
    made = bench("JOG ACC X100 : JOG DEC X50 : JOG VEL X10", "JOG FWD X")
    assert flags(made) == on(active=True, forward=True)
    made.ticks(ticks(0.1) - 1)
    assert flags(made) == on(active=True, forward=True)
    made.ticks(1)
    assert flags(made) == on(active=True, at_speed=True, forward=True)
    assert made.p(12346) == 10.0
    made.type("JOG OFF X")
    made.ticks(1)
    assert flags(made) == on(active=True, stopping=True)
    made.ticks(ticks(0.2) - 2)
    assert flags(made) == on(active=True, stopping=True)
    made.ticks(1)
    assert flags(made) == on()
    assert made.p(JOG) == 500 + 1000


@pytest.mark.req("ACR-CMD-JOG-REV")
def test_a_reverse_jog_sets_direction_and_reverse() -> None:
    made = bench("JOG VEL X10", "JOG REV X").ticks(100)
    assert flags(made) == on(active=True, direction=True, reverse=True)
    assert made.p(JOG) < 0


@pytest.mark.req("ACR-JOG-09")
def test_the_forward_flag_starts_and_stops_a_jog() -> None:
    made = bench("JOG ACC X0 : JOG DEC X0 : JOG VEL X10", "SET 796").ticks(100)
    assert made.p(JOG) == 500
    made.type("CLR 796")
    made.ticks(10)
    assert (made.p(JOG), made.bit(ACTIVE)) == (500, False)


@pytest.mark.req("ACR-JOG-10")
def test_jog_lockout_keeps_an_axis_at_rest() -> None:
    made = bench("JOG ACC X0 : JOG VEL X10", "SET 799", "JOG FWD X").ticks(20)
    assert (made.p(JOG), made.bit(FORWARD), made.bit(ACTIVE)) == (0, True, False)
    made.type("CLR 799")
    made.ticks(20)
    assert made.p(JOG) == 100


@pytest.mark.parametrize("start", ["JOG HOME X1", f"SET {HOME_REQUEST}"])
def test_jog_lockout_keeps_homing_from_starting(start: str) -> None:
    made = bench("JOG VEL X10", "SET 799", start).ticks(20)
    assert (made.psp(0), made.bit(ACTIVE), made.bit(HOMING)) == (0, False, False)
    made.all("CLR 799", start).ticks(20)
    assert made.psp(0) > 0


def test_the_flag_that_starts_homing_does_nothing_while_the_axis_moves() -> None:
    made = bench("JOG VEL X10 : VEL 1", "X1", f"SET {HOME_REQUEST}").ticks(20)
    assert (made.p(JOG), made.bit(HOMING), made.bit(HOME_REQUEST)) == (0, False, False)


def test_a_search_takes_over_a_jog_vel_set_later() -> None:
    made = bench("JOG ACC X0", "JOG HOME X1").ticks(20)
    assert (made.psp(0), made.bit(HOMING)) == (0, True)
    made.all("JOG VEL X10").ticks(20)
    assert made.psp(0) == pytest.approx(100)


def test_with_negative_ppu_forward_is_where_the_units_count_up() -> None:
    made = Bench("X").all("PPU X-1000", "JOG ACC X0 : JOG DEC X0 : JOG VEL X10", "JOG FWD X")
    made.ticks(20)
    assert (made.p(JOG), made.p(VELOCITY), made.bit(DIRECTION)) == (-100, 10, False)
    made.all("JOG REV X").ticks(40)
    assert (made.p(JOG), made.p(VELOCITY), made.bit(DIRECTION)) == (100, -10, True)
    made.all("JOG OFF X", "JLM X(0.5,-0.2)", "SET 798", "JOG FWD X").seconds(0.2)
    assert made.p(JOG) == -500
    made.all("JOG REV X").seconds(0.2)
    assert made.p(JOG) == 200
    made.all("JOG OFF X").ticks(2).all("JOG HOME X-1").ticks(20)
    assert made.p(JOG) == 300


@pytest.mark.req("ACR-CMD-JOG-VEL", "ACR-JOG-06")
def test_the_jog_speed_may_change_during_a_jog() -> None:
    made = bench("JOG ACC X20 : JOG DEC X25 : JOG VEL X10", "JOG INC X10").seconds(1.0)
    assert made.p(JOG) == 7500
    made.type("JOG VEL X5")
    assert made.until_clear(ACTIVE) == ticks(0.5)
    assert made.p(JOG) == 10000


@pytest.mark.req("ACR-CMD-JOG-JRK")
def test_jog_jrk_makes_s_curves() -> None:
    made = bench("JOG ACC X100 : JOG DEC X100 : JOG JRK X1000 : JOG VEL X50", "JOG INC X40")
    assert made.until_clear(ACTIVE) == ticks(1.4)
    assert made.p(JOG) == 40000


# jogs with a target


@pytest.mark.req("ACR-CMD-JOG-ABS")
def test_repeating_an_absolute_jog_moves_nothing() -> None:
    made = bench("JOG VEL X10", "JOG ABS X5")
    made.until_clear(ACTIVE)
    assert made.p(JOG) == 5000
    assert made.type("JOG ABS X5") == ""
    assert not made.bit(ACTIVE)


@pytest.mark.req("ACR-CMD-JOG-INC")
def test_an_incremental_jog_adds_to_the_offset_or_the_target_under_way() -> None:
    made = bench("JOG ACC X0 : JOG DEC X0 : JOG VEL X10", "JOG INC X5")
    made.until_clear(ACTIVE)
    made.all("JOG INC X-2").ticks(10)
    made.all("JOG INC X-2")
    made.until_clear(ACTIVE)
    assert made.p(JOG) == 1000


@pytest.mark.req("ACR-JOG-05", "ACR-JOG-02")
def test_jogs_of_one_statement_start_together_and_end_on_their_own() -> None:
    made = bench("JOG ACC X1000 Y500", "JOG DEC X1000 Y500", "JOG VEL X25 Y50", "JOG INC X10 Y10")
    assert (made.bit(ACTIVE), made.bit(ACTIVE + 32)) == (True, True)
    assert made.until_clear(ACTIVE + 32) == ticks(0.3)
    assert made.bit(ACTIVE)
    assert made.until_clear(ACTIVE) == ticks(0.425) - ticks(0.3)
    assert (made.p(JOG), made.p(JOG + 256)) == (10000, 10000)


@pytest.mark.req("ACR-JOG-07")
def test_a_program_waits_for_a_jog_with_inh() -> None:
    made = bench("JOG ACC X1000 Y500", "JOG DEC X1000 Y500", "JOG VEL X25 Y50")
    made.run("JOG INC X10", "INH -792", "JOG INC Y10", "INH -824")
    made.ticks(3)
    assert (made.bit(ACTIVE), made.bit(ACTIVE + 32)) == (True, False)
    first = made.until_clear(ACTIVE)
    assert first + 3 == pytest.approx(ticks(0.425), abs=3)
    made.ticks(3)
    assert made.bit(ACTIVE + 32)
    assert made.until_clear(ACTIVE + 32) + 3 == pytest.approx(ticks(0.3), abs=3)


def test_a_new_target_turns_a_jog_round_through_zero() -> None:
    made = bench("JOG ACC X100 : JOG DEC X100 : JOG VEL X10", "JOG FWD X").seconds(0.5)
    made.all("JOG ABS X0")
    assert not made.bit(FORWARD)
    assert largest(made, at.AX_CURRENT_JOG_VELOC, 0, ACTIVE) == pytest.approx(10.0)
    assert made.p(JOG) == 0


def test_jog_velocity_0_means_no_motion() -> None:
    made = bench("JOG INC X5").seconds(0.2)
    assert made.p(JOG) == 0


# what jogs share with other motion


@pytest.mark.req("ACR-JOG-03")
def test_a_jog_runs_beside_gear_and_cam_motion() -> None:
    made = bench("ACC 0 STP 0 VEL 10", "JOG ACC X0 : JOG DEC X0 : JOG VEL X5")
    made.all("DIM LA(1)", "DIM LA0(2)", "LA0(0)=0 : LA0(1)=1000")
    made.all("GEAR SRC X ENC9 : GEAR PPU X1000 : GEAR ON X")
    made.all("CAM DIM X1", "CAM SEG X(0,1000,LA0)", "CAM SRC X ENC9", "CAM ON X")
    made.all("X10", "JOG INC X-2")
    row = at.ENC_BASE + 9 * at.ENC_STRIDE
    for _ in range(500):
        made.memory.I[row] += 1
        made.ticks(1)
    parts = (made.p(CURRENT), made.p(JOG), made.p(GEAR), made.p(CAM))
    assert parts == pytest.approx((2500, -1250, 500, 500), abs=6)
    assert made.p(PSP) == pytest.approx(sum(parts), abs=2)


@pytest.mark.req("ACR-JOG-11", "ACR-JOG-03", "ACR-SUM-02", "ACR-MOT-01")
def test_a_jog_adds_to_a_coordinated_move_and_leaves_its_register() -> None:
    made = bench("ACC 0 STP 0 VEL 10", "JOG ACC X0 : JOG DEC X0 : JOG VEL X5")
    made.all("X10", "JOG INC X-2").ticks(400)
    assert (made.p(CURRENT), made.p(JOG), made.p(PSP)) == (2000, -1000, 1000)
    made.until_clear(516, ACTIVE)
    assert (made.p(CURRENT), made.p(JOG), made.p(PSP)) == (10000, -2000, 8000)


@pytest.mark.req("ACR-SUM-01", "ACR-SERVO-01")
def test_the_primary_setpoint_is_the_sum_of_all_parts() -> None:
    made = bench()
    made.place(0, position=100.25, gear=20.5, jog=3.25, cam=0.5)
    made.ticks(1)
    assert made.psp(0) == 124.5
    assert made.p(PSP) in (124, 125)
    made.type("P12296 = 0")
    made.ticks(1)
    assert made.psp(0) == 104.0


@pytest.mark.req("ACR-JOG-04")
def test_a_jog_by_name_needs_attachments_and_one_by_number_does_not() -> None:
    made = Bench()
    made.all("AXIS0 JOG VEL 10 AXIS0 JOG ACC 0")
    assert made.type("JOG FWD X") == "Undefined symbol"
    assert made.at(Level.SYS).type("JOG FWD X") == "Unknown command"
    assert made.type(":AXIS0 JOG FWD") == ""
    made.ticks(100)
    assert made.p(JOG) == pytest.approx(0.5, abs=0.5)
    assert made.bit(ACTIVE)
    assert made.type(":AXIS0 JOG OFF") == ""


@pytest.mark.parametrize(
    ("setup", "line", "message"),
    [
        ("SET 8467", "JOG FWD X", "Associated Slave Kill Motion Request Active"),
        ("SET 8499", "JOG INC X1", "Associated Slave Kill Motion Request Active"),
        ("AXIS0 OFF", "JOG ABS X1", "Axis is off"),
        ("HLIM X1 : SET 0", "JOG FWD X", "Hard limit"),
        ("HLIM X2 : SET 1", "JOG REV X", "Hard limit"),
        ("SLIM X1 : SLM X(-1,-2)", "JOG INC X1", "Soft limit"),
        ("SLIM X2 : SLM X(2,1)", "JOG ABS X-1", "Soft limit"),
    ],
)
def test_a_jog_is_refused_with_the_reason(setup: str, line: str, message: str) -> None:
    made = bench("JOG VEL X10 Y10", setup).ticks(1)
    assert made.type(line) == message
    assert not made.bit(ACTIVE)


def test_a_refused_axis_lets_none_of_the_statement_start() -> None:
    made = bench("JOG VEL X10 Y10", "HLIM Y1 : SET 3").ticks(1)
    assert made.type("JOG FWD X Y") == "Hard limit"
    assert not made.bit(ACTIVE)
    assert made.type("JOG INC X1 Y1") == "Hard limit"
    assert not made.bit(ACTIVE)


# registers


def test_jog_ren_and_res_are_refused_while_their_profiler_moves() -> None:
    made = bench("JOG VEL X10", "ACC 0 STP 0 VEL 1", "X10")
    assert made.type("JOG REN X") == "Not valid while in motion"
    assert made.type("JOG RES X") == "Not valid while in motion"
    made.until_clear(516)
    made.all("JOG FWD X")
    assert made.type("JOG RES X") == "Not valid while in motion"


def test_what_jog_res_takes_into_a_held_path_is_jog_offset_again_when_it_goes_on() -> None:
    made = bench("JOG VEL X10 : JOG ACC X0 : JOG DEC X0", "ACC 0 DEC 0 STP 0 VEL 1", "X1").ticks(
        100
    )
    made.all("SET 520").seconds(0.2)
    held = made.p(CURRENT)
    made.all("JOG INC X0.5").until_clear(ACTIVE)
    made.all("JOG RES X")
    assert (made.p(CURRENT), made.p(JOG), made.p(PSP)) == (held + 500, 0, held + 500)
    made.all("SET 521")
    psp = made.psp(0)
    while made.bit(516):
        made.ticks(1)
        assert abs(made.psp(0) - psp) < 1.01 * 0.5
        psp = made.psp(0)
    assert (made.p(CURRENT), made.p(JOG), made.p(PSP)) == (1000, 500, 1500)


def test_what_jog_res_takes_into_a_held_path_stays_when_its_moves_are_dropped() -> None:
    made = bench("JOG VEL X10 : JOG ACC X0 : JOG DEC X0", "ACC 0 DEC 0 STP 0 VEL 1", "X1").ticks(
        100
    )
    made.all("SET 520").seconds(0.2)
    held = made.p(CURRENT)
    made.all("JOG INC X0.5").until_clear(ACTIVE)
    made.all("JOG RES X", "SET 522").ticks(10).all("CLR 522", "VEL 10", "X2")
    made.until_clear(516)
    assert (made.p(CURRENT), made.p(JOG), held < 1000) == (2000, 0, True)


def test_jog_ren_during_a_jog_moves_nothing_and_keeps_the_target() -> None:
    made = bench("JOG ACC X0 : JOG DEC X0 : JOG VEL X10", "JOG ABS X3").ticks(100)
    before = made.psp(0)
    made.all("JOG REN X1").ticks(1)
    assert made.psp(0) == pytest.approx(before + 5)
    made.until_clear(ACTIVE)
    assert (made.p(CURRENT), made.p(JOG), made.p(PSP)) == (1000, 3000, 4000)


# homing


@pytest.mark.req("ACR-CMD-JOG-HOME")
def test_homing_starts_on_all_axes_at_once_and_is_refused_in_motion() -> None:
    made = bench("JOG VEL X1 Y1")
    assert made.type("JOG HOME X1 Y-1") == ""
    made.ticks(20)
    assert (made.bit(ACTIVE), made.bit(ACTIVE + 32)) == (True, True)
    assert made.p(JOG) > 0 > made.p(JOG + 256)
    assert made.type("JOG HOME X1") == "Not valid while in motion"
    made.all("JOG OFF X Y")
    assert made.bit(16135)


def test_homing_takes_only_a_direction() -> None:
    made = bench("JOG VEL X1")
    for value in ("0", "2", "-2"):
        assert made.type(f"JOG HOME X{value}") == "Invalid argument"
    assert made.type("JOG HOME X") == ""
    made.ticks(20)
    assert made.p(JOG) > 0


@pytest.mark.req("ACR-CMD-JOG-HOMVF")
def test_homvf_is_the_speed_of_the_last_approach() -> None:
    made = bench("JOG ACC X100 : JOG DEC X100 : JOG VEL X10 : JOG HOMVF X0.5")
    made.all("SET 16152", "JOG HOME X1").seconds(0.1)
    made.all("SET 2").seconds(0.1)
    made.all("CLR 2")  # the positive edge: backs up, then approaches it again
    made.seconds(0.3)
    assert made.p(12346) == -0.5
    made.all("SET 2").ticks(2)  # met while moving backwards: on, stops, approaches forwards
    made.seconds(0.1)
    assert made.p(12346) == 0.5
    made.all("CLR 2").ticks(2)
    assert (made.bit(16134), made.p(CURRENT), made.p(JOG)) == (True, 0, 0)
