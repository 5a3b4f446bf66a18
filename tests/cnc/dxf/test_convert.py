"""DXF files of every kind of entity, and what program they make."""

import math
import random
from pathlib import Path
from typing import Any

import ezdxf
import pytest
from ezdxf.document import Drawing
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, MultiLineString, Point, Polygon
from tests.cnc.dxf.programs import trace
from tests.cnc.programs import unrolled

from openacr.cnc.canonical import Arc, Line, Rapid
from openacr.cnc.dxf import Conversion, Options, Pattern, convert
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.survey import survey
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.errors import UserError
from openacr.sysvar import Store

pytestmark = pytest.mark.evidence("oracle", "shapes of shapely")


def drawing(units: int = 1, version: str = "R2010") -> Drawing:
    document = ezdxf.new(version)  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = units
    return document


def converted(document: Drawing, tmp_path: Path, **options: Any) -> Conversion:
    path = tmp_path / "part.dxf"
    document.saveas(path)
    return convert(path, Options(**options))


def square(space: Any, x: float = 0.0, side: float = 2.0, **attributes: Any) -> None:
    """Four lines, not in order, not in one direction."""
    a, b, c, d = (x, 0), (x + side, 0), (x + side, side), (x, side)
    for start, end in ((c, d), (a, b), (d, a), (c, b)):
        space.add_line(start, end, dxfattribs=attributes)


@pytest.mark.req("MILL-DXF-13", "MILL-DXF-05")
@pytest.mark.parametrize(("is_ccw", "path"), [(False, "clockwise"), (True, "counter-clockwise")])
def test_a_square_is_cut_once_around_and_ends_where_it_began(
    is_ccw: bool, path: str, tmp_path: Path
) -> None:
    document = drawing()
    square(document.modelspace())
    text = converted(document, tmp_path, is_counter_clockwise=is_ccw).text
    (run,) = trace(text).runs
    assert trace(text).length == 8.0
    assert run[0] == run[-1] == (0.0, 0.0)
    assert Polygon(run).exterior.is_ccw == is_ccw
    assert f"closed, {path}, length 8" in text


def test_the_program_is_laid_out_for_reading(tmp_path: Path) -> None:
    document = drawing()
    square(document.modelspace())
    document.modelspace().add_circle((5, 1), 0.5)
    text = converted(document, tmp_path, feed=12.0, safe_height=0.25).text
    assert text.splitlines() == [
        "; part.dxf: 2 chains (2 closed) of 5 entities",
        "G90 G17",
        "G20",
        "G200 F2",
        "F12",
        "; chain 1: closed, clockwise, length 8",
        "G0 Z0.25",
        "G0 X0 Y0",
        "G1 Z0",
        "G1 X0 Y2",
        "G1 X2 Y2",
        "G1 X2 Y0",
        "G1 X0 Y0",
        "; chain 2: closed, clockwise, length 3.141593",
        "G0 Z0.25",
        "G0 X5.5 Y1",
        "G1 Z0",
        "G2 X5.5 Y1 I5 J1",
        "G0 Z0.25",
        "M2",
    ]


@pytest.mark.req("MILL-DXF-09")
@pytest.mark.parametrize(
    ("add", "length", "codes"),
    [
        (lambda m: m.add_line((1, 1), (4, 5)), 5.0, [1]),
        (lambda m: m.add_arc((0, 0), 2, 0, 90), math.pi, [3]),
        (lambda m: m.add_arc((0, 0), 1, 350, 10), math.pi / 9, [3]),
        (lambda m: m.add_circle((3, 3), 0.5), math.pi, [2]),
        (lambda m: m.add_lwpolyline([(0, 0), (3, 0), (3, 4)], close=True), 12.0, [1, 1, 1]),
        (lambda m: m.add_lwpolyline([(0, 0), (3, 0), (3, 4)]), 7.0, [1, 1]),
        (
            lambda m: m.add_lwpolyline([(0, 0, 1), (2, 0, 1)], format="xyb", close=True),
            2 * math.pi,
            [2, 2],
        ),
        (lambda m: m.add_polyline2d([(0, 0, 1), (2, 0, 0)], format="xyb"), math.pi, [3]),
        (lambda m: m.add_polyline3d([(0, 0, 1), (3, 4, 7)]), 5.0, [1]),
        (
            lambda m: m.add_arc((2, 0), 2, 0, 90, dxfattribs={"extrusion": (0, 0, -1)}),
            math.pi,
            None,
        ),
    ],
)
def test_an_entity_becomes_blocks_of_its_length(
    add: Any, length: float, codes: list[int] | None, tmp_path: Path
) -> None:
    document = drawing()
    add(document.modelspace())
    traced = trace(converted(document, tmp_path).text)
    assert traced.length == pytest.approx(length, rel=1e-4)
    assert codes is None or traced.codes == codes


