"""Kill All Motion Request and Kill All Moves, as set and cleared by hand."""

import pytest
from tests.basic.motion_bench import Bench, ticks
from tests.controller.hosts import connected

from openacr.basic.language.registry import Level
from openacr.map import numbers as at

KAMR_X, KAMR_Y, KILL_MOVES, STOP_MOVES = 8467, 8499, 522, 523
ACTIVE, IN_MOTION = 792, 516
CURRENT, ACTUAL, PSP, JOG = 12288, 12290, 12294, 12297
IDEAL_MOTOR = 3
KILLED = "Associated Slave Kill Motion Request Active"


def bench(*lines: str) -> Bench:
    """Axes X and Y of 1000 pulses per unit on master 0, Z on master 1."""
    made = Bench("X", "Y")
    made.attach(1, (2, "Z"))
    made.all("PPU X1000 Y1000", "PPU AXIS2 1000", "ACC 0 DEC 100 STP 0 VEL 10")
    made.all("JOG ACC X0 Y0 AXIS2 0 : JOG VEL X10 Y10 AXIS2 10 : HLDEC X100 Y200")
    return made.all(*lines)


def dimension(made: Bench) -> None:
    made.at(Level.SYS).all("DIM P(10)").at(Level.PROG, 0)


def speed(made: Bench, axis: int = 0) -> float:
    return made.axis(axis, at.AX_VELOCITY) / 1000


@pytest.mark.parametrize("axis", [0, 1, 7])
@pytest.mark.req("ACR-KAMR-01", "ACR-KAMR-44")
def test_kamr_is_flag_19_of_the_quaternary_word(axis: int) -> None:
    made = Bench().all(f"SET {8467 + 32 * axis}")
    assert made.p(4360 + axis) == 1 << 19


@pytest.mark.req("ACR-KAMR-02", "ACR-KAMR-09", "ACR-KAMR-17")
def test_kamr_stops_a_jog_with_hldec() -> None:
    made = bench("JOG FWD X").seconds(0.1)
    made.all("SET 8467")
    assert made.until_clear(ACTIVE) == ticks(10 / 100)
    made.ticks(1)
    assert speed(made) == pytest.approx(0.0)
    assert made.p(JOG) == pytest.approx(1000 + 500, abs=6)
    assert not made.bit(796)


@pytest.mark.req("ACR-KAMR-03", "ACR-KAMR-18", "ACR-KAMR-19", "ACR-KAMR-20", "ACR-KAMR-21")
def test_kamr_stops_a_move_through_the_jog_profiler() -> None:
    made = bench("X10 Y0.5").seconds(0.1)
    made.all("SET 8467").ticks(1)
    assert (made.bit(IN_MOTION), made.bit(KILL_MOVES), made.bit(KAMR_Y)) == (False, True, True)
    assert made.bit(ACTIVE)
    made.until_clear(ACTIVE, ACTIVE + 32)
    made.ticks(2)
    offset, stop = made.p(JOG), made.p(PSP)
    assert offset == pytest.approx(500, abs=6)
    made.all("JOG RES X").ticks(3)
    assert (made.p(JOG), made.p(CURRENT), made.p(PSP), made.p(ACTUAL)) == (0, stop, stop, stop)


@pytest.mark.req("ACR-KAMR-06")
def test_kamr_clears_the_flags_of_the_other_profilers() -> None:
    made = bench("JOG FWD X", "SET 788 SET 790 SET 791").ticks(3)
    made.all("SET 8467").ticks(1)
    assert [made.bit(flag) for flag in (788, 789, 790, 791, 796)] == [False] * 5


@pytest.mark.req("ACR-KAMR-08")
def test_axes_of_another_master_keep_moving() -> None:
    made = bench("AXIS2 JOG FWD", "SET 8467").seconds(0.1)
    assert speed(made, 2) == pytest.approx(10.0)
    assert (made.bit(KAMR_X + 64), made.bit(KILL_MOVES + 32)) == (False, False)
    assert made.type("AXIS2 JOG INC 1") == ""


