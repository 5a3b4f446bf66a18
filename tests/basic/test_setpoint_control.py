"""Jog commands: profile, flags, targets, registers; jog and coordinated motion together."""

import pytest
from tests.basic.motion_bench import Bench, largest

from openacr.map.rows import axes

ACTIVE, DIRECTION, FORWARD = 792, 793, 796
HOMING, HOME_REQUEST, VELOCITY = 16131, 17160, 12346
CURRENT, PSP, JOG = 12288, 12294, 12297


def bench(*lines: str) -> Bench:
    """Axes X and Y of 1000 pulses per unit."""
    return Bench("X", "Y").all("PPU X1000 Y1000", *lines)


def flags(made: Bench) -> dict[str, bool]:
    names = ("active", "direction", "at_speed", "stopping", "forward", "reverse")
    return {name: made.bit(ACTIVE + place) for place, name in enumerate(names)}


# values


def test_a_refused_value_leaves_the_others_of_the_statement() -> None:
    made = bench("JOG VEL X1 Y1")
    assert made.type("JOG VEL X5 Y-1") == "Invalid argument"
    assert made.type("JOG VEL X Y") == "1|1"


@pytest.mark.parametrize("line", ["JOG", "JOG FWD", "JOG ABS X", "JOG INC", "JOG ABS"])
def test_a_malformed_jog_is_a_syntax_error(line: str) -> None:
    assert bench().type(line) == "Syntax error"


# continuous jogs


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


# jogs with a target


def test_a_new_target_turns_a_jog_round_through_zero() -> None:
    made = bench("JOG ACC X100 : JOG DEC X100 : JOG VEL X10", "JOG FWD X").seconds(0.5)
    made.all("JOG ABS X0")
    assert not made.bit(FORWARD)
    assert largest(made, axes.current_jog_veloc, 0, ACTIVE) == pytest.approx(10.0)
    assert made.p(JOG) == 0


def test_jog_velocity_0_means_no_motion() -> None:
    made = bench("JOG INC X5").seconds(0.2)
    assert made.p(JOG) == 0


# what jogs share with other motion


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
