"""Programs as generators write them, run on the card: every setpoint lies on the drawing.

The ideal curves are computed from the numbers of the files with shapely and scipy.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicHermiteSpline
from shapely import STRtree, linestrings, points
from shapely.geometry import LineString

from openacr.controller import Controller
from openacr.map.rows import axes
from openacr.source_check import check

pytestmark = pytest.mark.evidence("oracle", "curves of scipy, shapes of shapely")

FIELD = Path(__file__).parents[1] / "data" / "field"
PULSES = 1000
IN_MOTION, CUTTING, RUNNING = 516, 32, 1024
SETUP = (
    "DIM P(2000)\nP1000=0.25\nPROG0\nATTACH MASTER0\n"
    'ATTACH SLAVE0 AXIS0 "X"\nATTACH SLAVE1 AXIS1 "Y"\n'
    f"PPU X{PULSES} Y{PULSES}\nVEL 50\nDRIVE ON X Y\n"
)


def test_every_program_has_its_test() -> None:
    assert {path.stem for path in FIELD.glob("*.8k")} == {
        "dxf_export_style", "weighted_nurb_style", "timed_spline_style",
    }  # fmt: skip


class Cut:
    """A program of the field that has been run: setpoints in units, tick by tick."""

    def __init__(self, folder: Path, name: str) -> None:
        (folder / "setup.8k").write_text(SETUP)
        text = (FIELD / f"{name}.8k").read_text()
        (folder / "prog0.8k").write_text(text)
        assert list(check(folder)) == []
        self.card = Controller.from_project(folder)
        self.card.send("PROG0\rRUN\r")
        self.places, self.cutting = [self.place()], [False]
        for _ in range(40_000):
            self.card.advance(1)
            self.places.append(self.place())
            self.cutting.append(self.card.bit[CUTTING])
            if not (self.card.bit[IN_MOTION] or self.card.bit[RUNNING]):
                break

    def place(self) -> tuple[float, float]:
        rows = self.card.memory.F
        return (rows[axes.position_cnt[0]] / PULSES, rows[axes.position_cnt[1]] / PULSES)

    def strokes(self) -> list[np.ndarray]:
        """The setpoints while the output was on, stroke by stroke."""
        found: list[list[tuple[float, float]]] = []
        was_on = False
        for place, is_on in zip(self.places, self.cutting, strict=True):
            if is_on and not was_on:
                found.append([])
            if is_on:
                found[-1].append(place)
            was_on = is_on
        return [np.array(stroke) for stroke in found]


def length(stroke: np.ndarray) -> float:
    return float(np.hypot(*np.diff(stroke, axis=0).T).sum())


def is_on(stroke: np.ndarray, ideal: LineString, within: float) -> bool:
    """Whether every setpoint is on the curve and every place of the curve was passed."""
    places = np.array(ideal.coords)
    pieces = STRtree(linestrings(np.stack((places[:-1], places[1:]), axis=1)))
    off = pieces.query_nearest(points(stroke), return_distance=True)[1].max()
    passed = LineString(places[:: max(1, len(places) // 2000)])
    return bool(off < within and passed.hausdorff_distance(LineString(stroke)) < 0.05)


def arc(cx: float, cy: float, radius: float, begin: float, end: float) -> LineString:
    angles = np.linspace(math.radians(begin), math.radians(end), 20_000)
    return LineString(np.column_stack([cx + radius * np.cos(angles), cy + radius * np.sin(angles)]))


def test_entities_of_a_drawing_are_cut_where_they_are_drawn(tmp_path: Path) -> None:
    cut = Cut(tmp_path, "dxf_export_style")
    polyline, spline, circle, half, point = cut.strokes()
    ring = [(0, 0), (30, 0), (30, 20), (12.5, 20), (0, 0)]
    assert is_on(polyline, LineString(ring), 1e-9)
    assert length(polyline) == pytest.approx(30 + 20 + 17.5 + math.hypot(12.5, 20), abs=1e-6)
    knots = [0, 0, 0, 0, 1.5, 2, 4, 4, 4, 4]
    poles = [(-40, 25), (-30, 45), (-20, 5), (-5, 40), (10, 32.5), (25, 30)]
    curve = BSpline(knots, np.array(poles, float), 3)(np.linspace(0, 4, 100_001))
    assert is_on(spline, LineString(curve), 1e-6)
    assert is_on(circle, arc(15, 12, 4, 90, 450), 1e-6)
    assert length(circle) == pytest.approx(8 * math.pi, abs=1e-4)
    assert is_on(half, arc(40, 20, 10, 0, 180), 1e-6)
    assert length(half) == pytest.approx(10 * math.pi, abs=1e-4)
    assert {tuple(place) for place in point} == {(-12.5, -2.25)}
    assert len(point) == pytest.approx(0.25 / cut.card.period_s, abs=20)
    assert cut.places[-1] == (-12.5, -2.25)


def test_weights_before_or_after_the_axes_draw_a_half_circle(tmp_path: Path) -> None:
    cut = Cut(tmp_path, "weighted_nurb_style")
    (stroke,) = cut.strokes()
    radii = np.hypot(stroke[:, 0], stroke[:, 1])
    assert (radii.min(), radii.max()) == pytest.approx((10, 10), abs=1e-9)
    assert stroke[0] == pytest.approx((10, 0), abs=1e-9)
    assert stroke[-1] == pytest.approx((-10, 0), abs=1e-9)
    assert (stroke[:, 1] >= -1e-9).all()
    assert length(stroke) == pytest.approx(10 * math.pi, abs=1e-4)
    assert cut.places[-1] == (0, 0)


def test_a_timed_spline_takes_exactly_the_times_of_its_knots(tmp_path: Path) -> None:
    cut = Cut(tmp_path, "timed_spline_style")
    points = np.array(
        [(0, 0), (1, 0.25), (2.5, 1), (4, 1), (4.5, 2.75), (4, 4), (2, 4.125), (1, 4)]
    )
    slopes = np.zeros_like(points)
    slopes[1], slopes[6] = (points[2] - points[0]) / 0.1, (points[7] - points[5]) / 0.1
    for i in range(2, 6):
        slopes[i] = (points[i - 2] - 8 * points[i - 1] + 8 * points[i + 1] - points[i + 2]) / 0.6
    times = np.arange(0, 0.35 + cut.card.period_s / 2, cut.card.period_s)
    ideal = CubicHermiteSpline(np.arange(8) * 0.05, points, slopes)(times)
    first = next(n for n, place in enumerate(cut.places) if place != (0, 0)) - 1
    assert np.array(cut.places[first : first + len(times)]) == pytest.approx(ideal, abs=1e-9)
    assert cut.places[-1] == (0, 0)
