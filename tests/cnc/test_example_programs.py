"""The programs in parts/: checked by geometry, and run on the virtual machine."""

import math
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from shapely.geometry import LineString, Point, Polygon, box
from tests.cnc.programs import unrolled

from openacr.cnc.canonical import Arc, Entry, Line, Probe, Rapid, Say
from openacr.cnc.canonical import Point as Place
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.interpreter.survey import survey
from openacr.cnc.loading.batch import read_batch
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.mill.config.dialects import dialect_of
from openacr.mill.session import MillSession, Start
from openacr.sysvar import Store
from openacr.sysvar.exchange import imported

pytestmark = pytest.mark.evidence("oracle", "shapes of the parts in shapely")

PARTS = Path(__file__).parents[2] / "parts"
PROGRAMS = sorted(path.name for path in PARTS.glob("*.nc"))
MM = 25.4
Spot = tuple[float, float]


def store_for(name: str) -> Store:
    store = Store()
    for output, cell in enumerate((800_005, 800_009, 800_010), 40):  # spindle, mist, flood
        store.write(cell, output)
    if name == "knife_letter.nc":
        imported(store, (PARTS / "knife.toml").read_text(), "knife.toml")
    return store


def entries_of(name: str, machine: VirtualMachine | None = None) -> list[Entry]:
    store = store_for(name)
    dialect = dialect_of(PARTS / name, store, None)
    program = load(PARTS / name, store, dialect)
    assert program.findings == []
    run = Interpreter(program, Shadow(store), machine or VirtualMachine(), dialect)
    return list(unrolled(run.entries()))


def runs_at(entries: list[Entry], depth: float, scale: float = 1.0) -> list[list[Spot]]:
    """The paths in the plane at a depth, with arcs as points; lengths times a scale."""
    runs: list[list[Spot]] = []
    here: Place = (0.0,) * 8
    for entry in entries:
        if not isinstance(entry, Rapid | Line | Arc):
            continue
        if entry.end[2] * scale == pytest.approx(depth):
            if here[2] * scale != pytest.approx(depth):
                runs.append([])
            elif isinstance(entry, Arc):
                runs[-1] += around(entry, here, scale)
            runs[-1].append((entry.end[0] * scale, entry.end[1] * scale))
        here = entry.end
    return runs


def around(arc: Arc, start: Place, scale: float) -> list[Spot]:
    (x, y), radius = arc.centre, arc.end_radius
    angle = math.atan2(start[1] - y, start[0] - x)
    turns = (angle + arc.sweep_rad * k / 90 for k in range(1, 90))
    return [((x + radius * math.cos(t)) * scale, (y + radius * math.sin(t)) * scale) for t in turns]


def bottoms(entries: list[Entry], depth: float) -> list[Spot]:
    """Where lines go straight down to a depth."""
    found: list[Spot] = []
    here: Place = (0.0,) * 8
    for entry in entries:
        if isinstance(entry, Rapid | Line | Arc):
            if entry.end[2] == pytest.approx(depth) and entry.end[:2] == here[:2]:
                found.append((round(entry.end[0], 6), round(entry.end[1], 6)))
            here = entry.end
    return list(dict.fromkeys(found))


def on_circle(radius: float, count: int, first_deg: float = 0.0) -> list[Spot]:
    angles = (math.radians(first_deg + 360 * k / count) for k in range(count))
    return [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]


# --- geometry ---------------------------------------------------------------------------


def test_the_plate_is_cut_beside_its_pocket_and_its_outline() -> None:
    entries = entries_of("plate.nc")
    (outline,) = (LineString(run) for run in runs_at(entries, -3.0, MM))
    plate = box(0, 0, 80, 50)
    assert outline.intersection(plate.buffer(2.999)).length == pytest.approx(0.0, abs=1e-6)
    assert max(outline.distance(Point(p)) for p in plate.exterior.coords) == pytest.approx(
        3.0, abs=1e-3
    )
    pocket = box(25, 20, 55, 30).buffer(5)
    for depth in (-2.0, -4.0):
        (travel,) = (LineString(run) for run in runs_at(entries, depth, MM))
        assert travel.difference(pocket.buffer(-2.99)).length == pytest.approx(0.0, abs=1e-3)
        edge = [pocket.exterior.interpolate(k / 200, normalized=True) for k in range(200)]
        assert max(travel.distance(point) for point in edge) == pytest.approx(3.0, abs=0.01)
        assert pocket.difference(travel.buffer(3.01)).area < 1e-3 * pocket.area
    holes = [(x / MM, y / MM) for x, y in ((8, 8), (72, 8), (72, 42), (8, 42))]
    assert bottoms(entries, -10 / MM) == [pytest.approx(hole, abs=1e-6) for hole in holes]


def test_the_bolt_circle_is_spotted_and_drilled_in_pecks() -> None:
    entries = entries_of("bolt_circle.nc")
    wanted = [pytest.approx(spot, abs=1e-6) for spot in on_circle(2.0, 8, 22.5)]
    for depth in (-0.1, -0.3, -0.7, -1.1, -1.2):  # G83 goes down by Q .4 from R .1
        assert bottoms(entries, depth) == wanted


