"""A part of a search in `make test`, all of it in `make soak`."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from tests import search

from openacr.compiled import is_compiled

TEST = """
from hypothesis import given, strategies as st
from tests.search import search, sparse, stride
import pytest

@search(60, derandomize=True)
@given(st.integers())
def test_drawn(n):
    print("drawn")

@pytest.mark.search
def test_stridden():
    print("tick " * len(range(0, 60, stride(1))))

@pytest.mark.parametrize(("n", "m"), sparse([(n, -n) for n in range(7)], 3))
def test_sparse(n, m):
    assert m == -n
    print("sparse")
"""


@pytest.mark.parametrize(
    ("marks", "environment", "counts"),
    [("not soak", {}, (10, 10, 3)), ("soak or search", {"OPENACR_SEARCH": "whole"}, (60, 60, 4))],
)
@pytest.mark.skipif(not is_compiled, reason="plain Python tries few")
def test_make_test_tries_a_part_and_make_soak_the_rest(
    tmp_path: Path, marks: str, environment: dict[str, str], counts: tuple[int, ...]
) -> None:
    (tmp_path / "test_it.py").write_text(TEST)
    markers = "-omarkers=search\nsoak"
    options = [
        "-p",
        "no:cacheprovider",
        "-p",
        "no:xdist",
        "-s",
        markers,
        "--rootdir",
        str(tmp_path),
    ]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-c", os.devnull, *options, "-m", marks, "test_it.py"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])} | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert tuple(map(done.stdout.count, ("drawn", "tick", "sparse"))) == counts


def test_plain_python_tries_few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "is_compiled", False)
    assert [search.examples(whole) for whole in (10, 600)] == [2, 4]
    assert search.stride(2) == 100


def test_of_sparse_cases_the_first_is_tried_and_none_is_lost() -> None:
    found: list[Any] = search.sparse(range(7), 3)
    assert [each.values for each in found] == [(n,) for n in range(7)]
    assert [bool(each.marks) for each in found] == [False, True, True, False, True, True, False]
