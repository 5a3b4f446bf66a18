"""Gears: offsets, ramps, registers, triggers, flags and what ends them."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.basic.motion_bench import WHEEL, Bench

from openacr.basic.language.registry import Level
from openacr.map.rows import axes

PSP, GEAR, SLIP, ON_OFFSET = 12294, 12296, 12369, 12396
LOCK, AT_SPEED, STOPPING, ACTIVATE, ACTIVE = 781, 782, 783, 788, 789
ON_ARMED, ON_POSITION, STARTED, OFF_ARMED, OFF_POSITION, MAX, MIN = (
    2312, 2313, 2314, 2316, 2317, 2318, 2319,
)  # fmt: skip
KAMR = 8467
KILLED = "Associated Slave Kill Motion Request Active"


def bench(*lines: str) -> Bench:
    return Bench("X", "Y").all("GEAR SRC X ENC10", *lines)


def turn(made: Bench, counts: int) -> Bench:
    """The source moves within one tick."""
    made.memory.I[WHEEL] += counts
    return made.ticks(1)


def gear(made: Bench) -> float:
    """Gear offset of X, unrounded."""
    return made.memory.F[axes.gear_cnt[0]]


# offsets


def test_a_counter_that_runs_over_is_no_jump() -> None:
    made = bench()
    made.memory.I[WHEEL] = 2**31 - 5
    made.ticks(1)
    made.all("GEAR ON X")
    made.memory.I[WHEEL] = -(2**31) + 5
    made.ticks(1)
    assert gear(made) == 10.0


def test_choosing_another_source_is_no_jump() -> None:
    made = bench("P38912=1000", "GEAR ON X")
    turn(made, 7)
    made.all("GEAR SRC X P38912").ticks(2)
    assert gear(made) == 7.0
    assert made.type("GEAR SRC X") == "P38912"


@pytest.mark.parametrize("source", ["ENC100", "AXIS16", "RATCH8", "LIMIT9", "P40000"])
def test_a_source_that_does_not_exist_is_invalid(source: str) -> None:
    made = Bench("X")
    refused = made.type(f"GEAR SRC X {source}")
    assert refused == ("Invalid source")
    assert made.type("GEAR SRC X") == "NONE"


# ramps


@pytest.mark.req("ACR-GEAR-03")
def test_gear_acc_ramps_the_ratio_and_counts_the_slip() -> None:
    made = bench("GEAR ACC X100 : GEAR DEC X200", "GEAR RATIO X4", "GEAR ON X")
    assert (made.bit(ACTIVATE), made.bit(ACTIVE)) == (True, True)
    for tick in range(1, 81):  # 0 to 4 in 0.04 s
        turn(made, 10)
        time_s = tick * 0.0005
        assert gear(made) == pytest.approx(20000 * 100 * time_s**2 / 2)
        assert made.bit(AT_SPEED) == (tick == 80)
    assert made.p(SLIP) == pytest.approx(20000 * 4 * 0.04 / 2)
    before = gear(made)
    made.all("GEAR OFF X")
    for tick in range(1, 41):
        turn(made, 10)
        assert made.bit(STOPPING) == (tick < 40)
    assert gear(made) - before == pytest.approx(20000 * 4 * 0.02 / 2)
    assert not made.bit(ACTIVE)
    turn(made, 10)
    assert made.p(SLIP) == pytest.approx(1600)


def test_a_ramp_may_end_within_a_tick_and_pass_through_zero() -> None:
    made = bench("GEAR RATIO X2", "GEAR ON X").ticks(1)
    made.all("GEAR ACC X3000 : GEAR DEC X8000", "GEAR RATIO X-0.3")
    turn(made, 1000)  # 2 to 0 in 0.25 ms, 0 to -0.3 in 0.1 ms, the rest at -0.3
    area = 0.5 * 2 * 0.25 - 0.5 * 0.3 * 0.1 - 0.3 * 0.15
    assert gear(made) == pytest.approx(1000 * area / 0.5)
    assert made.bit(AT_SPEED)


def test_gear_lock_forces_the_programmed_ratio() -> None:
    made = bench("GEAR ACC X1", f"SET {LOCK}", "GEAR ON X")
    turn(made, 100)
    assert (gear(made), made.bit(AT_SPEED)) == (100.0, True)
    made.all("GEAR RATIO X-2")
    turn(made, 100)
    assert gear(made) == -100.0


# registers


def test_gear_res_waits_for_no_move_to_end() -> None:
    made = bench("GEAR ON X", "VEL 10", "X100").ticks(5)
    assert made.type("GEAR RES X") == "Not valid while in motion"


def test_writing_the_shown_offset_replaces_it() -> None:
    made = bench("GEAR ON X")
    turn(made, 9)
    made.all("P12296=0").ticks(1)
    assert (gear(made), made.p(PSP)) == (0.0, 0)
    turn(made, 3)
    assert gear(made) == 3.0


@pytest.mark.parametrize(("scale", "sign"), [("10", 1), ("-10", -1)])
def test_the_offset_stops_at_max_and_min(scale: str, sign: int) -> None:
    made = bench(f"PPU X{scale}", "GEAR MAX X2", "GEAR MIN X-1", "GEAR ON X")
    turn(made, 5)
    assert (made.p(GEAR), made.bit(MAX), made.bit(MIN)) == (sign * 20, True, False)
    turn(made, -1)
    assert (made.p(GEAR), made.bit(MAX)) == (sign * 10, False)
    turn(made, -9)
    assert (made.p(GEAR), made.bit(MIN)) == (-sign * 10, True)


def test_an_offset_beyond_max_is_no_jump() -> None:
    made = bench("GEAR ON X")
    turn(made, 50)
    made.all("GEAR MAX X20", "GEAR MIN X-20")
    turn(made, 5)
    assert gear(made) == 50.0
    turn(made, -40)
    assert gear(made) == 10.0


@pytest.mark.parametrize(
    "line", ["GEAR ON", "GEAR", "GEAR RATIO", "GEAR ON IHPOS X", "GEAR ON TRG"]
)
def test_a_malformed_gear_is_a_syntax_error(line: str) -> None:
    assert Bench("X").type(line) == "Syntax error"


def test_values_are_checked_and_reported() -> None:
    made = Bench("X", "Y")
    assert made.type("GEAR PPU X Y") == "1|1"
    assert made.type("GEAR PPU X0") == "Invalid argument"
    assert made.type("GEAR ACC X-1") == "Invalid argument"
    assert made.at(Level.SYS).type("AXIS1 GEAR RATIO 2.5") == ""
    assert made.type("GEAR RATIO AXIS1") == "2.5"


# triggers


@pytest.mark.parametrize(
    ("line", "delta", "gained"),
    [
        ("GEAR ON IHPOS X(P6304, 25)", 10, 15.0),
        ("GEAR ON IHPOS X(-P6304, -25)", -10, -15.0),
    ],
)
def test_on_ihpos_counts_the_source_beyond_the_setpoint(
    line: str, delta: int, gained: float
) -> None:
    made = bench(line)
    assert made.bit(ON_POSITION)
    for _ in range(2):
        turn(made, delta)
    assert (gear(made), made.bit(ACTIVATE)) == (0.0, False)
    for _ in range(2):
        turn(made, delta)
    assert gear(made) == gained
    assert (made.bit(ON_POSITION), made.bit(ACTIVATE), made.bit(ACTIVE)) == (False, True, True)


def test_on_ihpos_gives_up_after_its_timeout() -> None:
    made = bench("GEAR ON IHPOS X(P6304, 25, 0.005)").ticks(9)
    assert made.bit(ON_POSITION)
    made.ticks(1)
    assert not made.bit(ON_POSITION)
    turn(made, 100)
    assert gear(made) == 0.0


@pytest.mark.parametrize("timeout", ["-1", "2000000", "1e300"])
def test_a_timeout_that_cannot_be_counted_in_servo_periods_is_refused(timeout: str) -> None:
    assert bench().type(f"GEAR ON IHPOS X(P6304, 25, {timeout})") == "Invalid argument"


def test_on_ihpos_past_its_setpoint_takes_up_no_more_than_the_tick() -> None:
    made = bench()
    turn(made, 1000)
    made.all("GEAR ON IHPOS X(P6304, 25)")
    turn(made, 5)
    assert gear(made) == 5.0


def test_off_ihpos_counts_the_source_up_to_the_setpoint() -> None:
    made = bench("GEAR ON X", "GEAR OFF IHPOS X(P6304, 25)")
    assert made.bit(OFF_POSITION)
    for _ in range(5):
        turn(made, 10)
    assert gear(made) == 25.0
    assert (made.bit(OFF_POSITION), made.bit(ACTIVE)) == (False, False)


def test_a_ramp_after_a_trigger_begins_at_the_event() -> None:
    made = bench("GEAR ACC X1000", "GEAR ON IHPOS X(P6304, 25)")
    for _ in range(4):
        turn(made, 10)
    time_s = 0.0005 * 1.5
    assert gear(made) == pytest.approx(20000 * 1000 * time_s**2 / 2)


def test_on_trg_engages_from_the_captured_position_plus_the_offset() -> None:
    made = bench(f"P{ON_OFFSET}=25", "GEAR ON TRG X(2, P38912)")
    assert made.bit(ON_ARMED)
    turn(made, 10)
    made.memory.set_bit(26, True)  # first capture input of encoder 10
    turn(made, 10)
    assert (made.p(38912), gear(made)) == (20, 0.0)
    for _ in range(3):
        turn(made, 10)
    assert gear(made) == 5.0
    assert (made.bit(ON_ARMED), made.bit(STARTED), made.bit(ACTIVATE)) == (False, True, True)
    made.all("GEAR OFF X").ticks(1)
    assert not made.bit(STARTED)


def test_on_trg_watches_the_capture_inputs_of_the_register_it_names() -> None:
    made = bench("GEAR ON TRG X(2, 5)")
    turn(made, 10).memory.set_bit(26, True)  # first capture input of encoder 10
    assert gear(turn(made, 10)) == 0.0
    made.memory.set_bit(29, True)  # of encoder 5
    assert gear(turn(turn(made, 10), 10)) == 10.0


@pytest.mark.parametrize("cap", ["16", "-1", "P12304"])
def test_a_capture_register_or_parameter_that_does_not_exist_is_refused(cap: str) -> None:
    expected = "Invalid parameter" if cap.startswith("P") else "Invalid argument"
    made = bench()
    assert made.type(f"GEAR ON TRG X(2, {cap})") == expected
    assert not made.bit(ON_ARMED)


def test_off_trg_disengages_at_the_captured_position() -> None:
    made = bench("GEAR ON X", "GEAR OFF TRG X(6)")
    made.memory.set_bit(26, True)
    turn(made, 10)
    assert made.bit(OFF_ARMED)
    made.memory.set_bit(26, False)
    turn(made, 10)
    turn(made, 10)
    assert (gear(made), made.bit(OFF_ARMED), made.bit(ACTIVE)) == (20.0, False, False)


@pytest.mark.parametrize(
    ("line", "armed"),
    [("GEAR OFF TRG X(6)", OFF_ARMED), ("GEAR OFF IHPOS X(P6304, 25)", OFF_POSITION)],
)
def test_off_forgets_what_an_off_waits_for(line: str, armed: int) -> None:
    made = bench("GEAR ON X", line)
    assert made.bit(armed)
    made.all("GEAR OFF X").ticks(1)
    assert not made.bit(armed)
    made.all("GEAR ON X")
    made.memory.set_bit(26, True)
    turn(made, 10)
    made.memory.set_bit(26, False)
    for _ in range(4):
        turn(made, 10)
    assert (gear(made), made.bit(ACTIVE)) == (50.0, True)


# flags and kills


def test_the_activate_flag_switches_the_gear() -> None:
    made = bench(f"SET {ACTIVATE}")
    turn(made, 4)
    assert (gear(made), made.bit(ACTIVE)) == (4.0, True)
    made.all(f"CLR {ACTIVATE}")
    turn(made, 4)
    assert (gear(made), made.bit(ACTIVE)) == (4.0, False)


@pytest.mark.req("ACR-KAMR-04", "ACR-KAMR-06")
def test_a_kill_stops_a_gear_with_hldec_and_bars_it() -> None:
    made = bench("HLDEC X100000", "GEAR ON X")
    for _ in range(20):
        turn(made, 10)  # 20000 pulses per second
    made.all(f"SET {KAMR}")
    ticks = 0
    while made.bit(792) or ticks == 0:
        turn(made, 10)
        ticks += 1
    assert ticks == 400
    assert made.p(GEAR) == 200
    assert made.p(PSP) == pytest.approx(200 + 20000**2 / (2 * 100000), abs=1)
    assert not any(made.bit(flag) for flag in (ACTIVATE, ACTIVE, AT_SPEED))
    assert made.type("GEAR ON X") == KILLED
    made.all(f"SET {ACTIVATE}")
    turn(made, 10)
    assert (made.bit(ACTIVATE), made.p(GEAR)) == (False, 200)
    made.all(f"CLR {KAMR} {KAMR + 32}", "GEAR ON X")
    turn(made, 10)
    assert made.p(GEAR) == 210


def test_an_axis_that_is_off_does_not_gear() -> None:
    made = bench("AXIS0 OFF")
    assert made.type("GEAR ON X") == "Axis is off"


# for any history


STEPS = st.lists(
    st.one_of(
        st.integers(-40, 40),
        st.sampled_from(
            ["GEAR ON X", "GEAR OFF X", "GEAR RATIO X-2", "GEAR RATIO X0.3", "GEAR RES X3",
             "GEAR RES X", f"SET {LOCK}", f"CLR {LOCK}", "GEAR SRC X CLK", "GEAR SRC X ENC10"]
        ),
    ),
    max_size=40,
)  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(STEPS)
def test_setpoints_are_sums_and_never_jump(history: list[int | str]) -> None:
    made = bench("GEAR ACC X500 : GEAR DEC X700", "GEAR RATIO X2")
    for step in history:
        before = made.psp(0)
        if isinstance(step, str):
            made.all(step)
            assert made.psp(0) == before
            made.ticks(1)
        else:
            turn(made, step)
        moved = abs(step) if isinstance(step, int) else 0.5
        assert abs(made.psp(0) - before) <= 2 * max(moved, 0.5) + 1e-9
        parts = made.memory.F[axes.reals[0] : axes.reals[0] + 4]
        assert made.psp(0) == pytest.approx(math.fsum(parts))