@pytest.mark.req("ACR-KAMR-10", "ACR-KAMR-28")
def test_a_program_may_set_kamr_and_goes_on() -> None:
    made = bench("JOG FWD X")
    dimension(made)
    made.run("SET 8467", "WHILE (P0 < 50)", "P0 = P0+1", "WEND")
    made.seconds(0.2)
    assert (made.bit(KAMR_X), made.bit(ACTIVE), made.p(0)) == (True, False, 50.0)


@pytest.mark.req("ACR-KAMR-22", "ACR-KAMR-23", "ACR-KAMR-24")
def test_motion_commands_of_the_group_are_refused_while_kamr_is_set() -> None:
    made = bench("SET 8467").ticks(5)
    for line in ("JOG FWD X", "JOG INC Y1", "JOG ABS Y1", "X1", "Y1", "JOG HOME Y", "X1 Y1"):
        assert made.type(line) == KILLED
    made.seconds(0.1)
    assert (made.p(PSP), made.p(PSP + 256)) == (0, 0)
    assert (made.bit(KAMR_X), made.bit(KAMR_Y)) == (True, True)


@pytest.mark.req("ACR-KAMR-25")
def test_clearing_kamr_frees_jogs_and_clearing_kill_all_moves_frees_moves() -> None:
    made = bench("SET 8467").ticks(2)
    made.all("CLR 8467")
    assert made.type("JOG INC X1") == KILLED
    made.all("CLR 8499", "JOG INC X1")
    made.until_clear(ACTIVE)
    assert made.type("X1") == "Master Kill All Moves Request Active"
    made.all("CLR 522", "X1")
    made.until_clear(IN_MOTION)
    assert made.p(CURRENT) == 1000


@pytest.mark.req("ACR-KAMR-40")
def test_the_terminal_dialogue_of_the_guide() -> None:
    made = bench("HLDEC X0 Y0", "JOG FWD X").ticks(20)
    made.all("SET 8467").ticks(1)
    here = made.p(PSP)
    assert made.type("JOG FWD Y") == KILLED
    made.ticks(20)
    assert made.p(PSP) == here
    made.all("CLR 8467 CLR8499", "JOG FWD Y").ticks(20)
    assert made.p(PSP + 256) > 0
    made.all("JOG OFF Y")
    made.until_clear(ACTIVE + 32)
    assert made.type("Y1") == "Master Kill All Moves Request Active"
    made.all("CLR 522")
    assert made.type("Y1") == ""


@pytest.mark.req("ACR-KAMR-15")
def test_a_drive_fault_kills_the_axis() -> None:
    made = bench("SET 8468")
    made.memory.I[at.PLI_BASE + at.PLI_KIND] = IDEAL_MOTOR
    made.ticks(2).all("DRIVE ON X").seconds(0.02)
    assert made.type("DRIVE X") == "DRIVE ON X"
    made.memory.I[at.PLI_BASE + at.PLI_DRIVE_FAULT] = 1
    made.ticks(2)
    assert (made.bit(KAMR_X), made.bit(8477)) == (True, True)
    assert made.type("DRIVE X") == "DRIVE OFF X FAULT"


@pytest.mark.parametrize(("answered", "line"), [(True, "SET 8469"), (False, "CLR 8469")])
@pytest.mark.req("ACR-KAMR-16", "ACR-CMD-EXC")
def test_excess_error_kills_the_axis_if_it_is_answered(answered: bool, line: str) -> None:
    made = bench("EXC X0.1 : TLM X0", line, "JOG INC X1").seconds(0.2)
    assert (made.bit(KAMR_X), made.bit(8479), made.bit(769)) == (answered, answered, False)


@pytest.mark.req("ACR-CMD-EXC")
@pytest.mark.parametrize(
    ("target", "faults"), [(0.3, False), (0.301, True), (-0.2, False), (-0.201, True)]
)
def test_the_ends_of_the_error_band_belong_to_it(target: float, faults: bool) -> None:
    made = bench("EXC Y(0.3,-0.2) : TLM Y0", "SET 8501", f"Y{target}").seconds(0.2)
    assert [made.bit(flag) for flag in (KAMR_Y, 8511)] == [faults] * 2
    assert made.bit(801) is not faults
    assert made.bit(769)


