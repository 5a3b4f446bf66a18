"""Files of tests that take longest begin first."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests import longest


def test_files_that_take_longest_come_first_and_their_tests_keep_their_order() -> None:
    names = ["a.py::one", "b.py::one", "a.py::two", "c.py::one", "b.py::two", "new.py::one"]
    items: list[Any] = [SimpleNamespace(nodeid=name) for name in names]
    longest.sort(items, {"a.py": 0.0, "b.py": 2.0, "c.py": 3.0})
    assert [item.nodeid for item in items] == [
        "new.py::one", "c.py::one", "b.py::one", "b.py::two", "a.py::one", "a.py::two",
    ]  # fmt: skip


def test_the_seconds_of_a_file_are_those_of_its_tests_with_their_fixtures() -> None:
    spent = [("a.py::one[x::y]", 0.25), ("b.py::one", 1.0), ("a.py::one[x::y]", 2.0)]
    reports: list[Any] = [SimpleNamespace(nodeid=n, duration=s) for n, s in spent]
    assert longest.measured(reports) == {"a.py": 2.2, "b.py": 1.0}


def test_what_the_last_run_noted_counts_and_before_it_what_the_sources_say(
    pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    cache = pytest.Cache(tmp_path, pytestconfig, _ispytest=True)
    given = json.loads(longest.GIVEN.read_text())
    assert longest.noted(cache) == longest.noted(None) == given
    cache.set(longest.KEY, {"a.py": 2.0})
    assert longest.noted(cache) == given | {"a.py": 2.0}