def test_the_macro_cuts_six_squares_that_grow() -> None:
    runs = runs_at(entries_of("macro_grid.nc"), -0.05)
    squares = [Polygon(run) for run in runs]
    sides = [0.4 + 0.1 * (column + 3 * row) for column in range(3) for row in range(2)]
    assert [square.area for square in squares] == [pytest.approx(side**2) for side in sides]
    centres = [(1.5 * column, 1.5 * row) for column in range(3) for row in range(2)]
    assert [square.centroid.coords[0] for square in squares] == [
        pytest.approx(centre, abs=1e-9) for centre in centres
    ]


def test_the_thread_rises_by_its_pitch_beside_the_tool_radius() -> None:
    turns = [
        entry
        for entry in entries_of("thread_mill.nc")
        if isinstance(entry, Arc) and abs(entry.sweep_rad) > 6.0
    ]
    assert len(turns) == 8
    assert [turn.end[2] * MM for turn in turns] == [
        pytest.approx(-12 + 1.5 * (k + 1)) for k in range(8)
    ]
    assert all(turn.end_radius * MM == pytest.approx(10 - 6) for turn in turns)
    assert all(turn.is_compensated for turn in turns)


def test_the_knife_looks_along_its_path() -> None:
    here: Place = (0.0,) * 8
    cuts = 0
    for entry in entries_of("knife_letter.nc"):
        if isinstance(entry, Line | Arc) and entry.end[2] < 0 and entry.end[:2] != here[:2]:
            cuts += 1
            if isinstance(entry, Line):
                travel = math.degrees(math.atan2(entry.end[1] - here[1], entry.end[0] - here[0]))
                assert math.cos(math.radians(entry.end[3] - travel)) == pytest.approx(1.0)
            else:
                assert entry.end[3] - here[3] == pytest.approx(math.degrees(entry.sweep_rad))
        here = entry.end if isinstance(entry, Rapid | Line | Arc) else here
    assert cuts == 5


def test_the_surface_is_its_formula() -> None:
    cut = [entry.end for entry in entries_of("surface.nc") if isinstance(entry, Line)]
    assert len(cut) == 33 * 17
    for x, y, z, *_ in cut:
        wave = math.sin(math.radians(90 * x)) * math.cos(math.radians(90 * y))
        assert z == pytest.approx(0.15 * wave - 0.15)


@dataclass
class Block(VirtualMachine):
    """A block with its corner at machine position 1, 0.8, touched by a ball of .125."""

    touches: list[Place] = field(
        default_factory=lambda: [
            (0.875, 0.0, 0.0, *(0.0,) * 5),
            (0.625, 0.675, 0.0, *(0.0,) * 5),
        ]
    )

    def tripped(self) -> Place | None:
        return self.touches.pop(0) if self.touches else None


def test_the_corner_that_is_touched_becomes_zero() -> None:
    entries = entries_of("probe_corner.nc", Block())
    assert sum(isinstance(entry, Probe) for entry in entries) == 2
    marks = [entry.end[:3] for entry in entries if isinstance(entry, Line) and entry.end[2] < 0]
    assert marks == [pytest.approx((1.0, 0.8, -0.02))]
    texts = [entry.text for entry in entries_of("probe_corner.nc") if isinstance(entry, Say)]
    assert texts == ["nothing was touched: is there a block?"]


def test_a_program_of_another_control_drills_two_circles_and_cuts_a_third() -> None:
    entries = entries_of("flange_ngc.nc")
    for depth, spots in ((-0.4, on_circle(1.5, 6)), (-0.2, on_circle(0.75, 3))):
        assert bottoms(entries, depth) == [pytest.approx(spot, abs=1e-6) for spot in spots]
    (ring,) = (entry for entry in entries if isinstance(entry, Arc))
    assert [ring.end_radius, ring.sweep_rad] == pytest.approx([2.5, 2 * math.pi])


def test_the_batch_runs_the_plate_twice() -> None:
    names = [entry.path.name for entry in read_batch(PARTS / "shift.txt").runs()]
    assert names == ["plate.nc", "plate.nc", "bolt_circle.nc", "macro_grid.nc"]


# --- all of them ------------------------------------------------------------------------


@pytest.mark.parametrize("name", PROGRAMS)
def test_nothing_is_wrong_or_doubtful(name: str) -> None:
    store = store_for(name)
    dialect = dialect_of(PARTS / name, store, None)
    found = survey(load(PARTS / name, store, dialect), store, dialect)
    assert found.findings == []


@pytest.mark.parametrize("name", [each for each in PROGRAMS if each != "probe_corner.nc"])
def test_it_runs_on_the_virtual_machine_to_where_it_ends(name: str) -> None:
    """As a dry run at high speed: the path is the same."""
    store = store_for(name)
    for cell, value in ((650_000, 20_000.0), (650_001, 20_000.0), (650_007, 1e4), (650_008, 1e4)):
        store.write(cell, value)
    dialect = dialect_of(PARTS / name, store, None)
    program = load(PARTS / name, store, dialect)
    shop = MillSession.virtual(store, lambda _text: None)
    shop.start(program, Start(dialect=dialect, is_dry=True, is_repeated=False))
    while shop.runner.is_busy:
        shop.step()
        shop.carry_on()
    assert shop.runner.alarms.active == []
    wanted = survey(program, store, dialect).end
    assert shop.runner.stream.host.position()[:4] == pytest.approx(wanted[:4], abs=2e-4)