def test_a_mirrored_arc_lies_where_the_drawing_shows_it(tmp_path: Path) -> None:
    document = drawing()
    arc = document.modelspace().add_arc((2, 0), 2, 0, 90, dxfattribs={"extrusion": (0, 0, -1)})
    shown = [(p.x, p.y) for p in arc.flattening(0.0001)]
    (run,) = trace(converted(document, tmp_path).text).runs
    assert LineString(run).hausdorff_distance(LineString(shown)) < 0.001


@pytest.mark.parametrize("kind", ["spline", "ellipse", "tilted"])
def test_curves_are_cut_as_chords_a_tenth_of_epsilon_high(kind: str, tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    if kind == "spline":
        entity = space.add_spline([(0, 0), (1, 2), (3, -1), (5, 0)])
    elif kind == "ellipse":
        entity = space.add_ellipse((1, 1), (3, 0), 0.4)  # type: ignore[assignment]
    else:
        entity = space.add_circle((0, 0), 2, dxfattribs={"extrusion": (0, 0.6, 0.8)})  # type: ignore[assignment]
    exact = [(p.x, p.y) for p in entity.flattening(1e-6)]
    for epsilon in (0.02, 0.002):
        traced = trace(converted(document, tmp_path, epsilon=epsilon).text)
        (run,) = traced.runs
        assert set(traced.codes) == {1}
        assert LineString(run).hausdorff_distance(LineString(exact)) < 0.1 * epsilon + 2e-6


def test_blocks_are_expanded_where_they_are_inserted(tmp_path: Path) -> None:
    document = drawing()
    block = document.blocks.new("PLATE")
    square(block)
    nested = document.blocks.new("TWO")
    nested.add_blockref("PLATE", (10, 0))
    nested.add_blockref("PLATE", (0, 0), dxfattribs={"xscale": 0.5, "yscale": 0.5})
    document.modelspace().add_blockref("TWO", (100, 0), dxfattribs={"rotation": 90})
    runs = trace(converted(document, tmp_path).text).runs
    shapes = sorted((Polygon(run) for run in runs), key=lambda shape: shape.area)
    assert [shape.area for shape in shapes] == pytest.approx([1.0, 4.0])
    assert shapes[0].bounds == pytest.approx((99, 0, 100, 1))
    assert shapes[1].bounds == pytest.approx((98, 10, 100, 12))


@pytest.mark.req("MILL-DXF-06")
def test_one_layer_is_taken_whatever_its_case_or_all_but_the_frozen_ones(tmp_path: Path) -> None:
    document = drawing()
    for name in ("Cut", "Text", "Ice"):
        document.layers.add(name)
    document.layers.get("Ice").freeze()
    space = document.modelspace()
    square(space, 0, 1, layer="CUT")
    square(space, 10, 2, layer="Text")
    square(space, 20, 3, layer="Ice")
    block = document.blocks.new("B")
    square(block, 30, 4)  # on layer 0: that of the insertion
    space.add_blockref("B", (0, 0), dxfattribs={"layer": "cut"})

    def areas(**options: Any) -> list[float]:
        runs = trace(converted(document, tmp_path, **options).text).runs
        return sorted(Polygon(run).area for run in runs)

    assert areas(layer="cut") == pytest.approx([1.0, 16.0])
    assert areas(layer="TEXT") == pytest.approx([4.0])
    assert areas() == pytest.approx([1.0, 4.0, 16.0])
    with pytest.raises(UserError, match="there is nothing to cut on layer Ice"):
        areas(layer="Ice")
    with pytest.raises(UserError, match=r"the drawing has no layer cat \(it has .*Cut"):
        areas(layer="cat")


SURVEY_FOOT_IN = 1200 / 3937 / 0.0254  # by its definition in metres
# What one of a unit of $INSUNITS is in inches (G20) or millimetres (G21).
DRAWING_UNITS = [
    (1, "G20", 1.0), (2, "G20", 12.0), (3, "G20", 63360.0), (4, "G21", 1.0), (5, "G21", 10.0),
    (6, "G21", 1000.0), (7, "G21", 1e6), (8, "G20", 1e-6), (9, "G20", 1e-3), (10, "G20", 36.0),
    (11, "G21", 1e-7), (12, "G21", 1e-6), (13, "G21", 1e-3), (14, "G21", 100.0),
    (15, "G21", 1e4), (16, "G21", 1e5), (21, "G20", SURVEY_FOOT_IN),
    (22, "G20", SURVEY_FOOT_IN / 12), (23, "G20", SURVEY_FOOT_IN * 3),
    (24, "G20", SURVEY_FOOT_IN * 5280),
]  # fmt: skip


@pytest.mark.req("MILL-DXF-11")
@pytest.mark.parametrize(("units", "code", "factor"), DRAWING_UNITS)
def test_the_unit_of_the_drawing_is_respected(
    units: int, code: str, factor: float, tmp_path: Path
) -> None:
    document = drawing(units)
    document.modelspace().add_line((1 / factor, 0), (301 / factor, 400 / factor))
    result = converted(document, tmp_path, is_metric=code == "G20")
    assert code in result.text.splitlines()
    assert trace(result.text).length == pytest.approx(500, rel=1e-7)
    assert result.notes == ()


@pytest.mark.req("MILL-DXF-11")
@pytest.mark.parametrize("units", [17, 18, 19, 20, 25])
def test_a_drawing_in_units_of_no_machine_is_in_default_units_with_a_warning(
    units: int, tmp_path: Path
) -> None:
    document = drawing(units)
    document.modelspace().add_line((0, 0), (3, 4))
    result = converted(document, tmp_path, is_metric=True)
    assert "G21" in result.text.splitlines()
    assert trace(result.text).length == pytest.approx(5)
    assert result.notes == (f"the drawing has unit {units}, which is not known here: taken as mm",)


@pytest.mark.req("MILL-DXF-11")
@pytest.mark.parametrize(("is_metric", "code"), [(False, "G20"), (True, "G21")])
def test_a_drawing_without_unit_is_in_default_units_with_a_warning(
    is_metric: bool, code: str, tmp_path: Path
) -> None:
    document = drawing(0)
    document.modelspace().add_line((0, 0), (3, 4))
    result = converted(document, tmp_path, is_metric=is_metric)
    assert code in result.text.splitlines()
    assert result.notes == (
        f"the drawing states no unit: taken as {'mm' if is_metric else 'inch'}",
    )


def test_settings_in_default_units_hold_in_a_drawing_of_the_other_unit(tmp_path: Path) -> None:
    document = drawing(4)
    space = document.modelspace()
    space.add_line((0, 0), (30, 0))
    space.add_line((30.05, 0), (30, 40))  # 0.05 mm apart: less than 0.002 inch
    result = converted(document, tmp_path)
    assert "G0 Z2.54" in result.text
    assert len(trace(result.text).runs) == 1


@pytest.mark.req("MILL-DXF-04")
def test_points_and_circles_are_drilled_nearest_first(tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    for x, y in ((5, 0), (1, 0), (9, 1)):
        space.add_point((x, y))
    space.add_circle((2.5, 0), 0.3)
    space.add_circle((5, 0.0005), 0.1)  # the same hole as the point
    space.add_line((0, 0), (1, 1))
    result = converted(document, tmp_path, pattern=Pattern.DRILL, drill_bottom=-0.75)
    assert result.text.splitlines() == [
        "; part.dxf: 4 holes",
        "G90 G17",
        "G20",
        "G0 Z0.1",
        "G98 G81 X1 Y0 Z-0.75 R0.1 F10",
        "X2.5 Y0",
        "X5 Y0",
        "X9 Y1",
        "G80",
        "M2",
        "$I CYCLES.TXT",
    ]
    assert result.notes == ("not used: 1 LINE",)


@pytest.mark.req("MILL-DXF-09")
def test_entities_that_cannot_be_used_are_listed(tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    space.add_line((0, 0), (1, 0))
    space.add_text("hello")
    space.add_text("again")
    space.add_point((3, 3))
    space.add_3dface([(0, 0), (1, 0), (1, 1)])
    assert converted(document, tmp_path).notes == ("not used: 1 3DFACE, 1 POINT, 2 TEXT",)


def test_every_release_from_r12_on_is_read(tmp_path: Path) -> None:
    for version in ("R12", "R2000", "R2004", "R2007", "R2010", "R2013", "R2018"):
        document = drawing(1, version)
        document.modelspace().add_circle((1, 1), 0.5)
        (run,) = trace(converted(document, tmp_path).text).runs
        assert Polygon(run).symmetric_difference(Point(1, 1).buffer(0.5, 360)).area < 1e-4


def test_arcs_that_are_too_small_or_too_flat_to_write_never_become_circles(tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    space.add_lwpolyline(
        [(0, 0, 0), (1, 0, 1), (1 + 2e-7, 0, 0), (2, 0, 1e-7), (3, 0, 0)], format="xyb"
    )
    traced = trace(converted(document, tmp_path).text)
    assert traced.codes == [1, 1, 1]
    assert traced.length == pytest.approx(3.0, abs=1e-5)


# --- files that are not drawings ----------------------------------------------------------------


@pytest.mark.req("MILL-DXF-12")
@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "cannot be read|damaged"),
        (b"G1 X1\nM2\n", "cannot be read|damaged"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00\x00\x00", "cannot be read|damaged"),
        (bytes(range(256)) * 20, "cannot be read|damaged"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nLINE\n 10\nabc\n", "damaged|cannot be read|empty"),
        (b"  0\nSECTION\n  2\nENTITIES\n  0\nENDSEC\n  0\nEOF\n", "the drawing is empty"),
    ],
)
def test_a_file_that_is_no_dxf_text_is_refused(content: bytes, words: str, tmp_path: Path) -> None:
    path = tmp_path / "x.dxf"
    path.write_bytes(content)
    with pytest.raises(UserError, match=words):
        convert(path, Options())


@pytest.mark.req("MILL-DXF-12")
def test_damage_anywhere_in_a_file_gives_a_program_or_an_error(tmp_path: Path) -> None:
    document = drawing(1, "R12")
    square(document.modelspace())
    document.modelspace().add_circle((5, 5), 1)
    path = tmp_path / "part.dxf"
    document.saveas(path)
    lines = path.read_text().splitlines()
    first = lines.index("ENTITIES")
    chance = random.Random(4)
    refused = 0
    for _ in range(40):
        damaged = lines.copy()
        for _ in range(3):
            where = chance.randrange(first, len(damaged))
            damaged[where] = chance.choice(["", "abc", "-1", "1e999", "nan", "0", "\x00", "999999"])
        path.write_text("\n".join(damaged))
        try:
            text = convert(path, Options()).text
            assert "nan" not in text
            assert "inf" not in text
        except UserError as error:
            refused += 1
            assert "part.dxf" in str(error) or "drawing" in str(error)
    assert refused


def test_a_missing_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"none\.dxf: cannot be read: No such file"):
        convert(tmp_path / "none.dxf", Options())


# --- the programs run -------------------------------------------------------------------


def interpreted(result: Conversion, is_metric: bool = False) -> list[list[tuple[float, float]]]:
    """What the part-program interpreter makes of an imported program, at depth 0."""
    store = Store(is_metric=is_metric)
    program = load(result.text, store)
    assert not program.errors
    here, depth = (0.0, 0.0), 1.0
    runs: list[list[tuple[float, float]]] = []
    for entry in unrolled(Interpreter(program, store, VirtualMachine()).entries()):
        if isinstance(entry, Rapid | Line | Arc):
            end = (entry.end[0], entry.end[1])
            if entry.end[2] == 0.0 and depth > 0.0:
                runs.append([here])
            elif isinstance(entry, Arc):
                runs[-1] += arc_points(entry, here)
            elif isinstance(entry, Line):
                runs[-1].append(end)
            here, depth = end, entry.end[2]
    return runs


def arc_points(arc: Arc, start: tuple[float, float]) -> list[tuple[float, float]]:
    (x, y), points = arc.centre, []
    angle = math.atan2(start[1] - y, start[0] - x)
    for k in range(1, 181):
        turned = angle + arc.sweep_rad * k / 180
        points.append(
            (x + arc.end_radius * math.cos(turned), y + arc.end_radius * math.sin(turned))
        )
    return points


@pytest.mark.req("MILL-DXF-08", "MILL-DXF-13", "MILL-LOAD-DXF")
@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10**9), count=st.integers(3, 12), units=st.sampled_from([1, 4, 5]))
def test_an_imported_program_runs_around_the_drawing(
    seed: int, count: int, units: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Outlines of lines, arcs and polylines, through the file, the program and the interpreter."""
    chance = random.Random(seed)
    corners = []
    for k in range(count):
        angle, r = 2 * math.pi * (k + 0.6 * chance.random()) / count, chance.uniform(2, 5)
        corners.append((20 + r * math.cos(angle), 10 + r * math.sin(angle)))
    bulges = [chance.choice((0.0, chance.uniform(-0.3, 0.3))) for _ in corners]
    document = drawing(units)
    whole = document.modelspace().add_lwpolyline(
        [(x, y, b) for (x, y), b in zip(corners, bulges, strict=True)], format="xyb", close=True
    )
    whole.explode()
    folder = tmp_path_factory.mktemp("dxf")
    is_ccw = chance.random() < 0.5
    result = converted(document, folder, is_counter_clockwise=is_ccw)
    factor = {1: 1.0, 4: 1 / 25.4, 5: 10 / 25.4}[units]  # the interpreter speaks inches here
    (run,) = interpreted(result)
    assert run[0] == pytest.approx(run[-1])
    shape = Polygon(run)
    # The sign of the area: rounded arcs can cross themselves by a hair at the lowest point.
    area = sum(
        x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(run, [*run[1:], run[0]], strict=True)
    )
    assert (area > 0.0) == is_ccw
    wanted = bulged_area(corners, bulges) * factor**2
    assert shape.area == pytest.approx(wanted, rel=1e-3)
    for x, y in corners:
        assert shape.exterior.distance(Point(x * factor, y * factor)) < 1e-4


def bulged_area(corners: list[tuple[float, float]], bulges: list[float]) -> float:
    """The area of a polygon plus that of its circular segments."""
    area = float(Polygon(corners).area)
    for (x0, y0), (x1, y1), b in zip(corners, [*corners[1:], corners[0]], bulges, strict=True):
        if b:
            chord, sweep = math.hypot(x1 - x0, y1 - y0), 4 * math.atan(abs(b))
            r = chord / (2 * math.sin(sweep / 2))
            area += math.copysign(r * r / 2 * (sweep - math.sin(sweep)), b)
    return area


@pytest.mark.req("MILL-DXF-04", "MILL-DXF-08")
def test_an_imported_drill_pattern_drills(tmp_path: Path) -> None:
    document = drawing()
    holes = [(1.0, 0.0), (2.0, 3.0), (5.0, 1.0)]
    for hole in holes:
        document.modelspace().add_point(hole)
    store = Store()
    program = load(converted(document, tmp_path, pattern=Pattern.DRILL).text, store)
    assert not program.errors
    entries = Interpreter(program, store, VirtualMachine()).entries()
    bottoms = [e.end[:3] for e in entries if isinstance(e, Line) and e.end[2] < 0]
    assert sorted(bottoms) == [(x, y, -0.5) for x, y in holes]


# --- compensation -----------------------------------------------------------------------


def compensated(result: Conversion, radius: float, offset: int = 3) -> MultiLineString:
    """The path of the tool's centre at depth 0; nothing may be wrong with it."""
    store = Store()
    store.write(1000 + offset, radius)
    found = survey(load(result.text, store), store)
    assert [str(each) for each in found.errors] == []
    assert not [each for each in found.warnings if each.code in ("W312", "W320", "W323")]
    runs: list[list[tuple[float, float]]] = []
    here, depth = (0.0, 0.0), 1.0
    program = load(result.text, store)
    for entry in unrolled(Interpreter(program, store, VirtualMachine()).entries()):
        if isinstance(entry, Rapid | Line | Arc):
            end = (entry.end[0], entry.end[1])
            if entry.end[2] == 0.0 and depth > 0.0:
                runs.append([end])
            elif entry.end[2] == 0.0:
                runs[-1] += [*(arc_points(entry, here) if isinstance(entry, Arc) else ()), end]
            here, depth = end, entry.end[2]
    return MultiLineString(runs)


@pytest.mark.parametrize("is_ccw", [False, True])
def test_the_tool_stays_outside_outlines_and_inside_holes(is_ccw: bool, tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    square(space, side=6.0)
    space.add_circle((3, 3), 1.5)
    options = {"is_counter_clockwise": is_ccw, "d_number": 3, "radius": 0.25, "lead": 0.6}
    result = converted(document, tmp_path, **options)
    assert result.summary == "2 chains (2 closed) of 5 entities"
    outside, inside = ("G42", "G41") if is_ccw else ("G41", "G42")
    codes = [line[:6] for line in result.text.splitlines() if line.startswith(("G41", "G42"))]
    assert codes == [f"{inside} D3", f"{outside} D3"]  # the hole before its plate
    path = compensated(result, 0.25)
    hole = Point(3, 3).buffer(1.5, 256)
    plate = Polygon([(0, 0), (6, 0), (6, 6), (0, 6)]).difference(hole)
    assert path.intersection(plate.buffer(0.249)).length == pytest.approx(0.0, abs=2e-3)
    for edge in (plate.exterior, plate.interiors[0]):
        for k in range(100):
            spot = edge.interpolate(k / 100, normalized=True)
            assert path.distance(spot) == pytest.approx(0.25, abs=2e-3)


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**9), count=st.integers(3, 9))
def test_random_outlines_are_entered_and_left_without_a_cut(
    seed: int, count: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    chance = random.Random(seed)
    corners = []
    for k in range(count):
        angle, r = 2 * math.pi * (k + 0.6 * chance.random()) / count, chance.uniform(3, 5)
        corners.append((r * math.cos(angle), r * math.sin(angle)))
    document = drawing()
    document.modelspace().add_lwpolyline(corners, close=True)
    folder = tmp_path_factory.mktemp("dxf")
    result = converted(document, folder, d_number=3, radius=0.125, lead=0.5)
    path = compensated(result, 0.125)
    assert path.intersection(Polygon(corners).buffer(0.124)).length < 2e-3


def test_a_hole_without_room_for_the_tool_is_left_out_with_a_note(tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    square(space, side=6.0)
    space.add_circle((3, 3), 0.2)
    space.add_line((9, 9), (10, 9))
    result = converted(document, tmp_path, d_number=3, radius=0.25)
    assert result.notes == (
        "left out: a chain at 3.2, 3: D3 has no room beside it",
        "open chains are not compensated: 1",
    )
    assert compensated(result, 0.25).length > 24
    space.add_circle((3, 3), 1.0)  # with the small one in it, a ring 0.8 wide
    ring = converted(document, tmp_path, d_number=3, radius=0.25)
    assert ring.notes == ("open chains are not compensated: 1",)
    assert compensated(ring, 0.25).length > 26
    # A smaller lead circle fits where the wanted one does not.
    assert converted(document, tmp_path, d_number=3, radius=0.1, lead=5.0).text.count("D3") == 3


def test_entities_drawn_twice_are_cut_once(tmp_path: Path) -> None:
    document = drawing()
    square(document.modelspace())
    square(document.modelspace())
    result = converted(document, tmp_path)
    assert result.notes == ("drawn twice, left out: 4",)
    assert trace(result.text).length == 8.0
