"""Ballscrew tables and backlash: what the secondary setpoint adds to the primary one."""

import pytest
from tests.basic.motion_bench import Bench

from openacr.map.rows import axes

ACTUAL, PSP, SSP, BALLSCREW, BACKLASH = 12290, 12294, 12295, 12299, 12300
ACTIVATE = 791
KAMR = 8467


def at_place(made: Bench, position: float) -> float:
    """Ballscrew offset of X, unrounded, with the primary setpoint at a position."""
    made.memory.F[axes.jog_cnt[0]] = position
    made.ticks(1)
    return made.memory.F[axes.ballscrew_cnt[0]]


def bench(*lines: str) -> Bench:
    """Errors 0, 20, -10 at 0, 100 and 200 pulses."""
    made = Bench("X").all("DIM LA(1)", "DIM LA0(3)", "LA0(1)=20 : LA0(2)=-10")
    return made.all("BSC DIM X1", "BSC SEG X(0,200,LA0)", *lines)


# ballscrews


@pytest.mark.req("ACR-CMD-BSC", "MILL-BSC-INTERP", "MILL-BSC-APPLY")
def test_the_table_is_interpolated_at_the_primary_setpoint() -> None:
    made = bench("BSC ON X")
    places = (-50, 0, 25, 100, 150, 200, 999)
    assert [at_place(made, place) for place in places] == [0, 0, 5, 20, 5, -10, -10]
    at_place(made, 100)
    assert (made.p(PSP), made.p(SSP), made.p(BALLSCREW)) == (100, 120, 20)


def test_scale_offset_flz_and_shift() -> None:
    made = bench("PPU X10", "BSC SCALE X2", "BSC OFFSET X3", "BSC SHIFT X-1", "BSC FLZ X50")
    made.all("BSC ON X")
    assert at_place(made, 50) == 2 * 20 + 30 - 10
    assert made.type("BSC SHIFT X") == "-1"


def test_another_source_may_be_the_index() -> None:
    made = bench("BSC SRC X P38912", "P38912=25", "BSC ON X")
    assert at_place(made, 100) == 5
    assert made.type("BSC SRC X") == "P38912"


def test_on_and_off_act_at_once() -> None:
    made = bench()
    assert (at_place(made, 100), made.type("BSC X")) == (0, "OFF")
    made.all("BSC ON X").ticks(1)
    assert (made.p(SSP), made.bit(ACTIVATE), made.type("BSC X")) == (120, True, "ON")
    made.all("BSC OFF X").ticks(1)
    assert (made.p(SSP), made.p(BALLSCREW)) == (100, 0)
    made.all(f"SET {ACTIVATE}").ticks(1)
    assert made.p(BALLSCREW) == 20
    made.all(f"CLR {ACTIVATE}").ticks(1)
    assert made.p(BALLSCREW) == 0


def test_bsc_res_gives_the_difference_to_shift() -> None:
    made = bench("BSC ON X")
    at_place(made, 100)
    made.all("BSC RES X50").ticks(1)
    assert (made.p(BALLSCREW), made.type("BSC SHIFT X")) == (50, "30")
    assert at_place(made, 0) == 30


@pytest.mark.req("ACR-KAMR-06")
def test_a_kill_switches_the_table_off_without_a_step() -> None:
    made = bench("BSC ON X")
    at_place(made, 100)
    made.all(f"SET {KAMR}").ticks(2)
    assert (made.bit(ACTIVATE), made.p(SSP)) == (False, 120)


def test_without_segments_or_array_there_is_no_table() -> None:
    made = Bench("X")
    assert made.type("BSC ON X") == "No cam segments"
    made = bench("BSC ON X")
    assert at_place(made, 100) == 20
    made.all("CLEAR").ticks(1)
    assert (made.bit(ACTIVATE), made.p(BALLSCREW)) == (False, 0)
    made.all("BSC CLEAR X")
    assert made.type("BSC DIM X") == "0"


# backlash


def test_the_step_is_spread_over_10_ms() -> None:
    made = Bench("X").all("BKL X100")
    offsets = []
    at_place(made, 1)
    for _ in range(20):
        offsets.append(made.memory.F[axes.backlash_cnt[0]])
        made.ticks(1)
    assert offsets == pytest.approx([5 * (n + 1) for n in range(20)])
    made.all("BKL X0").seconds(0.005)
    assert made.p(BACKLASH) == 50
    made.seconds(0.005)
    assert made.p(BACKLASH) == 0


def test_by_direction_the_slack_is_taken_up_at_every_reversal_and_kept_at_rest() -> None:
    made = Bench("X").all("PPU X1000", "BKL X0.01", "BKL DIR X1")
    assert (made.type("BKL DIR X"), made.type("BKL DIR X2")) == ("1", "Invalid argument")
    found = []
    for place in (-500, -400, -400, -401, 300, 299, 299.0000005, 301):
        at_place(made, place)
        made.seconds(0.02)
        found.append(made.p(BACKLASH))
    assert found == [0, 10, 10, 0, 10, 0, 0, 10]
    made.all("BKL X0.02").seconds(0.02)
    assert made.p(BACKLASH) == 20
    made.all("BKL X0").seconds(0.02)
    assert made.p(BACKLASH) == 0


def test_by_direction_a_reset_position_is_no_travel() -> None:
    made = Bench("X").all("BKL X10", "BKL DIR X1")
    at_place(made, 100)
    made.seconds(0.02)
    made.all("RES X500").seconds(0.02)
    assert (made.p(PSP), made.p(BACKLASH), made.p(SSP)) == (500, 0, 500)
    at_place(made, 1)
    made.seconds(0.02)
    assert (made.p(PSP), made.p(BACKLASH)) == (501, 10)
    made.all("BKL DIR X0", "RES X-7").seconds(0.02)
    assert (made.p(PSP), made.p(BACKLASH)) == (-7, 0)


@pytest.mark.req("MILL-BSC-BACKLASH")
def test_ballscrew_and_backlash_add_up() -> None:
    made = bench("BSC ON X", "BKL X7")
    at_place(made, 100)
    made.seconds(0.02)
    assert made.p(SSP) - made.p(PSP) - made.p(BACKLASH) == 20
    made.all("RES X").ticks(1)
    assert (made.p(PSP), made.p(SSP), made.p(ACTUAL)) == (0, 0, 0)
