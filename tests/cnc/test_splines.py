"""Splines of the rs274ngc dialect: G5, G5.1, G5.2 and G5.3 against their closed forms."""

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cnc.programs import Run, made, run
from tests.search import search

from openacr.cnc.canonical import Arc, Line
from openacr.cnc.geometry.splines import (
    MOST_ARCS,
    TOLERANCE_INCH,
    Piece,
    Spline,
    TooManyArcsError,
    biarcs,
    distance,
)

Pair = tuple[float, float]


def ngc(text: str, cells: dict[int, float] | None = None) -> Run:
    return run(text.replace("|", "\n"), cells, dialect="rs274ngc")


def fault(text: str, **more: object) -> str:
    done = made(text.replace("|", "\n"), dialect="rs274ngc", **more)  # type: ignore[arg-type]
    found = done.interpreter.program.errors
    if found:
        return str(found[0])
    error = ngc(text).error
    assert error is not None
    return str(error)


def bernstein(points: list[Pair], u: float) -> Pair:
    """A Bezier curve by its polynomial."""
    n = len(points) - 1
    shares = [math.comb(n, k) * u**k * (1 - u) ** (n - k) for k in range(n + 1)]
    return (
        sum(share * x for share, (x, _) in zip(shares, points, strict=True)),
        sum(share * y for share, (_, y) in zip(shares, points, strict=True)),
    )


def basis(k: int, order: int, u: float, knots: list[float]) -> float:
    """A B-spline basis function by the recursion of Cox and de Boor."""
    if order == 1:
        is_last = u == knots[-1] and knots[k] < u == knots[k + 1]
        return float(knots[k] <= u < knots[k + 1] or is_last)
    left = knots[k + order - 1] - knots[k]
    right = knots[k + order] - knots[k + 1]
    value = (u - knots[k]) / left * basis(k, order - 1, u, knots) if left else 0.0
    if right:
        value += (knots[k + order] - u) / right * basis(k + 1, order - 1, u, knots)
    return value


def nurbs(points: list[Pair], weights: list[float], order: int, u: float) -> Pair:
    """A clamped uniform rational B-spline by its definition; u from 0 to 1."""
    spans = len(points) - order + 1
    knots = [0.0] * order + [float(k) for k in range(1, spans)] + [float(spans)] * order
    shares = [w * basis(k, order, u * spans, knots) for k, w in enumerate(weights)]
    return (
        sum(s * x for s, (x, _) in zip(shares, points, strict=True)) / sum(shares),
        sum(s * y for s, (_, y) in zip(shares, points, strict=True)) / sum(shares),
    )


def farthest(done: Run, curve: Callable[[float], Pair], start: Pair = (0.0, 0.0)) -> float:
    """How far the moves are from the points of a curve, at most."""
    pieces: list[tuple[Pair, Piece]] = []
    for entry in done.entries:
        if isinstance(entry, Arc | Line):
            end = entry.end[0], entry.end[1]
            centre = entry.centre if isinstance(entry, Arc) else None
            sweep = entry.sweep_rad if isinstance(entry, Arc) else 0.0
            pieces.append((start, Piece(end, centre, sweep, 0.0)))
            start = end
    points = [curve(k / 500) for k in range(501)]
    return max(min(distance(point, *piece) for piece in pieces) for point in points)


def test_a_cubic_spline_has_its_four_control_points() -> None:
    done = ngc("F10 G5 X1 Y1 I0 J3 P0 Q-3")
    points = [(0.0, 0.0), (0.0, 3.0), (1.0, -2.0), (1.0, 1.0)]
    assert farthest(done, lambda u: bernstein(points, u)) < TOLERANCE_INCH
    assert done.ends[-1] == (1, 1, 0)
    moved = ngc("F10 G5 X1 Y1 I0 J3 P0 Q-2.9")
    assert farthest(moved, lambda u: bernstein(points, u)) > 100 * TOLERANCE_INCH


