"""Programs in the style of the post-processors that shops use, read as they are meant.

Lengths and extents are worked out by hand from the words of each file.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from shapely.geometry import LinearRing, Point, box
from tests.cnc.programs import made, shown, unrolled

from openacr.cnc.canonical import (
    Arc,
    Coolant,
    Dwell,
    End,
    Entry,
    Line,
    Output,
    Rapid,
    Spindle,
    Stop,
    Tool,
)  # fmt: skip
from openacr.cnc.interpreter.survey import survey
from openacr.cnc.loading.load import load
from openacr.cnc.state.shadow import Shadow
from openacr.mill.config.dialects import choose
from openacr.sysvar import Store

pytestmark = pytest.mark.evidence("oracle", "lengths worked out by hand, offsets of shapely")

EVENTS = (Tool, Spindle, Coolant, Dwell, Output, Stop, End)
FIELD = Path(__file__).parents[1] / "data" / "field"


@dataclass(frozen=True)
class Part:
    """What a file is to become; lengths in its own unit."""

    name: str
    dialect: str
    unit: str
    feed: float
    low: tuple[float, float, float]
    high: tuple[float, float, float]
    moves: dict[str, int]
    events: list[str] = field(default_factory=list)  # tools, spindle, coolant, dwells, the end
    errors: list[str] = field(default_factory=list)
    warned: set[str] = field(default_factory=set)  # warnings beside W405: nothing is wired here


PARTS = [
    Part(
        "fusion_style", "rs274ngc", "mm",
        17.0 - 10.0 + 40.0 + 2.5 * math.pi + 15.0 + 45.0,  # down from 5 to -2
        (-5.0, 0.0, -2.0), (40.0, 20.0, 15.0),
        {"rapid": 5, "feed": 4, "arc": 1, "dwell": 0},
        ["tool 1", "M3 S5000", "M5 S5000", "end"],
    ),
    Part(
        "mastercam_style", "rs274ngc", "inch", 3 * 0.35,
        (1.0, 1.0, -0.25), (2.0, 2.0, 0.5),
        {"rapid": 11, "feed": 3, "arc": 0, "dwell": 0},
        ["tool 2", "M3 S1200", "M5 S1200", "end"],
        warned={"W212"},
    ),
    Part(
        "vectric_style", "rs274ngc", "mm", 11.0 + 10.0 + 5.0 * math.pi + 10.0,
        (0.0, 0.0, -1.0), (30.0, 5.0, 10.0),
        {"rapid": 2, "feed": 3, "arc": 1, "dwell": 0},
        ["M3 S12000", "M5 S12000", "end"],
    ),
    Part(
        "owords_style", "rs274ngc", "mm", 4 * 5.0,
        (5.0, 5.0, -3.0), (35.0, 5.0, 2.0),
        {"rapid": 9, "feed": 4, "arc": 0, "dwell": 0},
        ["end"],
    ),
    Part(
        "guide_style", "acromill", "inch", 4 * 0.75,
        (-2.0, -2.0, -0.25), (2.0, 2.0, 0.5),
        {"rapid": 9, "feed": 4, "arc": 0, "dwell": 0},
        ["end"],
    ),
    Part(
        "freecad_style", "rs274ngc", "mm",
        # down, around with corners of 2, two half turns of a helix that sink .5 each
        4.5 + 80.0 + 4.0 * math.pi + 2.0 * math.hypot(2.0 * math.pi, 0.5),
        (-2.0, -2.0, -1.5), (32.0, 12.0, 15.0),
        {"rapid": 7, "feed": 5, "arc": 6, "dwell": 0},
        ["M5 S0", "tool 4", "M3 S18000", "M5 S18000", "end"],
    ),
    Part(
        "estlcam_style", "rs274ngc", "mm", 1.5 + 2 * 20.0 + 2 * 5.0 * math.pi,
        (-5.0, -10.0, -1.0), (25.0, 0.0, 5.0),
        {"rapid": 3, "feed": 3, "arc": 2, "dwell": 0},
        ["M3 S24000", "M3 S24000", "M5 S24000", "end"],
    ),
    Part(
        "sheetcam_plasma_style", "rs274ngc", "mm", 3.8 - 1.5 + 10.0 * math.pi,
        (5.0, 5.0, 1.5), (15.0, 15.0, 20.0),
        {"rapid": 5, "feed": 1, "arc": 3, "dwell": 2},
        ["tool 1", "M3 S500", "dwell 0.6", "M5 S500", "dwell 0.4", "M5 S500", "end"],
    ),
    Part(
        "pcb_isolation_style", "rs274ngc", "mm",
        2.05 + 2 * 3.0 + 2 * 1.0 + 4 * math.sqrt(0.5),
        (0.5, 0.5, -0.05), (4.5, 2.5, 2.0),
        {"rapid": 3, "feed": 9, "arc": 0, "dwell": 1},
        ["M3 S20000", "dwell 1", "coolant 00", "M5 S20000", "end"],
    ),
    Part(
        "pcb_drill_style", "rs274ngc", "mm", 3 * (1.0 + 1.8) + 2 * (1.0 + 2.0),
        (0.0, 1.0, -2.0), (8.0, 5.0, 5.0),
        {"rapid": 16, "feed": 5, "arc": 0, "dwell": 4},
        ["M5 S20000", "tool 1", "M3 S20000", "dwell 1",
         "M5 S20000", "tool 2", "M3 S20000", "dwell 1", "dwell 0.2", "dwell 0.2",
         "M5 S20000", "coolant 00", "end"],
    ),
    Part(
        # 3 outside of 30 x 20; leads of radius 8 - 3, and lines over 8 that shift by 3
        "lead_in_left_style", "rs274ngc", "mm",
        3.0 + 100.0 + 6.0 * math.pi + 2 * (2.5 * math.pi + math.hypot(8.0, 3.0)),
        (-16.0, -3.0, -1.0), (33.0, 23.0, 20.0),
        {"rapid": 3, "feed": 8, "arc": 6, "dwell": 0},
        ["tool 3", "M3 S8000", "M5 S8000", "end"],
    ),
    Part(
        # The lead-in: from (-8, 18) to (-3, 10), there downwards: about (-3 - q, 10) where
        # (5 - q)^2 + 8^2 = q^2, which is q = 8.9.
        "lead_in_arc_style", "rs274ngc", "mm",
        3.0 + 8.9 * math.atan2(8.0, 3.9) + 100.0 + 6.0 * math.pi
        + 2.5 * math.pi + math.hypot(8.0, 3.0),
        (-16.0, -3.0, -1.0), (33.0, 23.0, 20.0),
        {"rapid": 3, "feed": 7, "arc": 6, "dwell": 0},
        ["tool 3", "M3 S8000", "M5 S8000", "end"],
    ),
    Part(
        # 2 inside of a circle of radius 10; leads of radius 5 - 2, and lines over 5
        "lead_in_right_style", "acromill", "inch",
        1.5 + 16.0 * math.pi + 2 * (1.5 * math.pi + math.hypot(5.0, 2.0)),
        (-8.0, -8.0, -0.5), (8.0, 8.0, 1.0),
        {"rapid": 3, "feed": 3, "arc": 3, "dwell": 0},
        ["tool 2", "M3 S900", "M5 S900", "end"],
    ),
    Part(
        "wrong_dialect", "acromill", "inch", 2.0, (10.0, 5.0, 0.0), (12.0, 5.0, 0.0),
        {"rapid": 1, "feed": 1, "arc": 0, "dwell": 0},
        [],
        [
            "wrong_dialect.nc:6:11: E230 arc radii differ too much: 12.649 and 13.928"
            " (I, J, K counted from the start of the arc fit: G200 F1, P250003 = 1 or"
            " --dialect rs274ngc)"
        ],
        {"E230"},
    ),
]  # fmt: skip


def test_every_file_has_its_expectation() -> None:
    assert {path.stem for path in FIELD.glob("*.nc")} == {part.name for part in PARTS}


@pytest.mark.parametrize("part", PARTS, ids=lambda part: part.name)
def test_a_program_of_the_field_is_read_as_it_is_meant(part: Part) -> None:
    path = FIELD / f"{part.name}.nc"
    store = Store()
    assert choose(path, store).name == part.dialect
    shadow = Shadow(store)
    events: list[str] = []

    def note(entry: Entry) -> None:
        if isinstance(entry, EVENTS):
            events.append(shown(entry))

    found = survey(load(path, shadow, part.dialect), shadow, part.dialect, look=note)
    assert {finding.code for finding in found.findings} - {"W405"} <= part.warned
    assert events == part.events
    assert [str(finding) for finding in found.errors] == part.errors
    data = found.data()
    assert data["unit"] == part.unit
    assert data["length"]["feed"] == pytest.approx(part.feed, abs=1e-6)
    assert data["extents"]["min"] == pytest.approx(part.low, abs=1e-6)
    assert data["extents"]["max"] == pytest.approx(part.high, abs=1e-6)
    assert data["moves"] == part.moves


MM = 25.4
PLATE = box(0.0, 0.0, 30.0, 20.0)
HOLE = Point(0.0, 0.0).buffer(10.0, quad_segs=4096)


@pytest.mark.parametrize(
    ("name", "dialect", "scale", "ring", "tool"),
    [
        ("lead_in_left_style", "rs274ngc", MM, PLATE.buffer(3.0, quad_segs=4096).exterior, 3.0),
        ("lead_in_arc_style", "rs274ngc", MM, PLATE.buffer(3.0, quad_segs=4096).exterior, 3.0),
        ("lead_in_right_style", "acromill", 1.0, HOLE.buffer(-2.0).exterior, 2.0),
    ],
)
def test_the_tool_runs_on_the_offset_of_the_contour_and_never_into_it(
    name: str, dialect: str, scale: float, ring: LinearRing, tool: float
) -> None:
    done = made(FIELD / f"{name}.nc", dialect=dialect)
    part = HOLE.exterior if name == "lead_in_right_style" else PLATE
    here = (0.0, 0.0)
    on_ring = 0.0
    for entry in unrolled(done.interpreter.entries()):
        if not isinstance(entry, Line | Arc | Rapid):
            continue
        places = [(x * scale, y * scale) for x, y in samples(here, entry)]
        here = (entry.end[0], entry.end[1])
        if isinstance(entry, Rapid):
            continue
        assert min(Point(place).distance(part) for place in places) >= tool - 1e-3
        middles = [Point(place) for place in places[1:-1]]
        if all(place.distance(ring) < 1e-3 for place in middles):
            on_ring += sum(map(math.dist, places, places[1:]))
    assert on_ring == pytest.approx(ring.length, rel=1e-3)


def samples(start: tuple[float, float], move: Line | Arc | Rapid) -> list[tuple[float, float]]:
    """Points along a move in the plane, its ends included."""
    steps = 256
    end = (move.end[0], move.end[1])
    if isinstance(move, Arc):
        (cx, cy), radius = move.centre, math.dist(start, move.centre)
        first = math.atan2(start[1] - cy, start[0] - cx)
        angles = [first + move.sweep_rad * k / steps for k in range(steps + 1)]
        return [(cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in angles]
    return [
        (start[0] + (end[0] - start[0]) * k / steps, start[1] + (end[1] - start[1]) * k / steps)
        for k in range(steps + 1)
    ]
