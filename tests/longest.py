"""Which files of tests take longest: these begin first, so that no worker is left with them alone.

A run notes the seconds of each file in the cache of pytest and sorts by what the last one noted.
Of a file without a note `tests/longest.json` counts, which is such a note
(`build/pytest/v/openacr/seconds`) of a whole run. A file that neither knows may be a long one: it
begins before all others.
"""

import json
from collections import defaultdict
from collections.abc import Iterable, Mapping
from math import inf
from pathlib import Path

import pytest

GIVEN = Path(__file__).with_suffix(".json")
KEY = "openacr/seconds"
Seconds = dict[str, float]


def sort(items: list[pytest.Item], seconds: Mapping[str, float]) -> None:
    """Sort tests by the time of their file, those of one file as they are."""
    items.sort(key=lambda item: -seconds.get(file_of(item.nodeid), inf))


def file_of(test: str) -> str:
    """The file of a test."""
    return test.partition("::")[0]


def noted(cache: pytest.Cache | None) -> Seconds:
    """The seconds of each file: those of the last run, else those of the sources."""
    given: Seconds = json.loads(GIVEN.read_text())
    return given | (cache.get(KEY, {}) if cache else {})


def measured(reports: Iterable[pytest.TestReport]) -> Seconds:
    """The seconds of each file of a run."""
    seconds: Seconds = defaultdict(float)
    for report in reports:
        seconds[file_of(report.nodeid)] += report.duration
    return {name: round(value, 1) for name, value in sorted(seconds.items())}