def test_the_next_cubic_spline_goes_on_in_the_same_direction() -> None:
    done = ngc("F10 G5 X1 Y1 I0 J3 P0 Q-3|G5 X2 Y2 P.5 Q-1")
    second = [(1.0, 1.0), (1.0, 4.0), (2.5, 1.0), (2.0, 2.0)]
    own = [entry for entry in done.entries if entry.source.line == 2]
    tail = Run(own, done.interpreter, done.cells, done.machine)
    assert farthest(tail, lambda u: bernstein(second, u), (1.0, 1.0)) < TOLERANCE_INCH


@pytest.mark.parametrize(
    ("words", "middle"), [("I2 J4", (2.0, 4.0)), ("J4", (0.0, 4.0)), ("I2", (2.0, 0.0))]
)
def test_a_quadratic_spline_has_three_control_points(words: str, middle: Pair) -> None:
    done = ngc(f"F10 G5.1 X4 Y1 {words}")
    points = [(0.0, 0.0), middle, (4.0, 1.0)]
    assert farthest(done, lambda u: bernstein(points, u)) < TOLERANCE_INCH


def test_a_nurbs_has_the_points_weights_and_order_of_its_blocks() -> None:
    done = ngc("F10|G5.2 X0 Y1 P1 L3|X2 Y2 P1|X2 Y0 P1|G5.2 X0 Y0 P2|G5.3|G1 X1")
    points = [(0.0, 0.0), (0.0, 1.0), (2.0, 2.0), (2.0, 0.0), (0.0, 0.0)]
    weights = [1.0, 1.0, 1.0, 1.0, 2.0]
    done.entries[:] = [entry for entry in done.entries if entry.source.line == 6]
    assert farthest(done, lambda u: nurbs(points, weights, 3, u)) < TOLERANCE_INCH


def test_the_order_and_the_weight_of_the_first_point_are_read() -> None:
    done = ngc("F10|G5.2 P3|X0 Y1 P1 L4|X2 Y2 P.5|X2 Y0 P1|X4 Y0 P1|G5.3")
    points = [(0.0, 0.0), (0.0, 1.0), (2.0, 2.0), (2.0, 0.0), (4.0, 0.0)]
    weights = [3.0, 1.0, 0.5, 1.0, 1.0]
    assert farthest(done, lambda u: nurbs(points, weights, 4, u)) < TOLERANCE_INCH
    assert farthest(done, lambda u: nurbs(points, weights, 3, u)) > 100 * TOLERANCE_INCH


def test_a_quarter_of_a_circle_is_cut_on_the_circle() -> None:
    done = ngc("F10 G1 X1|G5.2 X1 Y1 P.7071067811865476|X0 Y1 P1|G5.3")
    arcs = [entry for entry in done.entries if isinstance(entry, Arc)]
    assert sum(arc.sweep_rad for arc in arcs) == pytest.approx(math.pi / 2)
    for arc in arcs:
        assert arc.start_radius == pytest.approx(1.0)
        assert arc.centre == pytest.approx((0.0, 0.0), abs=1e-9)


def test_the_arcs_touch_each_other() -> None:
    arcs = ngc("F10 G5 X1 Y1 I0 J3 P0 Q-3").of(Arc)
    begin, before = (0.0, 0.0), math.pi / 2
    for arc in arcs:
        assert isinstance(arc, Arc)
        turn = math.copysign(math.pi / 2, arc.sweep_rad)
        out = math.atan2(begin[1] - arc.centre[1], begin[0] - arc.centre[0]) + turn
        assert math.remainder(out - before, math.tau) == pytest.approx(0.0, abs=1e-6)
        before, begin = out + arc.sweep_rad, (arc.end[0], arc.end[1])


def test_splines_follow_units_increments_and_rotated_systems() -> None:
    inches = ngc("F10 G1 X1|G5 X2 Y1 I0 J3 P0 Q-3")
    metric = ngc("G21 F254 G1 X25.4|G5 X50.8 Y25.4 I0 J76.2 P0 Q-76.2")
    by_increments = ngc("F10 G1 X1|G91 G5 X1 Y1 I0 J3 P0 Q-3")
    turned = ngc("G10 L2 P1 R90|F10 G1 X1|G5 X2 Y1 I0 J3 P0 Q-3")
    for other in (metric, by_increments):
        for one, two in zip(inches.ends, other.ends, strict=True):
            assert one == pytest.approx(two, abs=1e-8)
    for (x, y, z), two in zip(inches.ends, turned.ends, strict=True):
        assert (-y, x, z) == pytest.approx(two, abs=1e-8)


