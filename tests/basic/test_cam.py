"""Cams: tables, cycles, registers, triggers, flags and what ends them."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.basic.motion_bench import WHEEL, Bench

from openacr.map.rows import axes

PSP, CAM, CYCLES, SMOOTH = 12294, 12298, 12400, 12401
ACTIVATE, TRIGGER_MODE, TRIGGER_STARTED = 790, 2308, 2309
KAMR = 8467


def bench(*points: int, length: int = 100, lines: tuple[str, ...] = ()) -> Bench:
    """A cam of one segment on X, driven by encoder 10."""
    made = Bench("X", "Y").all("DIM LA(2)", f"DIM LA0({len(points)})")
    for place, point in enumerate(points):
        made.all(f"LA0({place})={point}")
    made.all("CAM SRC X ENC10", "CAM DIM X1", f"CAM SEG X(0,{length},LA0)")
    return made.all(*lines)


def turn(made: Bench, counts: int) -> float:
    """The source moves within one tick; the cam offset of X, unrounded."""
    made.memory.I[WHEEL] += counts
    made.ticks(1)
    return made.memory.F[axes.cam_cnt[0]]


def offsets(made: Bench, *counts: int) -> list[float]:
    return [turn(made, count) for count in counts]


# tables


def test_a_cam_runs_in_both_directions() -> None:
    made = bench(0, 100, 0, 40, 0, lines=("CAM ON X",))
    assert offsets(made, -10, -15, -50) == pytest.approx([16, 40, 100])


# settings


def test_flz_shifts_the_index_without_a_jump_at_the_start() -> None:
    made = bench(0, 100, 0, lines=("CAM FLZ X25", "CAM ON X"))
    assert offsets(made, 0, 25, 50) == [0, 50, -50]


def test_a_cam_starts_from_the_offset_that_stands() -> None:
    made = bench(0, 100, 0, lines=("CAM ON X",))
    assert turn(made, 25) == 50
    made.all("CAM OFF X")
    assert turn(made, 40) == 50
    made.all("CAM ON X")
    assert offsets(made, 0, 25) == [50, 100]


@pytest.mark.parametrize("delta", [30, -30])
def test_cam_cycles_end_it_exactly_at_the_cycle_end(delta: int) -> None:
    made = bench(0, 100, 0, lines=("CAM CYCLES X2", "CAM ON X"))
    assert made.p(CYCLES) == 2
    for _ in range(6):
        turn(made, delta)
    assert made.bit(ACTIVATE)
    assert turn(made, delta) == 0.0
    assert not made.bit(ACTIVATE)
    assert turn(made, delta) == 0.0


def test_shift_preloads() -> None:
    made = bench(0, 100, 0, lines=("PPU X10", "CAM SHIFT X2", "CAM ON X"))
    assert turn(made, 25) == 50
    made.all("CAM SHIFT X1")
    assert turn(made, 0) == 40


def test_writing_the_shown_offset_replaces_it() -> None:
    made = bench(0, 100, 0, lines=("CAM ON X",))
    turn(made, 25)
    made.all(f"P{CAM}=0")
    assert offsets(made, 0, 25) == [0, 50]


# triggers


def test_on_trg_starts_at_the_captured_position() -> None:
    made = bench(0, 100, 0, lines=("CAM ON TRG X(2)",))
    turn(made, 10)
    made.memory.set_bit(26, True)  # first capture input of encoder 10
    assert offsets(made, 10, 10) == [0, 20]
    assert (made.bit(TRIGGER_MODE), made.bit(TRIGGER_STARTED)) == (True, True)
    made.all("CAM OFF X")
    assert (made.bit(TRIGGER_MODE), made.bit(TRIGGER_STARTED)) == (False, False)


def test_pon_and_poff_engage_between_positions_of_the_cycle() -> None:
    made = bench(0, 100, 0)
    turn(made, 205)
    made.all("CAM PON X20", "CAM POFF X45")
    assert offsets(made, 10, 10, 10) == [0, 10, 30]
    assert made.bit(ACTIVATE)
    assert offsets(made, 20, 30) == [50, 50]
    assert not made.bit(ACTIVATE)


# what bars and ends a cam


def test_a_cam_needs_segments() -> None:
    made = Bench("X").all("DIM LA(1)", "DIM LA0(3)", "CAM DIM X2", "CAM SEG X(0,100,LA0)")
    assert made.type("CAM ON X") == "No cam segments"
    assert made.type("CAM DIM X") == "2"
    assert made.type("CAM DIM X3") == "Re-dimensioned block"
    assert made.type("CAM SEG X(2,100,LA0)") == "Subscript out of range"
    assert made.type("CAM SEG X(1,100,LA4)") == "Undefined variable"
    assert made.type("CAM SEG X(1,0,LA0)") == "Invalid argument"
    assert made.type("CAM CLEAR X") == ""
    assert made.type("CAM DIM X65") == "Out of memory"


def test_an_array_that_is_freed_ends_the_cam() -> None:
    made = bench(0, 100, 0, lines=("CAM ON X",))
    assert turn(made, 25) == 50
    made.all("CLEAR")
    assert turn(made, 25) == 50
    assert not made.bit(ACTIVATE)


@pytest.mark.req("ACR-KAMR-05", "ACR-KAMR-06")
def test_a_kill_stops_a_cam_with_hldec_and_bars_it() -> None:
    made = bench(0, 1000000, length=1000000, lines=("HLDEC X100000", "CAM ON X"))
    for _ in range(20):
        turn(made, 10)  # 20000 pulses per second
    made.all(f"SET {KAMR}")
    made.ticks(1)
    assert (made.bit(ACTIVATE), made.bit(792)) == (False, True)
    for _ in range(399):
        turn(made, 10)
    assert not made.bit(792)
    assert (made.p(CAM), made.p(PSP)) == (200, 2200)
    assert made.type("CAM ON X") == "Associated Slave Kill Motion Request Active"
    made.all(f"SET {ACTIVATE}")
    assert turn(made, 10) == 200
    assert not made.bit(ACTIVATE)


def test_the_feed_forward_sees_the_averaged_speed() -> None:
    made = bench(0, 1000, length=1000, lines=(f"P{SMOOTH}=4", "CAM ON X"))
    row = axes.ssp_velocity_cps[0]
    seen = []
    for count in (8, 0, 8, 0, 0, 0, 0):
        turn(made, count)
        seen.append(made.memory.F[row] / 2000)
    assert seen == pytest.approx([8, 4, 16 / 3, 4, 2, 2, 0])
    made.all("CAM OFF X").ticks(2)
    assert made.memory.F[row] == 0.0


# for any history


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.integers(-50, 50), min_size=2, max_size=5),
    st.lists(
        st.one_of(
            st.integers(-30, 30),
            st.sampled_from(["CAM ON X", "CAM OFF X", "CAM RES X", "CAM RES X7", "CAM SRC X CLK"]),
        ),
        max_size=30,
    ),
)
def test_nothing_jumps(points: list[int], history: list[int | str]) -> None:
    made = bench(*points, length=60)
    steepest = 100 * (len(points) - 1) / 60
    for step in history:
        before = made.psp(0)
        if isinstance(step, str):
            made.all(step)
            made.ticks(1)
        else:
            turn(made, step)
        moved = abs(step) if isinstance(step, int) else 0.0
        assert abs(made.psp(0) - before) <= steepest * max(moved, 0.5) + 1e-9
        parts = made.memory.F[axes.reals[0] : axes.reals[0] + 4]
        assert made.psp(0) == pytest.approx(sum(parts))
