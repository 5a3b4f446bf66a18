"""Hand wheels, time bases of jogs, filters, locked pairs, directional limits and RPM."""

import pytest
from tests.basic.motion_bench import Bench, largest, turn

from openacr.map.rows import axes, motors

PSP, GEAR, JOG = 12294, 12296, 12297
ACTIVE, KAMR = 792, 8467


def bench(*lines: str) -> Bench:
    made = Bench("X", "Y").all("PPU X1000 Y1000", "JOG VEL X10 Y10", "JOG ACC X100 Y100")
    return made.all("JOG DEC X100 Y100", *lines)


# hand wheels


def test_the_wheel_has_speeds_of_its_own() -> None:
    made = bench("HDW SRC X ENC10", "HDW PPU X10", "HDW VEL X2 : HDW ACC X50", "HDW ON X")
    turn(made, 10)
    assert largest(made, axes.current_jog_veloc, 0, ACTIVE) == pytest.approx(2.0)
    assert made.p(JOG) == 1000
    assert made.type("HDW X Y") == "ON|OFF"


def test_turning_back_turns_the_axis_back() -> None:
    made = bench("HDW SRC X ENC10", "HDW RATIO X0.1", "HDW ON X")
    turn(made, 50, *([0] * 300), *([-2] * 40))
    made.until_clear(ACTIVE)
    assert made.p(JOG) == -3000


def test_switched_off_it_still_arrives_without_a_jump() -> None:
    made = bench("HDW SRC X ENC10", "HDW ON X")
    turn(made, 1)
    made.all("HDW OFF X")
    turn(made, 5)
    made.until_clear(ACTIVE)
    assert made.p(JOG) == 1000


def test_a_kill_drops_its_counts() -> None:
    made = bench("HDW SRC X ENC10", "HDW ON X", f"SET {KAMR}")
    turn(made, 5)
    made.all(f"CLR {KAMR} {KAMR + 32}")
    turn(made, 0, 0)
    assert (made.p(JOG), made.bit(ACTIVE)) == (0, False)


@pytest.mark.req("MILL-HW-LIMITS")
def test_it_stops_at_a_soft_limit_and_comes_back() -> None:
    made = bench("HDW SRC X ENC10", "SLM X(2,-2)", "SLIM X3", "SLDEC X1000", "HDW ON X")
    turn(made, 10).seconds(2)
    stopped = made.p(JOG)
    assert 2000 < stopped < 2100
    turn(made, 10).seconds(0.1)
    assert made.p(JOG) == stopped
    turn(made, -1)
    made.until_clear(ACTIVE)
    assert made.p(JOG) == stopped - 1000


# time base of jogs


def test_a_kill_stops_by_the_clock() -> None:
    made = bench("JOG SRC X ENC10", "HLDEC X100", "JOG ACC X0", "JOG FWD X")
    turn(made, *([1] * 20))
    made.all(f"SET {KAMR}").seconds(1.0)
    assert not made.bit(ACTIVE)


# filtered following


def test_a_filter_may_move_a_parameter() -> None:
    made = bench("FLT SRC X ENC10", "FLT COEF X4", "FLT OUT X P38912", "FLT ON X")
    turn(made, 10, 0, 0)
    assert made.p(38912) == 7
    turn(made, 0, 0)
    assert (made.p(38912), made.p(GEAR)) == (10, 0)


# locked pairs


@pytest.mark.parametrize("flag", [788 + 32, 790 + 32, 796 + 32, 797 + 32, 17160 + 32])
def test_flags_do_not_move_a_locked_axis(flag: int) -> None:
    made = bench("GEAR SRC Y CLK", "LOCK X Y", f"SET {flag}").ticks(100)
    assert (made.psp(1), made.bit(flag)) == (0, False)


def test_res_of_the_leader_moves_nothing() -> None:
    made = bench("LOCK X Y", "JOG INC X1")
    made.until_clear(ACTIVE)
    made.all("RES X").ticks(5)
    assert (made.p(PSP), made.p(PSP + 256)) == (0, 1000)


@pytest.mark.parametrize("flag", [KAMR, KAMR + 32])
def test_a_kill_stops_the_pair_together(flag: int) -> None:
    made = bench("LOCK X Y", "HLDEC X100", "JOG FWD X").seconds(0.5)
    made.all(f"SET {flag}")
    for _ in range(300):
        made.ticks(1)
        assert made.psp(1) == pytest.approx(made.psp(0))
    assert not made.bit(ACTIVE)
    assert made.bit(KAMR)


def test_a_pair_is_coupled_by_its_following_errors() -> None:
    made = bench("LOCK X Y", "P12376=0.5", "PGAIN X0.001 Y0.001")
    made.memory.I[motors.kind[0]] = 1  # an encoder that does not follow
    made.all("JOG ACC X0", "JOG VEL X1", "JOG FWD X").ticks(3)
    error = made.axis(0, axes.following_error) - made.axis(1, axes.following_error)
    assert error > 0
    outputs = [made.axis(axis, axes.output_signal) for axis in (0, 1)]
    assert outputs[0] > 0 > outputs[1]


def test_what_cannot_be_locked() -> None:
    made = bench()
    assert made.type("LOCK X") == "Syntax error"
    assert made.type("LOCK X X") == "Invalid argument"
    made.all("LOCK X Y")
    assert made.type("LOCK Y X") == "Axis is locked"
    made.all("UNLOCK X")
    assert made.type("LOCK") == ""


# directional limits and RPM


@pytest.mark.parametrize(("flag", "target"), [(2304, "X5"), (2305, "X-5")])
def test_a_directional_limit_holds_the_master(flag: int, target: str) -> None:
    made = bench("ACC 0 DEC 0 STP 0 VEL 10", f"SET {flag} 2306", target).seconds(0.1)
    assert (made.bit(2307), made.bit(519)) == (True, True)
    stopped = made.p(PSP)
    made.all(f"CLR {flag} 2307", "SET 521").seconds(2)
    assert abs(stopped) < 20
    assert abs(made.p(PSP)) == 5000


def test_the_other_direction_is_free() -> None:
    made = bench("ACC 0 DEC 0 STP 0 VEL 10", "SET 2304 2306", "X-5").seconds(1)
    assert (made.bit(2307), made.p(PSP)) == (False, -5000)


def test_rpm_is_the_factor_times_pulses_per_tick() -> None:
    made = bench("P12370=30", "JOG ACC X0", "JOG FWD X").ticks(10)  # 4000 pulses per turn
    assert made.p(12371) == pytest.approx(30 * 5)
