"""Fields of heights against shapes of shapely, closed forms of volume, and both builds."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely

from openacr.compiled import is_compiled
from openacr.mill.config.tools import Tip
from openacr.mill.plan.pictures import removal_cy, stock
from openacr.mill.plan.pictures.stock import Array, Blank, Cutter, Mark, Stock, Sweep

pytestmark = pytest.mark.evidence(
    "oracle", "areas swept by discs of shapely, volumes in closed form, envelopes by brute force"
)
BLANK = Blank((-20.0, -15.0, -10.0), (60.0, 45.0, 0.0))
CELL = 0.25


def cut(
    field: Stock, cutter: Cutter, *places: tuple[float, float, float], by: Sweep = Sweep.CUTS
) -> Mark:
    """Cut along a polyline; what happened."""
    found = field.remove(cutter, np.array(places), np.full(len(places) - 1, by, np.uint8))
    return Mark(int(np.bitwise_or.reduce(found)))


def middles(field: Stock) -> tuple[Array, Array]:
    rows, columns = field.heights.shape
    x = field.blank.low[0] + field.cell * (np.arange(columns) + 0.5)
    y = field.blank.low[1] + field.cell * (np.arange(rows) + 0.5)
    return np.meshgrid(x, y)


def polyline(seed: int, count: int = 12) -> list[tuple[float, float]]:
    places = np.random.default_rng(seed).uniform((-25.0, -20.0), (65.0, 50.0), (count, 2))
    return [(float(x), float(y)) for x, y in places]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("radius", [0.4, 3.0, 11.0])
def test_a_flat_end_at_one_depth_removes_the_area_that_a_disc_sweeps(
    seed: int, radius: float
) -> None:
    field, line = Stock(BLANK, CELL), polyline(seed)
    cut(field, Cutter(radius), *((x, y, -2.5) for x, y in line))
    x, y = middles(field)
    away = shapely.distance(shapely.LineString(line), shapely.points(x, y))
    sure = np.abs(away - radius) > 1e-9
    assert np.array_equal((field.heights == -2.5)[sure], (away <= radius)[sure])
    assert np.array_equal((field.heights == 0.0)[sure], (away > radius)[sure])
    swept = shapely.LineString(line).buffer(radius, quad_segs=256)
    box = shapely.box(*BLANK.low[:2], *BLANK.high[:2])
    area, edge = swept.intersection(box).area, swept.intersection(box).length
    assert field.removed / 2.5 == pytest.approx(area, abs=0.1 * edge * CELL)


def brute(cutter: Cutter, line: list[tuple[float, float, float]], x: float, y: float) -> float:
    """The lowest height of the cutter above a place, by trying many positions of its axis."""
    best = 0.0
    for begin, end in pairwise(line):
        share = np.linspace(0.0, 1.0, 20001)[:, None]
        axis = np.array(begin) + share * (np.array(end) - np.array(begin))
        away2 = (axis[:, 0] - x) ** 2 + (axis[:, 1] - y) ** 2
        under = away2 <= cutter.radius**2
        rise = 0.0
        if cutter.tip is Tip.BALL:
            rise = cutter.radius - np.sqrt(np.maximum(cutter.radius**2 - away2, 0.0))
        heights = np.where(under, axis[:, 2] + rise, 0.0)
        best = min(best, float(heights.min()))
    return max(best, BLANK.low[2])


@pytest.mark.parametrize("tip", Tip)
@pytest.mark.parametrize("seed", range(3))
def test_a_sloping_move_leaves_its_lower_envelope(tip: Tip, seed: int) -> None:
    rng = np.random.default_rng(seed)
    flat = [
        (x, y, float(z))
        for (x, y), z in zip(polyline(seed, 4), rng.uniform(-9, -1, 4), strict=True)
    ]
    line = [*flat, (flat[-1][0], flat[-1][1], -9.5)]  # then straight down
    cutter = Cutter(6.0, tip)
    field = Stock(BLANK, CELL)
    cut(field, cutter, *line)
    x, y = middles(field)
    rows, columns = field.heights.shape
    for row, column in zip(rng.integers(0, rows, 150), rng.integers(0, columns, 150), strict=True):
        px, py = float(x[row, column]), float(y[row, column])
        nearest = shapely.distance(
            shapely.LineString([(a, b) for a, b, _ in line]), shapely.Point(px, py)
        )
        if abs(nearest - cutter.radius) > 0.01:  # positions of the brute force are apart
            wanted = brute(cutter, line, px, py)
            assert field.heights[row, column] == pytest.approx(wanted, abs=0.01)


def test_a_slot_of_a_flat_end_has_the_volume_of_its_shape() -> None:
    field = Stock(BLANK, 0.05)
    cut(field, Cutter(4.0), (0.0, 0.0, 0.0), (0.0, 0.0, -3.0), (30.0, 18.0, -3.0))
    length = math.hypot(30.0, 18.0)
    assert field.removed == pytest.approx(3.0 * (8.0 * length + math.pi * 16.0), rel=2e-4)


def test_a_slot_of_a_ball_end_has_the_volume_of_its_shape() -> None:
    field = Stock(BLANK, 0.05)
    cut(field, Cutter(4.0, Tip.BALL), (0.0, 0.0, 0.0), (0.0, 0.0, -4.0), (40.0, 0.0, -4.0))
    half_cylinder, half_ball = 0.5 * math.pi * 16.0 * 40.0, 2.0 / 3.0 * math.pi * 64.0
    assert field.removed == pytest.approx(half_cylinder + half_ball, rel=2e-4)


def test_a_pocket_has_the_volume_of_a_rectangle_with_round_corners() -> None:
    field, radius = Stock(BLANK, 0.05), 3.0
    lanes = [(x, 4.0 * k) for k in range(6) for x in ((0.0, 30.0), (30.0, 0.0))[k % 2]]
    rim = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0), (0.0, 0.0)]
    cut(field, Cutter(radius), *((x, y, -4.0) for x, y in [*lanes, *rim]))
    area = 36.0 * 26.0 - (4.0 - math.pi) * radius**2
    assert field.removed == pytest.approx(4.0 * area, rel=2e-4)


# --- marks ----------------------------------------------------------------------------


def test_a_rapid_in_material_is_marked_where_it_touches_it() -> None:
    field = Stock(BLANK, CELL, 0.01)
    cut(field, Cutter(2.0), (0.0, 0.0, 1.0), (0.0, 0.0, -2.0), (20.0, 0.0, -2.0))
    assert cut(field, Cutter(2.0), (20.0, 0.0, -2.0), (20.0, 0.0, 5.0), by=Sweep.CROSSES) == Mark(0)
    touched = cut(field, Cutter(2.0), (0.0, 0.0, -2.0), (0.0, 20.0, -2.0), by=Sweep.CROSSES)
    assert touched is Mark.RAPID
    x, y = middles(field)
    was_cut = shapely.distance(shapely.LineString([(0, 0), (20, 0)]), shapely.points(x, y)) <= 2.0
    crossed = (
        shapely.distance(shapely.LineString([(0, 0), (0, 20)]), shapely.points(x, y)) <= 2.0 - 0.01
    )
    assert np.array_equal(field.marks == Mark.RAPID, crossed & ~was_cut)
    assert field.heights[crossed].max() == -2.0  # what a rapid breaks off is gone


@pytest.mark.parametrize(("z", "mark"), [(-0.01, Mark(0)), (-0.0101, Mark.RAPID)])
def test_a_rapid_may_be_as_deep_in_material_as_chords_are_off(z: float, mark: Mark) -> None:
    field = Stock(BLANK, CELL, 0.01)
    assert cut(field, Cutter(2.0), (0.0, 0.0, z), (9.0, 0.0, z), by=Sweep.CROSSES) == mark


def test_a_rapid_from_an_unknown_place_removes_nothing() -> None:
    field = Stock(BLANK, CELL)
    assert cut(field, Cutter(2.0), (0.0, 0.0, -5.0), (9.0, 0.0, -5.0), by=Sweep.PASSES) == Mark(0)
    assert field.removed == 0.0


@pytest.mark.parametrize(("z", "mark"), [(-10.01, Mark(0)), (-10.0101, Mark.BELOW)])
def test_a_cut_below_the_blank_is_marked_and_leaves_its_bottom(z: float, mark: Mark) -> None:
    field = Stock(BLANK, CELL, 0.01)
    cut(field, Cutter(3.0), (0.0, 0.0, -10.0), (20.0, 0.0, -10.0))  # to the bottom, not below
    assert not field.marks.any()
    assert cut(field, Cutter(2.0), (0.0, 0.0, z), (20.0, 0.0, z)) == mark
    x, y = middles(field)
    away = shapely.distance(shapely.LineString([(0, 0), (20, 0)]), shapely.points(x, y))
    assert np.array_equal(field.marks != 0, (away <= 2.0) if mark else np.zeros_like(x, bool))
    assert field.heights.min() == -10.0


def test_a_blank_is_covered_by_whole_cells() -> None:
    assert Blank((0.0, 0.0, 0.0), (10.0, 5.1, 1.0)).cells(0.5) == (20, 11)
    assert Blank((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)).cells(0.5) == (1, 1)


def test_progress_is_reported_for_every_move(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stock, "TOGETHER", 4)
    counts: list[int] = []
    places = np.zeros((10, 3))
    Stock(BLANK, 5.0).remove(Cutter(1.0), places, np.zeros(9, np.uint8), counts.append)
    assert counts == [4, 4, 1]


@pytest.mark.skipif(not is_compiled, reason="there is one build only")
@pytest.mark.parametrize("tip", Tip)
def test_both_builds_leave_the_same_bits(monkeypatch: pytest.MonkeyPatch, tip: Tip) -> None:
    rng = np.random.default_rng(7)
    places = np.column_stack([polyline(7), rng.uniform(-11, 1, 12)])
    sweeps = rng.integers(0, 3, 11).astype(np.uint8)
    fields, marks = [], []
    for _build in range(2):
        field = Stock(BLANK, 1.0, 0.01)
        marks.append(field.remove(Cutter(2.5, tip), places, sweeps).tobytes())
        fields.append((field.heights.tobytes(), field.marks.tobytes()))
        monkeypatch.setattr(stock, "_moves", removal_cy.removal_moves)
    assert fields[0] == fields[1]
    assert marks[0] == marks[1]