# Kill All Moves and Stop All Moves


@pytest.mark.parametrize(("master", "flag"), [(0, 522), (7, 746), (8, 7434), (15, 7658)])
@pytest.mark.req("ACR-KAMR-30")
def test_kill_all_moves_is_flag_10_of_the_master(master: int, flag: int) -> None:
    made = Bench().all(f"SET {flag}")
    word = (at.MF1_WORD if master < 8 else at.MF1_WORD_HIGH) + master
    assert made.memory.I[word] == at.MF1_KILL_ALL_MOVES_REQUEST


@pytest.mark.req("ACR-KAMR-31", "ACR-KAMR-35", "ACR-KAMR-37")
def test_kill_all_moves_stops_moves_at_once_and_leaves_jogs() -> None:
    made = bench("X10", "JOG FWD Y").seconds(0.1)
    made.all("SET 522").ticks(1)
    here = made.p(CURRENT)
    assert (speed(made), made.bit(IN_MOTION)) == (0.0, False)
    made.ticks(100)
    assert (made.p(CURRENT), made.p(12289)) == (here, here)
    assert speed(made, 1) == pytest.approx(10.0)
    assert made.bit(KILL_MOVES)
    assert made.type("JOG INC X1") == ""


@pytest.mark.req("ACR-KAMR-36")
def test_kill_all_moves_leaves_programs_running() -> None:
    made = bench()
    dimension(made)
    made.run("SET 522", "WHILE (P0 < 50)", "P0 = P0+1", "WEND")
    made.seconds(0.2)
    assert (made.bit(KILL_MOVES), made.p(0)) == (True, 50.0)


@pytest.mark.req("ACR-KAMR-36")
def test_kill_all_moves_leaves_plcs_running() -> None:
    host = connected("DIM PLC0(1000)", "PLC0")
    host.type("10 LD 40", "20 OUT 41", "RUN", "SET 522")
    for on in (True, False):
        host.card.bit[40] = on
        host.card.advance(200)
        assert (host.card.bit[41], host.card.bit[KILL_MOVES]) == (on, True)


@pytest.mark.req("ACR-KAMR-33", "ACR-KAMR-39")
def test_stop_all_moves_ramps_with_dec_then_kills() -> None:
    made = bench("X10").seconds(0.1)
    made.all("SET 523")
    while made.bit(STOP_MOVES) and not made.bit(518):
        made.ticks(1)
    began = made.card.tick
    while made.bit(STOP_MOVES):
        assert not made.bit(KILL_MOVES)
        made.ticks(1)
    assert made.card.tick - began == pytest.approx(ticks(10 / 100), abs=1)
    made.ticks(1)
    assert (made.bit(KILL_MOVES), made.bit(IN_MOTION), speed(made)) == (True, False, 0.0)


# DRIVE ON lifts them


@pytest.mark.req("ACR-KAMR-26")
@pytest.mark.parametrize("axis", [0, 1])
def test_drive_on_lifts_kills_and_latches_of_a_drive_that_is_off(axis: int) -> None:
    latches = [flag + 32 * axis for flag in (16132, 16133)]
    of_other = 16132 + 32 * (1 - axis)
    made = bench(*(f"SET {flag}" for flag in (8467 + 32 * axis, *latches, of_other))).ticks(5)
    kills = (KAMR_X, KAMR_Y, KILL_MOVES)
    assert all(made.bit(flag) for flag in kills)
    made.all(f"DRIVE ON {'XY'[axis]}").seconds(0.02)
    assert not any(made.bit(flag) for flag in (*kills, *latches))
    assert made.bit(of_other)
    assert made.type("X1 Y1") == ""


@pytest.mark.req("ACR-KAMR-27")
def test_drive_on_of_an_enabled_drive_lifts_nothing() -> None:
    made = bench("DRIVE ON X").seconds(0.02)
    made.all("SET 8467").ticks(5)
    made.all("DRIVE ON X").ticks(5)
    assert (made.bit(KAMR_X), made.bit(KILL_MOVES)) == (True, True)
    assert made.type("X1") == KILLED
