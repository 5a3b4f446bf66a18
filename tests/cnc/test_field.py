"""Programs in the style of the post-processors that shops use, read as they are meant.

Lengths and extents are worked out by hand from the words of each file.
"""

import math
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from openacr.cnc.canonical import Entry
from openacr.cnc.load import load
from openacr.cnc.shadow import Shadow
from openacr.cnc.survey import survey
from openacr.mill.dialects import choose
from openacr.sysvar import Store

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
    errors: list[str] = field(default_factory=list)


PARTS = [
    Part(
        "fusion_style", "rs274ngc", "mm",
        17.0 - 10.0 + 40.0 + 2.5 * math.pi + 15.0 + 45.0,  # down from 5 to -2
        (-5.0, 0.0, -2.0), (40.0, 20.0, 15.0),
        {"rapid": 5, "feed": 4, "arc": 1, "dwell": 0},
    ),
    Part(
        "mastercam_style", "rs274ngc", "inch", 3 * 0.35,
        (1.0, 1.0, -0.25), (2.0, 2.0, 0.5),
        {"rapid": 11, "feed": 3, "arc": 0, "dwell": 0},
    ),
    Part(
        "vectric_style", "rs274ngc", "mm", 11.0 + 10.0 + 5.0 * math.pi + 10.0,
        (0.0, 0.0, -1.0), (30.0, 5.0, 10.0),
        {"rapid": 2, "feed": 3, "arc": 1, "dwell": 0},
    ),
    Part(
        "owords_style", "rs274ngc", "mm", 4 * 5.0,
        (5.0, 5.0, -3.0), (35.0, 5.0, 2.0),
        {"rapid": 9, "feed": 4, "arc": 0, "dwell": 0},
    ),
    Part(
        "guide_style", "acromill", "inch", 4 * 0.75,
        (-2.0, -2.0, -0.25), (2.0, 2.0, 0.5),
        {"rapid": 9, "feed": 4, "arc": 0, "dwell": 0},
    ),
    Part(
        "wrong_dialect", "acromill", "inch", 2.0, (10.0, 5.0, 0.0), (12.0, 5.0, 0.0),
        {"rapid": 1, "feed": 1, "arc": 0, "dwell": 0},
        [
            "wrong_dialect.nc:6:11: E230 arc radii differ too much: 12.649 and 13.928"
            " (I, J, K counted from the start of the arc fit: G200 F1, P250003 = 1 or"
            " --dialect rs274ngc)"
        ],
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
    kinds: Counter[str] = Counter()

    def count(entry: Entry) -> None:
        kinds[type(entry).__name__] += 1

    found = survey(load(path, shadow, part.dialect), shadow, part.dialect, look=count)
    assert [str(finding) for finding in found.errors] == part.errors
    data = found.data()
    assert data["unit"] == part.unit
    assert data["length"]["feed"] == pytest.approx(part.feed, abs=1e-6)
    assert data["extents"]["min"] == pytest.approx(part.low, abs=1e-6)
    assert data["extents"]["max"] == pytest.approx(part.high, abs=1e-6)
    assert data["moves"] == part.moves