def test_increments_of_control_points_count_from_the_start_of_the_curve() -> None:
    one = ngc("F10 G1 X1|G5.2 X1 Y1 P1|X3 Y2 P1|G5.3")
    two = ngc("F10 G1 X1|G91 G5.2 X0 Y1 P1|X2 Y2 P1|G5.3")
    assert one.moves == two.moves


def test_the_time_of_g93_is_that_of_the_whole_curve() -> None:
    arcs = [arc for arc in ngc("G93 G5.1 X4 Y0 I2 J4 F2").of(Arc) if isinstance(arc, Arc)]
    length = sum(arc.start_radius * abs(arc.sweep_rad) for arc in arcs)
    # of the parabola y = 2 x - x*x/2 from 0 to 4
    exact = 2 * math.sqrt(5) + math.asinh(2)
    assert length == pytest.approx(exact, rel=1e-6)
    assert [arc.pace.feed_upm for arc in arcs] == pytest.approx([2 * exact] * len(arcs), rel=1e-6)


def test_straight_splines_are_lines() -> None:
    done = ngc("F10 G5 X3 Y0 I1 J0 P-1 Q0|G5.1 X6 Y0 I1.5 J0")
    assert all(isinstance(entry, Line) for entry in done.entries[:-1])
    assert done.ends[-1] == (6, 0, 0)
    assert ngc("F10 G5 X0 Y0 I0 J0 P0 Q0").moves == []


def test_no_motion_is_active_after_a_spline() -> None:
    assert fault("F10 G5 X1 Y1 I0 J3 P0 Q-3|X2") == (
        "PROGRAM:2:1: E206 word has no meaning in this block: X"
    )


WRONG = "E235 spline word missing or wrong"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("F10 G5 X1 I0 J3 P0", f"1:1: {WRONG} (P and Q are needed)"),
        ("F10 G5 X1 I0 P0 Q1", f"1:11: {WRONG} (I and J, or neither)"),
        ("F10 G5 X1 J0 P0 Q1", f"1:11: {WRONG} (I and J, or neither)"),
        ("F10 G5 X1 P0 Q1", f"1:1: {WRONG} (the first G5 needs I and J)"),
        ("F10 G5 X1 I0 J1 P0 Q1|G0 X2|G5 X1 P0 Q1", f"3:1: {WRONG} (the first G5 needs I and J)"),
        ("F10 G5.1 X1", f"1:1: {WRONG} (I, J or both are needed)"),
        ("F10 G5 X1 Z1 I0 J3 P0 Q1", f"1:11: {WRONG}: Z (splines move X and Y alone)"),
        ("F10 G18 G5 X1 I0 J3 P0 Q1", f"1:1: {WRONG} (splines lie in the XY plane: G17)"),
        ("G41.1 D1 F10 G1 X2|G5 X3 I0 J3 P0 Q1", "2:1: E314 spline with compensation"),
        ("G41.1 D1 F10 G1 X2|G5.2 X3 Y0 P1", "2:1: E314 spline with compensation"),
        ("F10 G5.3", f"1:1: {WRONG} (G5.2 begins a curve)"),
        ("G5.2 X1 Y1", f"1:1: {WRONG} (each control point has a weight P)"),
        ("G5.2 X1 P1", f"1:1: {WRONG} (a control point has X and Y)"),
        ("G5.2 Y1 P1", f"1:1: {WRONG} (a control point has X and Y)"),
        ("G5.2 X1 Y1 P0", f"1:12: {WRONG}: P0 (P 1e-06 to 1e+06)"),
        ("G5.2 X1 Y1 P-1", f"1:12: {WRONG}: P-1 (P 1e-06 to 1e+06)"),
        ("G5.2 X1 Y1 P1 L2", f"1:15: {WRONG}: L2 (L 3 to 20)"),
        ("G5.2 X1 Y1 P1 L3.5", "1:15: E204 integer expected: L"),
        ("G5.2 X1 Y1 P1|P1", f"2:1: {WRONG} (a control point has X and Y)"),
        ("G5.2 X1 Y1 P1|X2 Y2 P1 Z1", f"2:10: {WRONG}: Z (splines move X and Y alone)"),
        ("G5.2 X1 Y1 P1|X2 Y2 P1 R1", "2:10: E206 word has no meaning in this block: R"),
        ("G5.2 X1 Y1 P1|G5.3", f"2:1: {WRONG}: 2 control points, and L3 needs 3"
                               " (where the curve begins is one of them)"),
        ("F10 G5.2 X1 Y1 P1|X2 Y1 P1|G92 X5|G5.3",
         f"4:1: {WRONG} (offsets have changed since G5.2)"),
        ("F10 G5.2 X1 Y1 P1|X2 Y1 P1|G18 G5.3", f"3:1: {WRONG} (splines lie in the XY plane: G17)"),
        ("G5.2 X1 Y1 P1|G5.3 X1", "2:6: E206 word has no meaning in this block: X"),
        ("F10 G5 X1E9 Y1 I0 J3 P0 Q1", "1:10: E206 word has no meaning in this block: E"),
        ("F10 G5 X99999999 Y1 I0 J99999999 P0 Q1", f"1:1: {WRONG}: more than {MOST_ARCS} arcs"),
    ]
    + [
        (f"F10 G5.2 X1 Y1 P1|{other}", f"2:1: {WRONG} (a curve of G5.2 is open: G5.3 ends it)")
        for other in ("G0 X1", "G1 X1", "G2 X1 I1", "G80 X1", "G53 G0 X1", "G28 X1", "G30",
                      "G38.3 X1", "G81 X1 Z-1 R1", "G5 X1 I1 J1 P1 Q1", "G5.1 X1 I1", "M2", "M30")
    ]
    + [("G5.2 X1 Y1 P1|G1|X1", f"3:1: {WRONG} (a curve of G5.2 is open: G5.3 ends it)")],
)  # fmt: skip
def test_what_is_no_spline_is_refused(text: str, found: str) -> None:
    place = found if "G1|X1" not in text else found.replace("2:1", "3:1")
    said = fault(text)
    assert said == f"PROGRAM:{place}" or (
        " M" not in f" {text[-3:]}" and said == f"PROGRAM:{place}"
    )


