"""Every supplied part, interpreted, against its shape: nothing of the part is cut, its whole
edge is reached, pockets are cleared, holes are where they belong."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from shapely.geometry import LineString, MultiLineString
from tests.cnc.part_models import MODELS, Model
from tests.cnc.programs import unrolled

from openacr.cnc.canonical import Arc, End, Entry, Line, Point, Rapid
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import Folders, load
from openacr.cnc.parts.library import FOLDER, Ready, names, part_named, prepared
from openacr.cnc.parts.part import read_part
from openacr.cnc.state.hosts import VirtualMachine
from openacr.sysvar import Store

pytestmark = pytest.mark.evidence("oracle", "shapes of the parts in shapely")

Spot = tuple[float, float]
DEGREES = 1.0  # between points of an arc
STEPPED = ("POCKET", "RPOCKET", "SLOT", "ARCSLOT", "FACE")  # their step depends on the tool
CASES = [(name, change) for name, model in MODELS.items() for change in model.changes]


@dataclass
class Cut:
    """What a part does below the surface and above it."""

    runs: list[list[Spot]] = field(default_factory=list)
    deepest: float = 0.0
    rapids_below: int = 0
    end: Point = ()
    holes: list[Spot] = field(default_factory=list)
    drilled: float = 0.0


def cut(entries: Iterable[Entry]) -> Cut:
    """Follow the canonical moves."""
    result = Cut()
    here: Point = (0.0,) * 8
    for entry in unrolled(iter(entries)):
        if isinstance(entry, End):
            break
        assert isinstance(entry, Rapid | Line | Arc), entry
        end, is_across = entry.end, entry.end[:2] != here[:2] or isinstance(entry, Arc)
        if isinstance(entry, Rapid):
            result.rapids_below += is_across and min(here[2], end[2]) < 0
        elif is_across and end[2] < 0:
            if not result.runs or result.runs[-1][-1] != _flat(here):
                result.runs.append([_flat(here)])
            result.runs[-1] += _points(entry, here)
        elif end[2] < here[2]:
            if not result.holes or result.holes[-1] != _flat(end):
                result.holes.append(_flat(end))
            result.drilled = min(result.drilled, end[2])
        result.deepest = min(result.deepest, end[2])
        here = end
    result.end = here
    return result


def _flat(point: Point) -> Spot:
    return (point[0], point[1])


def _points(entry: Line | Arc, start: Point) -> list[Spot]:
    if isinstance(entry, Line):
        return [_flat(entry.end)]
    (x, y), sweep = entry.centre, entry.sweep_rad
    angle = math.atan2(start[1] - y, start[0] - x)
    count = max(4, math.ceil(abs(math.degrees(sweep)) / DEGREES))
    points = []
    for k in range(1, count):
        r = entry.start_radius + (entry.end_radius - entry.start_radius) * k / count
        turned = angle + sweep * k / count
        points.append((x + r * math.cos(turned), y + r * math.sin(turned)))
    return [*points, _flat(entry.end)]


def ready_for(name: str, change: dict[int, float], radius: float, store: Store) -> Ready:
    model = MODELS[name]
    store.write(250_001, 1 if model.is_metric else 0)
    store.write(1001, radius)
    return prepared(
        part_named(name), change, store, is_metric=model.is_metric, d_number=1 if radius else 0
    )


def run(ready: Ready, store: Store) -> Cut:
    program = load(ready.program, store, folders=Folders(library=FOLDER), name=ready.part.name)
    assert not program.errors
    options = Options(is_library_part=True)
    return cut(Interpreter(program, store, VirtualMachine(), options=options).entries())


def test_every_supplied_part_has_a_shape_to_be_compared_with() -> None:
    assert set(names()) == set(MODELS)


@pytest.mark.req("MILL-LOAD-LIBRARY")
@pytest.mark.parametrize(("name", "change"), CASES)
def test_a_part_follows_its_shape(name: str, change: dict[int, float]) -> None:
    store, model = Store(), MODELS[name]
    ready = ready_for(name, change, 0.0, store)
    done = run(ready, store)
    _assert_shape(model, ready, done, 0.0)


@pytest.mark.req("MILL-LIB-COMP")
@pytest.mark.parametrize("radius", [0.0625, 0.125])
@pytest.mark.parametrize("name", MODELS)
def test_a_part_is_cut_beside_its_shape_with_a_tool(name: str, radius: float) -> None:
    store, model = Store(), MODELS[name]
    unit = 25.4 if model.is_metric else 1.0
    change = {203: 1.2 * radius} if name in STEPPED else {}
    ready = ready_for(name, change, radius * unit, store)
    _assert_shape(model, ready, run(ready, store), radius * unit)


def _assert_shape(model: Model, ready: Ready, done: Cut, radius: float) -> None:
    unit = 25.4 if model.is_metric else 1.0
    values, close = ready.values, 0.002 * unit
    assert done.rapids_below == 0
    assert done.end[:2] == pytest.approx((0.0, 0.0))
    assert done.end[2] == pytest.approx(values[222])
    path = MultiLineString([run for run in done.runs if len(run) > 1])
    if model.keeps is not None:
        shape = model.keeps(values)
        assert done.deepest == pytest.approx(-values[220])
        assert path.intersection(shape.buffer(radius - close)).length == pytest.approx(0, abs=1e-9)
        rounded = shape.buffer(radius).buffer(-radius)  # no tool gets into inner corners
        _assert_reached(path, model.rim(values) if model.rim else rounded.boundary, radius, close)
    if model.clears is not None:
        shape = model.clears(values)
        assert done.deepest == pytest.approx(-values[220])
        assert path.difference(shape.buffer(close - radius)).length == pytest.approx(0, abs=1e-9)
        # With no tool, half a step to either side is what a tool would clear.
        cleared = path.buffer(radius or values[203] * 0.75)
        reachable = shape.buffer(-radius).buffer(radius)
        assert reachable.difference(cleared).area < 1e-3 * reachable.area
    if model.covers is not None:
        cleared = path.buffer(radius or values[203] * 0.75)
        assert model.covers(values).difference(cleared).area == pytest.approx(0, abs=1e-9)
    if model.holes is not None:
        wanted = sorted(_rounded(hole) for hole in model.holes(values))
        assert sorted(_rounded(hole) for hole in done.holes[: len(wanted)]) == wanted
        assert done.drilled == pytest.approx(-values.get(223, values.get(220, 0.0)))


def _assert_reached(path: MultiLineString, edge: LineString, radius: float, close: float) -> None:
    points = [edge.interpolate(k / 300, normalized=True) for k in range(300)]
    assert max(path.distance(point) for point in points) < radius + close


def _rounded(hole: Spot) -> Spot:
    return (round(hole[0], 6) + 0.0, round(hole[1], 6) + 0.0)


@pytest.mark.parametrize("angle", [1.0, 10.0])
@pytest.mark.parametrize("name", ["POCKET", "RPOCKET", "SLOT", "ARCSLOT"])
def test_a_ramp_goes_down_no_steeper_than_its_angle(name: str, angle: float) -> None:
    store = Store()
    ready = ready_for(name, {207: angle}, 0.125, store)
    program = load(ready.program, store, folders=Folders(library=FOLDER), name=name)
    entries = Interpreter(
        program, store, VirtualMachine(), options=Options(is_library_part=True)
    ).entries()
    here: Point = (0.0,) * 8
    reached = 0.0  # what is open already
    for entry in unrolled(iter(entries)):
        if not isinstance(entry, Rapid | Line | Arc):
            continue
        if not isinstance(entry, Rapid) and entry.end[2] < reached:
            path = LineString([_flat(here), *_points(entry, here)])
            fall = reached - entry.end[2]
            assert fall <= path.length * math.tan(math.radians(angle)) + 1e-4, entry.source
        reached, here = min(reached, entry.end[2]), entry.end
    assert reached == pytest.approx(-0.25)


@pytest.mark.parametrize("name", ["CIRCLE", "LBRACKET", "WASHER"])
def test_without_d_the_tool_is_that_of_the_run_set_up(name: str) -> None:
    store, model = Store(), MODELS[name]
    store.write(100_020, 0.125)
    ready = prepared(part_named(name), {}, store, is_metric=False)
    assert "D1" not in ready.program.splitlines()
    _assert_shape(model, ready, run(ready, store), 0.125)


def test_parts_work_in_millimetres_as_in_inches() -> None:
    inch, metric = Store(), Store(is_metric=True)
    part = part_named("RECTANGLE")
    small = run(prepared(part, {}, inch, is_metric=False), inch)
    large = run(prepared(part, {}, metric, is_metric=True), metric)
    for a, b in zip(small.runs, large.runs, strict=True):
        scaled = LineString([(25.4 * x, 25.4 * y) for x, y in a])
        assert scaled.hausdorff_distance(LineString(b)) < 1.0  # the leads have 0.01 of a unit more


@pytest.mark.req("MILL-LIB-IJ", "MILL-SYS-CTL-LIBIJ")
@pytest.mark.parametrize(
    ("code", "words"), [(0, "I0 J-1"), (1, "I0 J1"), (2, "I1 J2")], ids=["F0", "F1", "F2"]
)
def test_arcs_of_a_part_are_read_by_the_setting_for_parts(
    code: int, words: str, tmp_path: Path
) -> None:
    """Start (1,1), centre (1,2), by the three readings; that of user programs has no say."""
    path = tmp_path / "ARC.TXT"
    path.write_text(f";PART Arc\nG90 G17\nG1 X1 Y1 Z-1\nG3 X1 Y1 {words}\nG0 X0 Y0 Z0\nM2\n")
    for user in (0, 1, 2):
        store = Store()
        store.write(250_003, user)
        store.write(250_004, code)
        done = run(prepared(read_part(path), {}, store, is_metric=False), store)
        assert max(y for _, y in done.runs[0]) == pytest.approx(3.0)
