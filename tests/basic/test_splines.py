"""SPLINE and NURB: where the axes are, how fast, and what the flags say."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.interpolate import BSpline, CubicHermiteSpline
from tests.basic.motion_bench import PERIOD_S, Bench

from openacr.map.rows import masters

pytestmark = pytest.mark.evidence("oracle", "B-splines and Hermite curves of scipy")

IN_MOTION = 516
CNT = 1000  # pulses per unit
SPLINE_FLAGS, NURB_FLAGS = 5120, 5136
LENGTH = masters.spline_buffer_length[0]
SPLINE_FACTOR = masters.spline_time_factor[0]
NURB_FACTOR = masters.nurb_time_factor[0]
NURB_START = masters.nurb_start_time[0]
POINTS = ("X1 Y0", "X2 Y1", "X2 Y2", "X1 Y3", "X0 Y3")
HALF = math.sqrt(0.5)
QUARTER = ("X1 Y0 NK 0", f"X1 Y1 NK 0 NW {HALF:.15f}", "X0 Y1 NK 0", "NK 1")


def bench(*lines: str) -> Bench:
    """A card at rest at 0 with slow moves."""
    made = Bench("X", "Y", "Z").all(f"PPU X{CNT} Y{CNT} Z{CNT}", "ACC 50 DEC 50 STP 50 VEL 2")
    return made.all(*lines)


def sampled(made: Bench, *lines: str) -> np.ndarray:
    """Positions in units, tick by tick, while lines are taken and until the end."""
    found = [_place(made)]
    for line in lines:
        made.type(line)
        while made.is_waiting:
            found.append(_place(made.ticks(1)))
    while made.bit(IN_MOTION):
        found.append(_place(made.ticks(1)))
    return np.array(found)


def _place(made: Bench) -> list[float]:
    return [made.psp(axis) / CNT for axis in range(3)]


def times(path: np.ndarray) -> np.ndarray:
    return np.arange(len(path)) * PERIOD_S


def velocities(path: np.ndarray) -> np.ndarray:
    return np.diff(path, axis=0) / PERIOD_S


def largest_jump(path: np.ndarray) -> float:
    """The largest change of an axis velocity from tick to tick, starts and ends included."""
    rest = np.zeros((1, path.shape[1]))
    return float(np.abs(np.diff(np.vstack([rest, velocities(path), rest]), axis=0)).max())


# splines


@pytest.mark.req("ACR-CMD-SPLINE")
@pytest.mark.parametrize("mode", [0, 1])
@pytest.mark.parametrize("length", [3, 4, 5])
def test_a_spline_meets_its_points_without_velocity_jumps(length: int, mode: int) -> None:
    made = bench(f"P{LENGTH}={length}", "ACC 20 DEC 20 STP 20", f"SPLINE MODE {mode}")
    path = sampled(made, *POINTS, "SPLINE END")
    for x, y in ((1, 0), (2, 1), (2, 2), (1, 3)):
        assert np.min(np.hypot(path[:, 0] - x, path[:, 1] - y)) < 3e-3
    assert _place(made) == [0, 3, 0]
    # Where the velocity were to jump at a point it would do so by some units/s.
    assert largest_jump(path) < 0.05


def test_a_spline_is_the_hermite_curve_of_five_point_velocities() -> None:
    made = bench("SPLINE MODE 0")
    path = sampled(made, "X1", "X3", "X2", "X5", "X4", "X4.5", "SPLINE END")
    p = np.array([0, 1, 3, 2, 5, 4, 4.5])
    slopes = np.zeros(7)
    slopes[1], slopes[5] = (p[2] - p[0]) / 2, (p[6] - p[4]) / 2
    for i in (2, 3, 4):
        slopes[i] = (p[i - 2] - 8 * p[i - 1] + 8 * p[i + 1] - p[i + 2]) / 12
    curve = CubicHermiteSpline(np.arange(7), p, slopes)
    assert len(path) == 6 / PERIOD_S + 1
    assert path[:, 0] == pytest.approx(curve(times(path)), abs=1e-9)


def test_unequal_knots_take_the_velocity_between_the_neighbours() -> None:
    made = bench("SPLINE MODE 0")
    path = sampled(made, "X1 SK 0.5", "X3 SK 1.5", "X2 SK 0.25", "X5", "SPLINE END")
    t = np.array([0, 0.5, 2, 2.25, 3.25])
    p = np.array([0, 1, 3, 2, 5])
    slopes = [0, *((p[2:] - p[:-2]) / (t[2:] - t[:-2])), 0]
    assert path[:, 0] == pytest.approx(CubicHermiteSpline(t, p, slopes)(times(path)), abs=1e-9)


def test_two_points_at_a_time_are_straight_lines() -> None:
    made = bench(f"P{LENGTH}=2", "SPLINE MODE 0")
    path = sampled(made, "X1", "X3", "X2", "SPLINE END")
    assert path[:, 0] == pytest.approx(np.interp(times(path), range(4), [0, 1, 3, 2]), abs=1e-9)


def test_the_time_factor_scales_the_times() -> None:
    made = bench(f"P{SPLINE_FACTOR}=0.125", "SPLINE MODE 0")
    assert len(sampled(made, *POINTS, "SPLINE END")) == 0.625 / PERIOD_S + 1


def test_the_motion_lags_the_input_by_the_buffer_less_two() -> None:
    for length in (2, 3, 4, 5):
        made = bench(f"P{LENGTH}={length}", "SPLINE MODE 0")
        given = 0
        while not made.bit(IN_MOTION):
            given += 1
            made.type(f"X{given}")
        assert given == length - 1


def test_a_negative_knot_ends_the_spline_with_its_point() -> None:
    made = bench("SPLINE MODE 0", "X1 SK .2", "X2 SK .2", "X/1 SK -.2")
    assert made.bit(SPLINE_FLAGS + 10)
    assert made.type("SPLINE") == "OFF"
    made.type("X4")
    assert made.until_clear(IN_MOTION) > 0.6 / PERIOD_S
    assert made.psp(0) == 4 * CNT
    assert not made.bit(SPLINE_FLAGS + 10)


def test_a_spline_in_velocity_mode_follows_the_profile() -> None:
    path = sampled(bench("SPLINE MODE 1"), *POINTS, "SPLINE END")
    speed = np.hypot(*velocities(path)[:, :2].T)
    assert speed.max() == pytest.approx(2, rel=1e-6)
    cruising = speed[int(2 / 50 / PERIOD_S) + 1 : -int(2 / 50 / PERIOD_S) - 2]
    assert cruising == pytest.approx(2, rel=1e-4)
    assert np.abs(np.diff(speed)).max() / PERIOD_S < 50 * 1.001


def test_weights_of_the_vector_measure_the_arc() -> None:
    path = sampled(bench("VECDEF X1 Y0", "SPLINE MODE 1"), *POINTS, "SPLINE END")
    assert np.abs(velocities(path)[:, 0]).max() == pytest.approx(2, rel=1e-3)


def test_another_axis_may_join_later() -> None:
    made = bench("SPLINE MODE 0")
    path = sampled(made, "X1", "X2", "X3 Z1", "X4", "X5", "SPLINE END")
    assert path[-1] == pytest.approx([5, 0, 1])
    assert largest_jump(path[:, 2:]) < 0.05


def test_the_flags_of_a_spline() -> None:
    def flags(made: Bench) -> set[int]:
        return {n for n in range(15) if made.bit(SPLINE_FLAGS + n)}

    made = bench()
    assert flags(made.all("SPLINE MODE 1")) == {2, 4}
    assert flags(made.all("SPLINE MODE 0")) == {2, 5}
    assert made.type("SPLINE") == "0"
    assert flags(made.all("X1 SK .1")) == {2, 5, 7, 13}
    made.all("X2 SK .1", "X3 SK .1", "X4 SK .1").ticks(2)
    assert flags(made) == {2, 5, 7, 9, 11, 12, 13, 14}
    made.ticks(300)  # waits for its next points
    assert made.bit(IN_MOTION)
    assert not made.bit(SPLINE_FLAGS + 9)
    made.all("SPLINE END").ticks(1)
    assert {6, 9, 1, 12} <= flags(made)
    assert not {2, 5} & flags(made)
    made.until_clear(IN_MOTION)
    assert flags(made) == {11}


def test_a_first_point_where_the_axes_are_is_the_start() -> None:
    one = sampled(bench("SPLINE MODE 0"), "X0 Y0", *POINTS, "SPLINE END")
    assert np.array_equal(one, sampled(bench("SPLINE MODE 0"), *POINTS, "SPLINE END"))


def test_a_killed_spline_is_forgotten() -> None:
    made = bench("SPLINE MODE 0", *POINTS).ticks(100)
    made.all("SET 522").ticks(1).all("CLR 522")
    assert not made.bit(IN_MOTION)
    here = _place(made)
    path = sampled(made, "X/1", "X/1", "SPLINE END")
    assert path[-1] == pytest.approx([here[0] + 2, *here[1:]])


def test_halt_ends_an_unfinished_spline() -> None:
    made = bench()
    made.run("SPLINE MODE 0", "X1", "X2", "X3", "X4", "INH 32")
    made.seconds(3)
    made.type("HALT")
    assert made.until_clear(IN_MOTION, limit_s=1) < 2000


def test_a_feedhold_on_a_spline_stops_without_jump_and_goes_on() -> None:
    made = bench("ACC 20 DEC 20 STP 20", "SPLINE MODE 0", *POINTS, "SPLINE END")
    path = [_place(made)]
    for line, ticks in (("", 2300), ("SET 520", 1500), ("SET 521", 3000)):
        made.type(line)
        path += [_place(made.ticks(1)) for _ in range(ticks)]
        if line == "SET 520":
            assert made.bit(519)
    while made.bit(IN_MOTION):
        path.append(_place(made.ticks(1)))
    assert _place(made) == [0, 3, 0]
    assert largest_jump(np.array(path)) < 0.05


def test_overrides_scale_the_times() -> None:
    made = bench("ACC 0 DEC 0", "FOV 0.5", "SPLINE MODE 0")
    assert len(sampled(made, *POINTS, "SPLINE END")) == 10 / PERIOD_S + 1


def test_points_pass_the_transformations() -> None:
    made = bench("OFFSET X10", "SCALE Y2", "SPLINE MODE 0")
    assert sampled(made, "X1 Y1", "X/1 Y/1", "SPLINE END")[-1] == pytest.approx([12, 4, 0])


def test_a_snapshot_holds_an_unfinished_spline() -> None:
    made = bench("SPLINE MODE 0", *POINTS).ticks(100)
    kept = made.memory.snapshot()
    first = sampled(made, "SPLINE END")
    made.memory.restore(kept)
    assert np.array_equal(sampled(made, "SPLINE END"), first)


def test_long_splines_are_fed_by_the_buffer() -> None:
    made = bench(f"P{SPLINE_FACTOR}=0.01", "SPLINE MODE 0")
    path = sampled(made, *(f"X{n}" for n in range(1, 61)), "SPLINE END")
    assert len(path) == pytest.approx(0.6 / PERIOD_S, abs=2)
    assert np.abs(np.diff(velocities(path[200:-200])[:, 0])).max() < 1e-3


# NURBs


def written(knots: Sequence[float], weights: Sequence[float], form: str) -> list[str]:
    points = ("X1 Y0", "X1 Y1", "X0 Y1")
    return [
        form.format(k=k, w=f"{w:.15f}", xy=xy)
        for k, w, xy in zip(knots, weights, points, strict=True)
    ]


@pytest.mark.parametrize(
    "form", ["K {k} {xy} W {w}", "K {k} W {w} {xy}", "{xy} K {k} W{w}", "k{k} {xy} w {w}"]
)
def test_k_and_w_are_knot_and_weight_of_a_nurb(form: str) -> None:
    def at_start() -> Bench:
        made = bench("X1")
        made.until_clear(IN_MOTION)
        return made.all("NURB RANK 3", "NURB MODE 1")

    plain = sampled(at_start(), *QUARTER, "NURB END")
    lines = written((0, 0, 0), (1, HALF, 1), form)
    made = at_start()
    assert np.array_equal(sampled(made, *lines, "K 1", "K 1", "K 1", "K -1"), plain)
    assert made.type("NURB") == "OFF"
    made.all("X3")
    made.until_clear(IN_MOTION)
    assert _place(made) == [3, 1, 0]


def test_a_negative_knot_alone_ends_a_curve_whatever_its_size() -> None:
    made = bench("NURB MODE 0", "NURB RANK 2", "K 0 X0", "K 0 X1", "K 5 X2", "K -1")
    assert made.type("NURB") == "OFF"
    assert made.bit(NURB_FLAGS + 15)
    made.until_clear(IN_MOTION)
    assert _place(made)[0] == 2
    assert not made.bit(NURB_FLAGS + 15)
    made.all("SPLINE MODE 0", "K .2 X3", "K .2 X4", "K -1")
    assert made.bit(SPLINE_FLAGS + 10)
    assert made.type("SPLINE") == "OFF"
    assert made.until_clear(IN_MOTION) == 0.4 / PERIOD_S
    assert _place(made)[0] == 4


def test_k_is_the_time_to_a_point_of_a_spline() -> None:
    one = sampled(bench("SPLINE MODE 0"), "K .2 X1", "Y1 K .3", "K -.2 X2 Y2")
    two = sampled(bench("SPLINE MODE 0"), "X1 SK .2", "Y1 SK .3", "X2 Y2 SK -.2")
    assert np.array_equal(one, two)
    assert bench("SPLINE MODE 0").type("K .2 W 2 X1") == "Invalid argument"


def test_axes_named_k_and_w_stay_axes() -> None:
    made = Bench("K", "W").all("ACC 0 DEC 0 STP 0 VEL 1000", "K1 W2")
    made.until_clear(IN_MOTION)
    assert (made.psp(0), made.psp(1)) == (1, 2)
    made.all("NURB MODE 0", "NURB RANK 2", "K1 W2 NK 0", "K3 W4 NK 0 NW 2", "NK -1")
    made.until_clear(IN_MOTION)
    assert (made.psp(0), made.psp(1)) == (3, 4)


def test_knots_and_weights_need_a_curve_and_each_other() -> None:
    made = bench()
    assert made.type("K 0 X1") == "Not valid at this level"
    assert made.type("W 1 X1") == "Unknown command"
    assert made.type("X1 W 1") == "Unknown command"
    assert made.type("K X1") == "Syntax error"
    assert made.type("K 1 : W 1") == "Unknown command"
    assert made.psp(0) == 0


def test_the_profile_moves_along_the_arc() -> None:
    made = bench("X1")
    made.until_clear(IN_MOTION)
    path = sampled(made.all("NURB MODE 1", "NURB RANK 3"), *QUARTER, "NURB END")
    assert len(path) - 1 == math.ceil((math.pi / 2 / 2 + 2 / 50) / PERIOD_S)
    assert np.hypot(*velocities(path)[:, :2].T).max() == pytest.approx(2, rel=1e-6)


def test_mode_4_is_slower_where_acc_demands_it() -> None:
    made = bench("VEL 100", "ACC 9 DEC 1000 STP 1000", "X1")
    made.until_clear(IN_MOTION)
    path = sampled(made.all("NURB MODE 4", "NURB RANK 3"), *QUARTER, "NURB END")
    assert np.hypot(*velocities(path)[:, :2].T).max() == pytest.approx(3, rel=1e-3)


def bspline(
    rank: int, points: Sequence[float], weights: Sequence[float], knots: Sequence[float]
) -> BSpline:
    """The homogeneous B-spline, by scipy."""
    rows = [[p * w, w] for p, w in zip(points, weights, strict=True)]
    return BSpline(knots, np.array(rows), rank - 1, extrapolate=False)


@settings(max_examples=15, deadline=None)
@given(st.data(), st.integers(2, 6))
def test_any_nurb_is_the_one_of_de_boor(data: st.DataObject, rank: int) -> None:
    count = data.draw(st.integers(rank, rank + 4))
    points = data.draw(st.lists(st.floats(-9, 9), min_size=count, max_size=count))
    weights = data.draw(st.lists(st.floats(0.2, 5), min_size=count, max_size=count))
    steps = data.draw(
        st.lists(st.sampled_from([0.05, 0.1, 0.2]), min_size=count - rank, max_size=count - rank)
    )
    inner = list(np.cumsum(steps))
    knots = [0.0] * rank + inner + [(inner[-1] if inner else 0) + 0.1] * rank
    lines = [
        f"X{p:.9f} NK {k:.9f} NW {w:.9f}" for p, k, w in zip(points, knots, weights, strict=False)
    ]
    made = bench("VEL 1000", f"X{points[0]:.9f}")
    made.until_clear(IN_MOTION)
    made.all("NURB MODE 0", f"NURB RANK {rank}")
    path = sampled(made, *lines, f"NK {knots[-1]:.9f}", "NURB END")
    values = bspline(rank, points, weights, knots)(np.minimum(times(path), knots[-1] - 1e-12))
    assert path[:, 0] == pytest.approx(values[:, 0] / values[:, 1], abs=2e-6)


def test_missing_knots_count_on_and_the_next_one_is_the_end() -> None:
    made = bench(f"X{7 / 6:.9f}")
    made.until_clear(IN_MOTION)
    made.all("NURB MODE 0", f"P{NURB_FACTOR}=0.125")
    path = sampled(made, "X0", "X1", "X3", "X2", "X5", "X4", "NURB END")
    knots = [0, 1, 2, 3, 4, 5, 6, 6, 6, 6]
    curve = bspline(4, [0, 1, 3, 2, 5, 4], [1.0] * 6, knots)
    u = 3 + times(path) / 0.125
    assert path[:, 0] == pytest.approx(curve(np.minimum(u, 6 - 1e-9))[:, 0], abs=2e-6)
    assert _place(made)[0] == 4


def test_a_curve_that_begins_elsewhere_is_led_up_to() -> None:
    made = bench("NURB MODE 1", "NURB RANK 3")
    path = sampled(made, *QUARTER, "NURB END")
    off = np.hypot(path[:, 0], path[:, 1]) < 1 - 1e-6
    assert np.all(path[off, 1] == 0)
    assert largest_jump(path) < 0.06


def test_a_gap_of_repeated_knots_is_bridged() -> None:
    made = bench("NURB MODE 0", "NURB RANK 2")
    points = ("X0 NK 0", "X1 NK 0", "X2 NK .5", "X3 NK .5", "NK 1", "NURB END")
    path = sampled(made, *points)
    assert np.diff(path[:, 0]).min() >= 0
    assert largest_jump(path) < 2.1
    assert _place(made)[0] == 3


def test_the_start_time_is_a_ramp_to_the_full_rate() -> None:
    made = bench("NURB MODE 0", "NURB RANK 2", f"P{NURB_START}=0.5", f"P{NURB_FACTOR}=2")
    path = sampled(made, "X0", "X1", "X2", "NURB END")
    t = times(path)
    rate = np.where(t < 0.5, t * t / 0.5 / 4, (t - 0.25) / 2)
    assert path[:, 0] == pytest.approx(np.minimum(rate, 2), abs=1e-9)


def test_the_flags_of_a_nurb() -> None:
    def flags(made: Bench) -> set[int]:
        return {n for n in range(16) if made.bit(NURB_FLAGS + n)}

    made = bench("NURB RANK 2")
    assert flags(made.all("NURB MODE 1")) == {5, 14}
    assert flags(made.all("NURB MODE 4")) == {5, 13}
    assert flags(made.all("NURB MODE 0")) == {5, 12}
    made.all("X0", "X1", "X2").ticks(2)
    assert flags(made) == {0, 4, 5, 7, 8, 11, 12}
    made.all("X3 NK -3").ticks(2)
    assert {6, 11, 15} <= flags(made)
    made.until_clear(IN_MOTION)
    assert flags(made) == {4}
    made.all("STP 5", "NURB MODE 1", "X3", "X5", "NURB END").ticks(4)
    assert {9, 10} <= flags(made)
    while not made.bit(NURB_FLAGS + 3):
        made.ticks(1)
    made.until_clear(IN_MOTION)


def test_arc_length_of_an_uneven_curve() -> None:
    made = bench("ACC 0 DEC 0 STP 0", "NURB MODE 1")
    path = sampled(made, "X0 Y0 NK 0", "X0 Y5 NK 0", "X1 Y5 NK 0", "X9 Y0 NK 0", "NK 1", "NURB END")
    x, y = np.polynomial.Polynomial([0, 0, 3, 6]), np.polynomial.Polynomial([0, 15, -15, 0])
    true, _ = quad(lambda u: math.hypot(x.deriv()(u), y.deriv()(u)), 0, 1)
    assert len(path) - 1 == math.ceil(true / 2 / PERIOD_S)
    assert np.hypot(*velocities(path)[:-1, :2].T) == pytest.approx(2, rel=1e-4)


def test_maxvel_bounds_every_axis_on_a_curve() -> None:
    for family, mode in (("NURB", 0), ("NURB", 1), ("SPLINE", 0), ("SPLINE", 1)):
        made = bench("VEL 50", "ACC 1000 DEC 1000 STP 1000", "MAXVEL X1.5", f"{family} MODE {mode}")
        path = sampled(made, "X0 Y0", "X4 Y1", "X6 Y2", "X4 Y3", "X2 Y9", f"{family} END")
        assert np.abs(velocities(path)[:, 0]).max() < 1.5 * 1.01


# what is refused


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (("X1 SK 1",), "Not valid at this level"),
        (("NK 1",), "Not valid at this level"),
        (("NURB MODE 2",), "Invalid argument"),
        (("SPLINE MODE 4",), "Invalid argument"),
        (("NURB RANK 7",), "Invalid argument"),
        (("SPLINE MODE 0", "X1 NK 1"), "Invalid argument"),
        (("SPLINE MODE 0", "X1 NW 1"), "Invalid argument"),
        (("SPLINE MODE 0", "SK 1"), "Invalid argument"),
        (("SPLINE MODE 0", "X1 SK 0"), "Invalid argument"),
        (("SPLINE MODE 0", "INT 32 X1"), "Invalid argument"),
        (("SPLINE MODE 0", "CIRCW X(1,1) Y(1,0)"), "Invalid argument"),
        (("NURB MODE 0", "X1 NK 1", "X1 NK 0"), "Invalid argument"),
        (("NURB MODE 0", "X1 NW 0"), "Invalid argument"),
        (("NURB MODE 0", "X1 NK 1", "NK 2", "X2"), "Invalid argument"),
        (("NURB MODE 0", "X1", "NURB END"), "Invalid argument"),
        (("NURB MODE 0", "X1", "NURB RANK 3"), "Invalid argument"),
        (("SET 522", "SPLINE MODE 0", "X1"), "Master Kill All Moves Request Active"),
        (("SPLINE MODE 0", "X1", "X2", "X3", "X4", "SPLINE MODE 1"), "Invalid argument"),
    ],
)
def test_what_makes_no_curve_is_refused(lines: tuple[str, ...], message: str) -> None:
    made = bench()
    *before, last = lines
    assert made.all(*before).type(last) == message


def test_queries() -> None:
    made = bench()
    assert [made.type(line) for line in ("NURB", "NURB RANK", "SPLINE")] == ["OFF", "4", "OFF"]
    made.all("NURB MODE 4", "NURB RANK 3")
    assert [made.type(line) for line in ("NURB", "NURB RANK", "SPLINE")] == ["4", "3", "OFF"]


@pytest.mark.parametrize(("mode", "tick"), [(0, 1), (1, 1), (1, 2000)])
def test_an_inhibit_within_a_curve_lets_it_run_to_its_end(mode: int, tick: int) -> None:
    """A curve is one move, though each of its pieces waits as one."""
    made = bench("MBUF ON", "LOOK ON", f"SPLINE MODE {mode}")
    path = []
    for line in (*POINTS, "SPLINE END", "X-1 Y3"):
        made.type(line)
        while made.is_waiting:
            path.append(_place(made.ticks(1)))
    path += [_place(made.ticks(1)) for _ in range(tick)]
    assert path[-1][1] < 2.9
    made.all("SET 540")
    path += [_place(made.ticks(1)) for _ in range(11_000)]
    assert path[-1] == [0.0, 3.0, 0.0]
    assert largest_jump(np.array(path)) < 0.1
    assert not mode or np.abs(np.diff(path, n=2, axis=0)).max() / PERIOD_S**2 <= 50.0 * 1.01
    made.all("CLR 540")
    assert sampled(made)[-1] == pytest.approx([-1.0, 3.0, 0.0])