def test_an_open_curve_at_the_end_of_the_text_is_refused() -> None:
    assert WRONG in fault("F10|G5.2 X1 Y1 P1|X2 Y2 P1")


def test_a_new_run_begins_without_the_curve_of_the_last_one() -> None:
    done = ngc("G5.2 X1 Y1 P1|M2")
    assert done.error is not None
    assert done.interpreter.curve.points == [(0.0, 0.0), (1.0, 1.0)]
    done.interpreter.begin()
    assert done.interpreter.curve.points == []


coordinates = st.integers(-40, 40).map(lambda n: n / 8)
places = st.tuples(coordinates, coordinates)


@search(60)
@given(
    st.lists(st.tuples(places, st.floats(0.1, 8)), min_size=3, max_size=7), st.integers(3, 5)
)  # fmt: skip
def test_any_curve_is_met_within_the_tolerance(
    chosen: list[tuple[Pair, float]], order: int
) -> None:
    points, weights = [place for place, _ in chosen], [weight for _, weight in chosen]
    order = min(order, len(points))
    tolerance = 1e-3
    curve = Spline(tuple(points), tuple(weights), order)
    start, pieces = points[0], list[tuple[Pair, Piece]]()
    for piece in biarcs(curve, tolerance):
        pieces.append((start, piece))
        start = piece.end
    assert start == pytest.approx(points[-1], abs=1e-9)
    for k in range(201):
        exact = nurbs(points, weights, order, k / 200)
        assert curve.at(k / 200 * curve.spans) == pytest.approx(exact, abs=1e-9)
        near = (distance(exact, *piece) for piece in pieces)
        assert min(near, default=math.dist(exact, points[0])) <= tolerance


def test_a_curve_that_is_too_long_for_its_tolerance_is_refused() -> None:
    curve = Spline(((0.0, 0.0), (1e6, 2e6), (2e6, 0.0)), (1.0,) * 3, 3)
    with pytest.raises(TooManyArcsError):
        biarcs(curve, 1e-6)
