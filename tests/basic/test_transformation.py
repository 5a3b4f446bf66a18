"""FLZ, OFFSET, ROTATE and SCALE: where a programmed path runs."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.basic.motion_bench import Bench

SCALE_CNT = 1000


def bench(*lines: str) -> Bench:
    made = Bench("X", "Y", "Z")
    made.all("PPU X1000 Y1000 Z1000", "VEL 1000", "ACC 0", "DEC 0", "STP 0")
    return made.all(*lines)


def ends(made: Bench, *lines: str) -> tuple[float, ...]:
    """Where X, Y and Z are after lines, in units."""
    for line in lines:
        assert made.type(line) == "", line
        made.until_clear(516)
    return tuple(round(made.psp(axis) / SCALE_CNT, 6) for axis in range(3))


def test_flz_counts_from_the_end_of_the_moves_that_wait() -> None:
    made = bench("VEL 10", "MBUF ON", "X7", "X9", "FLZ X0")
    assert made.type("FLZ X") == "9"


def test_flz_and_offset_add_up() -> None:
    made = bench("OFFSET X4")
    assert ends(made, "X1") == (5, 0, 0)
    made.all("FLZ X0")
    assert made.type("FLZ X") == "1"
    assert ends(made, "X2") == (7, 0, 0)


def test_a_single_axis_of_a_turned_path_keeps_the_programmed_other_one() -> None:
    made = bench("ROTATE 30")
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    assert ends(made, "X10") == (round(10 * c, 6), round(10 * s, 6), 0)
    expected = (round(10 * c - 5 * s, 6), round(10 * s + 5 * c, 6), 0)
    assert ends(made, "Y5") == expected


def test_the_plane_of_rotation_is_named_by_its_axes() -> None:
    made = bench("ROTATE 90 Y0 Z0")
    assert ends(made, "X1 Y10") == (1, 0, 10)


def test_mirroring_one_axis_turns_an_arc_round() -> None:
    made = bench("X10")
    made.until_clear(516)
    made.all("SCALE Y-1", "VEL 100", "CIRCCW X(0,0) Y(10,0)")  # a quarter, now below
    made.ticks(60)
    assert made.psp(1) < 0
    made.until_clear(516)
    assert ends(made) == (0, -10, 0)


def test_unequal_factors_make_no_arc() -> None:
    made = bench("X10")
    made.until_clear(516)
    assert made.all("SCALE X2").type("CIRCCW X(0,0) Y(10,0)") == "Invalid arc"


def test_an_arc_turns_with_its_plane_only() -> None:
    made = bench("ROTATE 90")
    assert ends(made, "X10 Y0", "CIRCCW X(0,0) Y(10,0)") == (-10, 0, 0)
    assert made.type("CIRCCW Y(0,0) Z(10,0)") == "Invalid arc"


@settings(max_examples=40, deadline=None)
@given(
    angle=st.floats(-720, 720),
    center=st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
    factors=st.tuples(*[st.floats(0.1, 3).map(lambda f: f) for _ in range(2)]),
    shift=st.tuples(st.floats(-9, 9), st.floats(-9, 9)),
    points=st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=1, max_size=4),
)
def test_scale_rotate_shift_act_in_this_order(
    angle: float,
    center: tuple[float, float],
    factors: tuple[float, ...],
    shift: tuple[float, float],
    points: list[tuple[float, float]],
) -> None:
    made = bench(
        f"SCALE X{factors[0]:.6f} Y{factors[1]:.6f}",
        f"ROTATE {angle:.6f} X{center[0]:.6f} Y{center[1]:.6f}",
        f"OFFSET X{shift[0]:.6f} Y{shift[1]:.6f}",
        "VEL 100000",
    )
    turn = complex(math.cos(math.radians(round(angle, 6))), math.sin(math.radians(round(angle, 6))))
    about = complex(round(center[0], 6), round(center[1], 6))
    for x, y in points:
        made.all(f"X{x:.6f} Y{y:.6f}").until_clear(516)
        scaled = complex(round(x, 6) * round(factors[0], 6), round(y, 6) * round(factors[1], 6))
        end = about + turn * (scaled - about) + complex(round(shift[0], 6), round(shift[1], 6))
        assert made.psp(0) / SCALE_CNT == pytest.approx(end.real, abs=1e-6)
        assert made.psp(1) / SCALE_CNT == pytest.approx(end.imag, abs=1e-6)
